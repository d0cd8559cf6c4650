#pragma once
// Small scenes for segmentation tests: signed distances sampled on a grid and extracted.

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/extract/extract.h"
#include "core/parts/surface_model.h"
#include "core/relief/smoothing/smooth.h"

namespace dubsar::scene {

using Field = std::function<float(const glm::vec3&)>;  ///< positive inside, about 1 per grid step

inline float ball(const glm::vec3& p, const glm::vec3& centre, float radius) {
  return radius - glm::distance(p, centre);
}

/// A box with rounded edges; `half` includes the rounding.
inline float box(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& half, float rounding) {
  const glm::vec3 d = glm::abs(p - centre) - half + rounding;
  const glm::vec3 outside = glm::max(d, glm::vec3(0.0f));
  return rounding - glm::length(outside) - std::min(std::max({d.x, d.y, d.z}), 0.0f);
}

inline SurfaceModel extract_model(const Dims& dims, const Field& field, bool closed = true) {
  Volume<float> volume(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) volume.at(x, y, z) = field(glm::vec3(x, y, z));
  VolumeSource source(volume);
  SilentProgress progress;
  SurfaceModel model;
  ExtractOptions options;
  options.closed = closed;
  model.samples = sample_surface(source, options, progress).value();
  model.mesh = build_quad_mesh(model.samples, progress).value();
  SmoothOptions smoothing;
  smoothing.normals.iterations = 4;
  smooth(model.mesh, model.attributes.normals, smoothing, progress).value();
  return model;
}

/// An envelope around a tablet: rounded boxes, a gap of `gap` steps, glued where `glue` holds. Grid 96 x 64
/// x 96.
struct Nested {
  Dims dims{96, 64, 96};
  glm::vec3 centre{47.3f, 31.6f, 47.8f};
  glm::vec3 outer{42.0f, 27.0f, 42.0f};
  float wall = 8.0f;
  float gap = 3.0f;
  std::function<bool(const glm::vec3&)> glue = [](const glm::vec3&) { return false; };
  std::function<float(float, const glm::vec3&)> change = [](float v, const glm::vec3&) { return v; };

  float shell(const glm::vec3& p) const { return box(p, centre, outer, 10.0f); }
  float hollow(const glm::vec3& p) const { return box(p, centre, outer - wall, 8.0f); }
  float tablet(const glm::vec3& p) const { return box(p, centre, outer - wall - gap, 6.0f); }
  float operator()(const glm::vec3& p) const {
    const float envelope = std::min(shell(p), -hollow(p));
    const float solid = glue(p) ? shell(p) : std::max(envelope, tablet(p));
    return change(solid, p);
  }
  /// 0 tablet, 1 outer wall, 2 inner wall: the nearest of the three surfaces.
  int truth(const glm::vec3& p) const {
    const float t = std::abs(tablet(p)), o = std::abs(shell(p)), i = std::abs(hollow(p));
    return t <= o && t <= i ? 0 : o <= i ? 1 : 2;
  }
};

}  // namespace dubsar::scene
