#include "core/contact/clay_sides.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr float kUnit = 256.0f;  ///< capacity of a unit face through clay that shows nothing
/// Strength of a dip from which the cut costs almost nothing, and what is left then.
constexpr float kClearDip = 2.0f, kLeastCost = 0.03f, kMostCost = 1.6f;
/// Walls of the sheet along the contact's normal: cheap enough that it can go down into wedges.
constexpr float kWall = 0.4f;
/// Cost of being on the wrong side of the patch, for each step from it: it holds the sheet where nothing is seen.
constexpr float kPull = 0.006f;
constexpr std::int32_t kHard = 1 << 28;
constexpr std::int64_t kNodeGrain = 1 << 14;

constexpr std::array<glm::ivec3, 3> kAxes{glm::ivec3(1, 0, 0), glm::ivec3(0, 1, 0), glm::ivec3(0, 0, 1)};

std::int32_t capacity(float faces) {
  return static_cast<std::int32_t>(std::clamp(std::lround(kUnit * faces), std::int64_t{-kHard}, std::int64_t{kHard}));
}
float cost_of(float strength) { return std::clamp(1.0f - strength / kClearDip, kLeastCost, kMostCost); }

/// Does the height of a node over the patch tell its side? Not beyond the rim: where a gap ends in an upright wall, the
/// patch begins along that, and the tablet on the other side of the gap is over it, too.
bool height_tells(const ContactBand& band, const ContactBand::Node& node) { return !band.samples[node.sample].at_rim; }

/// Far above or below the patch: surely envelope or tablet. Beside it nobody knows.
bool at_border(const ContactBand& band, const ContactBand::Node& node) {
  return node.distance > band.reach_at(node.height) - 1.0f && std::abs(node.height) > 0.97f * node.distance;
}

/// visit(node, its upper neighbour, axis) for all that are neighbours in the band.
template <class Visit>
void each_face_of(const ContactBand& band, std::uint32_t n, const Visit& visit) {
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t m = band.at(band.point(n) + kAxes[axis]);
    if (m != ContactBand::kNone) visit(n, m, axis);
  }
}

/// Islands of one clay in the other do not exist: they take the side of what is around them. Crumbs that air cuts off
/// from both are the tablet's; nobody asks.
void adopt_islands(const ContactBand& band, std::vector<ClaySide>& side, const std::vector<bool>& certain) {
  const auto count = static_cast<std::int64_t>(band.nodes.size());
  const auto each_node = [&](const auto& visit) {
    parallel_for(count, kNodeGrain, [&](std::int64_t n) { visit(static_cast<std::uint32_t>(n)); });
  };
  ConcurrentSets pieces(band.nodes.size());  // of one side
  each_node([&](std::uint32_t node) {
    each_face_of(band, node, [&](std::uint32_t n, std::uint32_t m, std::uint32_t) {
      if (side[n] == side[m]) pieces.join(n, m);
    });
  });
  std::vector<std::uint8_t> held(band.nodes.size(), 0);  // first the pieces, by their roots
  each_node([&](std::uint32_t n) {
    if (certain[n]) std::atomic_ref(held[pieces.root(n)]).store(1, std::memory_order_relaxed);
  });
  using Nodes = std::vector<std::uint32_t>;
  const Nodes islands =
      parallel_gather<std::uint32_t>(count, kNodeGrain, [&](std::int64_t begin, std::int64_t end, Nodes& found) {
        for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n)
          if (held[pieces.root(n)] == 0) found.push_back(n);
      });
  std::fill(held.begin(), held.end(), 1);
  for (const std::uint32_t n : islands) held[n] = 0;
  Nodes queue;  // what lies around an island is of the other side, all of it
  const auto adopt_beside = [&](std::uint32_t n) {
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      const std::uint32_t m = band.at(q);
      if (m == ContactBand::kNone || held[m] != 0) return;
      side[m] = side[n];
      held[m] = 1;
      queue.push_back(m);
    });
  };
  for (const std::uint32_t n : islands) {
    if (held[n] != 0) continue;
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      const std::uint32_t m = band.at(q);
      if (m != ContactBand::kNone && held[m] != 0) adopt_beside(m);
    });
    for (; !queue.empty();) {
      const std::uint32_t next = queue.back();
      queue.pop_back();
      adopt_beside(next);
    }
  }
  for (const std::uint32_t n : islands)
    if (held[n] == 0) side[n] = ClaySide::kTablet;
}

/// Four points of a grid face that belong to tablet, envelope, tablet, envelope in turn would pinch the contact: the
/// lower one of the envelope's goes to the tablet.
bool unpinch(const ContactBand& band, std::vector<ClaySide>& side) {
  constexpr std::uint32_t kNone = ContactBand::kNone;
  const auto pinch_at = [&](std::uint32_t n, std::size_t a) {  // the point of the envelope that goes
    const glm::ivec3 p = band.point(n), u = kAxes[a], v = kAxes[(a + 1) % 3];
    const std::uint32_t right = band.at(p + u);
    if (right == kNone || side[n] == side[right]) return kNone;
    const std::uint32_t across = band.at(p + u + v), up = band.at(p + v);
    if (across == kNone || up == kNone || side[n] != side[across] || side[right] != side[up]) return kNone;
    const std::uint32_t one = side[n] == ClaySide::kEnvelope ? n : right,
                        other = side[n] == ClaySide::kEnvelope ? across : up;
    return band.nodes[one].height <= band.nodes[other].height ? one : other;
  };
  using Nodes = std::vector<std::uint32_t>;
  const Nodes pinched = parallel_gather<std::uint32_t>(
      static_cast<std::int64_t>(band.nodes.size()), kNodeGrain,
      [&](std::int64_t begin, std::int64_t end, Nodes& found) {
        for (auto n = static_cast<std::uint32_t>(begin); n < static_cast<std::uint64_t>(end); ++n)
          if (pinch_at(n, 0) != kNone || pinch_at(n, 1) != kNone || pinch_at(n, 2) != kNone) found.push_back(n);
      });
  for (const std::uint32_t n : pinched)
    for (std::size_t a = 0; a < 3; ++a)
      if (const std::uint32_t of_envelope = pinch_at(n, a); of_envelope != kNone) side[of_envelope] = ClaySide::kTablet;
  return !pinched.empty();
}

/// Nodes over the same piece of the patches: flow runs across the band, and most of it stays in one block. With blocks
/// twice as wide threads wait for each other: a quarter more by the clock on two cores.
LatticeCut cut_in_blocks(const ContactBand& band) {
  constexpr float kBlockSide = 32.0f;
  const Dims d = band.node_at.dims();
  const auto along = [](std::int64_t n) { return static_cast<std::uint32_t>(static_cast<float>(n) / kBlockSide) + 1; };
  const std::uint32_t x = along(d.x), y = along(d.y), z = along(d.z);
  std::vector<std::uint32_t> block(band.nodes.size());
  std::vector<float> height(block.size());
  parallel_for(static_cast<std::int64_t>(block.size()), kNodeGrain, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const glm::uvec3 cube(glm::max(band.samples[band.nodes[n].sample].position, glm::vec3(0.0f)) / kBlockSide);
    block[n] = (std::min(cube.z, z - 1) * y + std::min(cube.y, y - 1)) * x + std::min(cube.x, x - 1);
    height[n] = band.nodes[n].height;
  });
  return {std::move(block), x * y * z, height};
}

/// Of the face between two nodes that are neighbours along an axis.
std::int32_t cost_of_face(const ContactBand& band, std::uint32_t n, std::uint32_t m, std::uint32_t axis,
                          float strength) {
  const auto a = static_cast<glm::length_t>(axis);
  const float along = 0.5f * (std::abs(band.normal(n)[a]) + std::abs(band.normal(m)[a]));
  const float face = along + kWall * (1.0f - along);
  return 1 + static_cast<std::int32_t>(std::lround(kUnit * face * cost_of(strength)));
}

}  // namespace

void unpinch_sides(const ContactBand& band, std::vector<ClaySide>& side) {
  constexpr int kMostRounds = 20;  // each round removes pinches and seldom makes one
  for (int round = 0; round < kMostRounds && unpinch(band, side); ++round) {
  }
}

ClayDivision::ClayDivision(const ClayEvidence& evidence)
    : band_(evidence.band),
      whole_(evidence.whole),
      cut_(cut_in_blocks(evidence.band)),  // source side: tablet
      certain_(evidence.band.nodes.size(), false) {
  const Dips& dips = evidence.dips;
  const auto count = static_cast<std::uint32_t>(band_.nodes.size());
  std::vector<std::int32_t> wish(count);  // > 0: tablet
  parallel_for(count, kNodeGrain, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const ContactBand::Node& node = band_.nodes[n];
    const bool known = height_tells(band_, node);
    if (known && at_border(band_, node))
      wish[n] = node.height < 0.0f ? kHard : -kHard;
    else
      wish[n] = capacity((evidence.votes.empty() ? 0.0f : evidence.votes[n]) - (known ? kPull * node.height : 0.0f));
  });
  for (std::uint32_t n = 0; n < count; ++n) certain_[n] = std::abs(wish[n]) == kHard;
  for (const SurfaceHint& hint : evidence.hints) {
    const std::int32_t sense = hint.side == ClaySide::kTablet ? 1 : -1;
    if (hint.weight >= kCertain) {
      if (!certain_[hint.node]) wish[hint.node] = sense * kHard;
      certain_[hint.node] = true;
    } else if (!certain_[hint.node]) {
      wish[hint.node] += sense * capacity(hint.weight);
    }
  }
  parallel_for(count, kNodeGrain, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    const std::int32_t cost = std::clamp(wish[n], -kHard, kHard);
    cut_.add_node_cost(n, cost < 0 ? -cost : 0, cost > 0 ? cost : 0);
  });
  parallel_for(count, kNodeGrain, [&](std::int64_t i) {
    each_face_of(band_, static_cast<std::uint32_t>(i), [&](std::uint32_t n, std::uint32_t m, std::uint32_t axis) {
      cut_.add_step_cost(n, m, axis, cost_of_face(band_, n, m, axis, 0.5f * (dips.strength[n] + dips.strength[m])));
    });
  });
  for (const ClayCavity& cavity : evidence.whole)
    for (std::size_t i = 1; i < cavity.size(); ++i) cut_.tie(cavity[i - 1], cavity[i], kHard);
}

Result<std::vector<ClaySide>> ClayDivision::sides(Progress& progress) {
  DUBSAR_TRY(cut_.solve(progress));
  std::vector<ClaySide> side(band_.nodes.size());
  parallel_for(static_cast<std::int64_t>(side.size()), kNodeGrain, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    side[n] = cut_.on_source_side(n) ? ClaySide::kTablet : ClaySide::kEnvelope;
  });
  constexpr int kMostRounds = 5;  // seldom more than two
  for (int round = 0; round < kMostRounds; ++round) {
    adopt_islands(band_, side, certain_);
    unpinch_sides(band_, side);
    if (!keep_whole(band_, whole_, side)) break;
  }
  return side;
}

}  // namespace dubsar
