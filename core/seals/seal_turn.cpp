#include "core/seals/seal_turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace dubsar {
namespace {

constexpr double kLeastDeviations = 4.5;
// Of the best of all turns and places across, which unlike ones have, too.
constexpr double kChanceDeviations = 1.5;
// A turn apart there is somewhat less likeness than where two lie: what is far apart is bent in other ways.
constexpr double kAlikeShare = 0.8;
constexpr double kUsualLikeness = 0.6;  // of two that have each lost half; where there are none to tell it
constexpr double kLeastTurnRatio = 6.0, kOverOthers = 1.3, kSameTurnMm = 2.5;
constexpr double kLeastTurnMm = 15.0, kMostTurnMm = 90.0, kTurnStepMm = 0.2;
constexpr double kSamePlaceMm = 2.0, kAcrossOffMm = 2.5;  // strips are named within that, and bend

struct AlikePair {
  std::size_t first, second;
  Likeness likeness;
  bool alike() const { return first == second || likeness.best().weight() >= kLeastDeviations; }
};

glm::dvec2 middle_of(const SealImpression& of) { return 0.5 * of.step_mm * glm::dvec2(of.width, of.height); }

/// How far the second of a pair is moved along the first where both lie, as Likeness counts.
double shift_of(const AlikePair& pair, const std::vector<SealImpression>& impressions, const SealPlacing& in) {
  const glm::dvec2 middle = middle_of(impressions[pair.second]);
  return in.seal_from_band[pair.first].back(in.seal_from_band[pair.second](middle)).x - middle.x;
}

PlacedOn reversed(const PlacedOn& of) {
  PlacedOn out;
  out.turn = glm::inverse(of.turn);
  out.shift = -(out.turn * of.shift);
  return out;
}

/// How alike pairs are where they lie.
double usual_likeness(const std::vector<AlikePair>& pairs) {
  double sum = 0.0, area = 0.0;
  for (const AlikePair& pair : pairs) {
    if (pair.first == pair.second || !pair.alike()) continue;
    sum += pair.likeness.best().likeness * pair.likeness.best().area_mm2;
    area += pair.likeness.best().area_mm2;
  }
  return kAlikeShare * (area > 0.0 ? sum / area : kUsualLikeness);
}

/// Logarithm of how much more likely a meeting is of one seal's same place than of unlike ones.
double same_place(const Likeness::At& there, double usual) {
  const double figures = there.area_mm2 / Likeness::kFigureMm2;
  if (!(figures > 0.0)) return 0.0;
  const double beyond_chance = there.likeness - kChanceDeviations / std::sqrt(figures);
  return 0.5 * figures * usual * (2.0 * beyond_chance - usual);
}

/// The turn by all pairs.
void find_turn(const std::vector<SealImpression>& impressions, const std::vector<AlikePair>& pairs, SealPlacing& out) {
  const double usual = usual_likeness(pairs);
  std::vector<std::array<double, 2>> all;  // lengths, how likely
  for (double turn = kLeastTurnMm; turn <= kMostTurnMm; turn += kTurnStepMm) {
    double likely = 0.0;
    for (const AlikePair& pair : pairs)
      for (const double way : {-1.0, 1.0}) {
        if (pair.first == pair.second && way < 0.0) continue;  // the same
        likely += same_place(pair.likeness.near(shift_of(pair, impressions, out) + way * turn), usual);
      }
    all.push_back({turn, likely});
    if (likely > out.turn_sure) {
      out.turn_sure = likely;
      out.turn_mm = turn;
    }
  }
  bool sure = out.turn_sure >= kLeastTurnRatio;
  for (const auto& [turn, likely] : all) {
    const double whole = turn / out.turn_mm, off = std::abs(whole - std::max(1.0, std::round(whole))) * out.turn_mm;
    if (off > kSameTurnMm && kOverOthers * likely > out.turn_sure) sure = false;
  }
  if (!sure) out.turn_mm = out.turn_sure = 0.0;
}

/// Lays impressions on each other one by one.
class Placer {
 public:
  Placer(const std::vector<SealImpression>& impressions, const std::vector<AlikePair>& pairs, double turn_mm)
      : impressions_(impressions), pairs_(pairs), turn_mm_(turn_mm), usual_(usual_likeness(pairs)) {}

  /// Which were.
  std::vector<std::uint8_t> place_all(SealPlacing& out) {
    laid_.assign(impressions_.size(), 0);
    laid_[out.first] = 1;
    for (std::size_t round = 1; round < impressions_.size(); ++round) {
      const AlikePair* most = nullptr;
      for (const AlikePair& pair : pairs_)
        if (laid_[pair.first] != laid_[pair.second] && pair.alike())
          if (!most || pair.likeness.best().weight() > most->likeness.best().weight()) most = &pair;
      if (!most) break;
      const std::size_t fresh = laid_[most->first] ? most->second : most->first;
      lay(fresh, out);
      laid_[fresh] = 1;
    }
    return laid_;
  }

 private:
  /// Where both meet if `fresh` lies so: of its pair with one that is laid, moved by whole turns; nothing else than
  /// chance where it is turned or moved otherwise than there.
  Likeness::At meeting(const AlikePair& pair, std::size_t fresh, const PlacedOn& place, const SealPlacing& in,
                       int turns) const {
    const PlacedOn& first = pair.first == fresh ? place : in.seal_from_band[pair.first];
    const PlacedOn& second = pair.first == fresh ? in.seal_from_band[pair.second] : place;
    const glm::dvec2 middle = middle_of(impressions_[pair.second]),
                     off = first.back(second(middle) + glm::dvec2(turns * turn_mm_, 0.0)) - middle;
    Likeness::At there = pair.likeness.near(off.x);
    const bool upside = (glm::inverse(first.turn) * second.turn)[0][0] < 0.0;
    const PlacedOn& is = there.first_from_second;
    if ((is.turn[0][0] < 0.0) != upside || std::abs(is(middle).y - middle.y - off.y) > kAcrossOffMm)
      there.likeness = 0.0;
    return there;
  }

  struct Candidate {
    PlacedOn place;
    double weight, likely;
  };

  /// By all pairs of an impression with those that are laid. `own`: the pair by whose meeting it is placed.
  double likely_at(const PlacedOn& place, std::size_t fresh, const AlikePair& own, const Likeness::At& at,
                   const SealPlacing& in) const {
    const int most_turns = turn_mm_ > 0.0 ? 1 : 0;
    double out = 0.0;
    for (const AlikePair& pair : pairs_) {
      if (pair.first == pair.second || (pair.first != fresh && pair.second != fresh) ||
          !laid_[pair.first == fresh ? pair.second : pair.first])
        continue;
      for (int turns = -most_turns; turns <= most_turns; ++turns)
        out += same_place(&pair == &own && turns == 0 ? at : meeting(pair, fresh, place, in, turns), usual_);
    }
    return out;
  }

  void lay(std::size_t fresh, SealPlacing& out) const {
    std::vector<Candidate> all;
    for (const AlikePair& pair : pairs_) {
      if (pair.first == pair.second || !pair.alike()) continue;
      const bool is_second = pair.second == fresh && laid_[pair.first];
      if (!is_second && !(pair.first == fresh && laid_[pair.second])) continue;
      for (const Likeness::At& at : pair.likeness.along) {
        if (at.weight() < kLeastDeviations) continue;
        const PlacedOn place = is_second ? after(out.seal_from_band[pair.first], at.first_from_second)
                                         : after(out.seal_from_band[pair.second], reversed(at.first_from_second));
        all.push_back({place, at.weight(), likely_at(place, fresh, pair, at, out)});
      }
    }
    const Candidate* best =
        &*std::max_element(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.likely < y.likely; });
    // All pairs together say which of the places, the most alike one says it best.
    const glm::dvec2 middle = middle_of(impressions_[fresh]), there = best->place(middle);
    const bool upside = best->place.turn[0][0] < 0.0;
    for (const Candidate& other : all) {
      double off = other.place(middle).x - there.x;
      if (turn_mm_ > 0.0) off -= turn_mm_ * std::round(off / turn_mm_);
      if (std::abs(off) <= kSamePlaceMm && (other.place.turn[0][0] < 0.0) == upside && other.weight > best->weight)
        best = &other;
    }
    out.seal_from_band[fresh] = best->place;
    out.likeness[fresh] = best->weight;
  }

  const std::vector<SealImpression>& impressions_;
  const std::vector<AlikePair>& pairs_;
  double turn_mm_, usual_;
  std::vector<std::uint8_t> laid_;
};

}  // namespace

SealPlacing place_impressions(const std::vector<SealImpression>& impressions, std::size_t first, double turn_mm) {
  SealPlacing out;
  const std::size_t count = impressions.size();
  out.seal_from_band.resize(count);
  out.likeness.assign(count, 0.0);
  out.first = first;
  std::vector<AlikePair> pairs;
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a; b < count; ++b) pairs.push_back({a, b, likeness_of(impressions[a], impressions[b])});
  std::vector<std::uint8_t> laid = Placer(impressions, pairs, std::max(turn_mm, 0.0)).place_all(out);
  if (turn_mm > 0.0) {
    out.turn_mm = turn_mm;
  } else if (turn_mm == 0.0) {
    std::vector<AlikePair> together = pairs;
    std::erase_if(together, [&](const AlikePair& pair) { return !laid[pair.first] || !laid[pair.second]; });
    find_turn(impressions, together, out);
    if (out.turn_mm > 0.0) Placer(impressions, pairs, out.turn_mm).place_all(out);
  }
  return out;
}

}  // namespace dubsar
