#include "core/script/tangent_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "core/base/system/parallel.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr float kPatchUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr float kPatchOutside = -1e30f;
constexpr double kPatchMostCells = 3e7;
constexpr float kPatchSeam = -1e-5f;    // what lies on an edge belongs to both
constexpr double kClosingReach = 0.55;  // of the ball's radius: beyond it falls by more than any wedge is deep

/// Largest of value - sag along one axis; `along`: distance of neighbours in the array.
void raise_rows(const std::vector<float>& in, std::vector<float>& out, int side, int reach, float sag, bool rows) {
  std::fill(out.begin(), out.end(), kPatchOutside);
  for (int y = 0; y < side; ++y)
    for (int k = -reach; k <= reach; ++k) {
      const float lower = sag * static_cast<float>(k * k);
      const int from = rows ? y : y + k;
      if (from < 0 || from >= side) continue;
      const int first = rows ? std::max(0, -k) : 0, end = rows ? std::min(side, side - k) : side;
      float* const to = out.data() + static_cast<std::ptrdiff_t>(y) * side;
      const float* const values = in.data() + static_cast<std::ptrdiff_t>(from) * side + (rows ? k : 0);
      for (int x = first; x < end; ++x) to[x] = std::max(to[x], values[x] - lower);
    }
}

void close_from_outside(std::vector<float>& heights, int side, int reach, float sag) {
  std::vector<float> other(heights.size());
  raise_rows(heights, other, side, reach, sag, true);
  raise_rows(other, heights, side, reach, sag, false);
  for (float& v : heights) v = v < 0.5f * kPatchOutside ? kPatchOutside : -v;
  raise_rows(heights, other, side, reach, sag, true);
  raise_rows(other, heights, side, reach, sag, false);
  for (float& v : heights) v = -v;
}

void fill_triangle(TangentPatch& patch, const std::array<glm::vec3, 3>& p) {
  const float area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  if (!(area > 1e-9f)) return;  // turned away, or edge on
  const auto half = static_cast<float>(patch.half);
  const int x0 = static_cast<int>(std::ceil(std::max(-half, std::min({p[0].x, p[1].x, p[2].x}) - 1e-4f)));
  const int x1 = static_cast<int>(std::floor(std::min(half, std::max({p[0].x, p[1].x, p[2].x}) + 1e-4f)));
  const int y0 = static_cast<int>(std::ceil(std::max(-half, std::min({p[0].y, p[1].y, p[2].y}) - 1e-4f)));
  const int y1 = static_cast<int>(std::floor(std::min(half, std::max({p[0].y, p[1].y, p[2].y}) + 1e-4f)));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const float a = ((p[1].x - fx) * (p[2].y - fy) - (p[2].x - fx) * (p[1].y - fy)) / area;
      const float b = ((p[2].x - fx) * (p[0].y - fy) - (p[0].x - fx) * (p[2].y - fy)) / area;
      const float c = 1.0f - a - b;
      if (a < kPatchSeam || b < kPatchSeam || c < kPatchSeam) continue;
      float& height = patch.depth[patch.index(x, y)];
      height = std::max(height, a * p[0].z + b * p[1].z + c * p[2].z);
    }
}

}  // namespace

PatchCells::PatchCells(const TriMesh& mesh) {
  points_.resize(mesh.positions.size());
  parallel_for(static_cast<std::int64_t>(points_.size()), 1 << 15, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    points_[v] = glm::vec3(mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])));
  });
  const auto inferred = [&](std::size_t t) {
    if (!mesh.triangle_inferred.empty() && mesh.triangle_inferred[t]) return true;
    return !mesh.evidence.empty() &&
           std::any_of(mesh.triangles[t].begin(), mesh.triangles[t].end(),
                       [&](std::uint32_t v) { return mesh.evidence[v] == evidence_byte(Evidence::kInferred); });
  };
  std::vector<Triangle> kept;
  kept.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (!inferred(t)) kept.push_back(mesh.triangles[t]);
  sort_into_cells(kept);
}

PatchCells::PatchCells(std::vector<glm::vec3> points_mm, std::vector<Triangle> triangles)
    : points_(std::move(points_mm)) {
  sort_into_cells(triangles);
}

void PatchCells::sort_into_cells(const std::vector<Triangle>& kept) {
  low_ = glm::dvec3(std::numeric_limits<double>::max()), high_ = -low_;
  double edges = 0.0;
  for (const Triangle& f : kept) {
    const glm::dvec3 a(points_[f[0]]), b(points_[f[1]]), c(points_[f[2]]);
    low_ = glm::min(low_, glm::min(a, glm::min(b, c)));
    high_ = glm::max(high_, glm::max(a, glm::max(b, c)));
    area_ += 0.5 * glm::length(glm::cross(b - a, c - a));
    edges += glm::distance(a, b);
  }
  if (kept.empty()) return;
  edge_ = edges / static_cast<double>(kept.size());
  const glm::dvec3 extent = high_ - low_;
  cell_mm_ = std::max(std::max({extent.x, extent.y, extent.z}) / 200.0, 1e-9);
  while ((extent.x / cell_mm_ + 1) * (extent.y / cell_mm_ + 1) * (extent.z / cell_mm_ + 1) > kPatchMostCells)
    cell_mm_ *= 1.25;
  for (int a = 0; a < 3; ++a) cells_[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(extent[a] / cell_mm_) + 1;
  starts_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  std::vector<std::uint32_t> cell(kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const glm::dvec3 p(points_[kept[k][0]]);
    cell[k] = static_cast<std::uint32_t>(index(cell_of(0, p.x), cell_of(1, p.y), cell_of(2, p.z)));
    ++starts_[cell[k] + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  triangles_.resize(kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k) triangles_[next[cell[k]]++] = kept[k];
}

std::int64_t PatchCells::cell_of(int axis, double at) const {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((at - low_[axis]) / cell_mm_)), 0,
                                  cells_[static_cast<std::size_t>(axis)] - 1);
}

std::vector<PatchCells::Tile> PatchCells::tiles(double tile_mm) const {
  struct Sum {
    glm::dvec3 place{0.0}, normal{0.0};
    double area = 0.0;
  };
  const std::int64_t factor = std::max<std::int64_t>(1, std::llround(tile_mm / cell_mm_));
  const auto tiles_along = [&](std::size_t a) { return (cells_[a] + factor - 1) / factor; };
  const std::int64_t nx = tiles_along(0), ny = tiles_along(1), nz = tiles_along(2);
  const auto tile_index = [&](std::int64_t x, std::int64_t y, std::int64_t z) { return (z * ny + y) * nx + x; };
  std::vector<Sum> sums(static_cast<std::size_t>(nx * ny * nz));
  parallel_for(nz, 1, [&](std::int64_t tz) {
    for (std::int64_t z = tz * factor; z < std::min(cells_[2], (tz + 1) * factor); ++z)
      for (std::int64_t y = 0; y < cells_[1]; ++y)
        for (std::int64_t x = 0; x < cells_[0]; ++x) {
          const std::size_t c = index(x, y, z);
          Sum& sum = sums[static_cast<std::size_t>(tile_index(x / factor, y / factor, tz))];
          for (std::uint32_t i = starts_[c]; i < starts_[c + 1]; ++i) {
            const Triangle& t = triangles_[i];
            const glm::dvec3 a(points_[t[0]]), b(points_[t[1]]), d(points_[t[2]]), n = glm::cross(b - a, d - a);
            const double area = glm::length(n);
            sum.place += area * (a + b + d) / 3.0;
            sum.normal += n;
            sum.area += area;
          }
        }
  });
  std::vector<Tile> out;
  for (std::int64_t z = 0; z < nz; ++z)
    for (std::int64_t y = 0; y < ny; ++y)
      for (std::int64_t x = 0; x < nx; ++x) {
        const Sum& own = sums[static_cast<std::size_t>(tile_index(x, y, z))];
        if (!(own.area > 0.0)) continue;
        glm::dvec3 normal(0.0);
        for (std::int64_t oz = std::max<std::int64_t>(0, z - 1); oz <= std::min(nz - 1, z + 1); ++oz)
          for (std::int64_t oy = std::max<std::int64_t>(0, y - 1); oy <= std::min(ny - 1, y + 1); ++oy)
            for (std::int64_t ox = std::max<std::int64_t>(0, x - 1); ox <= std::min(nx - 1, x + 1); ++ox) {
              const glm::dvec3& n = sums[static_cast<std::size_t>(tile_index(ox, oy, oz))].normal;
              if (glm::dot(n, own.normal) > 0.0) normal += n;
            }
        if (glm::length(normal) > 0.0) out.push_back({own.place / own.area, glm::normalize(normal)});
      }
  return out;
}

TangentPatch tangent_patch(const PatchCells& cells, const glm::dvec3& middle, const glm::dvec3& normal,
                           const PatchSize& size) {
  TangentPatch patch;
  patch.origin = middle;
  patch.out = normal;
  const glm::dvec3 aside = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  patch.right = glm::normalize(glm::cross(aside, normal));
  patch.up = glm::cross(normal, patch.right);
  patch.half = size.half;
  patch.step_mm = size.step_mm;
  patch.depth.assign(static_cast<std::size_t>(patch.side()) * static_cast<std::size_t>(patch.side()), kPatchOutside);
  const auto scale = static_cast<float>(1.0 / size.step_mm);
  const glm::vec3 origin(middle), right = glm::vec3(patch.right) * scale, up = glm::vec3(patch.up) * scale,
                                  out = glm::vec3(patch.out) * scale;
  const double reach = (size.half + 1) * size.step_mm;
  const auto half = static_cast<float>(size.half + 1);
  cells.visit(middle, reach, [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const Triangle&) {
    const glm::vec3 first = a - origin;
    const float x = glm::dot(first, right), y = glm::dot(first, up);
    if (std::abs(x) > half + 40.f || std::abs(y) > half + 40.f) return;
    const glm::vec3 second = b - origin, third = c - origin;
    fill_triangle(patch, {glm::vec3(x, y, glm::dot(first, out)),
                          glm::vec3(glm::dot(second, right), glm::dot(second, up), glm::dot(second, out)),
                          glm::vec3(glm::dot(third, right), glm::dot(third, up), glm::dot(third, out))});
  });
  patch.level = patch.depth;  // heights in steps, until here
  const double ball = size.ball_mm / size.step_mm;
  close_from_outside(patch.level, patch.side(), static_cast<int>(kClosingReach * ball), static_cast<float>(0.5 / ball));
  const auto step = static_cast<float>(size.step_mm);
  for (std::size_t i = 0; i < patch.depth.size(); ++i) {
    const bool known = patch.depth[i] > 0.5f * kPatchOutside && patch.level[i] > 0.5f * kPatchOutside;
    patch.depth[i] = known ? (patch.level[i] - patch.depth[i]) * step : kPatchUnknown;
    patch.level[i] = known ? patch.level[i] * step : kPatchUnknown;
  }
  return patch;
}

}  // namespace dubsar
