#include "core/relief/occlusion/surface_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

namespace dubsar {
namespace {

constexpr double kCellsPerReach = 2.0;
constexpr std::int64_t kMostCells = 1 << 24;
constexpr float kNearest = 1e-6f;  // mm: a place on the point itself has no direction

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
};
Bounds bounds_of(const std::vector<SurfaceElement>& places) {
  Bounds out;
  for (const SurfaceElement& place : places) {
    out.low = glm::min(out.low, place.at);
    out.high = glm::max(out.high, place.at);
  }
  return out;
}

struct Columns {
  std::span<const float> x, y, z, ax, ay, az;
};

/// Adds the places [begin, end) to the sums; no branches, so that several are done at once.
void add(const Columns& c, std::size_t begin, std::size_t end, const glm::vec3& p, const glm::vec3& square,
         BandSums& sums) {
  float plain_first = 0.0f, plain_all = 0.0f, third_first = 0.0f, third_all = 0.0f;
#pragma omp simd reduction(+ : plain_first, plain_all, third_first, third_all)
  for (std::size_t i = begin; i < end; ++i) {
    const float dx = c.x[i] - p.x, dy = c.y[i] - p.y, dz = c.z[i] - p.z;
    const float d2 = dx * dx + dy * dy + dz * dz;
    const float way = dx * c.ax[i] + dy * c.ay[i] + dz * c.az[i];
    const float all = d2 >= square.x && d2 < square.z ? way : 0.0f;
    const float first = d2 < square.y ? all : 0.0f;
    const float held = d2 > kNearest * kNearest ? d2 : kNearest * kNearest;
    const float third = 1.0f / (held * std::sqrt(held));
    plain_all += all;
    plain_first += first;
    third_all += all * third;
    third_first += first * third;
  }
  sums.plain_first += plain_first;
  sums.plain_all += plain_all;
  sums.third_first += third_first;
  sums.third_all += third_all;
}

}  // namespace

std::vector<SurfaceElement> merged_elements(const std::vector<SurfaceElement>& places, double cell) {
  struct Keyed {
    std::uint64_t key;
    std::uint32_t place;
  };
  const Bounds bounds = bounds_of(places);
  std::vector<Keyed> order(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec3 at = glm::floor(glm::dvec3(places[i].at - bounds.low) / cell);
    const glm::vec3& n = places[i].area;
    const std::uint64_t octant = (n.x < 0 ? 1u : 0u) | (n.y < 0 ? 2u : 0u) | (n.z < 0 ? 4u : 0u);
    const auto axis = [](double v) { return static_cast<std::uint64_t>(std::clamp(v, 0.0, 1048575.0)); };
    order[i] = {((axis(at.z) << 20 | axis(at.y)) << 20 | axis(at.x)) << 3 | octant, static_cast<std::uint32_t>(i)};
  }
  std::sort(order.begin(), order.end(),
            [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.place < b.place; });
  std::vector<SurfaceElement> out;
  for (std::size_t i = 0; i < order.size();) {
    glm::dvec3 middle(0.0), area(0.0);
    double weight = 0.0;
    std::size_t end = i;
    for (; end < order.size() && order[end].key == order[i].key; ++end) {
      const SurfaceElement& place = places[order[end].place];
      const double size = std::max<double>(glm::length(place.area), 1e-20);
      middle += size * glm::dvec3(place.at);
      area += glm::dvec3(place.area);
      weight += size;
    }
    out.push_back({glm::vec3(middle / weight), glm::vec3(area)});
    i = end;
  }
  return 4 * out.size() > 3 * places.size() ? places : out;
}

glm::ivec3 SurfaceCells::cell_of(const glm::vec3& at) const {
  return glm::clamp(glm::ivec3(glm::floor((at - corner_) / cell_)), glm::ivec3(0), cells_ - 1);
}

SurfaceCells::SurfaceCells(std::vector<SurfaceElement> places, double reach) {
  const Bounds bounds = bounds_of(places);
  corner_ = bounds.low;
  for (double cell = reach / kCellsPerReach;; cell *= 2) {
    const glm::dvec3 wanted = glm::floor(glm::dvec3(bounds.high - bounds.low) / cell) + 1.0;
    cell_ = static_cast<float>(cell);
    cells_ = glm::ivec3(glm::min(wanted, glm::dvec3(1e6)));
    if (wanted.x * wanted.y * wanted.z <= static_cast<double>(kMostCells)) break;
  }
  const auto index = [&](const glm::ivec3& c) {
    return static_cast<std::size_t>(c.x) +
           static_cast<std::size_t>(cells_.x) *
               (static_cast<std::size_t>(c.y) + static_cast<std::size_t>(cells_.y) * static_cast<std::size_t>(c.z));
  };
  begin_.assign(index(cells_ - 1) + 2, 0);
  for (const SurfaceElement& place : places) ++begin_[index(cell_of(place.at)) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  for (auto& column : columns_) column.resize(places.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const SurfaceElement& place : places) {
    const std::size_t at = next[index(cell_of(place.at))]++;
    for (int a = 0; a < 3; ++a) {
      columns_[static_cast<std::size_t>(a)][at] = place.at[a];
      columns_[static_cast<std::size_t>(a) + 3][at] = place.area[a];
    }
  }
}

BandSums SurfaceCells::sums(const glm::vec3& point, float from, float first, float to) const {
  const Columns columns{columns_[0], columns_[1], columns_[2], columns_[3], columns_[4], columns_[5]};
  const glm::ivec3 low = cell_of(point - to), high = cell_of(point + to);
  const glm::vec3 square{from * from, first * first, to * to};
  BandSums out;
  const auto beyond = [&](float lowest, float p) { return std::max({lowest - p, p - lowest - cell_, 0.0f}); };
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y) {
      const float dz = beyond(corner_.z + static_cast<float>(z) * cell_, point.z);
      const float dy = beyond(corner_.y + static_cast<float>(y) * cell_, point.y);
      if (dy * dy + dz * dz > square.z) continue;
      const std::size_t row =
          static_cast<std::size_t>(cells_.x) *
          (static_cast<std::size_t>(y) + static_cast<std::size_t>(cells_.y) * static_cast<std::size_t>(z));
      const std::size_t begin = begin_[row + static_cast<std::size_t>(low.x)];
      const std::size_t end = begin_[row + static_cast<std::size_t>(high.x) + 1];
      if (begin < end) add(columns, begin, end, point, square, out);
    }
  return out;
}

}  // namespace dubsar
