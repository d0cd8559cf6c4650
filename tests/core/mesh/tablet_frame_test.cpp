// The way up of a tablet, found from impressions that this file makes by itself: grooves that are steep at one end and
// run out slowly at the other, pressed into the sides of a block and turned as a scribe turns it.

#include "core/mesh/tablet_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

namespace dubsar {
namespace {

struct Side {
  glm::dvec3 front, right, up;
  double half_width, half_height, distance;
  double rise = 0.0;  ///< of its middle over its rim, mm
};

/// A groove: its head at `at`, running `along` for 2.4 mm; deepest .3 mm after the head.
struct Groove {
  glm::dvec2 at, along;
};

double depth_of(const Groove& g, const glm::dvec2& p) {
  const glm::dvec2 d = p - g.at, across(-g.along.y, g.along.x);
  const double s = glm::dot(d, g.along), w = std::abs(glm::dot(d, across));
  if (s < 0 || s > 2.4) return 0.0;
  const double profile = s < 0.3 ? s / 0.3 : 1.0 - (s - 0.3) / 2.1;
  const double half = 0.25 + 0.45 * profile;
  return w < half ? 0.55 * profile * (1.0 - w / half) : 0.0;
}

void add_side(TriMesh& mesh, const Side& side, const std::vector<Groove>& grooves, double step) {
  const int nx = static_cast<int>(2 * side.half_width / step), ny = static_cast<int>(2 * side.half_height / step);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int y = 0; y <= ny; ++y)
    for (int x = 0; x <= nx; ++x) {
      const glm::dvec2 p(-side.half_width + 2 * side.half_width * x / nx,
                         -side.half_height + 2 * side.half_height * y / ny);
      double depth = 0.0;
      for (const Groove& g : grooves) depth = std::max(depth, depth_of(g, p));
      const double u = p.x / side.half_width, v = p.y / side.half_height;
      const double height = side.distance - depth - side.rise * 0.5 * (u * u + v * v);
      mesh.positions.push_back(glm::vec3(p.x * side.right + p.y * side.up + height * side.front));
    }
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const std::uint32_t a = first + static_cast<std::uint32_t>(y * (nx + 1) + x), b = a + 1,
                          c = a + static_cast<std::uint32_t>(nx) + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
}

/// Lines of horizontal grooves (heads at the left) and vertical ones (heads at the top).
std::vector<Groove> writing(const Side& side, std::mt19937& random, double share_of_verticals) {
  std::vector<Groove> grooves;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (double y = -side.half_height + 1.5; y < side.half_height - 3.0; y += 3.6)
    for (double x = -side.half_width + 1.5; x < side.half_width - 3.5; x += 3.4)
      grooves.push_back(unit(random) < share_of_verticals ? Groove{{x + 0.8, y + 2.6}, {0, -1}}
                                                          : Groove{{x, y + 1.0}, {1, 0}});
  return grooves;
}

struct Shape {
  double obverse_rise = 0.0, reverse_rise = 0.0;  ///< mm
  bool edges = true;                              ///< the right edge is written on
  double blank_below = 0.0;                       ///< mm of the reverse
  double half_height = 19.0;                      ///< mm
};

/// A block of 46 x 38 x 14 mm, written on five sides as its scribe turned it; x right, y up, z out of the obverse.
TriMesh written_block(unsigned seed, double verticals = 0.5, const Shape& shape = {}) {
  std::mt19937 random(seed);
  const double h = shape.half_height;
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const std::array<Side, 6> sides{{{z, x, y, 23, h, 7, shape.obverse_rise},
                                   {-z, x, -y, 23, h, 7, shape.reverse_rise},
                                   {-y, x, z, 23, 7, h},    // lower edge
                                   {y, x, -z, 23, 7, h},    // upper edge
                                   {x, -z, y, 7, h, 23},    // right edge: lines run on
                                   {-x, z, y, 7, h, 23}}};  // left edge: blank
  TriMesh mesh;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    std::vector<Groove> grooves = writing(sides[k], random, verticals);
    if (k == 5 || (k == 4 && !shape.edges)) grooves.clear();
    if (k == 1) std::erase_if(grooves, [&](const Groove& g) { return g.at.y < -h + shape.blank_below; });
    add_side(mesh, sides[k], grooves, 0.15);
  }
  mesh.frame.input_voxel.provenance = "made";
  return mesh;
}

TriMesh rotated(TriMesh mesh, const glm::dmat3& turn) {
  for (glm::vec3& p : mesh.positions) p = glm::vec3(turn * glm::dvec3(p));
  return mesh;
}

glm::dmat3 any_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), std::uniform_real_distribution<double>(0.0, 6.28)(random), axis));
}

TEST(TabletFrame, TheTextStandsUprightHoweverTheTabletLayInTheScanner) {
  std::mt19937 random(20260407);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const glm::dmat3 turn = any_rotation(random);
    const auto found = find_tablet_frame(rotated(written_block(seed), turn));
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_GT(glm::dot(found->right, turn[0]), 0.995) << "seed " << seed;
    EXPECT_GT(glm::dot(found->up, turn[1]), 0.995) << "seed " << seed;
    EXPECT_GT(glm::dot(found->front, turn[2]), 0.995) << "seed " << seed;
    EXPECT_GT(found->up_probability, kSureOfTheWay);
    EXPECT_GT(found->obverse_probability, 0.5);
  }
}

TEST(TabletFrame, FewVerticalsOrFewHorizontalsAreEnough) {
  for (const double verticals : {0.15, 0.85}) {
    const auto found = find_tablet_frame(written_block(11, verticals));
    ASSERT_TRUE(found);
    EXPECT_GT(found->right.x, 0.995) << verticals;
    EXPECT_GT(found->front.z, 0.995) << verticals;
  }
}

// Areas that look left, right, up and down are the same on a square one, so that they do not tell its axes.
TEST(TabletFrame, ASquareTabletLiesAlongItsEdges) {
  std::mt19937 random(4);
  for (unsigned seed = 41; seed < 43; ++seed) {
    Shape square{0.4, 2.0};
    square.half_height = 23.0;
    const glm::dmat3 turn = any_rotation(random);
    const auto found = find_tablet_frame(rotated(written_block(seed, 0.5, square), turn));
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_GT(glm::dot(found->right, turn[0]), 0.99) << seed;
    EXPECT_GT(glm::dot(found->front, turn[2]), 0.99) << seed;
  }
}

TEST(TabletFrame, TheFlatterSideIsTheObverseAndTheOneWithRoomLeftTheReverse) {
  std::mt19937 random(77);
  const std::array<Shape, 4> shapes{
      {{0.4, 2.0, false}, {0.8, 1.4, true}, {0.0, 0.0, false, 14.0}, {1.0, 1.0, false, 12}}};
  for (const Shape& shape : shapes)
    for (unsigned seed = 31; seed < 32; ++seed) {
      const glm::dmat3 turn = any_rotation(random);
      const auto found = find_tablet_frame(rotated(written_block(seed, 0.5, shape), turn));
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_GT(glm::dot(found->right, turn[0]), 0.99) << seed;
      EXPECT_GT(glm::dot(found->front, turn[2]), 0.99) << shape.reverse_rise << " " << shape.blank_below;
      EXPECT_GT(found->obverse_probability, 0.6);
    }
  // The same of both sides and nothing on the edges: in doubt, and it says so.
  EXPECT_LT(find_tablet_frame(written_block(9, 0.5, {1.0, 1.0, false}))->obverse_probability, 0.7);
}

TEST(TabletFrame, ClosedHolesSayNothingOfTheAxes) {
  TriMesh mesh = written_block(7);
  mesh.triangle_inferred.assign(mesh.triangles.size(), 0);
  // A patch before the obverse, folded along a diagonal: as large as the sides together.
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int k = 0; k < 40; ++k)
    for (const double along : {-15.0, 15.0}) {
      const double fold = k % 2 ? 1.5 : 0.0, across = 0.5 * (k - 20);
      const glm::dvec3 p(along + across, across - along, 8.0 + fold);
      mesh.positions.push_back(glm::vec3(p));
    }
  for (std::uint32_t k = 0; k + 1 < 40; ++k) {
    const std::uint32_t a = first + 2 * k;
    mesh.triangles.push_back({a, a + 1, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 2});
  }
  mesh.triangle_inferred.resize(mesh.triangles.size(), 0);
  const auto believed = find_tablet_frame(mesh);
  ASSERT_TRUE(believed);
  ASSERT_LT(std::abs(believed->right.x), 0.9998) << "the patch does not ask the question";
  std::fill(mesh.triangle_inferred.end() - 78, mesh.triangle_inferred.end(), std::uint8_t{1});
  const auto found = find_tablet_frame(mesh);
  ASSERT_TRUE(found);
  EXPECT_GT(found->right.x, 0.9999);
  EXPECT_GT(found->front.z, 0.9999);
}

TEST(TabletFrame, ABlankBlockIsAGuessAndSaysSo) {
  TriMesh blank;
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (const Side& side : {Side{z, x, y, 23, 19, 7}, Side{-z, x, -y, 23, 19, 7}, Side{-y, x, z, 23, 7, 19},
                           Side{y, x, -z, 23, 7, 19}, Side{x, -z, y, 7, 19, 23}, Side{-x, z, y, 7, 19, 23}})
    add_side(blank, side, {}, 0.5);
  const auto found = find_tablet_frame(blank);
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::abs(found->front.z), 1.0, 1e-6);
  EXPECT_NEAR(found->up_probability, 0.25, 0.01);
  EXPECT_NEAR(found->obverse_probability, 0.5, 0.01);
  EXPECT_FALSE(found->sure());
  EXPECT_FALSE(find_tablet_frame(TriMesh{}));
}

TEST(TabletFrame, TheUnitAndTheTrianglesDoNotMatter) {
  const TriMesh block = written_block(21, 0.5, {0.4, 1.6});
  const auto found = find_tablet_frame(block);
  ASSERT_TRUE(found);
  TriMesh metres = block;
  for (glm::vec3& p : metres.positions) p *= 0.001f;
  TriMesh finer = block;  // each triangle as three, of the same surface
  finer.triangles.clear();
  for (const Triangle& t : block.triangles) {
    const auto middle = static_cast<std::uint32_t>(finer.positions.size());
    finer.positions.push_back((block.positions[t[0]] + block.positions[t[1]] + block.positions[t[2]]) / 3.f);
    for (std::size_t k = 0; k < 3; ++k) finer.triangles.push_back({t[k], t[(k + 1) % 3], middle});
  }
  for (const TriMesh& other : {metres, finer}) {
    const auto again = find_tablet_frame(other);
    ASSERT_TRUE(again);
    EXPECT_GT(glm::dot(again->right, found->right), 0.9999);
    EXPECT_GT(glm::dot(again->front, found->front), 0.9999);
    EXPECT_NEAR(again->up_probability, found->up_probability, 0.01);
    EXPECT_NEAR(again->obverse_probability, found->obverse_probability, 0.01);
  }
}

TEST(TabletFrame, AMirrorImageIsNotCalledUpright) {
  for (unsigned seed = 51; seed < 53; ++seed) {
    TriMesh image = written_block(seed, 0.5, {0.4, 1.6});
    for (glm::vec3& p : image.positions) p.x = -p.x;
    for (Triangle& t : image.triangles) std::swap(t[1], t[2]);
    const auto found = find_tablet_frame(image);
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->sure()) << seed;
    EXPECT_GT(found->mirrored_probability, 0.5) << seed;
    EXPECT_NE(found->doubt(), "") << seed;
  }
}

// Of broken files: a vertex that lies a thousand kilometres away, a single triangle.
TEST(TabletFrame, SpikesAndNeedlesAreAGuessLikeAnyOther) {
  TriMesh spike;
  spike.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1e9f, 0, 0.001f}};
  spike.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 4, 3}};
  const auto found = find_tablet_frame(spike);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->sure());
  TriMesh one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  const auto alone = find_tablet_frame(one);
  ASSERT_TRUE(alone);
  EXPECT_NEAR(alone->up_probability, 0.25, 0.01);
  EXPECT_NEAR(std::abs(alone->front.z), 1.0, 1e-9);
}

TEST(TabletFrame, TurnsAreRotationsThatComeBack) {
  const TabletFrame frame;
  for (const FrameTurn turn : {FrameTurn::kHalf, FrameTurn::kLeft, FrameTurn::kRight, FrameTurn::kOver}) {
    const TabletFrame once = turned(frame, turn);
    EXPECT_NEAR(glm::determinant(once.tablet_from_model()), 1.0, 1e-12);
    EXPECT_GT(glm::dot(glm::cross(once.right, once.up), once.front), 0.999);
  }
  const TabletFrame left = turned(frame, FrameTurn::kLeft), back = turned(left, FrameTurn::kRight);
  EXPECT_EQ(back.right, frame.right);
  EXPECT_EQ(left.up, frame.right) << "what points right points up after a quarter turn to the left";
  EXPECT_EQ(turned(turned(frame, FrameTurn::kOver), FrameTurn::kOver).up, frame.up);
}

TEST(TabletFrame, TheMeshInItsOwnAxesIsTheBlockAgain) {
  std::mt19937 random(5);
  const TriMesh block = written_block(3);
  const auto found = find_tablet_frame(rotated(block, any_rotation(random)));
  ASSERT_TRUE(found);
  const TriMesh turned_again = in_tablet_frame(rotated(block, glm::dmat3(1.0)), TabletFrame{});
  EXPECT_EQ(turned_again.positions, block.positions);
}

}  // namespace
}  // namespace dubsar
