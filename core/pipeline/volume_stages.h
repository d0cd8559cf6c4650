#pragma once
// The stages that work on voxels: import and resampling, denoising, the threshold, sampling of the isosurface. Each is
// a function of values; a report is made from their results (report.h).

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extract/noise_cavities.h"
#include "core/extract/surface_samples.h"
#include "core/filter/denoise.h"
#include "core/filter/edge_spread.h"
#include "core/filter/estimate.h"
#include "core/filter/holder_removal.h"
#include "core/filter/levels.h"
#include "core/pipeline/detail.h"
#include "core/pipeline/stage_clock.h"
#include "core/rays/bent_rays.h"
#include "core/rays/ring_search.h"
#include "core/volume/formats/import.h"
#include "core/volume/grid_store.h"

namespace dubsar {

/// What a filter left, or what was there before the first: noise, air and material.
struct FilterStep {
  std::string name;  ///< "raw", "gauss 2:1", "joint_bilateral 1", ...
  Estimates estimates;
};

/// What is known of the scan once all of it was read.
struct ScanFacts {
  VolumeInfo info;
  Unmeasured unmeasured;  ///< what of it is no measurement
  MeasuredSource::Counts unmeasured_voxels;
  GridFrame frame;                    ///< of the scan as it is read
  std::vector<std::string> warnings;  ///< of the file and of its voxels
  Dims grid;                          ///< after resampling
  std::optional<RaysReport> rays;     ///< where artefacts were looked for
  std::optional<RingsReport> rings;   ///< that were taken off
  std::optional<Holder> holder;       ///< that the object stands in, where it was looked for
  std::optional<EdgeSpread> blur;     ///< of that grid before any filter; nothing where it has no flat surface
};

struct CountedGrid {
  GridStore grid;
  ValueCounts counts;  ///< of the grid, made while it was
};

struct ImportedGrid {
  ScanFacts facts;
  FilterStep raw;  ///< of a sample of the scan
  CountedGrid grid;
  DetailChoice detail;
  EstimateOptions estimate;              ///< as they were given, without what is no measurement
  std::unique_ptr<ImportedVolume> scan;  ///< to be read again: the run opens it once
  /// Instead of the scan (Detail::kScan) or of its halved grid as it was before any filter: with straight rays
  /// (rays_stage.h). Nothing where they are as they are.
  std::unique_ptr<GridStore> straightened;
  std::unique_ptr<RinglessSource> ringless;  ///< the scan without its rings, where it has any; it reads `scan`

  /// The scan at its own resolution as it is to be read: nothing of it is straightened.
  SlabSource& unbent() { return ringless ? static_cast<SlabSource&>(*ringless) : *scan; }

  std::unique_ptr<HolderlessSource> holderless;  ///< what follows without its holder, where it counts as air
  /// What the surface is found in before any filter, or what that is halved from.
  SlabSource& cleaned() {
    if (holderless) return *holderless;
    return straightened ? static_cast<SlabSource&>(*straightened) : unbent();
  }
  bool cleaned_is_half() const { return straightened && detail.resample(); }
};

/// How the grid of import_grid() was made, as a FilterStep is named.
inline constexpr const char* kHalvedGrid = "gauss 2:1";

/// Estimates the scan's noise from a sample, reads it, and halves it along each axis (Gauss 3x3x3 and 2:1): the surface
/// is found there. Where `detail` is that of the scan, facts are those of the scan itself, and the surface is refined
/// afterwards (refine_stage.h). Errors: those of the source; kTryAgain when there is no room for the grid.
Result<ImportedGrid> import_grid(std::unique_ptr<ImportedVolume> scan, const DetailChoice& detail, GridPlace place,
                                 const Budget& budget, const EstimateOptions& estimate, StageRun run);

/// Measures facts.blur in what the surface is found in. One record, "blur".
Result<void> measure_blur(ImportedGrid& imported, StageRun run);

/// Reads all of a source and, if wanted, halves it; two records, "import" and "resample", since both run interleaved.
Result<CountedGrid> read_grid(SlabSource& scan, bool resample, GridPlace place, const Budget& budget, StageRun run);

struct DenoisedGrid {
  GridStore grid;
  std::vector<FilterStep> steps;  ///< before the first pass (`name`) and after each one
};

/// One pass at a time, each with the noise that the one before has left, unless options.sigma is given; it is judged by
/// values that were counted while they were made. A volume without noise stays as it is.
Result<DenoisedGrid> denoise(CountedGrid grid, std::string name, const DenoiseOptions& options,
                             const EstimateOptions& estimate, StageRun run);

struct Threshold {
  float value = 0.0f;
  std::string path;       ///< how it was found, one sentence
  bool half_way = false;  ///< whether it is meant to lie half way between air and clay
};

/// The given one, or that of the estimates. kBadData, with their refusal, where they have none.
Result<Threshold> choose_threshold(std::optional<float> given, const Estimates& estimates);

struct SampleOptions {
  std::optional<float> sharpen;    ///< amount (sharpen.h); default: what the blur asks for and the noise allows
  int offset_bits = 4;             ///< N
  Levels levels = Levels::kLocal;  ///< of air and clay; local ones where the threshold is an automatic one
  bool closed = true;              ///< at the border of the volume
};

struct SampledSurface {
  SurfaceSamples samples;
  float sharpen = 0.0f;               ///< amount that was used
  float sharpen_wide = 0.0f;          ///< the same, against a Gauss of 7 voxels
  float fairing = 0.0f;               ///< share of what noise and blur did to the surface that was taken back
  std::optional<EdgeSpread> blur;     ///< of the grid before it was sharpened, where that was decided by it
  NoiseCavities noise;                ///< that became clay
  std::optional<LocalLevels> levels;  ///< where they were measured
  std::string warning;                ///< for people; empty: none
};

/// How much sharpening the noise allows, in dB of what filters left.
float sharpen_amount(double snr_db);

/// How much of fair_moves.h a surface needs, 0 to 1, by what noise moves it: that of voxels (`snr_db`, dB of what
/// filters left) over the slope of an edge of Gaussian blur, grid steps.
float fairing_share(const EdgeSpread& blur, double snr_db);

/// What is known of a grid whose surface is to be found.
struct GridFacts {
  const Threshold& threshold;
  const Estimates& estimates;
  std::optional<EdgeSpread> blur;
  std::vector<float> constants;  ///< values that stand where nothing was read
};

/// Samples the isosurface, half way between the levels beside it, anew where it is to be made fair (sampled.fairing and
/// .blur), and makes cavities of noise clay. One record, "extract".
Result<void> extract_surface(SlabSource& source, const GridFacts& facts, const SampleOptions& options,
                             SampledSurface& sampled, StageRun run);

/// Sharpens the halved grid, of which is known what 2:1 took, and samples the isosurface. `denoised`: whether a filter
/// pass was asked for; without one the default is no sharpening.
Result<SampledSurface> sample(GridStore& grid, const GridFacts& facts, bool denoised, const SampleOptions& options,
                              StageRun run);

}  // namespace dubsar
