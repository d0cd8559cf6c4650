#pragma once
// What a flat panel reads behind the object: light, stray light, photons, its own faults.

#include <vector>

#include "core/base/progress.h"
#include "core/phantom/scanner/beam.h"
#include "core/phantom/scanner/columns.h"
#include "core/phantom/scanner/geometry.h"

namespace dubsar::phantom {

/// Light that strays over tens of millimetres, on cells of some pixels: smooth over the whole panel.
class StrayField {
 public:
  /// `sigma_px`: standard deviation of the spread; dark beyond the panel.
  StrayField(std::int64_t columns, std::int64_t rows, double sigma_px);
  /// Means of the cells of a view (columns of `stride`), spread.
  std::vector<float> spread(const float* view, std::int64_t stride) const;
  float at(const std::vector<float>& field, std::int64_t column, std::int64_t row) const noexcept;

 private:
  std::int64_t columns_, rows_, cell_, cells_u_, cells_v_;
  std::vector<float> weights_;  ///< of the Gauss, from its middle
};

struct LongestRay {
  double clay_mm = 0.0;
  double scatter = 0.0;  ///< that its pixel sees, of the open beam
};

/// In the order of nature: the curve of the beam, blur of spot and panel, scatter and glare, photons (a compound
/// Poisson law: counts by the light, each worth the mean of its spectrum), electronic noise, gains. Then -ln(light).
///   scatter  its sources are as strong as the light that the object takes on the way (light times -ln light: once
///            scattered and weakened as the primary), Gaussian on the panel, scaled to the amount of the options
///   gains    .6 of the variance is common to neighbouring rows (steps of some forty rows), the rest single; the same
///   in
///            all views; bad pixels last for up to forty rows
/// The bits depend on the seed and the place, not on threads.
class Panel {
 public:
  Panel(const BeamOptions& beam, const PanelOptions& options, const ScanGeometry& geometry, std::uint64_t seed);

  /// `views`: mm of clay along each ray, replaced by what is measured, -ln(light / open light). All threads.
  /// kCancelled.
  Result<LongestRay> expose(Columns& views, Progress& progress) const;

 private:
  void make_gains();
  void blur(float* view, std::int64_t stride, std::vector<float>& row) const;
  void read(std::int64_t view, std::int64_t stride, const std::vector<float>& excess, float* light) const;

  Beam beam_;
  PanelOptions options_;
  ScanGeometry geometry_;
  std::uint64_t seed_;
  Columns offsets_;  ///< -ln(1 + gain error) of a pixel, added to all its readings
};

}  // namespace dubsar::phantom
