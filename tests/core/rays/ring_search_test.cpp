// Rings of a scanner are found and taken off; what is round in the object stays to the bit.
#include "core/rays/ring_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/filter/resample.h"
#include "core/phantom/density.h"
#include "core/phantom/phantom_source.h"
#include "core/phantom/scanner/scan.h"
#include "core/volume/grid_store.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

Volume<float> halved(const Volume<float>& scan) {
  VolumeSource source(scan);
  HalfResolutionSource half(source);
  return testing::read_all(half).value();
}

std::optional<FoundRings> rings_of(const Volume<float>& scan, const GreyLevels& levels) {
  VolumeSource source(scan);
  const Volume<float> small = halved(scan);
  VolumeSource half(small);
  SilentProgress progress;
  return find_rings(source, half, levels, progress).value();
}

Volume<float> less_rings(const Volume<float>& scan, const FoundRings& rings) {
  VolumeSource source(scan);
  RinglessSource less(source, rings.field);
  return testing::read_all(less, 5).value();
}

/// Root mean square of the difference.
double apart(const Volume<float>& a, const Volume<float>& b) {
  double squares = 0.0;
  for (std::int64_t i = 0; i < a.voxels.size(); ++i) {
    const double off = a.voxels[i] - b.voxels[i];
    squares += off * off;
  }
  return std::sqrt(squares / static_cast<double>(a.voxels.size()));
}

Volume<float> phantom_scan(std::uint64_t seed, double rings, double snr_db) {
  phantom::PhantomOptions wanted;
  wanted.dims = {192, 120, 200};
  wanted.seed = seed;
  wanted.snr_db = snr_db;
  wanted.rings = rings;
  phantom::PhantomSource source(phantom::Phantom::create(wanted).value());
  return testing::read_all(source).value();
}

TEST(RingSearch, RingsOfAScanAreTakenOff) {
  const GreyLevels levels{phantom::kAirDensity, phantom::kClayDensity};
  for (const auto& [seed, amount, snr_db] : {std::tuple{4711u, 0.05, 17.0}, {4712u, 0.05, 14.0}, {4713u, 0.02, 20.0}}) {
    const Volume<float> clean = phantom_scan(seed, 0.0, snr_db), scan = phantom_scan(seed, amount, snr_db);
    const auto rings = rings_of(scan, levels);
    ASSERT_TRUE(rings) << seed;
    EXPECT_NEAR(rings->report.look.centre.x, 95.5, 0.3);
    EXPECT_NEAR(rings->report.look.centre.y, 59.5, 0.3);
    const double before = apart(scan, clean), after = apart(less_rings(scan, *rings), clean);
    std::printf("seed %u: %s; %.4f of the contrast before, %.4f after\n", seed, describe(rings->report).c_str(),
                before / levels.contrast(), after / levels.contrast());
    EXPECT_LT(after, 0.3 * before) << seed;
    EXPECT_FALSE(rings_of(clean, levels)) << seed;
  }
}

phantom::ScannedVolume scanned(const std::string& scanner) {
  phantom::PhantomOptions wanted;
  wanted.dims = {176, 112, 184};
  wanted.seed = 4720;
  const auto object = phantom::Phantom::create(wanted).value();
  phantom::DensitySource density(*object);
  SilentProgress progress;
  return phantom::scan_object(density, object->options().voxel_mm, phantom::parse_scanner(scanner).value(), wanted.seed,
                              progress)
      .value();
}

TEST(RingSearch, RingsAndHalfRingsOfTheScannerAreTakenOff) {
  for (const std::string turn : {"full", "half"}) {
    const std::string ideal = "ideal,cone=0,turn=" + turn;
    const phantom::ScannedVolume clean = scanned(ideal), scan = scanned(ideal + ",rings=0.012");
    const GreyLevels levels{0.0, clean.clay_per_mm};
    const auto rings = rings_of(scan.per_mm, levels);
    EXPECT_FALSE(rings_of(clean.per_mm, levels)) << turn;
    ASSERT_TRUE(rings) << turn;
    EXPECT_EQ(rings->report.look.half_turn.has_value(), turn == "half");
    const double before = apart(scan.per_mm, clean.per_mm) / levels.contrast();
    const double after = apart(less_rings(scan.per_mm, *rings), clean.per_mm) / levels.contrast();
    std::printf("%s turn: %s; %.4f of the contrast before, %.4f after\n", turn.c_str(), describe(rings->report).c_str(),
                before, after);
    EXPECT_LT(after, 0.5 * before) << turn;
  }
}

// Faults of pixels that are so strong that clay falls below the level: a hollow about the axis in some slices.
TEST(RingSearch, HalfRingsAsDarkAsAirAreTakenOff) {
  const phantom::ScannedVolume clean = scanned("ideal,cone=0,turn=half");
  const phantom::ScannedVolume scan = scanned("ideal,cone=0,turn=half,rings=0.03,bad=0.002");
  const GreyLevels levels{0.0, clean.clay_per_mm};
  const auto rings = rings_of(scan.per_mm, levels);
  ASSERT_TRUE(rings);
  const Volume<float> less = less_rings(scan.per_mm, *rings);
  const auto wrong_side = [&](const Volume<float>& volume) {
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < volume.voxels.size(); ++i) {
      const double grey = clean.per_mm.voxels[i] / levels.contrast();
      if (grey > 0.9) count += volume.voxels[i] < 0.5 * levels.contrast();
    }
    return count;
  };
  const std::int64_t before = wrong_side(scan.per_mm), after = wrong_side(less);
  std::printf("%s; clay that counts as air: %lld before, %lld after\n", describe(rings->report).c_str(),
              static_cast<long long>(before), static_cast<long long>(after));
  EXPECT_GT(before, 500);
  EXPECT_LT(after, 4 * before / 10);
}

/// Clay turned about the middle: a bore, grooves outside, and denser layers in it.
Volume<float> turned_cylinder(double noise, bool layers) {
  const Dims d{120, 120, 64};
  Volume<float> scan(d);
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  for (std::int64_t i = 0; i < d.count(); ++i) {
    const std::int64_t row = i / d.x % d.y, slice = i / d.slice();
    const double x = static_cast<double>(i % d.x) - 59.5, y = static_cast<double>(row) - 59.5;
    const auto z = static_cast<double>(slice);
    const double r = std::hypot(x, y), outer = 48.0 + 2.0 * std::sin(z / 3.0);
    const double clay = std::clamp(outer - r + 0.5, 0.0, 1.0) * std::clamp(r - 9.5, 0.0, 1.0);
    const double layer = layers && std::abs(std::remainder(r, 7.0)) < 0.8 ? 0.08 : 0.0;
    scan.voxels[i] = static_cast<float>(clay * (1.0 + layer) + noise * normal(random));
  }
  return scan;
}

TEST(RingSearch, ATurnedCylinderKeepsItsGroovesAndLayers) {
  for (const double noise : {0.0, 0.05, 0.14})
    for (const bool layers : {false, true})
      EXPECT_FALSE(rings_of(turned_cylinder(noise, layers), {0.0, 1.0})) << noise << (layers ? ", layers" : "");
}

TEST(RingSearch, AShiftedCylinderKeepsThemToo) {
  // Its own axis beside that of the scanner: nothing of it is the same over all angles there.
  const Volume<float> round = turned_cylinder(0.05, true);
  const Dims d{140, 120, 64};
  Volume<float> scan(d);
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) scan.at(x, y, z) = round.at(std::max<std::int64_t>(0, x - 20), y, z);
  EXPECT_FALSE(rings_of(scan, {0.0, 1.0}));
}

}  // namespace
}  // namespace dubsar
