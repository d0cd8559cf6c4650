#include "core/seals/seal_turn.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

constexpr double kLeastDeviations = 4.5;
constexpr double kChance = 2.0,
                 kLeastTurn = 3.0;  // deviations: the best across and of all turns of unlike places; of a mean
constexpr double kLeastTurnMm = 15.0, kMostTurnMm = 90.0, kTurnStepMm = 0.2;

/// A pair and where its second one lies on its first one.
struct AlikePair {
  std::size_t first, second;
  Likeness likeness;
  double shift_mm;  ///< of the best place, as Likeness counts
};

/// The turn by all pairs.
void find_turn(const std::vector<AlikePair>& pairs, SealPlacing& out) {
  for (double turn = kLeastTurnMm; turn <= kMostTurnMm; turn += kTurnStepMm) {
    double like = 0.0, area = 0.0;
    for (const AlikePair& pair : pairs)
      for (const double way : {-1.0, 1.0}) {
        if (pair.first == pair.second && way < 0.0) continue;  // the same
        const Likeness::At there = pair.likeness.near(pair.shift_mm + way * turn);
        like += (there.area_mm2 > 0.0 ? there.weight() - kChance : 0.0) * std::sqrt(there.area_mm2);
        area += there.area_mm2;
      }
    if (!(area > 0.0)) continue;
    const double sure = like / std::sqrt(area);
    if (sure > out.turn_sure) {
      out.turn_sure = sure;
      out.turn_mm = turn;
    }
  }
  if (out.turn_sure < kLeastTurn) out.turn_mm = out.turn_sure = 0.0;
}

}  // namespace

SealPlacing place_impressions(const std::vector<SealImpression>& impressions, std::size_t first, double turn_mm) {
  SealPlacing out;
  const std::size_t count = impressions.size();
  out.seal_from_band.resize(count);
  out.likeness.assign(count, 0.0);
  out.first = first;
  std::vector<AlikePair> pairs;
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a; b < count; ++b) {
      AlikePair pair{a, b, likeness_of(impressions[a], impressions[b]), 0.0};
      const auto best = std::max_element(pair.likeness.along.begin(), pair.likeness.along.end(),
                                         [](const auto& x, const auto& y) { return x.weight() < y.weight(); });
      pair.shift_mm = a == b ? 0.0
                             : pair.likeness.least_mm +
                                   pair.likeness.step_mm * static_cast<double>(best - pair.likeness.along.begin());
      pairs.push_back(std::move(pair));
    }
  std::vector<std::uint8_t> laid(count, 0);
  laid[out.first] = 1;
  for (std::size_t round = 1; round < count; ++round) {
    const AlikePair* most = nullptr;
    for (const AlikePair& pair : pairs)
      if (laid[pair.first] != laid[pair.second] && pair.likeness.best().weight() >= kLeastDeviations)
        if (!most || pair.likeness.best().weight() > most->likeness.best().weight()) most = &pair;
    if (!most) break;
    const PlacedOn& first_from_second = most->likeness.best().first_from_second;
    const std::size_t fresh = laid[most->first] ? most->second : most->first;
    PlacedOn inverse;
    inverse.turn = glm::inverse(first_from_second.turn);
    inverse.shift = -(inverse.turn * first_from_second.shift);
    out.seal_from_band[fresh] = laid[most->first] ? after(out.seal_from_band[most->first], first_from_second)
                                                  : after(out.seal_from_band[most->second], inverse);
    out.likeness[fresh] = most->likeness.best().weight();
    laid[fresh] = 1;
  }
  if (turn_mm > 0.0) {
    out.turn_mm = turn_mm;
  } else {
    std::erase_if(pairs, [&](const AlikePair& pair) {
      return !laid[pair.first] || !laid[pair.second] ||
             (pair.first != pair.second && pair.likeness.best().weight() < kLeastDeviations);
    });
    find_turn(pairs, out);
  }
  return out;
}

}  // namespace dubsar
