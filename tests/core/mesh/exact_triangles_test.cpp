#include "core/mesh/exact_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>

#include "core/mesh/exact_crossings.h"

namespace dubsar {
namespace {

/// A fraction of small integers, in lowest terms.
struct Fraction {
  std::int64_t n = 0, d = 1;
  Fraction(std::int64_t num = 0, std::int64_t den = 1) {  // NOLINT(google-explicit-constructor)
    const std::int64_t common = std::gcd(num, den) * (den < 0 ? -1 : 1);
    n = num / common;
    d = den / common;
  }
  friend Fraction operator+(Fraction a, Fraction b) { return {a.n * b.d + b.n * a.d, a.d * b.d}; }
  friend Fraction operator-(Fraction a, Fraction b) { return {a.n * b.d - b.n * a.d, a.d * b.d}; }
  friend Fraction operator*(Fraction a, Fraction b) { return {a.n * b.n, a.d * b.d}; }
  friend Fraction operator/(Fraction a, Fraction b) { return {a.n * b.d, a.d * b.n}; }
};

/// The one solution of the columns' system, if there is one.
std::optional<std::vector<Fraction>> solve(std::vector<std::vector<Fraction>> rows, std::size_t columns) {
  std::size_t rank = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    std::size_t pivot = rank;
    while (pivot < rows.size() && rows[pivot][c].n == 0) ++pivot;
    if (pivot == rows.size()) return std::nullopt;
    std::swap(rows[pivot], rows[rank]);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (r == rank) continue;
      const Fraction f = rows[r][c] / rows[rank][c];
      for (std::size_t k = c; k <= columns; ++k) rows[r][k] = rows[r][k] - f * rows[rank][k];
    }
    ++rank;
  }
  for (std::size_t r = rank; r < rows.size(); ++r)
    if (rows[r][columns].n != 0) return std::nullopt;
  std::vector<Fraction> x;
  for (std::size_t c = 0; c < columns; ++c) x.push_back(rows[c][columns] / rows[c][c]);
  return x;
}

/// A linear programme solved at all its corners: weights of the corners of a and of b, none negative, that give the
/// same point. True where there is one, or, where corners are shared, one to which others of a contribute.
bool touch_by_weights(std::span<const ExactPlace> places, const Triangle& a, const Triangle& b) {
  std::vector<std::vector<Fraction>> rows(5, std::vector<Fraction>(7));
  for (std::size_t i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rows[static_cast<std::size_t>(axis)][i] = places[a[i]][axis];
      rows[static_cast<std::size_t>(axis)][i + 3] = -places[b[i]][axis];
    }
    rows[3][i] = rows[4][i + 3] = 1;
  }
  rows[3][6] = rows[4][6] = 1;
  for (unsigned chosen = 1; chosen < 64; ++chosen) {
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < 6; ++i)
      if (chosen >> i & 1u) columns.push_back(i);
    std::vector<std::vector<Fraction>> system;
    for (const auto& row : rows) {
      system.emplace_back();
      for (const std::size_t c : columns) system.back().push_back(row[c]);
      system.back().push_back(row[6]);
    }
    const auto weights = solve(system, columns.size());
    if (!weights || std::ranges::any_of(*weights, [](const Fraction& f) { return f.n < 0; })) continue;
    bool beside = false, any_shared = false;
    for (const std::uint32_t v : a) any_shared = any_shared || std::ranges::count(b, v) != 0;
    for (std::size_t i = 0; i < columns.size(); ++i)
      beside = beside || (columns[i] < 3 && (*weights)[i].n > 0 && std::ranges::count(b, a[columns[i]]) == 0);
    if (!any_shared || beside) return true;
  }
  return false;
}

struct Draw {
  std::mt19937 bits;
  explicit Draw(unsigned seed) : bits(seed) {}
  ExactPlace place(int range) {
    const auto one = [&] { return static_cast<std::int64_t>(bits() % static_cast<unsigned>(range)); };
    const std::int64_t x = one(), y = one();
    return {x, y, one()};
  }
};

TEST(ExactTriangles, TouchExactlyWhereWeightsOfTheirCornersGiveOnePoint) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Draw draw(seed);
    std::array<std::array<int, 2>, 3> found{};
    for (int trial = 0; trial < 6000; ++trial) {
      // Few places: corners on sides, sides on sides and planes in planes are the rule.
      const int range = 2 + trial % 5;
      const auto shared = static_cast<std::size_t>(trial / 7 % 3);
      std::vector<ExactPlace> places;
      for (std::size_t i = 0; i < 6 - shared; ++i) places.push_back(draw.place(range));
      Triangle a{0, 1, 2}, b{3, 4, 5};
      for (std::size_t i = 0; i < 3; ++i) b[i] = static_cast<std::uint32_t>(i < shared ? i : i + 3 - shared);
      std::shuffle(a.begin(), a.end(), draw.bits);
      std::shuffle(b.begin(), b.end(), draw.bits);
      const auto flat = [&](const Triangle& t) { return has_zero_area(places[t[0]], places[t[1]], places[t[2]]); };
      if (shared > 0 && (flat(a) || flat(b))) continue;
      const bool touch = touch_by_weights(places, a, b);
      ASSERT_EQ(triangles_touch(places, a, b), touch) << "seed " << seed << " trial " << trial;
      ASSERT_EQ(triangles_touch(places, b, a), touch) << "seed " << seed << " trial " << trial;
      ++found[shared][touch];
    }
    for (std::size_t shared = 0; shared < 3; ++shared)
      EXPECT_GT(std::min(found[shared][0], found[shared][1]), 100) << shared << " corners shared";
  }
}

TEST(ExactTriangles, TheAnswerDoesNotDependOnWhereAndHowLargeTheyAre) {
  Draw draw(7);
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<ExactPlace> places, moved;
    for (int i = 0; i < 6; ++i) places.push_back(draw.place(4));
    // Up to 2^30 apart: sums of products need 128 bits.
    for (const ExactPlace& p : places) moved.push_back(p * (std::int64_t{1} << 28) + ExactPlace(-5, 1 << 20, 77));
    EXPECT_EQ(triangles_touch(moved, {0, 1, 2}, {3, 4, 5}), triangles_touch(places, {0, 1, 2}, {3, 4, 5}));
    EXPECT_EQ(orientation(moved[0], moved[1], moved[2], moved[3]),
              orientation(places[0], places[1], places[2], places[3]));
  }
}

TEST(ExactTriangles, TrianglesThatShareASideTouchOnlyWhereTheyFoldOntoEachOther) {
  const std::vector<ExactPlace> places{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {2, -1, 0}, {2, 5, 0}, {2, 5, 1}, {9, 0, 0}};
  EXPECT_FALSE(triangles_touch(places, {0, 1, 2}, {1, 0, 3}));
  EXPECT_TRUE(triangles_touch(places, {0, 1, 2}, {1, 0, 4}));
  EXPECT_FALSE(triangles_touch(places, {0, 1, 2}, {1, 0, 5}));
  EXPECT_FALSE(triangles_touch(places, {0, 1, 2}, {1, 0, 6})) << "a flat one along the line of the side";
  EXPECT_TRUE(triangles_touch(places, {0, 1, 2}, {2, 1, 0})) << "the same triangle";
}

TEST(ExactTriangles, PlacesAreTheNearestOfTheLattice) {
  EXPECT_EQ(exact_place({0.5f, -0.25f, 8191.0f}), ExactPlace(512, -256, 8191 * 1024));
  EXPECT_EQ(exact_place({0.6f / 1024.0f, -0.6f / 1024.0f, 0.4f / 1024.0f}), ExactPlace(1, -1, 0));
}

TEST(ExactCrossings, AMeshIsCountedAsPairByPair) {
  Draw draw(11);
  std::vector<glm::vec3> positions;
  std::vector<Triangle> triangles;
  for (int i = 0; i < 200; ++i) positions.push_back(glm::vec3(draw.place(6000)) / 1000.0f);
  positions.push_back(positions[0]);
  for (int i = 0; i < 300; ++i) {
    const auto first = static_cast<std::uint32_t>(draw.bits() % 198);
    triangles.push_back({first, first + 1, first + 2});
  }
  triangles.push_back({0, 1, 200});  // flat
  const std::vector<ExactPlace> places = exact_places(positions);
  TrianglePairs expected;
  for (std::uint32_t a = 0; a < triangles.size(); ++a)
    for (std::uint32_t b = a + 1; b < triangles.size(); ++b)
      if (triangles_touch(places, triangles[a], triangles[b])) expected.push_back({a, b});
  EXPECT_EQ(touching_pairs(places, triangles), expected);
  const ExactCheck check = check_exactly(positions, triangles);
  EXPECT_EQ(check.crossing_pairs, static_cast<std::int64_t>(expected.size()));
  EXPECT_EQ(check.zero_area_triangles, 1);
  std::vector<std::uint8_t> wanted(triangles.size(), 0);
  wanted[7] = 1;
  std::erase_if(expected, [](const auto& pair) { return pair[0] != 7 && pair[1] != 7; });
  EXPECT_EQ(touching_pairs(places, triangles, wanted), expected);
}

}  // namespace
}  // namespace dubsar
