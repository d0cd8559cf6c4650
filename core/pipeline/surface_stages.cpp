#include "core/pipeline/surface_stages.h"

#include "core/base/system/log.h"
#include "core/exa/values/attributes.h"
#include "core/extract/extract.h"
#include "core/parts/enclosure.h"
#include "core/pipeline/model_occlusion.h"
#include "core/relief/curvature/shape_class.h"

namespace dubsar {

Result<QuadMesh> mesh_of_samples(const SurfaceSamples& samples, float threshold, StageRun run) {
  run.clock.start("mesh", "vertex");
  run.progress.begin("mesh", static_cast<std::int64_t>(samples.offsets.size()), "vertex");
  DUBSAR_ASSIGN(QuadMesh mesh, build_quad_mesh(samples, run.progress));
  run.clock.finish(mesh.vertex_count());
  if (mesh.vertex_count() == 0)
    return fail(ErrorKind::kBadData,
                "there is no surface at threshold {:g}: all voxels are on one side; give another threshold", threshold);
  return mesh;
}

Result<SmoothedMesh> smooth_and_measure(QuadMesh mesh, const SmoothOptions& options, CurvatureMethod curvature,
                                        StageRun run) {
  SmoothedMesh smoothed{std::move(mesh), {}, {}};
  VertexAttributes& attributes = smoothed.attributes;
  run.clock.start("smooth", "face iteration");
  DUBSAR_ASSIGN(smoothed.stats, smooth(smoothed.mesh, attributes.normals, options, run.progress));
  run.clock.finish(options.normals.iterations * smoothed.mesh.quad_count());

  run.clock.start("curvature", "vertex");
  DUBSAR_ASSIGN(Curvatures curvatures,
                principal_curvatures(smoothed.mesh, attributes.normals, curvature, run.progress));
  attributes.shape = shape_classes(curvatures.k_min, curvatures.k_max);
  attributes.k_min = std::move(curvatures.k_min);
  attributes.k_max = std::move(curvatures.k_max);
  run.clock.finish(smoothed.mesh.vertex_count());
  return smoothed;
}

Result<SettledModel> settle(SurfaceModel model, const SettleOptions& options, StageRun run) {
  SettledModel settled{std::move(model), {}};
  run.clock.start("settle", "vertex");
  DUBSAR_ASSIGN(settled.stats, settle_for_exa(settled.model, options, run.progress));
  run.clock.finish(settled.model.mesh.vertex_count());
  return settled;
}

Result<SeparatedModel> separate(SurfaceModel model, const SegmentOptions& options, bool fill, StageRun run) {
  SeparatedModel separated{std::move(model), {}, std::nullopt};
  run.clock.start("segment", "face");
  DUBSAR_ASSIGN(const FaceGraph graph, FaceGraph::build(separated.model.mesh, run.progress));
  DUBSAR_ASSIGN(separated.segment, segment(separated.model, graph, options, run.progress));
  run.clock.finish(separated.model.mesh.quad_count());
  run.clock.start("fill_holes", "triangle");
  if (fill) {
    DUBSAR_ASSIGN(separated.holes, fill_holes(separated.model, graph, HoleOptions{}, run.progress));
    if (separated.segment.nested && options.method == SegmentMethod::kNested &&
        !plausible_enclosure(separated.model.partitions)) {
      log_info("segment: the inner body, closed, is not the lump that a tablet is; the bodies stay whole");
      SegmentOptions whole = options;
      whole.method = SegmentMethod::kBodies;
      DUBSAR_ASSIGN(separated.segment, segment(separated.model, graph, whole, run.progress));
      separated.segment.enclosure_refused = true;
      DUBSAR_ASSIGN(separated.holes, fill_holes(separated.model, graph, HoleOptions{}, run.progress));
    }
  } else {
    DUBSAR_TRY(measure_partitions(separated.model));
  }
  run.clock.finish(separated.holes ? separated.holes->triangles : 0);
  return separated;
}

Result<SurfaceModel> shade(SurfaceModel model, const OcclusionOptions& options, StageRun run) {
  run.clock.start("occlusion", "ray");
  DUBSAR_TRY(occlusion_of_model(model, options, run.progress));
  settle_light(model.mesh, model.attributes.ao, run.progress);
  run.clock.finish(model.mesh.vertex_count() * rays_of_vertex(options));
  return model;
}

Result<CheckedProduct> check_product(const SurfaceModel& model, StageRun run) {
  run.clock.start("check", "triangle");
  CheckedProduct product;
  DUBSAR_ASSIGN(product.mesh, make_tri_mesh(model, {.only_evidence = true, .progress = &run.progress}));
  product.check = check_mesh(product.mesh.positions, product.mesh.triangles);
  run.clock.finish(product.check.triangles);
  return product;
}

}  // namespace dubsar
