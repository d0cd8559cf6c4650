#pragma once
// Measures on a surface: the nearest place, sections, lengths along it, and how deep an impression is. All lengths in
// mm of the mesh's frame. No state, no GL.

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct SurfacePlace {
  glm::dvec3 at_mm{0.0}, normal{0.0, 0.0, 1.0};  ///< normal: unit, of its triangle, towards the air
  std::size_t triangle = 0;
};

/// The place of the surface that is nearest to a point. kBadData: a mesh without triangles. Cost: some 10 ns a triangle
/// on one core, all threads.
Result<SurfacePlace> nearest_place(const TriMesh& mesh, const glm::dvec3& point_mm);

/// Degrees between the directions from `apex` to `a` and to `b`; 0 where one of them has no length.
double angle_between_deg(const glm::dvec3& a, const glm::dvec3& apex, const glm::dvec3& b);

/// The section of the surface from one place to another: by the plane through both that stands on the surface (along
/// the mean of its normals around them). Of the two ways round a closed section the shorter one. Places of the mesh,
/// the ends first and last; empty when the section does not lead from one to the other, such as across a gap. On
/// spheres and planes this is the shortest way along the surface, on cylinders along and across them; where the surface
/// is rough it follows all of it. Cost: some 5 ns a triangle, and the section's own.
std::vector<glm::dvec3> section_between(const TriMesh& mesh, const SurfacePlace& a, const SurfacePlace& b);
double length_of(const std::vector<glm::dvec3>& path_mm);
/// How far the path lies below the straight line between its ends at most, seen along `up`; at least 0.
double deepest_below_chord(const std::vector<glm::dvec3>& path_mm, const glm::dvec3& up);

struct ImpressionDepth {
  double depth_mm = 0.0;
  double uncertainty_mm = 0.0;  ///< one standard deviation
  double filled_mm = 0.0;       ///< of the depth: what the scan's blur had filled; 0 where that is not known
  glm::dvec3 bottom_mm{0.0};    ///< the deepest place that leads down from where it was asked for
  glm::dvec3 rim_mm{0.0};       ///< above it, on the surface as it was before the impression
  glm::dvec3 outward{0, 0, 1};  ///< unit, from bottom to rim
  double level_share = 0.0;     ///< of the neighbourhood that lies on that surface: little where all is written on
};

/// Wide enough for the wedges of a tablet, and flat enough not to see its edges (tuned on two phantoms).
inline constexpr double kDepthRadiusMm = 3.5;

struct DepthOptions {
  double radius_mm = kDepthRadiusMm;  ///< of the neighbourhood; wider around impressions that are deeper than usual
  double blur_mm2 = 0.0;              ///< variance of the blur of scan and filters along each axis; 0: not known
};

/// How deep the impression is that a place lies in: from its deepest place to the surface as it was before, which is
/// fitted to what is level around it (level_ground.h). Blur fills narrow bottoms; what it took is given back as far as
/// the blur is known. kUsage: a radius that is not positive, or a neighbourhood of fewer than 30 vertices.
Result<ImpressionDepth> impression_depth(const TriMesh& mesh, const SurfacePlace& place,
                                         const DepthOptions& options = {});

}  // namespace dubsar
