#include "core/contact/clay_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"

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
constexpr std::int64_t kBrickGrain = 1 << 8;

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

/// Half of the reach and more under two patches that face away from each other: in the middle of a tablet that is
/// thinner than both reaches, where nothing is at the border.
bool in_the_middle(const ContactBand& band, std::uint32_t node) {
  const auto deep = [&](std::uint32_t n) { return band.nodes[n].height < -0.5f * band.tablet_reach; };
  if (!deep(node)) return false;
  bool found = false;
  each_beside(band.point(node), [&](const glm::ivec3& q) {
    const std::uint32_t m = band.at(q);
    found = found || (m != ContactBand::kNone && deep(m) && glm::dot(band.normal(node), band.normal(m)) < 0.0f);
  });
  return found;
}

template <class Visit>
void each_brick(const BandBricks& bricks, const Visit& visit) {
  parallel_for(static_cast<std::int64_t>(bricks.lattice().count()) - 1, kBrickGrain,
               [&](std::int64_t i) { visit(static_cast<std::uint32_t>(i + 1)); });
}

/// Islands of one clay in the other do not exist: they take the side of what is around them. Crumbs that air cuts off
/// from both are the tablet's; nobody asks. `tablet`: of `side`.
void adopt_islands(const ContactBand& band, const BandBricks& bricks, const BrickBits& certain, BrickBits& tablet,
                   std::vector<ClaySide>& side) {
  BrickBits loose = bricks.in_band();
  std::array<BrickBits, 2> held;
  parallel_for(2, 1, [&](std::int64_t i) {
    BrickBits within = tablet;
    if (i == 1)
      for (std::size_t b = 0; b < within.size(); ++b) within[b] = loose[b] & ~within[b];
    held[static_cast<std::size_t>(i)] = bricks.reached(within, certain);
  });
  for (std::size_t b = 0; b < loose.size(); ++b) loose[b] &= ~(held[0][b] | held[1][b]);
  const std::vector<std::uint32_t> islands = bricks.nodes_of(loose);
  std::vector<std::uint32_t> queue;  // what lies around an island is of the other side, all of it
  const auto is_loose = [&](std::uint32_t n) { return has_bit(loose, bricks.point(n)); };
  const auto adopt_beside = [&](std::uint32_t n) {
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      const std::uint32_t m = band.at(q);
      if (m == ContactBand::kNone || !is_loose(m)) return;
      side[m] = side[n];
      set_bit(loose, bricks.point(m), false);
      queue.push_back(m);
    });
  };
  for (const std::uint32_t n : islands) {
    if (!is_loose(n)) continue;
    each_beside(band.point(n), [&](const glm::ivec3& q) {
      const std::uint32_t m = band.at(q);
      if (m != ContactBand::kNone && !is_loose(m)) adopt_beside(m);
    });
    for (; !queue.empty();) {
      const std::uint32_t next = queue.back();
      queue.pop_back();
      adopt_beside(next);
    }
  }
  for (const std::uint32_t n : islands) {
    if (is_loose(n)) side[n] = ClaySide::kTablet;
    set_bit(tablet, bricks.point(n), side[n] == ClaySide::kTablet);
  }
}

/// Four points of a grid face that belong to tablet, envelope, tablet, envelope in turn would pinch the contact: the
/// lower one of the envelope's goes to the tablet.
bool unpinch(const ContactBand& band, const BandBricks& bricks, BrickBits& tablet, std::vector<ClaySide>& side) {
  constexpr std::uint32_t kNone = ContactBand::kNone;
  const auto pinch_at = [&](std::uint32_t n, int a) {  // the point of the envelope that goes
    const glm::ivec3 p = band.point(n), u = unit_step(a), v = unit_step((a + 1) % 3);
    const std::uint32_t right = band.at(p + u), across = band.at(p + u + v), up = band.at(p + v);
    if (right == kNone || across == kNone || up == kNone) return kNone;
    if (side[n] == side[right] || side[n] != side[across] || side[right] != side[up]) return kNone;
    const std::uint32_t one = side[n] == ClaySide::kEnvelope ? n : right,
                        other = side[n] == ClaySide::kEnvelope ? across : up;
    return band.nodes[one].height <= band.nodes[other].height ? one : other;
  };
  const std::vector<std::uint32_t> pinched = bricks.nodes_of(bricks.pinched(tablet));
  for (const std::uint32_t n : pinched)
    for (int a = 0; a < 3; ++a)
      if (const std::uint32_t of_envelope = pinch_at(n, a); of_envelope != kNone) {
        side[of_envelope] = ClaySide::kTablet;
        set_bit(tablet, bricks.point(of_envelope), true);
      }
  return !pinched.empty();
}

/// What the cost of faces is made of, at the points of a brick and those beside it up the axes.
struct FacePoint {
  glm::vec3 across{0.0f};  ///< how far the normal lies along each axis
  float strength = 0.0f;
  bool there = false;
};

class BrickFaces {
 public:
  BrickFaces(const ContactBand& band, const Dips& dips, const BandBricks& bricks, std::uint32_t brick) {
    const BandBricks::Nodes own = bricks.nodes(brick);
    const auto add = [&](std::uint32_t n, int x, int y, int z) {
      if (n != ContactBand::kNone) at(x, y, z) = {glm::abs(band.normal(n)), dips.strength[n], true};
    };
    for (int k = 0; k < kPoints; ++k) add(own[static_cast<std::size_t>(k)], k & 3, k >> 2 & 3, k >> 4);
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t above = bricks.lattice().brick_beside(brick, 2 * static_cast<std::uint32_t>(axis));
      if (above == 0) continue;
      const BandBricks::Nodes beside = bricks.nodes(above);
      const int u = 1 << 2 * ((axis + 1) % 3), v = 1 << 2 * ((axis + 2) % 3);
      for (int i = 0; i < kEdge; ++i)
        for (int j = 0; j < kEdge; ++j) {
          const int k = i * u + j * v;
          const glm::ivec3 p = glm::ivec3(k & 3, k >> 2 & 3, k >> 4) + kEdge * unit_step(axis);
          add(beside[static_cast<std::size_t>(k)], p.x, p.y, p.z);
        }
    }
  }
  /// visit(point in the brick, axis, capacity of the face to the point above).
  template <class Visit>
  void each(const Visit& visit) {
    for (std::uint32_t k = 0; k < LatticeBricks::kPoints; ++k) {
      const glm::ivec3 p(k & 3, k >> 2 & 3, k >> 4);
      const FacePoint& a = at(p.x, p.y, p.z);
      if (!a.there) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const glm::ivec3 q = p + unit_step(axis);
        const FacePoint& b = at(q.x, q.y, q.z);
        if (!b.there) continue;
        const float along = 0.5f * (a.across[axis] + b.across[axis]), face = along + kWall * (1.0f - along);
        visit(k, static_cast<std::uint32_t>(axis),
              1 + rounded(kUnit * face * cost_of(0.5f * (a.strength + b.strength))));
      }
    }
  }

 private:
  static constexpr int kEdge = LatticeBricks::kEdge, kPoints = LatticeBricks::kPoints;
  static constexpr std::size_t kSide = kEdge + 1;
  static std::int32_t rounded(float positive) {  // as std::lround
    const double half_more = static_cast<double>(positive) + 0.5;
    return static_cast<std::int32_t>(half_more);
  }
  FacePoint& at(int x, int y, int z) {
    return points_[(static_cast<std::size_t>(z) * kSide + static_cast<std::size_t>(y)) * kSide +
                   static_cast<std::size_t>(x)];
  }
  std::array<FacePoint, kSide * kSide * kSide> points_{};
};

}  // namespace

ClayDivision::ClayDivision(const ClayEvidence& evidence)
    : band_(evidence.band),
      whole_(evidence.whole),
      bricks_(evidence.band),
      cut_(bricks_.lattice(), bricks_.starts()),
      certain_(bricks_.lattice().count(), 0) {
  add_points(evidence);
  add_hints(evidence.hints);
  add_steps(evidence.dips);
  for (const ClayCavity& cavity : whole_)
    for (std::size_t i = 1; i < cavity.size(); ++i)
      cut_.tie(bricks_.point(cavity[i - 1]), bricks_.point(cavity[i]), kHard);
}

void ClayDivision::add_points(const ClayEvidence& evidence) {
  each_brick(bricks_, [&](std::uint32_t b) {
    std::uint32_t point = LatticeBricks::kPoints * b;
    for (const std::uint32_t n : bricks_.nodes(b)) {
      const std::uint32_t p = point++;
      if (n == ContactBand::kNone) continue;
      const ContactBand::Node& node = band_.nodes[n];
      const bool known = height_tells(band_, node);
      cut_.set_height(p, node.height);
      std::int32_t& wish = cut_.wish(p);
      if (known && (at_border(band_, node) || in_the_middle(band_, n)))
        wish = node.height < 0.0f ? kHard : -kHard;
      else
        wish = capacity((evidence.votes.empty() ? 0.0f : evidence.votes[n]) - (known ? kPull * node.height : 0.0f));
      set_bit(certain_, p, std::abs(wish) == kHard);
    }
  });
}

void ClayDivision::add_hints(const std::vector<SurfaceHint>& hints) {
  for (const SurfaceHint& hint : hints) {
    const std::int32_t sense = hint.side == ClaySide::kTablet ? 1 : -1;
    const std::uint32_t p = bricks_.point(hint.node);
    if (has_bit(certain_, p)) continue;
    if (hint.weight >= kCertain)
      cut_.wish(p) = sense * kHard;
    else
      cut_.wish(p) += sense * capacity(hint.weight);
    set_bit(certain_, p, hint.weight >= kCertain);
  }
  for (const SurfaceHint& hint : hints) {
    std::int32_t& wish = cut_.wish(bricks_.point(hint.node));
    wish = std::clamp(wish, -kHard, kHard);
  }
}

void ClayDivision::add_steps(const Dips& dips) {
  each_brick(bricks_, [&](std::uint32_t b) {
    BrickFaces(band_, dips, bricks_, b).each([&](std::uint32_t k, std::uint32_t axis, std::int32_t cost) {
      cut_.add_step_cost(LatticeBricks::kPoints * b + k, axis, cost);
    });
  });
}

Result<std::vector<ClaySide>> ClayDivision::sides(Progress& progress) {
  DUBSAR_TRY(cut_.solve(progress));
  std::vector<ClaySide> side(band_.nodes.size());
  BrickBits tablet(bricks_.lattice().count(), 0);
  each_brick(bricks_, [&](std::uint32_t b) {
    std::uint32_t point = LatticeBricks::kPoints * b;
    for (const std::uint32_t n : bricks_.nodes(b)) {
      const std::uint32_t p = point++;
      if (n == ContactBand::kNone) continue;
      const bool of_tablet = cut_.on_source_side(p);
      side[n] = of_tablet ? ClaySide::kTablet : ClaySide::kEnvelope;
      set_bit(tablet, p, of_tablet);
    }
  });
  constexpr int kMostRounds = 5;    // seldom more than two
  constexpr int kMostPinches = 20;  // each look removes pinches and seldom makes one
  for (int round = 0; round < kMostRounds; ++round) {
    adopt_islands(band_, bricks_, certain_, tablet, side);
    for (int look = 0; look < kMostPinches && unpinch(band_, bricks_, tablet, side); ++look) {
    }
    if (!keep_whole(band_, whole_, side)) break;
    tablet = bricks_.tablet(side);
  }
  return side;
}

}  // namespace dubsar
