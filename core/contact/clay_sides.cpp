#include "core/contact/clay_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/parts/min_cut.h"

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
  const auto spread = [&](bool adopt) {
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t n = queue[i];
      for (const glm::ivec3& axis : kAxes)
        for (const int sense : {-1, 1}) {
          const std::uint32_t m = band.at(band.point(n) + sense * axis);
          if (m == ContactBand::kNone || held[m] || (!adopt && side[m] != side[n])) continue;
          side[m] = side[n];
          held[m] = true;
          queue.push_back(m);
        }
    }
  };
  spread(false);
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
      const std::uint32_t right = band.at(p + u), across = band.at(p + u + v), up = band.at(p + v);
      if (right == ContactBand::kNone || across == ContactBand::kNone || up == ContactBand::kNone) continue;
      if (side[n] != side[across] || side[right] != side[up] || side[n] == side[right]) continue;
      side[side[n] == ClaySide::kEnvelope ? n : right] = ClaySide::kTablet;
      changed = true;
    }
  return changed;
}

/// Nodes over the same piece of the patches: flow runs across the band, and most of it stays in one block.
void set_blocks(const ContactBand& band, MinCut& cut) {
  constexpr float kBlockSide = 64.0f;
  const Dims d = band.node_at.dims();
  const auto along = [](std::int64_t n) { return static_cast<std::uint32_t>(static_cast<float>(n) / kBlockSide) + 1; };
  const std::uint32_t x = along(d.x), y = along(d.y), z = along(d.z);
  std::vector<std::uint32_t> block(band.nodes.size());
  for (std::size_t n = 0; n < block.size(); ++n) {
    const glm::uvec3 cube(glm::max(band.samples[band.nodes[n].sample].position, glm::vec3(0.0f)) / kBlockSide);
    block[n] = (std::min(cube.z, z - 1) * y + std::min(cube.y, y - 1)) * x + std::min(cube.x, x - 1);
  }
  cut.set_blocks(std::move(block), x * y * z);
}

}  // namespace

void unpinch_sides(const ContactBand& band, std::vector<ClaySide>& side) {
  constexpr int kMostRounds = 20;  // each round removes pinches and seldom makes one
  for (int round = 0; round < kMostRounds && unpinch(band, side); ++round) {
  }
}

Result<std::vector<ClaySide>> divide_clay(const ContactBand& band, const Dips& dips,
                                          const std::vector<SurfaceHint>& hints, const std::vector<float>& votes,
                                          const std::vector<ClayCavity>& whole, Progress& progress) {
  const auto count = static_cast<std::uint32_t>(band.nodes.size());
  MinCut cut(count);                         // source side: tablet
  std::vector<std::int64_t> wish(count, 0);  // > 0: tablet
  std::vector<bool> certain(count, false);
  for (std::uint32_t n = 0; n < count; ++n) {
    const ContactBand::Node& node = band.nodes[n];
    if (at_border(band, node)) {
      wish[n] = node.height < 0.0f ? kHard : -kHard;
      certain[n] = true;
    } else {
      wish[n] = std::lround(kUnit * ((votes.empty() ? 0.0f : votes[n]) - kPull * node.height));
    }
  }
  for (const SurfaceHint& hint : hints) {
    const std::int64_t sense = hint.side == ClaySide::kTablet ? 1 : -1;
    if (hint.weight >= kCertain) {
      if (!certain[hint.node]) wish[hint.node] = sense * kHard;
      certain[hint.node] = true;
    } else if (!certain[hint.node]) {
      wish[hint.node] += sense * std::lround(kUnit * hint.weight);
    }
  }
  for (std::uint32_t n = 0; n < count; ++n) {
    const auto cost = static_cast<std::int32_t>(std::clamp<std::int64_t>(wish[n], -kHard, kHard));
    cut.add_node_cost(n, cost < 0 ? -cost : 0, cost > 0 ? cost : 0);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t m = band.at(band.point(n) + kAxes[a]);
      if (m == ContactBand::kNone) continue;
      const auto axis = static_cast<glm::length_t>(a);
      const float along = 0.5f * (std::abs(band.normal(n)[axis]) + std::abs(band.normal(m)[axis]));
      const float face = along + kWall * (1.0f - along);
      const float cost_here = cost_of(0.5f * (dips.strength[n] + dips.strength[m]));
      cut.add_edge(n, m, 1 + static_cast<std::int32_t>(std::lround(kUnit * face * cost_here)));
    }
  }
  for (const ClayCavity& cavity : whole)
    for (std::size_t i = 1; i < cavity.size(); ++i) cut.add_edge(cavity[i - 1], cavity[i], kHard);
  set_blocks(band, cut);
  DUBSAR_TRY(cut.solve(progress));
  std::vector<ClaySide> side(count);
  for (std::uint32_t n = 0; n < count; ++n) side[n] = cut.on_source_side(n) ? ClaySide::kTablet : ClaySide::kEnvelope;
  adopt_islands(band, side, certain);
  unpinch_sides(band, side);
  return side;
}

}  // namespace dubsar
