#include "core/pipeline/contact_stage.h"

#include "core/exa/patches/patches.h"
#include "core/filter/resample.h"

namespace dubsar {

Result<TracedModel> trace(SurfaceModel model, const ImportOptions& scan, const ImportedGrid& imported, StageRun run) {
  TracedModel traced{std::move(model), {}};
  run.clock.start("contact", "point");
  ImportOptions again = scan;
  again.unmeasured = imported.facts.unmeasured;
  DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> volume, open_volume(again));
  ContactOptions options;
  if (imported.facts.blur) options.blur_variance = static_cast<float>(imported.facts.blur->variance);
  std::optional<HalfResolutionSource> halved;
  if (imported.detail.resample()) halved.emplace(*volume);
  options.halve_first = !halved;
  SlabSource& density = halved ? static_cast<SlabSource&>(*halved) : *volume;
  DUBSAR_ASSIGN(traced.contact, trace_contact(traced.model, density, options, run.progress));
  if (traced.contact.traced) settle_patches(traced.model.patches, traced.model.mesh.vertex_count());
  run.clock.finish(traced.contact.points);
  return traced;
}

}  // namespace dubsar
