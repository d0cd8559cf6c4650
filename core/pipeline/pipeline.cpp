#include "core/pipeline/pipeline.h"

#include "core/base/json_text.h"
#include "core/base/log.h"
#include "core/exa/attributes.h"
#include "core/exa/patches.h"
#include "core/extract/extract.h"
#include "core/pipeline/model_occlusion.h"
#include "core/pipeline/report.h"
#include "core/pipeline/volume_stages.h"

namespace dubsar {
namespace {

Result<void> smooth_and_measure(const PipelineOptions& options, PipelineResult& result, StageClock& clock,
                                Progress& progress) {
  SurfaceModel& model = result.model;
  const std::int64_t vertices = model.mesh.vertex_count();
  clock.start("smooth", "face iteration");
  DUBSAR_ASSIGN(result.report.smooth, smooth(model.mesh, model.attributes.normals, options.smooth, progress));
  clock.finish(options.smooth.normals.iterations * model.mesh.quad_count());

  clock.start("curvature", "vertex");
  DUBSAR_ASSIGN(Curvatures curvatures,
                principal_curvatures(model.mesh, model.attributes.normals, options.curvature, progress));
  model.attributes.shape = shape_classes(curvatures.k_min, curvatures.k_max);
  model.attributes.k_min = std::move(curvatures.k_min);
  model.attributes.k_max = std::move(curvatures.k_max);
  clock.finish(vertices);
  return {};
}

SettleOptions settle_options(const PipelineOptions& options) {
  SettleOptions settle = options.settle;
  settle.curvature = options.curvature;
  return settle;
}

Result<void> separate_with(const SegmentOptions& segment_options, bool fill, PipelineResult& result, StageClock& clock,
                           Progress& progress) {
  SurfaceModel& model = result.model;
  clock.start("segment", "face");
  DUBSAR_ASSIGN(result.report.segment, segment(model, segment_options, progress));
  clock.finish(model.mesh.quad_count());
  clock.start("fill_holes", "triangle");
  if (fill) {
    DUBSAR_ASSIGN(result.report.holes, fill_holes(model, HoleOptions{}, progress));
    settle_patches(model.patches, model.mesh.vertex_count());
  } else {
    DUBSAR_TRY(measure_partitions(model));
  }
  clock.finish(result.report.holes ? result.report.holes->triangles : 0);
  return {};
}

Result<void> separate(const PipelineOptions& options, PipelineResult& result, StageClock& clock, Progress& progress) {
  DUBSAR_TRY(separate_with(options.segment, options.fill_holes, result, clock, progress));
  if (options.segment.method != SegmentMethod::kNested || plausible_enclosure(result.model.partitions)) return {};
  log_info("segment: the inner body does not fill a cavity as an enclosed tablet would; the bodies stay whole");
  result.report.enclosure_refused = true;
  SegmentOptions bodies = options.segment;
  bodies.method = SegmentMethod::kBodies;
  const int crack_radius = result.report.segment.crack_radius;
  DUBSAR_TRY(separate_with(bodies, options.fill_holes, result, clock, progress));
  result.report.segment.crack_radius = crack_radius;  // bodies do not look for cracks
  return {};
}

/// The light of each dual vertex, from the triangles of its own part.
Result<void> add_occlusion(const PipelineOptions& options, PipelineResult& result, StageClock& clock,
                           Progress& progress) {
  if (!options.occlusion) return {};
  SurfaceModel& model = result.model;
  const std::int64_t rays = model.mesh.vertex_count() * options.occlusion_options.rays;
  clock.start("occlusion", "ray");
  DUBSAR_TRY(occlusion_of_model(model, options.occlusion_options, progress));
  settle_light(model.mesh, model.attributes.ao, progress);
  clock.finish(rays);
  return {};
}

Result<void> check(PipelineResult& result, StageClock& clock) {
  PipelineReport& report = result.report;
  clock.start("check", "triangle");
  DUBSAR_ASSIGN(const TriMesh mesh, make_tri_mesh(result.model));
  report.mesh = check_mesh(mesh.positions, mesh.triangles);
  clock.finish(report.mesh.triangles);
  report.partitions = result.model.partitions;
  report.vertices = result.model.mesh.vertex_count();
  report.xquads = result.model.mesh.quad_count();
  return {};
}

}  // namespace

Result<PipelineResult> run_pipeline(const PipelineOptions& options, Progress& progress) {
  PipelineResult result;
  StageClock clock;
  SurfaceModel& model = result.model;
  DUBSAR_ASSIGN(model.samples, run_volume_stages(options, result.report, model.frame, clock, progress));

  clock.start("mesh", "vertex");
  progress.begin("mesh", static_cast<std::int64_t>(model.samples.offsets.size()), "vertex");
  DUBSAR_ASSIGN(model.mesh, build_quad_mesh(model.samples, progress));
  clock.finish(model.mesh.vertex_count());
  if (model.mesh.vertex_count() == 0)
    return fail(ErrorKind::kBadData,
                "there is no surface at threshold {:g}: all voxels are on one side; give another threshold",
                result.report.threshold);

  DUBSAR_TRY(smooth_and_measure(options, result, clock, progress));
  clock.start("settle", "vertex");  // from here on the model is what the file will hold
  DUBSAR_ASSIGN(result.report.settle, settle_for_exa(model, settle_options(options), progress));
  clock.finish(model.mesh.vertex_count());
  DUBSAR_TRY(separate(options, result, clock, progress));
  DUBSAR_TRY(add_occlusion(options, result, clock, progress));
  DUBSAR_TRY(check(result, clock));
  model.provenance = dump_json(provenance_json(result.report, options));
  result.report.stages = clock.records();
  return result;
}

Result<void> write_product(const std::string& path, PipelineResult& result, Progress& progress) {
  StageClock clock;
  clock.start("write", "byte");
  DUBSAR_ASSIGN(result.report.exa, write_exa(path, result.model, progress));
  clock.finish(static_cast<std::int64_t>(result.report.exa.bytes));
  result.report.stages.push_back(clock.records().back());
  return {};
}

}  // namespace dubsar
