#include "core/extract/quad_envelope.h"

#include <algorithm>
#include <cstdlib>

namespace dubsar {
namespace {

std::int64_t cell_wall(std::int64_t place) noexcept { return place & ~(kExactSteps - 1); }

/// A vertex seen along the edge, from it.
struct Across {
  std::int64_t u, v, along;
};

std::int64_t turn(const Across& a, const Across& b) noexcept { return a.u * b.v - a.v * b.u; }

/// The diagonal a-c of the polygon a b c d, which runs counter-clockwise around the edge where `left` holds.
bool in_envelope(const Across& a, const Across& b, const Across& c, const Across& d, bool left) noexcept {
  const std::int64_t side = turn(a, c);
  // The triangle that the edge passes through, and the corner on the other side of the diagonal.
  const bool with_d = (side > 0) == left;
  const Across &in = with_d ? d : b, &out = with_d ? b : d;
  const std::int64_t weight_a = std::abs(turn(c, in)), weight_c = std::abs(turn(in, a)), weight_in = std::abs(side),
                     weights = weight_a + weight_c + weight_in;
  const std::int64_t height = weight_a * a.along + weight_c * c.along + weight_in * in.along;
  if (!(height > 0 && height < weights * kExactSteps)) return false;
  if (side == 0) return true;
  const std::int64_t share_c = std::abs(turn(a, out)), share_a = std::abs(turn(c, out)), shares = share_a + share_c,
                     low = std::abs(side) * out.along, at = share_a * a.along + share_c * c.along;
  return std::abs(side) < shares && low < at && at < low + (shares - std::abs(side)) * kExactSteps;
}

}  // namespace

std::optional<QuadEdge> edge_of_quad(const std::array<ExactPlace, 4>& corner) noexcept {
  const ExactPlace low{cell_wall(corner[0].x), cell_wall(corner[0].y), cell_wall(corner[0].z)};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto within = [&](const ExactPlace& p, int a, std::int64_t from, std::int64_t to) {
      return low[a] + from <= p[a] && p[a] <= low[a] + to;
    };
    const auto in_cell = [&](const ExactPlace& p, bool high_u, bool high_v) {
      return within(p, axis, 0, kExactSteps) && within(p, u, high_u ? 0 : -kExactSteps, high_u ? kExactSteps : 0) &&
             within(p, v, high_v ? 0 : -kExactSteps, high_v ? kExactSteps : 0);
    };
    if (!in_cell(corner[2], false, false)) continue;
    if (!(in_cell(corner[1], false, true) && in_cell(corner[3], true, false)) &&
        !(in_cell(corner[1], true, false) && in_cell(corner[3], false, true)))
      continue;
    QuadEdge edge{low, axis, true, true};
    for (const ExactPlace& p : corner) {
      const auto wall = [](std::int64_t x) { return (x & (kExactSteps - 1)) == 0; };
      edge.strict = edge.strict && !wall(p.x) && !wall(p.y) && !wall(p.z);
      edge.flat = edge.flat && p[axis] == low[axis];
    }
    return edge;
  }
  return std::nullopt;
}

unsigned allowed_diagonals(const std::array<ExactPlace, 4>& corner, const QuadEdge& edge) noexcept {
  std::array<Across, 4> p;
  for (std::size_t i = 0; i < 4; ++i) {
    const ExactPlace from = corner[i] - edge.low;
    p[i] = {from[(edge.axis + 1) % 3], from[(edge.axis + 2) % 3], from[edge.axis]};
  }
  if (edge.flat) {
    const auto area = [&](std::size_t a, std::size_t b, std::size_t c) {
      return turn({p[b].u - p[a].u, p[b].v - p[a].v, 0}, {p[c].u - p[a].u, p[c].v - p[a].v, 0});
    };
    const auto same_side = [](std::int64_t a, std::int64_t b) { return (a > 0 && b > 0) || (a < 0 && b < 0); };
    return (same_side(area(0, 1, 2), area(0, 2, 3)) ? 1u : 0u) | (same_side(area(1, 2, 3), area(1, 3, 0)) ? 2u : 0u);
  }
  const bool left = turn(p[0], p[1]) + turn(p[1], p[2]) + turn(p[2], p[3]) + turn(p[3], p[0]) > 0;
  return (in_envelope(p[0], p[1], p[2], p[3], left) ? 1u : 0u) | (in_envelope(p[1], p[2], p[3], p[0], left) ? 2u : 0u);
}

std::optional<unsigned> allowed_inside(const std::array<ExactPlace, 4>& corner) noexcept {
  const ExactPlace step = (corner[0] >> std::int64_t{10}) - (corner[2] >> std::int64_t{10});
  static_assert(kExactSteps == 1 << 10);
  const int axis = step.x == 0 ? 0 : step.y == 0 ? 1 : 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (step[axis] != 0 || step[u] != 1 || step[v] != 1) return std::nullopt;
  std::array<Across, 4> p;
  std::array<int, 4> quadrant;  // 1: at +u, 2: at +v
  const ExactPlace low{cell_wall(corner[0].x), cell_wall(corner[0].y), cell_wall(corner[0].z)};
  for (std::size_t i = 0; i < 4; ++i) {
    const ExactPlace from = corner[i] - low;
    p[i] = {from[u], from[v], from[axis]};
    constexpr std::int64_t kInCell = kExactSteps - 1;
    if (((from.x & kInCell) == 0) | ((from.y & kInCell) == 0) | ((from.z & kInCell) == 0) |
        (std::abs(p[i].u) >= kExactSteps) | (std::abs(p[i].v) >= kExactSteps) | (p[i].along < 0) |
        (p[i].along >= kExactSteps))
      return std::nullopt;
    quadrant[i] = (p[i].u > 0 ? 1 : 0) | (p[i].v > 0 ? 2 : 0);
  }
  if (quadrant[2] != 0 || quadrant[1] + quadrant[3] != 3 || (quadrant[1] & quadrant[3]) != 0 || quadrant[1] == 3 ||
      quadrant[3] == 3)
    return std::nullopt;
  // Heights between heights inside the step lie inside it: only the other triangle is left to look at.
  const std::array<std::int64_t, 4> sides = {std::abs(turn(p[0], p[1])), std::abs(turn(p[1], p[2])),
                                             std::abs(turn(p[2], p[3])), std::abs(turn(p[3], p[0]))};
  const bool left = quadrant[1] == 2;
  const auto allowed = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    const std::int64_t side = turn(p[a], p[c]), across = std::abs(side);
    const bool with_d = (side > 0) == left;
    const std::int64_t share_c = with_d ? sides[a] : sides[d], share_a = with_d ? sides[b] : sides[c],
                       shares = share_a + share_c, low_end = across * p[with_d ? b : d].along,
                       at = share_a * p[a].along + share_c * p[c].along;
    return side == 0 || ((across < shares) & (low_end < at) & (at < low_end + (shares - across) * kExactSteps));
  };
  return (allowed(0, 1, 2, 3) ? 1u : 0u) | (allowed(1, 2, 3, 0) ? 2u : 0u);
}

ExactPlace point_on_edge(std::span<const ExactPlace> vertices, const QuadEdge& edge) noexcept {
  ExactPlace point = edge.low;
  if (edge.flat) return point;
  std::int64_t sum = 0;
  for (const ExactPlace& p : vertices) sum += p[edge.axis] - edge.low[edge.axis];
  const auto count = static_cast<std::int64_t>(vertices.size());
  point[edge.axis] += (2 * sum + count) / (2 * count);
  return point;
}

}  // namespace dubsar
