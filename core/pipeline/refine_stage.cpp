#include "core/pipeline/refine_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/system/log.h"
#include "core/extract/extract.h"
#include "core/filter/sharpen.h"
#include "core/pipeline/tapped_source.h"

namespace dubsar {
namespace {

/// Groups of slices of the scan that are filtered in whole, for the noise that each pass leaves. Where two groups meet
/// less of it is left, since their noise has nothing in common: with 12 slices it comes out 1.5 % too small, with 6 3
/// %.
constexpr std::int64_t kGroupSlices = 12, kMostGroups = 8, kLeastGroups = 3, kMostSampled = 150'000'000;

/// Half the resolution shows a gap of a voxel as a dip of a quarter and more of the contrast, if it shows it at all;
/// so close to the threshold, in parts of the contrast, a value is suspicious. Less where its noise would be, too.
constexpr double kMostMargin = 0.3, kLeastMargin = 0.12, kMarginNoise = 4.0;

/// Balls in which the blur is measured, and what decides whether there is an edge (edge_spread.h).
constexpr std::int64_t kBlurReach = 7;

/// Variance of the Gauss 3x3x3 that sharpening undoes: an amount of 1 takes as much off the variance of an edge.
constexpr double kGaussVariance = 0.5;

struct Learned {
  std::vector<FilterStep> steps;
  std::vector<DenoiseOptions> passes;
};

/// What the filters need to know, from a sample of the scan that goes through them.
Result<Learned> learn(SlabSource& scan, const RefineOptions& options, const Budget& budget, StageRun run) {
  const std::int64_t groups =
      std::clamp(kMostSampled / (kGroupSlices * scan.dims().slice()), kLeastGroups, kMostGroups);
  SampledSource some(scan, groups * kGroupSlices, kGroupSlices);
  StageClock apart;
  const StageRun inner{apart, run.progress};
  run.clock.start("sample", "voxel");
  DUBSAR_ASSIGN(CountedGrid sampled, read_grid(some, false, place_for(some.dims(), budget), budget, inner));
  DUBSAR_ASSIGN(DenoisedGrid denoised, denoise(std::move(sampled), "sample", options.denoise, options.estimate, inner));
  run.clock.finish(some.dims().count());
  Learned learned{std::move(denoised.steps), {}};
  for (std::size_t k = 0; k + 1 < learned.steps.size(); ++k) {
    DenoiseOptions pass = options.denoise;
    pass.iterations = 1;
    if (pass.sigma <= 0.0) pass.sigma = learned.steps[k].estimates.sigma;
    learned.passes.push_back(pass);
  }
  return learned;
}

/// Values that may hide a surface; all where air and clay are not known.
float margin_for(const Estimates& scan, double half_noise) {
  const double contrast = scan.m_hi - scan.m_lo;
  if (!scan.refusal.empty() || !(contrast > 0.0)) return std::numeric_limits<float>::max();
  return static_cast<float>(contrast *
                            std::clamp(0.5 - kMarginNoise * half_noise / contrast, kLeastMargin, kMostMargin));
}

}  // namespace

Result<RefinedSurface> refine(SlabSource& scan, GridStore& half, double half_noise, const RefineOptions& options,
                              const Budget& budget, StageRun run) {
  RefinedSurface refined;
  DUBSAR_ASSIGN(Learned learned, learn(scan, options, budget, run));
  const Estimates& estimates = learned.steps.back().estimates;
  DUBSAR_ASSIGN(refined.threshold, choose_threshold(options.threshold, estimates));
  const float threshold = refined.threshold.value;
  const OutsideValues outside{
      std::min(static_cast<float>(estimates.m_lo), std::nextafter(threshold, std::numeric_limits<float>::lowest())),
      std::max(static_cast<float>(estimates.m_hi), threshold)};

  run.clock.start("band", "voxel");
  DUBSAR_ASSIGN(NearSurface surface,
                mark_near_surface(half, scan.dims(),
                                  {.threshold = threshold, .margin = margin_for(estimates, half_noise)}, run.progress));
  half.release();
  BandFilters filters{.passes = std::move(learned.passes), .level = threshold};
  SampledSurface& sampled = refined.sampled;
  sampled.sharpen =
      options.sample.sharpen.value_or(options.denoise.iterations > 0 ? sharpen_amount(estimates.snr_db) : 0.0f);
  if (!options.sample.sharpen && options.denoise.iterations > 0) {
    DUBSAR_ASSIGN(BandSource around, BandSource::make(scan, filters, surface, kBlurReach, outside));
    DUBSAR_ASSIGN(sampled.blur, measure_edge_spread(around, estimates.m_lo, estimates.m_hi, run.progress));
    if (sampled.blur) {
      sampled.sharpen *= static_cast<float>(std::min(sampled.blur->variance / kGaussVariance, 1.0));
      sampled.fairing = fairing_share(*sampled.blur, estimates.snr_db);
      sampled.sharpen_wide = wide_sharpening(sampled.blur->variance, estimates.snr_db, sampled.sharpen);
    }
    log_debug("sharpen: edges of {:.2f} voxel2, {:.1f} dB: {:.2f}, wide {:.2f}; fair {:.2f}",
              sampled.blur ? sampled.blur->variance : NAN, estimates.snr_db, sampled.sharpen, sampled.sharpen_wide,
              sampled.fairing);
  }
  filters.sharpen = sampled.sharpen;
  filters.sharpen_wide = sampled.sharpen_wide;
  DUBSAR_ASSIGN(SurfaceBand band, read_band(scan, std::move(surface), filters, threshold, outside, run.progress));
  refined.band = band.report;
  run.clock.finish(512 * band.report.bricks);
  log_debug("band: {:.1f} % of the scan is near the surface, {:.1f} MiB", 100.0 * band.report.share,
            static_cast<double>(band.report.bricks) / 512.0);
  if (band.report.cut > 0) log_warning("band: the surface ends at the band at {} bricks", band.report.cut);
  const GridFacts facts{refined.threshold, estimates, options.blur, {outside.below, outside.above}};
  DUBSAR_TRY(extract_surface(band.values, facts, options.sample, sampled, run));
  refined.steps = std::move(learned.steps);
  return refined;
}

}  // namespace dubsar
