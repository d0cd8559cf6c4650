#include "core/pipeline/pipeline.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/system/budget.h"
#include "core/base/text/json_text.h"
#include "core/exa/exa_file.h"
#include "core/pipeline/forecast.h"
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
    SlabSource& scan = imported.straightened ? static_cast<SlabSource&>(*imported.straightened) : *imported.scan;
    DUBSAR_ASSIGN(RefinedSurface refined,
                  refine(scan, half.grid, estimates.sigma,
                         {options.denoise, imported.estimate, options.threshold, options.sample, imported.facts.blur},
                         options.import.budget, run));
    found.sampled = std::move(refined.sampled);
    found.threshold = std::move(refined.threshold);
    found.band = refined.band;
    found.steps.insert(found.steps.end(), refined.steps.begin(), refined.steps.end());
  }
  imported.scan.reset();
  return found;
}

Result<PipelineResult> run_stages(const PipelineOptions& options, Progress& progress) {
  StageClock clock;
  const StageRun run{clock, progress};
  DUBSAR_TRY(check_room(options.import, options.detail, run));
  DUBSAR_ASSIGN(ImportedGrid imported, import_grid(options.import, options.detail, options.estimate, run));
  if (options.artefacts == Artefacts::kAuto) {
    DUBSAR_ASSIGN(imported.facts.rays, straighten_rays(imported, options.import.budget, run));
  }
  DUBSAR_ASSIGN(DenoisedGrid denoised,
                denoise(std::move(imported.grid), kHalvedGrid, options.denoise, imported.estimate, run));
  DUBSAR_ASSIGN(FoundSurface found, find_surface(options, imported, denoised, run));
  SampledSurface& sampled = found.sampled;

  DUBSAR_TRY(check_memory(
      fmt::format("the surface of {:.1f} million vertices", static_cast<double>(sampled.samples.offsets.size()) * 1e-6),
      static_cast<std::uint64_t>(kSurfaceBytesPerVertex * static_cast<double>(sampled.samples.offsets.size()))));
  DUBSAR_ASSIGN(QuadMesh mesh, mesh_of_samples(sampled.samples, found.threshold.value, run));
  DUBSAR_ASSIGN(SmoothedMesh smoothed, smooth_and_measure(std::move(mesh), options.smooth, options.curvature, run));
  SettleOptions settling = options.settle;
  settling.curvature = options.curvature;
  DUBSAR_ASSIGN(SettledModel settled, settle(assemble(std::move(found.frame), std::move(sampled.samples),
                                                      std::move(smoothed.mesh), std::move(smoothed.attributes)),
                                             settling, options.exa_profile, run));
  DUBSAR_ASSIGN(SeparatedModel separated, separate(std::move(settled.model), options.segment, options.fill_holes, run));
  PipelineResult result{std::move(separated.model), {}, {}};
  std::optional<ContactReport> contact;
  if (options.fill_holes && options.trace_contact && separated.segment.nested && !separated.segment.enclosure_refused) {
    DUBSAR_ASSIGN(TracedModel traced, trace(std::move(result.model), options.import, imported, run));
    result.model = std::move(traced.model);
    contact = traced.contact;
  }
  imported.straightened.reset();
  std::optional<UntangleReport> patches;
  if (contact && contact->traced) {
    patches = contact->patches;
  } else if (options.fill_holes) {
    DUBSAR_ASSIGN(UntangledModel untangled, untangle(std::move(result.model), run));
    result.model = std::move(untangled.model);
    patches = untangled.patches;
  }
  if (separated.holes) {
    separated.holes->triangles = 0;
    for (const FillPatch& patch : result.model.patches)
      separated.holes->triangles += static_cast<std::int64_t>(patch.triangles.size());
  }
  if (options.occlusion) {
    OcclusionOptions light = *options.occlusion;
    if (light.engine == OcclusionEngine::kBricks) {
      light.shared_by = std::min(light.rays, sharers_of_rays(imported.detail.detail, result.model.mesh.vertex_count()));
      if (light.shared_by > 1) light.most_cells = kCellsToShare;
    }
    DUBSAR_ASSIGN(result.model, shade(std::move(result.model), light, run));
  }
  DUBSAR_ASSIGN(CheckedProduct product, check_product(result.model, run));
  result.mesh = std::move(product.mesh);
  result.report = make_report({imported, found.steps, found.threshold, sampled, found.band, smoothed, settled,
                               separated, contact, patches, product.check},
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

Result<void> write_product(const std::string& path, PipelineResult& result, ExaProfile profile, Progress& progress) {
  StageClock clock;
  clock.start("write", "byte");
  DUBSAR_ASSIGN(result.report.exa, write_exa(path, result.model, progress, profile));
  clock.finish(static_cast<std::int64_t>(result.report.exa.bytes));
  result.report.stages.push_back(clock.records().back());
  return {};
}

}  // namespace dubsar
