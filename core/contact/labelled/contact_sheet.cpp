#include "core/contact/labelled/contact_sheet.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/system/parallel_gather.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr float kSheetReach = 1.8f;  ///< more than the half diagonal of a cell
constexpr float kSameDistance = 1e-4f;
constexpr std::uint32_t kLargePiece = 4096;  ///< nodes: more than a turned-over triangle gives to the other clay
constexpr std::int64_t kNodesTogether = 1 << 14;
constexpr int kSlabSlices = 8;  ///< of the grid, that one thread looks at

/// The place of a triangle nearest to a point, and what it lies on: bit i: corner i has a share in it.
struct NearestPlace {
  glm::vec3 place;
  unsigned corners = 7;
};

NearestPlace nearest_place(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp),
              d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d1 <= 0.0f && d2 <= 0.0f) return {a, 1};
  if (d3 >= 0.0f && d4 <= d3) return {b, 2};
  if (d6 >= 0.0f && d5 <= d6) return {c, 4};
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return {a + d1 / (d1 - d3) * ab, 3};
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return {a + d2 / (d2 - d6) * ac, 5};
  if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 6};
  const float sum = va + vb + vc;
  return {a + vb / sum * ab + vc / sum * ac, 7};
}

std::uint64_t sheet_side(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Spreads the bits of an id, so that sums of few of them are equal for the same ids only.
std::uint64_t spread_id(std::uint32_t id) {
  std::uint64_t x = (std::uint64_t{id} + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 32) * 0xd6e8feb86659fd93u;
  return x ^ x >> 32;
}

/// Sides of one triangle, and their ends: what goes from such a vertex does not come back to it.
class SheetRim {
 public:
  SheetRim(const std::vector<Triangle>& triangles, std::size_t vertices) : at_rim_(vertices, false) {
    std::vector<std::uint64_t> out_less_in(vertices, 0);
    const auto each_side = [&](const auto& visit) {
      for (const Triangle& t : triangles)
        for (std::size_t i = 0; i < 3; ++i) visit(t[i], t[(i + 1) % 3]);
    };
    each_side([&](std::uint32_t a, std::uint32_t b) {
      out_less_in[a] += spread_id(b);
      out_less_in[b] -= spread_id(a);
    });
    for (std::size_t v = 0; v < vertices; ++v) at_rim_[v] = out_less_in[v] != 0;
    std::unordered_map<std::uint64_t, int> uses;
    each_side([&](std::uint32_t a, std::uint32_t b) {
      if (at_rim_[a] && at_rim_[b]) ++uses[sheet_side(a, b)];
    });
    for (const auto& [side, count] : uses)
      if (count == 1) sides_.insert(side);
  }
  bool has(const Triangle& t, unsigned corners) const {
    if (corners == 7) return false;
    std::array<std::uint32_t, 2> ids{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (corners >> i & 1u) ids[count++] = t[i];
    return count == 1 ? at_rim_[ids[0]] : sides_.contains(sheet_side(ids[0], ids[1]));
  }

 private:
  std::unordered_set<std::uint64_t> sides_;
  std::vector<bool> at_rim_;
};

/// The grid points that a triangle may be near.
struct SheetBox {
  glm::ivec3 low, high;

  SheetBox(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
      : low(glm::ceil(glm::min(a, glm::min(b, c)) - kSheetReach)),
        high(glm::floor(glm::max(a, glm::max(b, c)) + kSheetReach)) {}
};

/// Triangles by slabs of the grid that they may be near, in order; a triangle may be in several.
std::vector<std::vector<std::uint32_t>> slabs_of(const std::vector<Triangle>& triangles, std::int64_t slices,
                                                 const auto& place) {
  std::vector<std::vector<std::uint32_t>> slabs(static_cast<std::size_t>((slices + kSlabSlices - 1) / kSlabSlices));
  const auto last = static_cast<int>(slabs.size()) - 1;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const SheetBox box(place(t[0]), place(t[1]), place(t[2]));
    for (int s = std::max(box.low.z, 0) / kSlabSlices; s <= std::min(std::max(box.high.z, 0) / kSlabSlices, last); ++s)
      slabs[static_cast<std::size_t>(s)].push_back(i);
  }
  return slabs;
}

}  // namespace

ContactSheet sheet_of_patches(const SurfaceModel& model) {
  ContactSheet sheet;
  const auto surface = static_cast<std::uint32_t>(model.mesh.positions.size());
  const auto each_patch = [&](const auto& visit) {
    for (const FillPatch& patch : model.patches)
      if (is_contact_patch(model, patch)) visit(patch);
  };
  std::unordered_map<std::uint32_t, std::uint32_t> dual;  // of vertices of the surface
  each_patch([&](const FillPatch& patch) {
    for (const Triangle& t : patch.triangles)
      for (const std::uint32_t v : t)
        if (v < surface && dual.try_emplace(v, static_cast<std::uint32_t>(dual.size())).second)
          sheet.dual_positions.push_back(model.mesh.positions[v]);
  });
  each_patch([&](const FillPatch& patch) {
    const auto first = static_cast<std::uint32_t>(sheet.dual_positions.size() + sheet.mesh.added.size());
    const bool out = model.partitions[patch.partition].kind == PartitionKind::kTablet;
    const auto id = [&](std::uint32_t v) { return v < surface ? dual.at(v) : first + v - surface; };
    for (const Triangle& t : patch.triangles)
      sheet.mesh.triangles.push_back({id(t[0]), id(t[out ? 1 : 2]), id(t[out ? 2 : 1])});
    sheet.mesh.added.insert(sheet.mesh.added.end(), patch.extra_positions.begin(), patch.extra_positions.end());
  });
  sheet.evidence.assign(sheet.mesh.added.size(), evidence_byte(Evidence::kInferred));
  return sheet;
}

std::vector<float> distances_from_sheet(const ContactBand& band, const InterfaceMesh& sheet,
                                        const std::vector<glm::vec3>& dual_positions) {
  const auto dual = static_cast<std::uint32_t>(dual_positions.size());
  const auto place = [&](std::uint32_t v) { return v < dual ? dual_positions[v] : sheet.added[v - dual]; };
  constexpr float kFar = std::numeric_limits<float>::infinity(), kUnknown = std::numeric_limits<float>::quiet_NaN();
  struct Nearest {
    float distance = kFar, cosine = 0.0f;  ///< of the angle between the triangle's normal and the way to the point
    bool rim = false;
  };
  std::vector<Nearest> nearest(band.nodes.size());
  constexpr float kRounded = 1e-3f;  // more than kSameDistance and what sums of coordinates are rounded by
  const SheetRim rim(sheet.triangles, dual_positions.size() + sheet.added.size());
  const auto look_around = [&](const Triangle& t, int from, int end) {
    const glm::vec3 a = place(t[0]), b = place(t[1]), c = place(t[2]), n = glm::cross(b - a, c - a);
    const float length = glm::length(n);
    if (!(length > 0.0f)) return;
    const auto [low, high] = SheetBox(a, b, c);
    const glm::vec3 middle = (a + b + c) / 3.0f;
    const float radius =
        kRounded + std::sqrt(std::max({glm::dot(a - middle, a - middle), glm::dot(b - middle, b - middle),
                                       glm::dot(c - middle, c - middle)}));
    for (int z = std::max(low.z, from); z <= std::min(high.z, end - 1); ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::uint32_t node = band.at({x, y, z});
          if (node == ContactBand::kNone) continue;
          const glm::vec3 p(x, y, z), from_middle = p - middle;
          Nearest& best = nearest[node];
          const float nearer = radius + std::min(best.distance, kSheetReach);  // else it is farther away for certain
          if (glm::dot(from_middle, from_middle) > nearer * nearer) continue;
          const NearestPlace found = nearest_place(p, a, b, c);
          const glm::vec3 off = p - found.place;
          const float distance = glm::length(off);
          if (distance > kSheetReach) continue;
          if (distance > best.distance + kSameDistance) continue;
          const float cosine = distance > 0.0f ? glm::dot(off, n) / (distance * length) : 1.0f;
          // Of triangles that meet at the nearest place the one that is seen least from its edge tells the side.
          if (distance > best.distance - kSameDistance && std::abs(cosine) <= std::abs(best.cosine)) continue;
          best = {distance, cosine, rim.has(t, found.corners)};
        }
  };
  const auto slabs = slabs_of(sheet.triangles, band.node_at.dims().z, place);
  parallel_for(static_cast<std::int64_t>(slabs.size()), 1, [&](std::int64_t s) {
    const int from = static_cast<int>(s) * kSlabSlices;
    for (const std::uint32_t i : slabs[static_cast<std::size_t>(s)])
      look_around(sheet.triangles[i], from, from + kSlabSlices);
  });
  std::vector<float> distances(nearest.size(), kUnknown);
  for (std::size_t i = 0; i < nearest.size(); ++i)
    if (nearest[i].distance < kFar)
      distances[i] = nearest[i].rim ? kFar : std::copysign(nearest[i].distance, nearest[i].cosine);
  return distances;
}

void follow_sheet(const ContactBand& band, const std::vector<float>& distances, int reach, std::size_t least,
                  std::vector<ClaySide>& side) {
  const std::vector<ClaySide> before = side;
  const auto at_end = [&](std::uint32_t n) {
    bool found = false;
    each_beside(band.point(n), [&](const glm::ivec3& q) { found = found || band.at(q) == ContactBand::kNone; });
    return found;
  };
  const auto count = static_cast<std::int64_t>(side.size());
  using Nodes = std::vector<std::uint32_t>;
  const auto near_sheet = [&](std::uint32_t n) { return !std::isnan(distances[n]); };
  Nodes front =
      parallel_gather<std::uint32_t>(count, kNodesTogether, [&](std::int64_t begin, std::int64_t end, Nodes& found) {
        for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n) {
          if (!near_sheet(n) || std::isinf(distances[n])) continue;  // as it was
          const ClaySide now = distances[n] > 0.0f ? ClaySide::kEnvelope : ClaySide::kTablet;
          if (now != side[n] && !at_end(n)) found.push_back(n);
        }
      });
  for (const std::uint32_t n : front) side[n] = distances[n] > 0.0f ? ClaySide::kEnvelope : ClaySide::kTablet;
  std::vector<bool> gone(side.size(), false);
  for (int step = 0; step < reach; ++step) {
    Nodes next;
    for (const std::uint32_t n : front)
      each_beside(band.point(n), [&](const glm::ivec3& q) {
        const std::uint32_t m = band.at(q);
        if (m == ContactBand::kNone || near_sheet(m) || gone[m] || side[m] == side[n] || at_end(m)) return;
        gone[m] = true;
        side[m] = side[n];
        next.push_back(m);
      });
    front = std::move(next);
  }

  // What has come loose of its clay stays as it was.
  ConcurrentSets pieces(side.size());
  parallel_for(count, kNodesTogether, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t m = band.at(band.point(n) + unit_step(axis));
      if (m != ContactBand::kNone && side[m] == side[n]) pieces.join(n, m);
    }
  });
  std::vector<std::uint32_t> size(side.size(), 0);
  parallel_chunks(count, kNodesTogether, [&](std::int64_t begin, std::int64_t end) {
    std::uint32_t root = 0, same = 0;  // most have the root of the one before
    const auto add = [&] {
      if (same > 0) std::atomic_ref(size[root]).fetch_add(same, std::memory_order_relaxed);
    };
    for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n) {
      const std::uint32_t own = pieces.root(n);
      if (own != root) add(), root = own, same = 0;
      ++same;
    }
    add();
  });
  std::vector<std::uint8_t> ends(side.size(), 0);  // of small pieces: is one of its nodes where the band ends?
  parallel_for(count, kNodesTogether, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    const std::uint32_t root = pieces.root(n);
    if (size[root] < kLargePiece && at_end(n)) std::atomic_ref(ends[root]).store(1, std::memory_order_relaxed);
  });
  parallel_for(count, kNodesTogether, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    if (side[n] == before[n]) return;
    const std::uint32_t root = pieces.root(n);
    if (size[root] < least || (size[root] < kLargePiece && ends[root] == 0)) side[n] = before[n];
  });
}

}  // namespace dubsar
