#include "core/pipeline/contact_stage.h"

#include "core/exa/patches.h"
#include "core/filter/resample.h"

namespace dubsar {
namespace {

/// Wedges up to this deep are followed under the contact, grid steps.
constexpr float kReachScan = 12.0f, kReachHalf = 7.0f;

}  // namespace

Result<TracedModel> trace(SurfaceModel model, const ImportOptions& scan, bool resampled, StageRun run) {
  TracedModel traced{std::move(model), {}};
  run.clock.start("contact", "point");
  DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> volume, open_volume(scan));
  ContactOptions options;
  options.reach = resampled ? kReachHalf : kReachScan;
  if (resampled) {
    HalfResolutionSource half(*volume);
    DUBSAR_ASSIGN(traced.contact, trace_contact(traced.model, half, options, run.progress));
  } else {
    DUBSAR_ASSIGN(traced.contact, trace_contact(traced.model, *volume, options, run.progress));
  }
  if (traced.contact.traced) settle_patches(traced.model.patches, traced.model.mesh.vertex_count());
  run.clock.finish(traced.contact.points);
  return traced;
}

}  // namespace dubsar
