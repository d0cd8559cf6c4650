#include "core/pipeline/volume_stages.h"

#include <algorithm>

#include "core/base/log.h"
#include "core/extract/extract.h"
#include "core/filter/resample.h"
#include "core/filter/sharpen.h"
#include "core/pipeline/tapped_source.h"

namespace dubsar {
namespace {

/// Slices of the raw scan that are enough to know its noise: its histogram is needed for the report only.
constexpr std::int64_t kRawSampleSlices = 48, kRawSampleGroup = 3;

Result<void> estimate_raw(SlabSource& scan, const PipelineOptions& options, PipelineReport& report, StageClock& clock,
                          Progress& progress) {
  SampledSource sample(scan, kRawSampleSlices, kRawSampleGroup);
  clock.start("estimate_raw", "voxel");
  progress.begin("estimate_raw", sample.dims().count(), "voxel");
  DUBSAR_ASSIGN(Estimates estimates, estimate(sample, options.estimate, progress));
  clock.finish(sample.dims().count());
  report.filters.push_back({"raw", std::move(estimates)});
  return {};
}

/// Reads, resamples and returns the volume in memory; two records, since both run interleaved.
Result<Volume<float>> import_and_resample(SlabSource& scan, bool resample, GridFrame& frame, StageClock& clock,
                                          Progress& progress) {
  clock.start(resample ? "resample" : "import", "voxel");
  progress.begin("import", scan.dims().count(), "voxel");
  TappedSource tap(scan, progress);
  SilentProgress silent;
  if (!resample) {
    frame = scan.frame();
    DUBSAR_ASSIGN(Volume<float> volume, read_all(tap, silent));
    clock.finish(scan.dims().count());
    return volume;
  }
  HalfResolutionSource half(tap);
  frame = half.frame();
  DUBSAR_ASSIGN(Volume<float> volume, read_all(half, silent));
  clock.finish(scan.dims().count());
  clock.split_before_last("import", tap.wall_s(), tap.cpu_s(), scan.dims().count(), "voxel");
  return volume;
}

Result<Estimates> estimate_volume(const Volume<float>& volume, std::string_view stage, const PipelineOptions& options,
                                  StageClock& clock, Progress& progress) {
  VolumeSource source(volume);
  clock.start(stage, "voxel");
  progress.begin(stage, volume.dims.count(), "voxel");
  DUBSAR_ASSIGN(Estimates estimates, estimate(source, options.estimate, progress));
  clock.finish(volume.dims.count());
  return estimates;
}

/// One filter pass at a time, each with the noise that the one before has left.
Result<void> denoise_and_estimate(Volume<float>& volume, const PipelineOptions& options, PipelineReport& report,
                                  StageClock& clock, Progress& progress) {
  DUBSAR_ASSIGN(Estimates estimates, estimate_volume(volume, "estimate", options, clock, progress));
  report.filters.push_back({options.resample ? "gauss 2:1" : "imported", estimates});
  for (int iteration = 1; iteration <= options.denoise.iterations; ++iteration) {
    DenoiseOptions pass = options.denoise;
    pass.iterations = 1;
    if (pass.sigma <= 0.0) pass.sigma = estimates.sigma;
    if (needs_sigma(pass.method) && pass.sigma <= 0.0) {
      log_info("denoise: the volume has no noise that could be measured, nothing to filter");
      break;
    }
    clock.start("denoise", "voxel");
    progress.begin("denoise", volume.dims.count(), "voxel");
    DUBSAR_TRY(denoise_in_place(volume, pass, progress));
    clock.finish(volume.dims.count());
    DUBSAR_ASSIGN(estimates, estimate_volume(volume, "estimate", options, clock, progress));
    report.filters.push_back({fmt::format("{} {}", name_in(kDenoiseMethods, pass.method), iteration), estimates});
  }
  report.estimates = std::move(estimates);
  return {};
}

Result<void> choose_threshold(const PipelineOptions& options, PipelineReport& report) {
  if (options.threshold) {
    report.threshold = *options.threshold;
    report.threshold_path = "given by the user";
    return {};
  }
  DUBSAR_ASSIGN(const double threshold, automatic_threshold(report.estimates));
  report.threshold = static_cast<float>(threshold);
  report.threshold_path = report.estimates.path;
  log_info("threshold {:g}: {}", report.threshold, report.threshold_path);
  return {};
}

/// Least SNR at which sharpening, which may double the noise, leaves more than a raw scan of the paper has (17 dB).
constexpr double kSharpenFromDb = 26.0;

float sharpen_amount(const PipelineOptions& options, const Estimates& estimates) {
  if (options.sharpen) return *options.sharpen;
  return options.denoise.iterations > 0 && estimates.snr_db >= kSharpenFromDb ? 1.0f : 0.0f;
}

}  // namespace

Result<SurfaceSamples> run_volume_stages(const PipelineOptions& options, PipelineReport& report, GridFrame& frame,
                                         StageClock& clock, Progress& progress) {
  DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> scan, open_volume(options.import));
  report.input = scan->info();
  report.warnings = report.input.warnings;
  DUBSAR_TRY(estimate_raw(*scan, options, report, clock, progress));
  DUBSAR_ASSIGN(Volume<float> volume, import_and_resample(*scan, options.resample, frame, clock, progress));
  report.nonfinite_voxels = scan->nonfinite_count();
  report.nonfinite_fill = scan->nonfinite_fill();
  if (report.nonfinite_voxels > 0) {
    report.warnings.push_back(
        fmt::format("{} voxels were NaN or Inf and count as {:g}", report.nonfinite_voxels, report.nonfinite_fill));
    log(LogLevel::kWarning, report.warnings.back());
  }
  report.grid = volume.dims;
  DUBSAR_TRY(denoise_and_estimate(volume, options, report, clock, progress));
  DUBSAR_TRY(choose_threshold(options, report));

  VolumeSource filtered(volume, frame);
  report.sharpen = sharpen_amount(options, report.estimates);
  SharpenedSource sharpened(filtered, report.sharpen);
  SlabSource& source = report.sharpen > 0.0f ? static_cast<SlabSource&>(sharpened) : filtered;
  clock.start("extract", "voxel");
  progress.begin("extract", volume.dims.count(), "voxel");
  const ExtractOptions extract{report.threshold, options.offset_bits, options.closed_boundary};
  DUBSAR_ASSIGN(SurfaceSamples samples, sample_surface(source, extract, progress));
  clock.finish(volume.dims.count());
  return samples;
}

}  // namespace dubsar
