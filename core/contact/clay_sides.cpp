#include "core/contact/clay_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr float kUnit = 256.0f;  ///< capacity of a unit face through clay that shows nothing
/// Strength of a dip from which the cut costs almost nothing, and what is left then.
constexpr float kClearDip = 2.4f, kLeastCost = 0.03f, kMostCost = 1.3f;
/// Walls of the sheet along the contact's normal: cheap enough that it can go down into wedges.
constexpr float kWall = 0.5f;
/// Cost of being on the wrong side of the patch, for each step from it: it holds the sheet where nothing is seen.
constexpr float kPull = 0.006f;
constexpr std::int32_t kHard = 1 << 28;

constexpr std::array<glm::ivec3, 3> kAxes{glm::ivec3(1, 0, 0), glm::ivec3(0, 1, 0), glm::ivec3(0, 0, 1)};

float cost_of(float strength) { return std::clamp(1.0f - strength / kClearDip, kLeastCost, kMostCost); }

/// Far above or below the patch: surely envelope or tablet. Beside it nobody knows.
bool at_border(const ContactBand& band, const ContactBand::Node& node) {
  return node.distance > band.reach - 1.0f && std::abs(node.height) > 0.97f * node.distance;
}

/// Islands of one clay in the other do not exist: they take the side of what is around them. Crumbs that air cuts off
/// from both are the tablet's; nobody asks.
void adopt_islands(const ContactBand& band, std::vector<ClaySide>& side, const std::vector<bool>& certain) {
  std::vector<bool> held(band.nodes.size(), false);
  std::vector<std::uint32_t> queue;
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    if (certain[n]) {
      held[n] = true;
      queue.push_back(n);
    }
  std::vector<std::uint32_t> rim;  // those beside clay of the other side that was not held then
  const auto spread = [&](bool adopt) {
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t n = queue[i];
      bool other_side = false;
      each_beside(band.point(n), [&](const glm::ivec3& q) {
        const std::uint32_t m = band.at(q);
        if (m == ContactBand::kNone || held[m]) return;
        if (!adopt && side[m] != side[n]) {
          other_side = true;
          return;
        }
        side[m] = side[n];
        held[m] = true;
        queue.push_back(m);
      });
      if (other_side) rim.push_back(n);
    }
  };
  spread(false);
  queue.swap(rim);
  spread(true);
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    if (!held[n]) side[n] = ClaySide::kTablet;
}

/// Four points of a grid face that belong to tablet, envelope, tablet, envelope in turn would pinch the contact: one of
/// the envelope's goes to the tablet.
bool unpinch(const ContactBand& band, std::vector<ClaySide>& side) {
  bool changed = false;
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    for (std::size_t a = 0; a < 3; ++a) {
      const glm::ivec3 p = band.point(n), u = kAxes[a], v = kAxes[(a + 1) % 3];
      const std::uint32_t right = band.at(p + u);
      if (right == ContactBand::kNone || side[n] == side[right]) continue;
      const std::uint32_t across = band.at(p + u + v), up = band.at(p + v);
      if (across == ContactBand::kNone || up == ContactBand::kNone) continue;
      if (side[n] != side[across] || side[right] != side[up]) continue;
      side[side[n] == ClaySide::kEnvelope ? n : right] = ClaySide::kTablet;
      changed = true;
    }
  return changed;
}

/// Nodes over the same piece of the patches: flow runs across the band, and most of it stays in one block.
LatticeCut cut_in_blocks(const ContactBand& band) {
  constexpr float kBlockSide = 64.0f;
  const Dims d = band.node_at.dims();
  const auto along = [](std::int64_t n) { return static_cast<std::uint32_t>(static_cast<float>(n) / kBlockSide) + 1; };
  const std::uint32_t x = along(d.x), y = along(d.y), z = along(d.z);
  std::vector<std::uint32_t> block(band.nodes.size());
  for (std::size_t n = 0; n < block.size(); ++n) {
    const glm::uvec3 cube(glm::max(band.samples[band.nodes[n].sample].position, glm::vec3(0.0f)) / kBlockSide);
    block[n] = (std::min(cube.z, z - 1) * y + std::min(cube.y, y - 1)) * x + std::min(cube.x, x - 1);
  }
  std::vector<float> height(block.size());
  for (std::size_t n = 0; n < height.size(); ++n) height[n] = band.nodes[n].height;
  return {block, x * y * z, height};
}

/// Of the face between two nodes that are neighbours along an axis.
std::int32_t cost_of_face(const ContactBand& band, std::uint32_t n, std::uint32_t m, std::uint32_t axis,
                          float strength) {
  const auto a = static_cast<glm::length_t>(axis);
  const float along = 0.5f * (std::abs(band.normal(n)[a]) + std::abs(band.normal(m)[a]));
  const float face = along + kWall * (1.0f - along);
  return 1 + static_cast<std::int32_t>(std::lround(kUnit * face * cost_of(strength)));
}

/// visit(node, its upper neighbour, axis) for all that are neighbours in the band.
template <class Visit>
void each_face(const ContactBand& band, const Visit& visit) {
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t m = band.at(band.point(n) + kAxes[axis]);
      if (m != ContactBand::kNone) visit(n, m, axis);
    }
}

}  // namespace

void unpinch_sides(const ContactBand& band, std::vector<ClaySide>& side) {
  constexpr int kMostRounds = 20;  // each round removes pinches and seldom makes one
  for (int round = 0; round < kMostRounds && unpinch(band, side); ++round) {
  }
}

ClayDivision::ClayDivision(const ClayEvidence& evidence)
    : band_(evidence.band),
      dips_(evidence.dips),
      cut_(cut_in_blocks(evidence.band)),  // source side: tablet
      certain_(evidence.band.nodes.size(), false) {
  const auto count = static_cast<std::uint32_t>(band_.nodes.size());
  std::vector<std::int64_t> wish(count, 0);  // > 0: tablet
  for (std::uint32_t n = 0; n < count; ++n) {
    const ContactBand::Node& node = band_.nodes[n];
    if (at_border(band_, node)) {
      wish[n] = node.height < 0.0f ? kHard : -kHard;
      certain_[n] = true;
    } else {
      wish[n] = std::lround(kUnit * ((evidence.votes.empty() ? 0.0f : evidence.votes[n]) - kPull * node.height));
    }
  }
  for (const SurfaceHint& hint : evidence.hints) {
    const std::int64_t sense = hint.side == ClaySide::kTablet ? 1 : -1;
    if (hint.weight >= kCertain) {
      if (!certain_[hint.node]) wish[hint.node] = sense * kHard;
      certain_[hint.node] = true;
    } else if (!certain_[hint.node]) {
      wish[hint.node] += sense * std::lround(kUnit * hint.weight);
    }
  }
  for (std::uint32_t n = 0; n < count; ++n) {
    const auto cost = static_cast<std::int32_t>(std::clamp<std::int64_t>(wish[n], -kHard, kHard));
    cut_.add_node_cost(n, cost < 0 ? -cost : 0, cost > 0 ? cost : 0);
  }
  each_face(band_, [&](std::uint32_t n, std::uint32_t m, std::uint32_t axis) {
    cut_.add_step_cost(n, m, axis, cost_of_face(band_, n, m, axis, 0.5f * (dips_.strength[n] + dips_.strength[m])));
  });
  for (const ClayCavity& cavity : evidence.whole)
    for (std::size_t i = 1; i < cavity.size(); ++i) cut_.tie(cavity[i - 1], cavity[i], kHard);
}

Result<std::vector<ClaySide>> ClayDivision::sides(Progress& progress) {
  DUBSAR_TRY(cut_.solve(progress));
  std::vector<ClaySide> side(band_.nodes.size());
  for (std::uint32_t n = 0; n < side.size(); ++n)
    side[n] = cut_.on_source_side(n) ? ClaySide::kTablet : ClaySide::kEnvelope;
  adopt_islands(band_, side, certain_);
  unpinch_sides(band_, side);
  return side;
}

Result<std::vector<ClaySide>> ClayDivision::sides_if_weaker(const std::vector<bool>& where, float by,
                                                            Progress& progress) {
  const auto strength = [&](std::uint32_t n) { return where[n] ? dips_.strength[n] - by : dips_.strength[n]; };
  each_face(band_, [&](std::uint32_t n, std::uint32_t m, std::uint32_t axis) {
    if (!where[n] && !where[m]) return;
    cut_.add_step_cost(n, m, axis,
                       cost_of_face(band_, n, m, axis, 0.5f * (strength(n) + strength(m))) -
                           cost_of_face(band_, n, m, axis, 0.5f * (dips_.strength[n] + dips_.strength[m])));
  });
  return sides(progress);
}

}  // namespace dubsar
