#pragma once
// One impression of a seal laid on another: found by likeness, then to fractions of a cell.

#include <array>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "core/seals/relief_level.h"

namespace dubsar {

/// Where places of one impression (mm in its raster) lie in another frame: turn * (p + bend(p)) + shift. Clay gives
/// way, and a straight seal meets a round side: what lies flat does not fit on another impression by turns alone.
struct PlacedOn {
  static constexpr std::size_t kBends = 4;
  glm::dmat2 turn{1.0};
  glm::dvec2 shift{0.0};
  glm::dvec2 middle{0.0};                 ///< of the impression
  std::array<glm::dvec2, kBends> bend{};  ///< mm, of x2, x y, y2, y3 in cm from the middle
  static std::array<double, kBends> bend_terms(const glm::dvec2& from_middle);
  glm::dvec2 operator()(const glm::dvec2& p) const { return turn * (p + bent(p)) + shift; }
  glm::dvec2 back(const glm::dvec2& p) const;

 private:
  glm::dvec2 bent(const glm::dvec2& p) const;
};
/// First b, then a, which is not bent.
PlacedOn after(const PlacedOn& a, const PlacedOn& b);

/// How alike two impressions are, by how far the second is moved along the first: for each shift along, over all
/// shifts across (at most 4 mm), turns of -2, 0 and 2 degrees, and both ways up.
struct Likeness {
  static constexpr double kFigureMm2 = 4.0;  ///< what tells one place from another
  struct At {
    double likeness = 0.0;  ///< correlation where both show something, -1..1
    double area_mm2 = 0.0;  ///< of that
    PlacedOn first_from_second;
    /// Likeness in deviations of what unlike ones have.
    double weight() const;
  };
  double step_mm = 0.0, least_mm = 0.0;
  std::vector<At> along;  ///< at least_mm + k * step_mm
  const At& best() const;
  /// The most likely within .8 mm of a shift; nothing of likeness 0 where both do not meet.
  At near(double shift_mm) const;
};

/// Masked correlation (D. Padfield: Masked object registration in the Fourier domain, 2012), summed directly: bands
/// are small. The same for any number of threads. Cost: about .3 s of a processor for bands of 50 mm.
Likeness likeness_of(const SealImpression& first, const SealImpression& second);

/// Value of a raster between its cells, and 0 of `weight` beside it.
struct Sampled {
  double mm = 0.0, weight = 0.0, figure = 0.0, raised = 0.0;
};
Sampled sampled(const SealImpression& impression, const glm::dvec2& at_mm);

/// Moves `start` until what stands out of the impression lies on that of the frame best: affine and bends, by
/// Gauss, Newton with a bounded loss, so that what only one of both shows does not pull. `period_mm`: of the frame
/// along x; 0: none.
PlacedOn refined(const SealImpression& frame, const SealImpression& impression, const PlacedOn& start,
                 double period_mm);

}  // namespace dubsar
