#include "core/script/usual_directions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dubsar {
namespace {

constexpr double kLongReach = 1.15;    // widths from T
constexpr double kUsualSpread = 0.14;  // radians: how much a hand trembles
constexpr double kUsualStrays = 0.1;   // share of directions that nothing is known of
constexpr double kUsualFewest = 12.0;  // wedges that count as much as all that is not known
constexpr double kTurnBelief = 3.0;    // log odds of a side standing as is usual
// A Winkelhaken explains 3e-5 more or less turned by a third, by chance: a vote of one is no word of one.
constexpr double kVoteNat = 5e-5, kVoteMostNats = 6.0;
// Who votes: heads that end as soon as a Winkelhaken's does, and that fit nearly as well turned. What is clear by
// itself is a wedge whose tail is broken or covered, and no word of how a Winkelhaken lies.
constexpr double kVoteReach = 0.85, kVoteClear = 1.5e-4;
// Where kinds of wedges point, by definition: along the line, down, obliquely; a Winkelhaken lies across the line alike
// above and below, whichever way it opens.
constexpr std::array<double, 5> kKindAngles{0.0, -0.5 * std::numbers::pi, -0.25 * std::numbers::pi,
                                            0.25 * std::numbers::pi, std::numbers::pi};
constexpr double kKindNats = 4.0;
constexpr double kFullTurn = 2.0 * std::numbers::pi;

}  // namespace

bool is_long(const Imprint& imprint) { return imprint.reach() > kLongReach * imprint.width(); }

UsualDirections::UsualDirections(std::span<const PlacedImprint> placed, const TextSides& sides)
    : long_(kSectors, 0.0), short_(kSectors, 0.0) {
  for (const bool long_ones : {true, false}) {
    std::vector<double>& density = long_ones ? long_ : short_;
    double count = 0.0;
    for (const PlacedImprint& one : placed) {
      if (is_long(one.imprint) != long_ones) continue;
      const double angle = sides.angle_of(one.along, one.normal).angle;
      count += 1.0;
      for (int s = 0; s < kSectors; ++s) {
        const double off = std::remainder(kFullTurn * s / kSectors - angle, kFullTurn) / kUsualSpread;
        density[static_cast<std::size_t>(s)] += std::exp(-0.5 * off * off);
      }
    }
    double sum = 0.0;
    for (const double d : density) sum += d;
    const double known = (1.0 - kUsualStrays) * count / (count + kUsualFewest);
    for (double& d : density) d = (1.0 - known) + (sum > 0.0 ? known * d * kSectors / sum : 0.0);
  }
  vote(placed, sides);
}

void UsualDirections::vote(std::span<const PlacedImprint> placed, const TextSides& sides) {
  thirds_.assign(kSectors, 0.0);
  for (int s = 0; s < kSectors; ++s) {
    double near = 0.0;
    for (const double kind : kKindAngles) {
      const double off = std::remainder(kFullTurn * s / kSectors - kind, kFullTurn) / kUsualSpread;
      near = std::max(near, std::exp(-0.5 * off * off));
    }
    thirds_[static_cast<std::size_t>(s)] = kKindNats * near;
  }
  for (const PlacedImprint& one : placed) {
    if (is_long(one.imprint) || one.imprint.reach() > kVoteReach * one.imprint.width() ||
        std::max(one.thirds[0], one.thirds[1]) > kVoteClear)
      continue;
    const double angle = sides.angle_of(one.along, one.normal).angle;
    const std::array<double, 3> costs{0.0, one.thirds[0], one.thirds[1]};
    const double mean = (costs[0] + costs[1] + costs[2]) / 3.0;
    for (std::size_t way = 0; way < 3; ++way) {
      const double at = angle + (way == 0 ? 0.0 : way == 1 ? 1.0 : -1.0) * kFullTurn / 3.0;
      for (int s = 0; s < kSectors; ++s) {
        const double off = std::remainder(kFullTurn * s / kSectors - at, kFullTurn) / kUsualSpread;
        thirds_[static_cast<std::size_t>(s)] += std::exp(-0.5 * off * off) * (mean - costs[way]) / kVoteNat;
      }
    }
  }
}

double UsualDirections::surprise(double angle, bool long_one) const {
  const std::vector<double>& density = long_one ? long_ : short_;
  if (density.empty()) return 0.0;
  const auto value = [](const std::vector<double>& of, double at) {
    at = std::remainder(at, kFullTurn) / kFullTurn * kSectors;
    const auto sector = static_cast<int>(std::floor(at));
    const auto one = [&](int s) { return of[static_cast<std::size_t>(((s % kSectors) + kSectors) % kSectors)]; };
    return (1.0 - (at - sector)) * one(sector) + (at - sector) * one(sector + 1);
  };
  double out = -std::log(value(density, angle));
  if (!long_one) {
    const double best = std::max(
        {value(thirds_, angle), value(thirds_, angle + kFullTurn / 3.0), value(thirds_, angle - kFullTurn / 3.0)});
    out += std::min(kVoteMostNats, best - value(thirds_, angle));
  }
  return out;
}

void turn_sides(TextSides& sides, std::span<const PlacedImprint> placed) {
  std::vector<PlacedImprint> broad;  // they say what is usual: nearly all is written there
  for (const PlacedImprint& one : placed)
    if (sides.side_of(one.normal) == TextSide::kObverse) broad.push_back(one);
  const UsualDirections usual(broad, sides);
  for (std::size_t s = 1; s < kTextSideCount; ++s) {
    const auto side = static_cast<TextSide>(s);
    std::array<double, 4> likely{kTurnBelief, 0.0, 0.0, 0.0};
    for (const PlacedImprint& one : placed) {
      const SideAngle found = sides.angle_of(one.along, one.normal);
      if (found.side != side || !is_long(one.imprint)) continue;
      for (int turn = 0; turn < 4; ++turn)
        likely[static_cast<std::size_t>(turn)] -=
            usual.surprise(found.angle - turn * 0.5 * std::numbers::pi, is_long(one.imprint));
    }
    int best = 0;
    for (int turn = 1; turn < 4; ++turn)
      if (likely[static_cast<std::size_t>(turn)] > likely[static_cast<std::size_t>(best)]) best = turn;
    sides.turn(side, sides.turned(side) + best);
  }
}

}  // namespace dubsar
