#include "core/phantom/phantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/system/parallel.h"
#include "core/phantom/random.h"
#include "core/phantom/write_phantom.h"

namespace dubsar::phantom {
namespace {

std::shared_ptr<const Phantom> make(Dims dims, std::uint64_t seed) {
  PhantomOptions options;
  options.dims = dims;
  options.seed = seed;
  return Phantom::create(options).value();
}

struct Near {
  glm::dvec3 point;
  double distance;
};

/// Points at random places within `reach` voxels of the clay's surface.
std::vector<Near> points_near_surface(const Phantom& phantom, int count, double reach, std::uint64_t seed) {
  Random random(seed, 99);
  const Dims d = phantom.options().dims;
  std::vector<Near> points;
  while (static_cast<int>(points.size()) < count) {
    const glm::dvec3 p{random.uniform(0, static_cast<double>(d.x)), random.uniform(0, static_cast<double>(d.y)),
                       random.uniform(0, static_cast<double>(d.z))};
    const double distance = phantom.signed_distance(p);
    if (std::abs(distance) < reach) points.push_back({p, distance});
  }
  return points;
}

TEST(PhantomModel, DistanceIsThatOfTheNearestChangeBetweenClayAndAir) {
  const auto phantom = make({320, 170, 295}, 3);
  const auto points = points_near_surface(*phantom, 400, 2.0, 1);
  // Oracle: the sign on spheres around the point. Within distance - e all is on the point's side; the sphere of radius
  // distance + e reaches the other side.
  constexpr int kDirections = 1500;
  int too_long = 0, too_short = 0;
  for (const Near& near : points) {
    const auto reaches_other_side = [&](double radius) {
      if (radius <= 0.0) return false;
      for (int i = 0; i < kDirections; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / kDirections, r = std::sqrt(1.0 - z * z), a = i * 2.39996323;
        const glm::dvec3 q = near.point + radius * glm::dvec3(r * std::cos(a), r * std::sin(a), z);
        const Fields f = phantom->fields(static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z));
        if ((f.clay.v < 0.0f) != (near.distance < 0.0)) return true;
      }
      return false;
    };
    too_long += reaches_other_side(std::abs(near.distance) - 0.05);
    too_short += !reaches_other_side(std::abs(near.distance) + 0.05);
  }
  // At edges sharper than a voxel the foot point can be the second nearest.
  EXPECT_LE(too_long, 0.03 * static_cast<double>(points.size()));
  EXPECT_LE(too_short, 0.02 * static_cast<double>(points.size()));
}

TEST(PhantomModel, GradientOfTheDistanceHasLengthOne) {
  const auto phantom = make({320, 170, 295}, 2);
  std::vector<double> error;
  for (const Near& near : points_near_surface(*phantom, 4000, 1.9, 7)) {
    const double e = 0.05;
    glm::dvec3 gradient;
    for (int a = 0; a < 3; ++a) {
      glm::dvec3 step(0.0);
      step[a] = e;
      gradient[a] =
          (phantom->signed_distance(near.point + step) - phantom->signed_distance(near.point - step)) / (2.0 * e);
    }
    error.push_back(std::abs(glm::length(gradient) - 1.0));
  }
  std::sort(error.begin(), error.end());
  EXPECT_LT(error[error.size() / 2], 0.005);
  EXPECT_LT(error[error.size() * 9 / 10], 0.05);
}

TEST(PhantomModel, BricksGiveWhatEachVoxelGives) {
  for (const std::uint64_t seed : {2u}) {
    const auto phantom = make({72, 48, 72}, seed);
    const Dims d = phantom->options().dims;
    std::vector<std::uint8_t> label(static_cast<std::size_t>(d.count()));
    std::vector<std::int16_t> distance(label.size());
    rasterise_truth(*phantom, 0, d.z, label, distance);
    std::int64_t wrong_label = 0, wrong_distance = 0, i = 0;
    for (std::int64_t z = 0; z < d.z; ++z)
      for (std::int64_t y = 0; y < d.y; ++y)
        for (std::int64_t x = 0; x < d.x; ++x, ++i) {
          const glm::dvec3 p{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          wrong_label += label[static_cast<std::size_t>(i)] != static_cast<std::uint8_t>(phantom->label(p));
          wrong_distance +=
              distance[static_cast<std::size_t>(i)] != std::lround(kDistanceSteps * phantom->signed_distance(p));
        }
    EXPECT_EQ(wrong_label, 0);
    EXPECT_EQ(wrong_distance, 0);
  }
}

TEST(PhantomModel, LabelAgreesWithTheSignOfTheDistance) {
  const auto phantom = make({512, 272, 472}, 3);
  const Dims d = phantom->options().dims;
  constexpr std::int64_t kFirst = 150, kLast = 162;
  std::vector<std::uint8_t> label(static_cast<std::size_t>(d.slice() * (kLast - kFirst)));
  std::vector<std::int16_t> distance(label.size());
  rasterise_truth(*phantom, kFirst, kLast, label, distance);
  std::array<std::int64_t, 7> count{};
  std::int64_t disagree = 0;
  for (std::size_t i = 0; i < label.size(); ++i) {
    ++count[label[i]];
    const auto name = static_cast<Label>(label[i]);
    const bool clay = name == Label::kTablet || name == Label::kEnvelope || name == Label::kGlue;
    // Rounding of the impressions' inner edges and of joints is no part of the labels' rule.
    if (distance[i] != 0 && std::abs(distance[i]) > 0.3 * kDistanceSteps) disagree += clay != (distance[i] < 0);
  }
  EXPECT_EQ(disagree, 0);
  for (const std::int64_t voxels : count) EXPECT_GT(voxels, 0);  // every label occurs
}

TEST(PhantomModel, WedgeTableHoldsTheDepthOfTheClay) {
  const auto phantom = make({512, 272, 472}, 5);
  std::set<Side> sides;
  int wedges = 0, open = 0;
  for (const Wedge& w : phantom->wedges()) {
    EXPECT_NEAR(glm::length(w.outward), 1.0, 1e-4);
    EXPECT_NEAR(glm::dot(w.outward, w.tail), 0.0, 1e-4);
    if (w.owner != Owner::kTablet) continue;
    ++wedges;
    open += w.open;
    sides.insert(w.side);
    // The deepest point is on the surface of the unwrapped tablet, and there is air above it.
    EXPECT_NEAR(phantom->tablet_distance(w.position - w.depth * w.outward), 0.0, 0.05);
    EXPECT_GT(phantom->tablet_distance(w.position - 0.6 * w.depth * w.outward), 0.0);
    EXPECT_GT(w.depth, 4.0);
  }
  EXPECT_EQ(sides.size(), 6u);
  EXPECT_GT(wedges, 300);
  EXPECT_GT(open, wedges / 2);
}

TEST(PhantomModel, TheDepthOfAWedgeIsThatOfItsDeepestPlace) {
  for (const double depth : {3.0, 7.0, 14.0}) {
    PhantomOptions options;
    options.dims = {256, 144, 240};
    options.seed = 3;
    options.wedge_depth_vox = depth;
    const auto phantom = Phantom::create(options);
    ASSERT_TRUE(phantom) << phantom.error().message;
    std::vector<double> deeper;
    for (const Wedge& w : (*phantom)->wedges()) {
      if (w.owner != Owner::kEnvelope) continue;
      // Below the places around it, along the same direction: how deep the clay lies there at most.
      double most = 0.0;
      const double reach = 0.3 * w.head_half_width;
      for (int i = -6; i <= 6; ++i) {
        const glm::dvec3 above = w.position + reach / 6.0 * i * w.tail;
        double air = 0.0, clay = 1.5 * w.depth;
        for (int k = 0; k < 30; ++k) {
          const double middle = 0.5 * (air + clay);
          const glm::dvec3 p = above - middle * w.outward;
          const Fields f =
              (*phantom)->fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
          (f.outer.v > 0.0f ? air : clay) = middle;
        }
        most = std::max(most, air);
      }
      deeper.push_back(most / w.depth);
    }
    ASSERT_GT(deeper.size(), 8u);
    std::nth_element(deeper.begin(), deeper.begin() + deeper.size() / 2, deeper.end());
    EXPECT_LT(deeper[deeper.size() / 2], 1.005) << depth << " voxels";
  }
}

TEST(PhantomModel, SignsHaveOneToNineWedges) {
  std::map<int, int> per_sign;
  const auto phantom = make({512, 272, 472}, 1);
  for (const Wedge& w : phantom->wedges()) ++per_sign[w.sign];
  int single = 0;
  for (const auto& [sign, wedges] : per_sign) {
    EXPECT_LE(wedges, 9);
    single += wedges == 1;
  }
  EXPECT_LT(single, static_cast<int>(per_sign.size()) / 4);  // numerals and dividers
}

// Oracle: the voxel faces between the two sides of the tablet's surface, glued where both voxels are clay.
TEST(PhantomModel, GluedFractionIsBetween5And30PercentForFiveSeeds) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const auto phantom = make({140, 75, 130}, seed);
    EXPECT_GE(phantom->glued_fraction(), 0.05);
    EXPECT_LE(phantom->glued_fraction(), 0.30);
    const Dims d = phantom->options().dims;
    struct Count {
      std::int64_t glued = 0, all = 0;
    };
    const Count count = parallel_reduce(
        d.z - 1, 8, Count{},
        [&](std::int64_t z0, std::int64_t z1) {
          Count c;
          for (std::int64_t z = z0; z < z1; ++z)
            for (std::int64_t y = 0; y < d.y; y += 2)
              for (std::int64_t x = 0; x < d.x; x += 2) {
                const glm::dvec3 p{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
                const glm::dvec3 q = p + glm::dvec3(0, 0, 1), r = p + glm::dvec3(0, 1, 0);
                const bool inside = phantom->on_tablet_side(p);
                for (const glm::dvec3& other : {q, r}) {
                  if (inside == phantom->on_tablet_side(other)) continue;
                  ++c.all;
                  c.glued += phantom->gap_width(0.5 * (p + other)) <= 0.0;
                }
              }
          return c;
        },
        [](Count a, Count b) {
          return Count{a.glued + b.glued, a.all + b.all};
        });
    EXPECT_NEAR(static_cast<double>(count.glued) / static_cast<double>(count.all), phantom->glued_fraction(), 0.04);
  }
}

TEST(PhantomModel, SeedsDifferAndRepeat) {
  const auto a = make({96, 64, 96}, 1), b = make({96, 64, 96}, 1), c = make({96, 64, 96}, 2);
  ASSERT_EQ(a->wedges().size(), b->wedges().size());
  for (std::size_t i = 0; i < a->wedges().size(); ++i) EXPECT_EQ(a->wedges()[i].position, b->wedges()[i].position);
  EXPECT_NE(a->wedges().front().position, c->wedges().front().position);
}

TEST(PhantomOptions, WrongOnesAreRefusedInOneSentence) {
  EXPECT_EQ(parse_preset("huge").error().kind, ErrorKind::kUsage);
  PhantomOptions options;
  options.dims = {16, 64, 64};
  EXPECT_EQ(Phantom::create(options).error().kind, ErrorKind::kUsage);
  options = {};
  options.snr_db = -3.0;
  EXPECT_EQ(Phantom::create(options).error().kind, ErrorKind::kUsage);
  options = {};
  options.voxel_mm = -1.0;
  EXPECT_EQ(Phantom::create(options).error().kind, ErrorKind::kUsage);
  EXPECT_NEAR(parse_preset("paper").value().voxel_mm, 0.038, 1e-9);
}

}  // namespace
}  // namespace dubsar::phantom
