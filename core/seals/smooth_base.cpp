#include "core/seals/smooth_base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/quadratic_sheet.h"

namespace dubsar {
namespace {

constexpr double kCellsOfRadius = 24.0;
constexpr std::array<double, 3> kRadii{1.0, 0.5, 0.25};  // tried one after the other
constexpr double kBaseGroundShare = 0.55;                // of what is near: less lies on the sheet where the side bends
constexpr double kSameSide = 0.35;                       // cosine: what looks 70 degrees away belongs to another side
constexpr std::size_t kLeastCells = 24;                  // four a term
constexpr int kSheetRounds = 2;                          // the second one from the first one's place
constexpr int kSpanRounds = 4, kGroundRounds = 4;
// With a quarter of the surface broken away by .35 mm and a twelfth figures of .25 mm the sheet lies on the ground.
constexpr double kBelowCounts = 0.25;
constexpr double kBaseGroundMm = 0.25;  // what lies farther off is not ground: half of what seals are cut

std::int64_t block_of(double x, double edge) { return static_cast<std::int64_t>(std::floor(x / edge)); }

}  // namespace

std::uint64_t SmoothBase::key(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kBias = 1 << 20;
  return (static_cast<std::uint64_t>(x + kBias) << 42) | (static_cast<std::uint64_t>(y + kBias) << 21) |
         static_cast<std::uint64_t>(z + kBias);
}

SmoothBase::SmoothBase(std::span<const glm::dvec3> points, std::span<const Triangle> triangles, double radius_mm)
    : radius_(radius_mm), cell_(radius_mm / kCellsOfRadius) {
  // Cells by place and by the octant that their faces look to: the two sides of a thin wall stay apart.
  std::unordered_map<std::uint64_t, std::uint32_t> known;
  for (const Triangle& t : triangles) {
    const glm::dvec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const glm::dvec3 twice = glm::cross(b - a, c - a), middle = (a + b + c) / 3.0;
    const double area = 0.5 * glm::length(twice);
    if (!(area > 0.0) || !std::isfinite(area)) continue;
    const std::uint64_t looks = (twice.x > 0 ? 1u : 0u) | (twice.y > 0 ? 2u : 0u) | (twice.z > 0 ? 4u : 0u);
    const std::uint64_t name =
        key(block_of(middle.x, cell_), block_of(middle.y, cell_), block_of(middle.z, cell_)) * 8 + looks;
    const auto [at, fresh] = known.try_emplace(name, static_cast<std::uint32_t>(cells_.size()));
    if (fresh) cells_.emplace_back();
    Cell& cell = cells_[at->second];
    cell.place += area * middle;
    cell.normal += 0.5 * twice;
    cell.area += area;
  }
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    Cell& cell = cells_[k];
    cell.place /= cell.area;
    cell.normal /= std::max(glm::length(cell.normal), 1e-30);
    blocks_[key(block_of(cell.place.x, radius_), block_of(cell.place.y, radius_), block_of(cell.place.z, radius_))]
        .push_back(static_cast<std::uint32_t>(k));
  }
}

std::optional<BasePlace> SmoothBase::sheet(const BasePlace& from, double radius, bool last) const {
  const glm::dvec3 n = from.normal,
                   u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))),
                   v = glm::cross(n, u);
  struct Seen {
    SheetTerms place;
    double height, weight, off;
  };
  std::vector<Seen> seen;
  const std::int64_t bx = block_of(from.at_mm.x, radius_), by = block_of(from.at_mm.y, radius_),
                     bz = block_of(from.at_mm.z, radius_);
  for (std::int64_t z = bz - 1; z <= bz + 1; ++z)
    for (std::int64_t y = by - 1; y <= by + 1; ++y)
      for (std::int64_t x = bx - 1; x <= bx + 1; ++x) {
        const auto block = blocks_.find(key(x, y, z));
        if (block == blocks_.end()) continue;
        for (const std::uint32_t k : block->second) {
          const Cell& cell = cells_[k];
          const glm::dvec3 d = (cell.place - from.at_mm) / radius;
          const double r2 = glm::dot(d, d);
          if (r2 >= 1.0 || glm::dot(cell.normal, n) < kSameSide) continue;
          seen.push_back(
              {sheet_terms(glm::dot(d, u), glm::dot(d, v)), glm::dot(d, n), cell.area * (1.0 - r2) * (1.0 - r2), 0.0});
        }
      }
  if (seen.size() < kLeastCells) return {};
  std::optional<SheetTerms> terms;
  for (int round = 0; round < kSpanRounds + kGroundRounds; ++round) {
    SheetEquations equations;
    for (const Seen& s : seen) {
      const double t = s.off * radius / kBaseGroundMm;
      double counts = t < 0.0 ? kBelowCounts : 1.0;
      if (round >= kSpanRounds) counts = std::abs(t) < 1.0 ? (1.0 - t * t) * (1.0 - t * t) : 0.0;
      if (counts > 0.0) equations.add(s.place, s.height, s.weight * counts);
    }
    equations.regularize();
    const auto next = equations.solved();
    if (!next) break;
    terms = next;
    for (Seen& s : seen) s.off = s.height - sheet_height(*terms, s.place);
  }
  if (!terms) return {};
  double on = 0.0, all = 0.0;
  for (const Seen& s : seen) {
    on += std::abs(s.off * radius) < kBaseGroundMm ? s.weight : 0.0;
    all += s.weight;
  }
  if (!last && on < kBaseGroundShare * all) return {};
  return BasePlace{from.at_mm + radius * (*terms)[0] * n, glm::normalize(n - (*terms)[1] * u - (*terms)[2] * v)};
}

std::optional<BasePlace> SmoothBase::under(const glm::dvec3& near, const glm::dvec3& normal) const {
  std::optional<BasePlace> place = BasePlace{near, normal};
  for (int round = 0; round < kSheetRounds && place; ++round) {
    const BasePlace from = *place;
    place.reset();
    for (std::size_t k = 0; k < kRadii.size() && !place; ++k)
      place = sheet(from, kRadii[k] * radius_, k + 1 == kRadii.size());
  }
  return place;
}

}  // namespace dubsar
