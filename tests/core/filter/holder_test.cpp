// What an object stands in is found, whatever its shape and side, and no part of an object is taken for it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/base/system/parallel.h"
#include "core/filter/holder_removal.h"
#include "core/filter/holder_search.h"
#include "core/filter/resample.h"
#include "tests/core/filter/filter_oracle.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

constexpr Dims kSize{112, 96, 128};
constexpr double kSoft = 0.8;  ///< blur of edges, voxels
const glm::dvec3 kMiddle(55.5, 47.5, 63.5);
using Distance = std::function<double(const glm::dvec3&)>;  ///< from the middle of the grid; negative inside

double within(double distance) { return 0.5 * std::erfc(distance / (kSoft * std::sqrt(2.0))); }

/// A tablet (an ellipsoid) in an envelope of its own density, a gap of 4 voxels between them.
struct Object {
  double envelope = 1.0, tablet = 1.0, cupping = 0.0;
  bool enveloped = true;
};
double depth_of(const glm::dvec3& p) {  // of the envelope's outside, about
  return (glm::length(p / glm::dvec3(44.0, 30.0, 46.0)) - 1.0) * 30.0;
}
double grey_of(const Object& object, const glm::dvec3& p) {
  const double out = depth_of(p);
  const double inner = within(out + 13.0);
  double v = object.tablet * inner;
  if (object.enveloped) v += object.envelope * (within(out) - within(out + 9.0));
  return v * (1.0 - object.cupping * (1.0 - std::hypot(p.x, p.y) / 74.0));
}

struct Scene {
  Object object;
  Distance holder;
  double level = 0.0, noise = 0.1;
};
Volume<float> scan_of(const Scene& scene, std::uint64_t seed) {
  oracle::Noise gauss(seed);
  return oracle::make_volume(kSize, [&](auto x, auto y, auto z) {
    const glm::dvec3 p = glm::dvec3(x, y, z) - kMiddle;
    const double outside = 1.0 - within(scene.object.enveloped ? depth_of(p) : depth_of(p) + 13.0);
    const double held = scene.holder ? scene.level * std::min(within(scene.holder(p)), outside) : 0.0;
    return grey_of(scene.object, p) + held + scene.noise * gauss();
  });
}

std::optional<FoundHolder> look(const Volume<float>& volume, std::optional<float> left_out = {}) {
  VolumeSource source(volume);
  HalfResolutionSource half(source);
  SilentProgress progress;
  return find_holder(half, {.voxels_a_step = 2.0, .left_out = left_out}, progress).value();
}

const Distance kBlock = [](const glm::dvec3& p) { return p.z + 30.0; };
const Distance kPlate = [](const glm::dvec3& p) { return std::abs(p.x - 0.2 * p.z - 40.0) - 8.0; };
const Distance kBowl = [](const glm::dvec3& p) {  // tilted
  const glm::dvec3 q(0.95 * p.x + 0.3 * p.z, p.y, 0.95 * p.z - 0.3 * p.x);
  return std::max(glm::length(q) - 60.0, q.z + 18.0);
};
/// At the high end of y.
const Distance kSlab = [](const glm::dvec3& p) { return 34.0 - p.y + 0.1 * p.x; };

double true_share(const Scene& scene) {
  double count = 0.0;
  for (std::int64_t z = 0; z < kSize.z; ++z)
    for (std::int64_t y = 0; y < kSize.y; ++y)
      for (std::int64_t x = 0; x < kSize.x; ++x) {
        const glm::dvec3 p = glm::dvec3(x, y, z) - kMiddle;
        count += scene.holder(p) < 0.0 && depth_of(p) > 0.0 ? 1.0 : 0.0;
      }
  return count / double(kSize.count());
}

TEST(Holder, OfAnyShapeAndLevelIsFoundAndSaid) {
  struct Case {
    Distance shape;
    double level;
    int axis;
    bool high, air;
  };
  std::uint64_t seed = 1;
  for (const Case& c : {Case{kBlock, 0.15, 2, false, true},
                        {kBlock, 0.6, 2, false, true},
                        {kPlate, 0.3, 0, true, true},
                        {kPlate, 0.55, 0, true, true},
                        {kBowl, 0.4, 2, false, true},
                        {kSlab, 0.12, 1, true, true}}) {
    const Scene scene{{}, c.shape, c.level};
    const auto found = look(scan_of(scene, ++seed));
    ASSERT_TRUE(found) << seed;
    EXPECT_NEAR(found->holder.of_clay(), c.level, 0.04) << seed;
    EXPECT_EQ(found->holder.axis, c.axis) << seed;
    EXPECT_EQ(found->holder.at_high_end, c.high) << seed;
    EXPECT_EQ(found->holder.counts_as_air(), c.air) << seed;
    EXPECT_NEAR(found->holder.share, true_share(scene), 0.35 * true_share(scene)) << seed;
  }
  const auto block = look(scan_of({{}, kBlock, 0.3}, 9));
  ASSERT_TRUE(block);
  EXPECT_NEAR(block->holder.reach_vox, 34.0, 5.0);
  const std::string text = describe(block->holder, {{0.5, 0.5, 0.5}, "test"});
  EXPECT_NE(text.find("of the clay's grey at the low end of z, as far as 1"), std::string::npos) << text;
  EXPECT_NE(text.find("counts as air"), std::string::npos) << text;
}

TEST(Holder, IsTheSameMirroredWithAxesExchangedAndInOtherGreys) {
  const Volume<float> scan = scan_of({{}, kBowl, 0.5}, 4);
  const auto plain = look(scan);
  ASSERT_TRUE(plain);
  const auto same = [&](const Volume<float>& other, int axis, bool high) {
    const auto found = look(other);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->holder.of_clay(), plain->holder.of_clay(), 0.005);
    EXPECT_NEAR(found->holder.share, plain->holder.share, 0.05 * plain->holder.share);
    EXPECT_EQ(found->holder.axis, axis);
    EXPECT_EQ(found->holder.at_high_end, high);
    EXPECT_EQ(found->holder.fate, plain->holder.fate);
  };
  Volume<float> mirrored(kSize), exchanged({kSize.z, kSize.x, kSize.y}), grey(kSize);
  for (std::int64_t z = 0; z < kSize.z; ++z)
    for (std::int64_t y = 0; y < kSize.y; ++y)
      for (std::int64_t x = 0; x < kSize.x; ++x) {
        mirrored.at(kSize.x - 1 - x, y, kSize.z - 1 - z) = scan.at(x, y, z);
        exchanged.at(z, x, y) = scan.at(x, y, z);
        grey.at(x, y, z) = 3.0f * scan.at(x, y, z) - 1000.0f;
      }
  same(mirrored, 2, true);
  same(exchanged, 0, false);
  same(grey, 2, false);
}

TEST(Holder, NoPartOfAnObjectIsTakenForOne) {
  std::uint64_t seed = 20;
  for (const Object& object : {Object{}, Object{.envelope = 0.7}, Object{.envelope = 0.55}, Object{.tablet = 0.7},
                               Object{.envelope = 1.3}, Object{.cupping = 0.4}, Object{.enveloped = false}})
    for (const double noise : {0.0, 0.2})
      EXPECT_FALSE(look(scan_of({object, {}, 0.0, noise}, ++seed)).has_value()) << seed;
}

TEST(Holder, AHeavierOneAndOneThatIsNearClayStay) {
  const auto heavy = look(scan_of({{.enveloped = false}, kBlock, 1.6}, 31));
  ASSERT_TRUE(heavy);
  EXPECT_NEAR(heavy->holder.of_clay(), 1.6, 0.08);
  EXPECT_FALSE(heavy->holder.counts_as_air());
  const auto near = look(scan_of({{}, kBlock, 0.8, 0.4}, 32));
  EXPECT_TRUE(!near || !near->holder.counts_as_air());
}

TEST(Holder, AtTheBorderOfTheFieldOfViewReachesTheBorder) {
  const float pad = 0.0f;
  Volume<float> scan = scan_of({{}, [](const glm::dvec3& p) { return std::max(p.z + 30.0, -55.0 - p.z); }, 0.6}, 41);
  const auto inside = [](auto x, auto y, auto z) {
    return std::hypot(double(x) - kMiddle.x, double(y) - kMiddle.y) < 46.0 && z > 9 && z < 118;
  };
  for (std::int64_t z = 0; z < kSize.z; ++z)
    for (std::int64_t y = 0; y < kSize.y; ++y)
      for (std::int64_t x = 0; x < kSize.x; ++x)
        if (!inside(x, y, z)) scan.at(x, y, z) = pad;
  const auto found = look(scan, pad);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->holder.at_border);
  EXPECT_EQ(found->holder.fate, HolderFate::kTakenOff);
}

/// Mean and deviation of where the surface crosses lines against z below the object, less where it truly is.
struct Off {
  double mean = 0.0, deviation = 0.0;
  int missed = 0;
};
Off below(const Volume<float>& volume, float threshold) {
  Off off;
  double count = 0.0, squares = 0.0;
  for (std::int64_t y = 38; y < 58; ++y)
    for (std::int64_t x = 40; x < 72; ++x) {
      double truth = 0.0;
      for (double z = -60.0; z < 0.0 && truth == 0.0; z += 0.01)
        if (depth_of({double(x) - kMiddle.x, double(y) - kMiddle.y, z}) < 0.0) truth = z + kMiddle.z;
      double best = 9.0;
      for (std::int64_t z = 2; z + 1 < kSize.z; ++z) {
        const double a = double(volume.at(x, y, z)), b = double(volume.at(x, y, z + 1));
        if (a >= double(threshold) || b < double(threshold)) continue;
        const double at = double(z) + (double(threshold) - a) / (b - a) - truth;
        if (std::abs(at) < std::abs(best)) best = at;
      }
      if (std::abs(best) > 3.0) {
        ++off.missed;
        continue;
      }
      count += 1.0;
      off.mean += best;
      squares += best * best;
    }
  off.mean /= count;
  off.deviation = std::sqrt(squares / count - off.mean * off.mean);
  return off;
}

TEST(Holder, TakenOffLeavesTheSurfaceOfWhatStandsInIt) {
  for (const double level : {0.3, 0.5, 0.65}) {
    const Volume<float> scan = scan_of({{}, kBlock, level, 0.05}, 51);
    const auto found = look(scan);
    ASSERT_TRUE(found && found->holder.counts_as_air()) << level;
    VolumeSource source(scan);
    HalfResolutionSource half(source);
    SilentProgress progress;
    HolderMask mask = make_holder_mask(half, *found, progress).value();
    HolderlessSource without(source, mask, kHolderCell);
    const Volume<float> cleaned = testing::read_all(without).value();
    const Off off = below(cleaned, 0.5f);
    EXPECT_LT(off.missed, 7) << level;  // of 640
    EXPECT_NEAR(off.mean, 0.0, 0.15) << level;
    // Nothing of the holder is left above the threshold, and what is far from it is as it was.
    double left = 0.0, all = 0.0;
    for (std::int64_t z = 0; z < kSize.z; ++z)
      for (std::int64_t y = 0; y < kSize.y; ++y)
        for (std::int64_t x = 0; x < kSize.x; ++x) {
          const glm::dvec3 p = glm::dvec3(x, y, z) - kMiddle;
          if (z > 56) {
            ASSERT_EQ(cleaned.at(x, y, z), scan.at(x, y, z));
          }
          if (kBlock(p) > 0.0 || depth_of(p) < 2.0) continue;
          all += 1.0;
          left += cleaned.at(x, y, z) > 0.5f ? 1.0 : 0.0;
        }
    EXPECT_LT(left, 0.01 * all) << level;
    // The same bits by slabs and by any number of threads.
    const int threads = thread_count();
    set_thread_count(1);
    std::vector<float> slab(static_cast<std::size_t>(7 * kSize.slice()));
    ASSERT_TRUE(without.read(20, 27, slab));
    set_thread_count(threads);
    EXPECT_TRUE(std::equal(slab.begin(), slab.end(), cleaned.row(0, 20)));
  }
}

}  // namespace
}  // namespace dubsar
