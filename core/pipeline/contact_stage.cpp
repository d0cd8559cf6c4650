#include "core/pipeline/contact_stage.h"

#include "core/base/system/log.h"
#include "core/exa/offsets/settle_labelled.h"
#include "core/exa/patches/patches.h"
#include "core/filter/resample.h"

namespace dubsar {
namespace {

/// Standard deviations of clay that straightening leaves: less is no difference of two clays.
constexpr double kUnevenClay = 2.0;

}  // namespace

Result<TracedModel> trace(SurfaceModel model, ContactMesh mesh, const SettleOptions& settling,
                          ImportedGrid& imported, StageRun run) {
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
