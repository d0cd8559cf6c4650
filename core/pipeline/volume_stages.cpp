#include "core/pipeline/volume_stages.h"

#include <algorithm>

#include "core/base/budget.h"
#include "core/base/log.h"
#include "core/extract/extract.h"
#include "core/filter/resample.h"
#include "core/filter/sharpen.h"
#include "core/pipeline/tapped_source.h"

namespace dubsar {
namespace {

/// Slices of the raw scan that are enough to know its noise: its histogram is needed for the report only.
constexpr std::int64_t kRawSampleSlices = 48, kRawSampleGroup = 3;

Result<Estimates> estimate_source(SlabSource& source, std::string_view stage, const EstimateOptions& options,
                                  StageRun run) {
  run.clock.start(stage, "voxel");
  run.progress.begin(stage, source.dims().count(), "voxel");
  DUBSAR_ASSIGN(Estimates estimates, estimate(source, options, run.progress));
  run.clock.finish(source.dims().count());
  return estimates;
}

/// Reads and resamples; two records, since both run interleaved.
Result<Grid> read_grid(SlabSource& scan, bool resample, StageRun run) {
  run.clock.start(resample ? "resample" : "import", "voxel");
  run.progress.begin("import", scan.dims().count(), "voxel");
  TappedSource tap(scan, run.progress);
  SilentProgress silent;
  Grid grid;
  if (!resample) {
    grid.frame = scan.frame();
    DUBSAR_ASSIGN(grid.volume, read_all(tap, silent));
    run.clock.finish(scan.dims().count());
    return grid;
  }
  HalfResolutionSource half(tap);
  grid.frame = half.frame();
  DUBSAR_ASSIGN(grid.volume, read_all(half, silent));
  run.clock.finish(scan.dims().count());
  run.clock.split_before_last("import", tap.wall_s(), tap.cpu_s(), scan.dims().count(), "voxel");
  return grid;
}

/// Sharpening by 1 may double the noise: from here on it leaves at least what a raw scan of the paper has (17 dB).
constexpr double kSharpenFromDb = 23.0, kAllFromDb = 27.0;

/// All of it where there is little noise, none where there is much, in between in proportion: at the scan's resolution
/// filters leave 24 to 26 dB of 17.
float sharpen_amount(double snr_db) {
  return static_cast<float>(std::clamp((snr_db - kSharpenFromDb) / (kAllFromDb - kSharpenFromDb), 0.0, 1.0));
}

}  // namespace

Result<ImportedGrid> import_grid(const ImportOptions& options, Detail detail, const EstimateOptions& estimate,
                                 StageRun run) {
  DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> scan, open_volume(options));
  ImportedGrid imported;
  imported.detail = choose_detail(detail, scan->dims(), available_memory_bytes());
  const bool resample = imported.detail.resample();
  if (detail == Detail::kAuto)
    log_info("detail {}: {}", name_in(kDetails, imported.detail.detail), imported.detail.why);
  imported.facts.info = scan->info();
  imported.facts.warnings = scan->info().warnings;
  SampledSource some(*scan, kRawSampleSlices, kRawSampleGroup);
  imported.raw.name = "raw";
  DUBSAR_ASSIGN(imported.raw.estimates, estimate_source(some, "estimate_raw", estimate, run));
  DUBSAR_ASSIGN(imported.grid, read_grid(*scan, resample, run));
  imported.grid_name = resample ? "gauss 2:1" : "imported";
  ScanFacts& facts = imported.facts;
  facts.grid = imported.grid.volume.dims;
  facts.nonfinite_voxels = scan->nonfinite_count();
  facts.nonfinite_fill = scan->nonfinite_fill();
  if (facts.nonfinite_voxels > 0) {
    facts.warnings.push_back(
        fmt::format("{} voxels were NaN or Inf and count as {:g}", facts.nonfinite_voxels, facts.nonfinite_fill));
    log(LogLevel::kWarning, facts.warnings.back());
  }
  return imported;
}

Result<DenoisedGrid> denoise(Grid grid, std::string name, const DenoiseOptions& options,
                             const EstimateOptions& estimate, StageRun run) {
  DenoisedGrid denoised{std::move(grid), {}};
  Volume<float>& volume = denoised.grid.volume;
  VolumeSource source(volume);
  const auto add_step = [&](std::string step) -> Result<void> {
    DUBSAR_ASSIGN(Estimates estimates, estimate_source(source, "estimate", estimate, run));
    denoised.steps.push_back({std::move(step), std::move(estimates)});
    return {};
  };
  DUBSAR_TRY(add_step(std::move(name)));
  for (int iteration = 1; iteration <= options.iterations; ++iteration) {
    DenoiseOptions pass = options;
    pass.iterations = 1;
    if (pass.sigma <= 0.0) pass.sigma = denoised.steps.back().estimates.sigma;
    if (needs_sigma(pass.method) && pass.sigma <= 0.0) {
      log_info("denoise: the volume has no noise that could be measured, nothing to filter");
      break;
    }
    run.clock.start("denoise", "voxel");
    run.progress.begin("denoise", volume.dims.count(), "voxel");
    DUBSAR_TRY(denoise_in_place(volume, pass, run.progress));
    run.clock.finish(volume.dims.count());
    DUBSAR_TRY(add_step(fmt::format("{} {}", name_in(kDenoiseMethods, pass.method), iteration)));
  }
  return denoised;
}

Result<Threshold> choose_threshold(std::optional<float> given, const Estimates& estimates) {
  if (given) return Threshold{*given, "given by the user"};
  DUBSAR_ASSIGN(const double value, automatic_threshold(estimates));
  Threshold threshold{static_cast<float>(value), estimates.path};
  log_debug("threshold {:g}: {}", threshold.value, threshold.path);
  return threshold;
}

Result<SampledSurface> sample(const Grid& grid, float threshold, const Estimates& estimates, bool denoised,
                              const SampleOptions& options, StageRun run) {
  SampledSurface sampled;
  sampled.sharpen = options.sharpen.value_or(denoised ? sharpen_amount(estimates.snr_db) : 0.0f);
  VolumeSource filtered(grid.volume, grid.frame);
  SharpenedSource sharpened(filtered, sampled.sharpen);
  SlabSource& source = sampled.sharpen > 0.0f ? static_cast<SlabSource&>(sharpened) : filtered;
  run.clock.start("extract", "voxel");
  run.progress.begin("extract", grid.volume.dims.count(), "voxel");
  DUBSAR_ASSIGN(sampled.samples,
                sample_surface(source, {threshold, options.offset_bits, options.closed}, run.progress));
  run.clock.finish(grid.volume.dims.count());
  return sampled;
}

}  // namespace dubsar
