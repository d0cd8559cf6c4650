#include "core/pipeline/contact_stage.h"

#include <iterator>
#include <vector>

#include "core/base/system/log.h"
#include "core/exa/offsets/settle_labelled.h"
#include "core/exa/patches/patches.h"
#include "core/filter/resample.h"
#include "core/parts/fill/holes.h"

namespace dubsar {
namespace {

/// Standard deviations of clay that straightening leaves: less is no difference of two clays.
constexpr double kUnevenClay = 2.0;

/// Membranes across the cracks of the envelope, between its outside and its inside, which close each alone: patches
/// behind the contact.
Result<void> lay_membranes(SurfaceModel& model, Progress& progress) {
  const bool embedded = model.mesh.embedded;
  HoleOptions beside;
  beside.keep_patches = true;
  beside.measure = false;
  DUBSAR_TRY(fill_holes(model, beside, progress));
  model.mesh.embedded = embedded;
  if (model.patches.size() == 1) return {};
  std::vector<FillPatch> membranes(std::make_move_iterator(model.patches.begin() + 1),
                                   std::make_move_iterator(model.patches.end()));
  settle_patches(membranes, model.mesh.vertex_count());
  model.patches.resize(1);
  model.patches.insert(model.patches.end(), std::make_move_iterator(membranes.begin()),
                       std::make_move_iterator(membranes.end()));
  return measure_partitions(model);
}

}  // namespace

Result<TracedModel> trace(SurfaceModel model, ContactMesh mesh, const SettleOptions& settling, ImportedGrid& imported,
                          StageRun run) {
  TracedModel traced{std::move(model), {}};
  run.clock.start("contact", "point");
  ContactOptions options;
  options.mesh = mesh;
  if (imported.facts.blur) options.blur_variance = static_cast<float>(imported.facts.blur->variance);
  options.halve_first = !imported.detail.resample();
  if (const auto& rays = imported.facts.rays; rays && rays->straightened)
    options.least_clay_step = static_cast<float>(kUnevenClay * rays->bent->after.clay * rays->bent->levels.contrast());
  HalfResolutionSource halved(imported.unbent());
  SlabSource& density = imported.straightened        ? static_cast<SlabSource&>(*imported.straightened)
                        : imported.detail.resample() ? static_cast<SlabSource&>(halved)
                                                     : imported.unbent();
  DUBSAR_ASSIGN(traced.contact, trace_contact(traced.model, density, options, run.progress));
  if (traced.contact.labelled) {
    DUBSAR_ASSIGN(const LabelledSettling settled,
                  settle_labelled(traced.model, std::move(*traced.contact.labelled), settling.curvature,
                                  settling.exact_normals, run.progress));
    traced.contact.labelled.reset();
    DUBSAR_TRY(lay_membranes(traced.model, run.progress));
    log_debug("contact: {} vertices escape, polygons touched at {} cells, and do at {}", settled.escaped,
              settled.touching, settled.left);
    traced.contact.patches.crossings = settled.left;
  } else if (traced.contact.traced) {
    settle_patches(traced.model.patches, traced.model.mesh.vertex_count());
  }
  run.clock.finish(traced.contact.points);
  return traced;
}

}  // namespace dubsar
