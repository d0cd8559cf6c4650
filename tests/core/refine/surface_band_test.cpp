// The surface in the band is that of the whole scan, filtered in whole.
#include "core/refine/surface_band.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/base/system/parallel.h"
#include "core/extract/extract.h"
#include "core/filter/resample.h"
#include "core/phantom/phantom_source.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

constexpr float kThreshold = 0.47f * phantom::kClayDensity;
constexpr OutsideValues kOutside{phantom::kAirDensity, phantom::kClayDensity};

Volume<float> scan_of(Dims dims, std::uint64_t seed, double snr_db) {
  phantom::PhantomOptions wanted;
  wanted.dims = dims;
  wanted.seed = seed;
  wanted.snr_db = snr_db;
  phantom::PhantomSource source(phantom::Phantom::create(wanted).value());
  return testing::read_all(source).value();
}

BandFilters filters_for(double snr_db, float sharpen, float wide = 0.0f) {
  BandFilters filters;
  double sigma = phantom::kClayDensity / std::pow(10.0, snr_db / 20.0);
  for (int pass = 0; pass < 2; ++pass, sigma *= 0.5) {
    DenoiseOptions options;
    options.iterations = 1;
    options.sigma = sigma;
    filters.passes.push_back(options);
  }
  filters.sharpen = sharpen;
  filters.sharpen_wide = wide;
  filters.level = kThreshold;
  return filters;
}

SurfaceSamples surface_of(SlabSource&& source) {
  SilentProgress progress;
  return sample_surface(source, {kThreshold, 4, true}, progress).value();
}

SurfaceBand band_of(const Volume<float>& scan, const BandFilters& filters) {
  VolumeSource source(scan);
  SilentProgress progress;
  HalfResolutionSource half(source);
  DenoiseOptions one = filters.passes[0];
  one.sigma *= 0.5;
  const auto filtered = make_denoised(half, one).value();
  NearSurface surface =
      mark_near_surface(*filtered, scan.dims, {kThreshold, 0.25f * phantom::kClayDensity, 4}, progress).value();
  return read_band(source, std::move(surface), filters, kThreshold, kOutside, progress).value();
}

TEST(SurfaceBand, ItsSurfaceIsThatOfTheWholeScanByteForByte) {
  for (const auto& [seed, snr, sharpen, wide] :
       {std::tuple{71u, 17.0, 0.0f, 0.7f}, {72u, 17.0, 0.5f, 0.0f}, {73u, 30.0, 1.0f, 0.4f}}) {
    const Volume<float> scan = scan_of({150, 81, 131}, seed, snr);
    const BandFilters filters = filters_for(snr, sharpen, wide);
    VolumeSource source(scan);
    FilteredScan all = FilteredScan::make(source, filters, {}).value();
    Volume<float> whole = testing::read_all(all).value();
    SurfaceBand band = band_of(scan, filters);
    EXPECT_EQ(band.report.cut, 0);
    EXPECT_LT(band.report.share, 0.8);

    // Pieces of surface that are nowhere near it are points of the whole scan on the other side than the band says.
    SurfaceSamples found = surface_of(std::move(band.values));
    const SurfaceSamples everywhere = surface_of(VolumeSource(whole));
    std::int64_t apart = 0;
    for (std::int64_t z = 0; z < scan.dims.z; ++z)
      for (std::int64_t y = 0; y < scan.dims.y; ++y)
        for (std::int64_t x = 0; x < scan.dims.x; ++x) {
          const bool inside = found.signs.get(x, y, z);
          if (everywhere.signs.get(x, y, z) == inside) continue;
          ++apart;
          whole.at(x, y, z) = inside ? kOutside.above : kOutside.below;
        }
    EXPECT_LT(apart, scan.dims.count() / 20000) << "seed " << seed;
    EXPECT_EQ(surface_of(VolumeSource(whole)), found) << "seed " << seed;
    EXPECT_GT(found.offsets.size(), 10000u);
    std::printf("seed %u: %.1f %% of the bricks, %lld added, %lld points far from them differ\n", seed,
                100.0 * band.report.share, static_cast<long long>(band.report.added), static_cast<long long>(apart));
  }
}

TEST(SurfaceBand, ItFollowsSurfaceThatHalfTheResolutionDoesNotShow) {
  // A bore of one voxel, from the air far into the clay: gone after 2:1.
  const Dims dims{96, 64, 64};
  Volume<float> scan(dims);
  for (std::int64_t i = 0; i < dims.count(); ++i) {
    const std::int64_t x = i % dims.x, y = i / dims.x % dims.y, z = i / dims.slice();
    scan.voxels[i] = x < 20 || (y == 32 && z == 32 && x < 80) ? 0.0f : phantom::kClayDensity;
  }
  SilentProgress progress;
  VolumeSource source(scan);
  HalfResolutionSource half(source);
  NearSurface surface = mark_near_surface(half, dims, {kThreshold, 0.1f * phantom::kClayDensity, 4}, progress).value();
  EXPECT_FALSE(surface.near.get(8, 4, 4));
  SurfaceBand band = read_band(source, std::move(surface), {}, kThreshold, kOutside, progress).value();
  EXPECT_GT(band.report.added, 3);
  EXPECT_EQ(band.report.cut, 0);
  EXPECT_EQ(surface_of(std::move(band.values)), surface_of(VolumeSource(scan)));
}

TEST(SurfaceBand, ThreadsChangeNoByte) {
  const Volume<float> scan = scan_of({96, 64, 96}, 74, 17.0);
  const BandFilters filters = filters_for(17.0, 0.3f, 0.5f);
  const SurfaceSamples first = surface_of(band_of(scan, filters).values);
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    EXPECT_EQ(surface_of(band_of(scan, filters).values), first) << threads << " threads";
  }
  set_thread_count(0);
}

TEST(SurfaceBand, ConstantsStandWhereNothingIsFiltered) {
  const Volume<float> scan = scan_of({96, 64, 96}, 75, 20.0);
  VolumeSource source(scan);
  const BandFilters filters = filters_for(20.0, 0.0f);
  SilentProgress progress;
  HalfResolutionSource half(source);
  const NearSurface surface =
      mark_near_surface(half, scan.dims, {kThreshold, 0.1f * phantom::kClayDensity, 4}, progress).value();
  FilteredScan all = FilteredScan::make(source, filters, {}).value();
  const Volume<float> whole = testing::read_all(all).value();
  BandSource some = BandSource::make(source, filters, surface, 7, kOutside).value();
  const Volume<float> part = testing::read_all(some).value();
  std::int64_t filtered = 0;
  for (std::int64_t z = 0; z < scan.dims.z; ++z)
    for (std::int64_t y = 0; y < scan.dims.y; ++y) {
      std::vector<Span> spans;
      surface.near.spans(y, z, 7, spans);
      for (std::int64_t x = 0; x < scan.dims.x; ++x) {
        const bool near =
            std::any_of(spans.begin(), spans.end(), [&](const Span& s) { return x >= s.begin && x < s.end; });
        filtered += near;
        const float expected = near                                      ? whole.at(x, y, z)
                               : surface.inside.get(x / 8, y / 8, z / 8) ? kOutside.above
                                                                         : kOutside.below;
        ASSERT_EQ(part.at(x, y, z), expected) << x << ' ' << y << ' ' << z;
      }
    }
  EXPECT_LT(filtered, scan.dims.count());
}

}  // namespace
}  // namespace dubsar
