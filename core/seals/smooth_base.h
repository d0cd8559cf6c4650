#pragma once
// The surface as it was before a seal was rolled on it, more or less: its own, smoothed over some millimetres.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

struct BasePlace {
  glm::dvec3 at_mm{0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit, towards the air
};

/// A moving least-squares surface of second order (D. Levin: Mesh-independent surface interpolation, 2003): sheets
/// (quadratic_sheet.h) through what lies within `radius_mm`, or half or a quarter of it where less than half of that
/// lies on one sheet, as on round edges. Weighted by area, first in rounds in which what lies below counts less (P.
/// Eilers, H. Boelens: Baseline correction with asymmetric least squares smoothing, 2005), then by Tukey's biweight: so
/// neither figures nor what broke away count where ground is left. The surface is gathered in cells of a 24th of the
/// radius first, so that the number of triangles does not matter. Queries from any thread.
class SmoothBase {
 public:
  SmoothBase(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles, double radius_mm);

  /// The place of the sheet that lies over or under `near`, as `normal` sees it; faces that look another way do not
  /// count. Nothing where too little surface is near.
  std::optional<BasePlace> under(const glm::dvec3& near, const glm::dvec3& normal) const;

 private:
  struct Cell {
    glm::dvec3 place{0.0}, normal{0.0};
    double area = 0.0;
  };
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z);
  std::optional<BasePlace> sheet(const BasePlace& from, double radius, bool last) const;

  double radius_, cell_;
  std::vector<Cell> cells_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> blocks_;  ///< cells of each block of a radius's edge
};

}  // namespace dubsar
