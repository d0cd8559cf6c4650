#include "core/contact/cut/band_bricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <vector>

namespace dubsar {
namespace {

/// Points drawn in a box, in the order of a band, with sides and samples drawn, too.
struct Scene {
  ContactBand band;
  std::vector<ClaySide> side;
  std::vector<bool> seed;

  explicit Scene(unsigned number) : band{{}, {}, BrickMap<std::uint32_t>(kDims, ContactBand::kNone), 4.0f, 4.0f} {
    std::mt19937 random(number);
    const auto one_in = [&](unsigned n) { return random() % n == 0; };
    for (int i = 0; i < 5; ++i)
      band.samples.push_back({glm::vec3(random() % 41, random() % 22, random() % 19), glm::vec3(0.0f, 0.0f, 1.0f)});
    for (std::int32_t bz = 0; bz < 3; ++bz)
      for (std::int32_t by = 0; by < 3; ++by)
        for (std::int32_t bx = 0; bx < 6; ++bx)
          for (std::int32_t k = 0; k < 512; ++k) {
            const glm::ivec3 p(8 * bx + k % 8, 8 * by + k / 8 % 8, 8 * bz + k / 64);
            if (p.x >= kDims.x || p.y >= kDims.y || p.z >= kDims.z || one_in(4) || (bx == 2 && by == 1)) continue;
            band.node_at.at(p.x, p.y, p.z) = static_cast<std::uint32_t>(band.nodes.size());
            band.nodes.push_back({p.x, p.y, p.z, static_cast<std::uint32_t>(random() % 5), 0.0f, 0.0f});
            side.push_back(one_in(2) ? ClaySide::kTablet : ClaySide::kEnvelope);
            seed.push_back(one_in(40));
          }
  }
  std::uint32_t at(const glm::ivec3& p) const { return band.at(p); }
  static constexpr Dims kDims{41, 22, 19};
};

class BandBricksOf : public testing::TestWithParam<unsigned> {};

TEST_P(BandBricksOf, HaveAllNodesOnce) {
  const Scene scene(GetParam());
  const BandBricks bricks(scene.band);
  std::vector<int> times(scene.band.nodes.size(), 0);
  for (std::uint32_t b = 1; b < bricks.lattice().count(); ++b) {
    const BandBricks::Nodes nodes = bricks.nodes(b);
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
      const std::uint32_t n = nodes[k], point = LatticeBricks::kPoints * b + k;
      ASSERT_EQ(n, scene.at(bricks.lattice().position(point)));
      ASSERT_EQ(has_bit(bricks.in_band(), point), n != ContactBand::kNone);
      if (n == ContactBand::kNone) continue;
      ASSERT_EQ(bricks.point(n), point);
      ++times[n];
    }
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
  EXPECT_EQ(bricks.starts().front(), 1u);
  EXPECT_EQ(bricks.starts().back(), bricks.lattice().count());
  EXPECT_TRUE(std::is_sorted(bricks.starts().begin(), bricks.starts().end(), std::less_equal<>()));
}

TEST_P(BandBricksOf, KnowWhoIsBesideWhom) {
  const Scene scene(GetParam());
  const BandBricks bricks(scene.band);
  const LatticeBricks& lattice = bricks.lattice();
  const BrickBits tablet = bricks.tablet(scene.side);
  const auto is_tablet = [&](const glm::ivec3& p) {
    const std::uint32_t n = scene.at(p);
    return n != ContactBand::kNone && scene.side[n] == ClaySide::kTablet;
  };
  for (std::uint32_t b = 1; b < lattice.count(); ++b)
    for (std::uint32_t way = 0; way < LatticeBricks::kWays; ++way) {
      const glm::ivec3 step = (way % 2 == 0 ? 1 : -1) * unit_step(static_cast<int>(way / 2));
      const std::uint64_t bits = lattice.bits_beside(tablet, b, way);
      for (std::uint32_t k = 0; k < LatticeBricks::kPoints; ++k) {
        const std::uint32_t point = LatticeBricks::kPoints * b + k, beside = lattice.beside(point, way);
        const glm::ivec3 q = lattice.position(point) + step;
        ASSERT_EQ((bits >> k & 1) != 0, is_tablet(q));
        ASSERT_EQ(beside, lattice.at(q));
        if (beside < LatticeBricks::kPoints)
          ASSERT_EQ(scene.at(q), ContactBand::kNone);
        else
          ASSERT_EQ(lattice.position(beside), q);
      }
    }
}

TEST_P(BandBricksOf, ReachWhatHangsTogether) {
  const Scene scene(GetParam());
  const BandBricks bricks(scene.band);
  BrickBits seeds(bricks.lattice().count(), 0);
  std::vector<std::uint32_t> queue, found;
  std::vector<bool> expected(scene.side.size(), false);
  for (std::uint32_t n = 0; n < scene.seed.size(); ++n) {
    if (!scene.seed[n]) continue;
    set_bit(seeds, bricks.point(n), true);
    if (scene.side[n] != ClaySide::kTablet) continue;
    queue.push_back(n);
    expected[n] = true;
  }
  for (; !queue.empty();) {
    const glm::ivec3 p = scene.band.point(queue.back());
    queue.pop_back();
    each_beside(p, [&](const glm::ivec3& q) {
      const std::uint32_t m = scene.at(q);
      if (m == ContactBand::kNone || expected[m] || scene.side[m] != ClaySide::kTablet) return;
      expected[m] = true;
      queue.push_back(m);
    });
  }
  for (std::uint32_t n = 0; n < expected.size(); ++n)
    if (expected[n]) found.push_back(n);
  EXPECT_EQ(bricks.nodes_of(bricks.reached(bricks.tablet(scene.side), seeds)), found);
}

TEST_P(BandBricksOf, FindFacesOfTabletAndEnvelopeInTurn) {
  const Scene scene(GetParam());
  const BandBricks bricks(scene.band);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t n = 0; n < scene.side.size(); ++n) {
    const glm::ivec3 p = scene.band.point(n);
    const auto pinched = [&](int a) {
      const glm::ivec3 u = unit_step(a), v = unit_step((a + 1) % 3);
      const std::array<std::uint32_t, 4> turn{n, scene.at(p + u), scene.at(p + u + v), scene.at(p + v)};
      for (std::size_t i = 0; i < 4; ++i)
        if (turn[i] == ContactBand::kNone || turn[(i + 1) % 4] == ContactBand::kNone ||
            scene.side[turn[i]] == scene.side[turn[(i + 1) % 4]])
          return false;
      return true;
    };
    if (pinched(0) || pinched(1) || pinched(2)) expected.push_back(n);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(bricks.nodes_of(bricks.pinched(bricks.tablet(scene.side))), expected);
}

INSTANTIATE_TEST_SUITE_P(Drawn, BandBricksOf, testing::Range(1u, 9u));

TEST(BandBricks, OfNothingAreNone) {
  const ContactBand band{{}, {}, BrickMap<std::uint32_t>({9, 9, 9}, ContactBand::kNone), 1.0f, 1.0f};
  const BandBricks bricks(band);
  EXPECT_EQ(bricks.lattice().count(), 1u);
  EXPECT_TRUE(bricks.nodes_of(bricks.pinched(bricks.tablet({}))).empty());
}

}  // namespace
}  // namespace dubsar
