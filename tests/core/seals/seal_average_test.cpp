// Three impressions of one drawn seal, each worn over half of it: what becomes of them together.

#include "core/seals/seal_average.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace dubsar {
namespace {

constexpr double kSealTurn = 38.0, kSealHigh = 17.0, kSealDeep = 0.45, kStep = 0.2, kLong = 50.0;

/// Round strokes in places of their own, periodic.
struct DrawnSeal {
  struct Stroke {
    double x, y, dx, dy, radius;
  };
  std::vector<Stroke> strokes;
  explicit DrawnSeal(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    for (int k = 0; k < 26; ++k) {
      const double angle = 3.1 * even(random), length = 1.0 + 4.0 * even(random);
      strokes.push_back({kSealTurn * even(random), 2.0 + (kSealHigh - 4.0) * even(random), length * std::cos(angle),
                         length * std::sin(angle), 0.5 + 0.7 * even(random)});
    }
  }
  double operator()(double x, double y) const {
    double nearest = 9.0;
    for (const Stroke& s : strokes) {
      double px = x - s.x;
      px -= kSealTurn * std::round(px / kSealTurn);
      const double py = y - s.y, t = std::clamp((px * s.dx + py * s.dy) / (s.dx * s.dx + s.dy * s.dy), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(px - t * s.dx, py - t * s.dy) - s.radius);
    }
    const double t = std::clamp(0.5 - nearest / 0.6, 0.0, 1.0);
    return kSealDeep * t * t * (3.0 - 2.0 * t);
  }
};

/// Patches over half of a band.
struct Worn {
  std::vector<std::array<double, 3>> waves;
  double least = 0.0;
  explicit Worn(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    for (int k = 0; k < 10; ++k) {
      const double angle = 6.28 * even(random), turns = 1.0 / (7.0 + 9.0 * even(random));
      waves.push_back({turns * std::cos(angle), turns * std::sin(angle), even(random)});
    }
    std::vector<double> values;
    for (double y = 0.0; y < kSealHigh; y += 0.5)
      for (double x = 0.0; x < kLong; x += 0.5) values.push_back(field(x, y));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    least = values[values.size() / 2];
  }
  double field(double x, double y) const {
    double out = 0.0;
    for (const auto& w : waves) out += std::sin(6.283185 * (w[0] * x + w[1] * y + w[2]));
    return out;
  }
  double kept(double x, double y) const { return std::clamp(0.5 - 2.0 * (field(x, y) - least), 0.0, 1.0); }
};

struct Rolled {
  double phase, up, turn_deg;
  bool weak = false;       ///< the right end was pressed by two fifths only
  bool scratched = false;  ///< three furrows across
  double clay_mm = 0.0;    ///< waves of 11 mm of the clay itself
};
constexpr Rolled kRolled[] = {{5.0, 0.0, 0.0}, {17.0, 0.5, 1.0}, {31.0, -0.4, -0.8}};

/// Where a place of an impression lies on the seal.
glm::dvec2 on_seal(const Rolled& r, const glm::dvec2& p) {
  const double a = r.turn_deg * 3.14159265 / 180.0, x = p.x - 0.5 * kLong, y = p.y - 0.5 * kSealHigh;
  return {std::cos(a) * x - std::sin(a) * y + 0.5 * kLong + r.phase,
          std::sin(a) * x + std::cos(a) * y + 0.5 * kSealHigh + r.up};
}

HeightMap rolled(const DrawnSeal& seal, const Rolled& how, const Worn& worn, unsigned seed) {
  HeightMap map;
  map.step_mm = kStep;
  map.width = static_cast<int>(kLong / kStep) + 1;
  map.height = static_cast<int>(kSealHigh / kStep) + 1;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const glm::dvec2 p = kStep * glm::dvec2(x, y), q = on_seal(how, p);
      const double inside = q.y > 0.0 && q.y < kSealHigh ? seal(q.x, q.y) : 0.0;
      double mm = inside * worn.kept(p.x, p.y) * (how.weak ? 1.0 - 0.6 * p.x / kLong : 1.0);
      mm += how.clay_mm * std::sin(6.283185 * (p.x + 0.6 * p.y) / 11.0 + how.phase);
      if (how.scratched)
        for (const double at : {9.0, 22.0, 37.0})
          if (std::abs(p.x + 0.3 * p.y - at) < 0.35) mm -= 0.4;
      map.mm.push_back(static_cast<float>(mm + noise(random)));
    }
  return map;
}

/// Error of a relief in the frame of the first impression, over one turn; what is not shown counts as ground.
double error_of(const DrawnSeal& seal, const SealImpression& relief, const glm::dvec2& least, const Rolled& first) {
  double sum = 0.0, count = 0.0;
  for (double y = 1.5; y < kSealHigh - 1.5; y += 0.25)
    for (double x = 0.0; x < kSealTurn; x += 0.25) {
      const glm::dvec2 q = on_seal(first, {x, y});
      const Sampled s = sampled(relief, glm::dvec2(x, y) - least);
      const double off = (s.weight > 0.3 ? s.mm : 0.0) - seal(q.x, q.y);
      sum += off * off;
      count += 1.0;
    }
  return std::sqrt(sum / count);
}

TEST(SealAverage, OfThreeWornImpressionsIsNearerToTheSealThanTheBestOfThem) {
  for (const unsigned seed : {11u, 12u, 13u}) {
    const DrawnSeal seal(seed);
    std::vector<SealImpression> impressions;
    double best = 1e9;
    for (unsigned k = 0; k < 3; ++k) {
      impressions.push_back(level_impression(rolled(seal, kRolled[k], Worn(100 * seed + k), seed + k)));
      best = std::min(best, error_of(seal, impressions[k], glm::dvec2(0.0), kRolled[k]));
    }
    const SealAverage average = average_seal(impressions, {.turn_mm = kSealTurn});
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(average.used[k], 1) << k;
    const double together = error_of(seal, average.relief, average.least_mm, kRolled[0]);
    EXPECT_GT(best / together, 1.5) << "seed " << seed << ": " << best << " and " << together;
    // Every place that one of them measures is drawn.
    std::size_t shown = 0;
    for (const float weight : average.relief.shown) shown += weight > 0.3f ? 1 : 0;
    EXPECT_GT(static_cast<double>(shown) / static_cast<double>(average.relief.shown.size()), 0.95);
  }
}

/// As if somebody had named the ends of the strip the other way round.
HeightMap upside_down(HeightMap map) {
  std::reverse(map.mm.begin(), map.mm.end());
  return map;
}

double times_as_near(unsigned seed, const std::array<Rolled, 3>& how, bool last_upside) {
  const DrawnSeal seal(seed);
  std::vector<SealImpression> impressions;
  double best = 1e9;
  for (unsigned k = 0; k < 3; ++k) {
    const HeightMap map = rolled(seal, how[k], Worn(100 * seed + k), seed + k);
    best = std::min(best, error_of(seal, level_impression(map), glm::dvec2(0.0), how[k]));
    impressions.push_back(level_impression(last_upside && k == 2 ? upside_down(map) : map));
  }
  const SealAverage average = average_seal(impressions, {.turn_mm = kSealTurn});
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(average.used[k], 1) << k << " of seed " << seed;
  return best / error_of(seal, average.relief, average.least_mm, how[0]);
}

TEST(SealAverage, BearsAnImpressionUpsideDownWeakPressingScratchesAndUnevenClay) {
  const std::array<Rolled, 3> plain{kRolled[0], kRolled[1], kRolled[2]};
  std::array<Rolled, 3> weak = plain, scratched = plain, uneven = plain;
  for (std::size_t k = 0; k < 3; ++k) {
    weak[k].weak = k > 0;
    scratched[k].scratched = true;
    uneven[k].clay_mm = 0.15;
  }
  EXPECT_GT(times_as_near(31, plain, true), 1.5);
  EXPECT_GT(times_as_near(32, weak, false), 1.3);
  EXPECT_GT(times_as_near(33, scratched, false), 1.3);
  EXPECT_GT(times_as_near(34, uneven, false), 1.5);
}

/// Three stand in a row, 9 mm apart, each alike: the seal is half alike to itself 9 and 18 mm on.
DrawnSeal with_worshippers(unsigned seed) {
  DrawnSeal out(seed);
  out.strokes.resize(10);
  for (const double x : {4.0, 13.0, 22.0}) {
    out.strokes.push_back({x, 3.0, 0.0, 6.0, 1.2});
    out.strokes.push_back({x, 11.5, 0.1, 1.0, 0.9});
    out.strokes.push_back({x, 8.0, 2.5, 1.0, 0.5});
    out.strokes.push_back({x - 0.5, 7.0, -2.0, -3.0, 0.45});
  }
  return out;
}

HeightMap left_part(const HeightMap& of, double wide_mm) {
  HeightMap out;
  out.step_mm = of.step_mm;
  out.width = static_cast<int>(wide_mm / of.step_mm);
  out.height = of.height;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      out.mm.push_back(
          of.mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(of.width) + static_cast<std::size_t>(x)]);
  return out;
}

TEST(SealAverage, FindsTheTurnOfFiguresInARowOrSaysThatItDoesNot) {
  int found = 0;
  for (const unsigned seed : {41u, 42u, 43u, 44u, 45u}) {
    const DrawnSeal seal = with_worshippers(seed);
    std::vector<SealImpression> impressions;
    for (unsigned k = 0; k < 3; ++k)
      impressions.push_back(level_impression(rolled(seal, kRolled[k], Worn(100 * seed + k), seed + k)));
    const SealAverage average = average_seal(impressions);
    found += average.placing.turn_mm > 0.0 ? 1 : 0;
    if (average.placing.turn_mm > 0.0) {
      EXPECT_NEAR(average.placing.turn_mm, kSealTurn, 0.7) << seed;
    }
  }
  EXPECT_GE(found, 4);
}

TEST(SealAverage, FindsNoTurnWhereNothingComesTwice) {
  for (const unsigned seed : {51u, 52u, 53u}) {
    const DrawnSeal seal = with_worshippers(seed);
    std::vector<SealImpression> impressions;
    for (unsigned k = 0; k < 3; ++k) {
      const Rolled how{5.0 + 2.0 * k, 0.0, 0.0};
      impressions.push_back(level_impression(left_part(rolled(seal, how, Worn(100 * seed + k), seed + k), 30.0)));
    }
    EXPECT_EQ(average_seal(impressions).placing.turn_mm, 0.0) << seed;
  }
}

TEST(SealAverage, OfAnotherSealIsLeftOut) {
  const DrawnSeal seal(21), other(22);
  const Worn whole(1), worn(2), third(3);
  const std::vector<SealImpression> impressions{level_impression(rolled(seal, kRolled[0], whole, 1)),
                                                level_impression(rolled(seal, kRolled[1], worn, 2)),
                                                level_impression(rolled(other, kRolled[2], third, 3))};
  const SealAverage average = average_seal(impressions);
  EXPECT_EQ(average.used[1], 1);
  EXPECT_EQ(average.used[2], 0) << average.placing.likeness[2];
}

}  // namespace
}  // namespace dubsar
