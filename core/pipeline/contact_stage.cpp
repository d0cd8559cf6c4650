#include "core/pipeline/contact_stage.h"

#include "core/exa/patches/patches.h"

namespace dubsar {

Result<TracedModel> trace(SurfaceModel model, const ImportOptions& scan, const std::optional<EdgeSpread>& blur,
                          StageRun run) {
  TracedModel traced{std::move(model), {}};
  run.clock.start("contact", "point");
  DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> volume, open_volume(scan));
  ContactOptions options;
  if (blur) options.blur_variance = static_cast<float>(blur->variance);
  DUBSAR_ASSIGN(traced.contact, trace_contact(traced.model, *volume, options, run.progress));
  if (traced.contact.traced) settle_patches(traced.model.patches, traced.model.mesh.vertex_count());
  run.clock.finish(traced.contact.points);
  return traced;
}

}  // namespace dubsar
