#include "core/pipeline/pipeline.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/system/budget.h"
#include "core/base/system/large_blocks.h"
#include "core/base/system/log.h"
#include "core/base/text/json_text.h"
#include "core/exa/exa_file.h"
#include "core/pipeline/holder_stage.h"
#include "core/pipeline/refine_stage.h"
#include "core/pipeline/room_check.h"

namespace dubsar {
namespace {

/// Of the grid that light marches through at the scan's resolution: fewer boxes, whose borders are done twice. Finding
/// the parts, before it, holds more memory.
constexpr double kCellsToShare = 1.2e9;

/// A model before its parts are known.
SurfaceModel assemble(GridFrame frame, SurfaceSamples samples, QuadMesh mesh, VertexAttributes attributes) {
  SurfaceModel model;
  model.frame = std::move(frame);
  model.samples = std::move(samples);
  model.mesh = std::move(mesh);
  model.attributes = std::move(attributes);
  return model;
}

/// What is known of voxels when they are not needed any more.
struct FoundSurface {
  SampledSurface sampled;
  Threshold threshold;
  GridFrame frame;
  std::vector<FilterStep> steps;
  std::optional<BandReport> band;  ///< at the scan's resolution
};

/// The surface of the halved grid, or that of the scan around it. The grid is released.
Result<FoundSurface> find_surface(const PipelineOptions& options, ImportedGrid& imported, DenoisedGrid& half,
                                  StageRun run) {
  const Estimates& estimates = half.steps.back().estimates;
  FoundSurface found;
  found.steps = half.steps;
  if (imported.detail.resample()) {
    found.frame = half.grid.frame();
    DUBSAR_ASSIGN(found.threshold, choose_threshold(options.threshold, estimates));
    DUBSAR_ASSIGN(found.sampled, sample(half.grid, {found.threshold, estimates, imported.facts.blur, {}},
                                        options.denoise.iterations > 0, options.sample, run));
    half.grid.release();  // from here on the samples are enough
  } else {
    found.frame = imported.scan->frame();
    DUBSAR_ASSIGN(RefinedSurface refined,
                  refine(imported.cleaned(), half.grid, estimates.sigma,
                         {options.denoise, imported.estimate, options.threshold, options.sample, imported.facts.blur},
                         options.import.budget, run));
    found.sampled = std::move(refined.sampled);
    found.threshold = std::move(refined.threshold);
    found.band = refined.band;
    found.steps.insert(found.steps.end(), refined.steps.begin(), refined.steps.end());
  }
  return found;
}

RunShape wanted_shape(const PipelineOptions& options) {
  RunShape shape;
  shape.artefacts = options.artefacts == Artefacts::kAuto;
  shape.fill_holes = options.fill_holes;
  shape.contact = options.contact.has_value();
  shape.noise.passes = options.denoise.iterations;
  shape.rays = options.occlusion ? options.occlusion->rays : 0.0;
  return shape;
}

std::int64_t patch_triangles(const SurfaceModel& model) {
  std::int64_t triangles = 0;
  for (const FillPatch& patch : model.patches) triangles += static_cast<std::int64_t>(patch.triangles.size());
  return triangles;
}

/// Hands on what a stage has made.
template <class T, class Made>
Result<void> keep(T& to, Result<Made> made) {
  if (!made) return tl::unexpected<Error>(made.error());
  to = std::move(*made);
  return {};
}

/// A run on its way: the stages of the plan, one after the other, and what they have made so far.
struct Run {
  const PipelineOptions& options;
  StageRun run;
  FittingRun plan;
  ImportedGrid imported;
  DenoisedGrid half;
  FoundSurface found;
  SmoothedMesh smoothed;
  SettledModel settled;
  SeparatedModel separated;  ///< its model is the one that later stages change
  std::optional<ContactReport> contact;
  CheckedProduct product;

  Result<void> import(std::unique_ptr<ImportedVolume> scan) {
    return keep(imported, import_grid(std::move(scan), plan.detail, plan.run.half_place, options.import.budget,
                                      options.estimate, run));
  }

  void close_scan() {
    imported.holderless.reset();
    imported.straightened.reset();
    imported.ringless.reset();
    imported.scan.reset();
  }

  Result<void> find() {
    if (const auto& blur = imported.facts.blur; blur && blur->doubled) {
      imported.facts.warnings.push_back(describe(*blur->doubled));
      log(LogLevel::kWarning, imported.facts.warnings.back());
    }
    DUBSAR_ASSIGN(found, find_surface(options, imported, half, run));
    plan.run.vertices = static_cast<double>(found.sampled.samples.offsets.size());
    return check_fits(plan.run, plan.room, RunStage::kMesh);
  }

  Result<void> settle_model() {
    SettleOptions settling = options.settle;
    settling.curvature = options.curvature;
    SurfaceModel model = assemble(std::move(found.frame), std::move(found.sampled.samples), std::move(smoothed.mesh),
                                  std::move(smoothed.attributes));
    return keep(settled, settle(std::move(model), settling, run));
  }

  /// How much of the surface is contact is known now. Where there is no room to trace it, it stays as smooth as
  /// patches.
  Result<void> close_contact() {
    SurfaceModel& model = separated.model;
    if (separated.segment.nested && !separated.segment.enclosure_refused) {
      std::optional<std::string> smooth;
      if (options.contact) {
        plan.run.patches = static_cast<double>(patch_triangles(model));
        if (const Result<void> fits = check_fits(plan.run, plan.room, RunStage::kContact); !fits) {
          smooth = fits.error().message;
          log_warning("contact: as smooth as patches, since {}", *smooth);
        }
      } else {
        smooth = "nobody asked for it";
      }
      SettleOptions settling = options.settle;
      settling.curvature = options.curvature;
      DUBSAR_ASSIGN(ClosedModel closed,
                    dubsar::close_contact(std::move(model),
                                          {smooth, options.contact.value_or(ContactRules{}), settling}, imported, run));
      model = std::move(closed.model);
      contact = std::move(closed.contact);
    }
    if (!model.labelled && !model.patches.empty()) {  // parts that touch elsewhere, which labels do not close
      model.patches.clear();
      DUBSAR_TRY(measure_partitions(model));
    }
    separated.holes->triangles = patch_triangles(model);
    return {};
  }

  Result<void> light() {
    OcclusionOptions light = *options.occlusion;
    if (light.engine == OcclusionEngine::kBricks) {
      light.shared_by = std::min(light.rays, sharers_of_rays(plan.run.half, plan.run.vertices));
      if (light.shared_by > 1) light.most_cells = kCellsToShare;
    }
    return keep(separated.model, shade(std::move(separated.model), light, run));
  }

  Result<void> perform(RunStage stage) {
    const Budget& budget = options.import.budget;
    switch (stage) {  // clang-format off
      case RunStage::kImport: return {};  // import()
      case RunStage::kRays:
        DUBSAR_TRY(keep(imported.facts.rays, straighten_rays(imported, plan.run, plan.room, budget, run)));
        return take_holder_off(imported, budget, run);
      case RunStage::kDenoise:
        return keep(half, denoise(std::move(imported.grid), kHalvedGrid, options.denoise, imported.estimate, run));
      case RunStage::kSurface: return find();
      case RunStage::kMesh:
        DUBSAR_TRY(keep(smoothed.mesh, mesh_of_samples(found.sampled.samples, found.threshold.value, run)));
        smoothed.mesh.embedded = true;
        return {};
      case RunStage::kSmooth:
        return keep(smoothed, smooth_and_measure(std::move(smoothed.mesh), options.smooth, options.curvature, run));
      case RunStage::kSettle: return settle_model();
      case RunStage::kParts:
        return keep(separated, separate(std::move(settled.model), options.segment, options.fill_holes, run));
      case RunStage::kContact: return close_contact();
      case RunStage::kLight: return light();
      case RunStage::kCheck: return keep(product, check_product(separated.model, run));
      case RunStage::kWrite: return {};  // write_product()
    }  // clang-format on
    return {};
  }
};

Result<PipelineResult> run_stages(const PipelineOptions& options, Progress& progress) {
  StageClock clock;
  DUBSAR_ASSIGN(std::unique_ptr<ImportedVolume> scan, open_volume(options.import));
  Run run{options, {clock, progress}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  DUBSAR_ASSIGN(run.plan, fit_run(*scan, wanted_shape(options), options.detail, options.import.budget, run.run));
  if (options.detail == Detail::kAuto)
    log_info("detail {}: {}", name_in(kDetails, run.plan.detail.detail), run.plan.detail.why);
  DUBSAR_TRY(run.import(std::move(scan)));
  for (const StagePlan& stage : kRunPlan) {
    if (!stage.wanted(run.plan.run)) continue;
    if (stage.stage > RunStage::kContact) run.close_scan();
    keep_below_limit();
    DUBSAR_TRY(run.perform(stage.stage));
  }
  PipelineResult result{std::move(run.separated.model), {}, std::move(run.product.mesh)};
  result.report = make_report({run.imported, run.found.steps, run.found.threshold, run.found.sampled, run.found.band,
                               run.smoothed, run.settled, run.separated, run.contact, run.product.check},
                              result.model, clock);
  result.model.provenance = dump_json(provenance_json(result.report, options));
  return result;
}

}  // namespace

Result<PipelineResult> run_pipeline(const PipelineOptions& options, Progress& progress) {
  PipelineOptions watched = options;
  watched.import.same_files = std::make_shared<std::vector<FileIdentity>>();
  Result<PipelineResult> result = run_stages(watched, progress);
  // What a scan that changes is found to be, also damaged, is no finding about it.
  if (result || result.error().kind != ErrorKind::kCancelled) DUBSAR_TRY(check_unchanged(*watched.import.same_files));
  return result;
}

Result<void> write_product(const std::string& path, PipelineResult& result, Progress& progress) {
  StageClock clock;
  return_free_memory();
  clock.start("write", "byte");
  DUBSAR_ASSIGN(result.report.exa, write_exa(path, result.model, progress));
  clock.finish(static_cast<std::int64_t>(result.report.exa.bytes));
  result.report.stages.push_back(clock.records().back());
  return {};
}

}  // namespace dubsar
