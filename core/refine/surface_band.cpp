#include "core/refine/surface_band.h"

#include <algorithm>

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/filter/sharpen.h"

namespace dubsar {
namespace {

constexpr int kMostRounds = 12;

}  // namespace

Result<FilteredScan> FilteredScan::make(SlabSource& scan, const BandFilters& filters, const Wanted& wanted) {
  FilteredScan result(scan);
  const std::int64_t narrow = filters.sharpen > 0.0f ? 1 : 0;
  std::int64_t reach = narrow + (filters.sharpen_wide > 0.0f ? 3 : 0);
  for (const DenoiseOptions& pass : filters.passes) reach += reach_of(pass);
  for (const DenoiseOptions& pass : filters.passes) {
    reach -= reach_of(pass);
    DUBSAR_ASSIGN(std::unique_ptr<SlabSource> filter, make_denoised(*result.last_, pass, wanted.wider(reach)));
    result.filters_.push_back(std::move(filter));
    result.last_ = result.filters_.back().get();
  }
  if (filters.sharpen_wide > 0.0f) {
    result.filters_.push_back(
        make_widely_sharpened(*result.last_, filters.sharpen_wide, filters.level, wanted.wider(narrow)));
    result.last_ = result.filters_.back().get();
  }
  if (filters.sharpen > 0.0f) {
    result.filters_.push_back(make_sharpened(*result.last_, filters.sharpen, wanted));
    result.last_ = result.filters_.back().get();
  }
  return result;
}

Result<BandSource> BandSource::make(SlabSource& scan, const BandFilters& filters, const NearSurface& surface,
                                    std::int64_t reach, const OutsideValues& outside) {
  DUBSAR_ASSIGN(FilteredScan filtered, FilteredScan::make(scan, filters, {&surface.near, reach}));
  return BandSource(std::move(filtered), surface, reach, outside);
}

Result<void> BandSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_TRY(filtered_.read(z_begin, z_end, out));
  const Dims d = dims();
  parallel_chunks((z_end - z_begin) * d.y, 64, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Span> spans;
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t y = i % d.y, z = z_begin + i / d.y;
      surface_->near.spans(y, z, reach_, spans);
      spans.push_back({d.x, d.x});
      std::int64_t x = 0;
      for (const Span& span : spans) {
        for (; x < span.begin; ++x)
          out[static_cast<std::size_t>(i * d.x + x)] =
              surface_->inside.get(x / BrickMask::kEdge, y / BrickMask::kEdge, z / BrickMask::kEdge) ? outside_.above
                                                                                                     : outside_.below;
        x = span.end;
      }
    }
  });
  return {};
}

Result<SurfaceBand> read_band(SlabSource& scan, NearSurface surface, const BandFilters& filters, float threshold,
                              const OutsideValues& outside, Progress& progress) {
  DUBSAR_CHECK(outside.below < threshold && outside.above >= threshold);
  SurfaceBand band{BrickValues(std::move(surface.inside), scan.frame(), outside), {}};
  BrickMask bricks = std::move(surface.near);
  const std::int64_t marked = bricks.count();
  for (int round = 0; round < kMostRounds; ++round) {
    progress.begin("band", scan.dims().z, "slice");
    DUBSAR_ASSIGN(FilteredScan filtered, FilteredScan::make(scan, filters, {&bricks, 0}));
    DUBSAR_TRY(band.values.keep(bricks, filtered, progress));
    bricks = band.values.crossed(bricks, threshold);
    band.report.cut = bricks.count();
    log_debug("band: {} bricks, surface runs into {} more", band.values.kept(), band.report.cut);
    if (band.report.cut == 0) break;
  }
  band.report.bricks = band.values.kept();
  band.report.added = band.values.kept() - marked;
  band.report.share =
      static_cast<double>(band.report.bricks) / static_cast<double>(band.values.dims().count() / 512 + 1);
  return band;
}

}  // namespace dubsar
