#pragma once
// The ground around a place: the surface as it was before anything was pressed into it, fitted to what is still level.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/quadratic_sheet.h"
#include "core/mesh/surface_measure.h"

namespace dubsar {

/// A vertex near a place, in a frame that stands on the surface there: mm from the place.
struct GroundSample {
  double u = 0.0, v = 0.0, height = 0.0;
  double area = 0.0;       ///< mm2 that it stands for, seen from outside
  glm::dvec3 normal{0.0};  ///< along u, v and outwards; unit
  glm::dvec3 at_mm{0.0};   ///< in the frame of the mesh
};

struct Neighbourhood {
  std::vector<GroundSample> samples;
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, out{0, 0, 1};  ///< of u, v and height, in the frame of the mesh
  double spacing_mm = 0.0;                               ///< from vertex to vertex
};

/// Vertices of the place's own sheet within the radius: of its partition, on faces that look its way. Cost: some ns a
/// triangle of the mesh.
Neighbourhood neighbourhood(const TriMesh& mesh, const SurfacePlace& place, double radius_mm);

class LevelGround {
 public:
  /// Fits a plane that is bent as the side is by iterated weighted least squares (Tukey's biweight): what lies off it
  /// and what does not look its way loses its weight, so that neither impressions nor the clay that was pushed up round
  /// them count. It begins as an upper envelope (P. Eilers, H. Boelens: Baseline correction with asymmetric least
  /// squares smoothing, 2005). There is at least one sample.
  LevelGround(const Neighbourhood& around, double radius_mm);

  double height(double u, double v) const;
  glm::dvec2 slope(double u, double v) const;
  /// How far a sample is below it, along its normal there.
  double depth(const GroundSample& sample) const;
  double roughness_mm() const noexcept { return roughness_mm_; }  ///< deviation of what lies on it
  double share() const noexcept { return share_; }                ///< of the neighbourhood that lies on it, 0..1

 private:
  void envelope(const Neighbourhood& around);
  void level(const Neighbourhood& around, double most_angle, double most_deviations);
  double turned(const GroundSample& sample) const;
  bool solve(const Neighbourhood& around, const std::vector<double>& weights);

  SheetTerms terms_{};
  double radius_mm_, roughness_mm_ = 0.0, share_ = 0.0;
  bool settled_ = false;
};

}  // namespace dubsar
