#include "core/pipeline/contact_stage.h"

#include <optional>

#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "core/exa/offsets/settle_labelled.h"
#include "core/filter/resample.h"

namespace dubsar {
namespace {

/// Standard deviations of clay that straightening leaves: less is no difference of two clays.
constexpr double kUnevenClay = 2.0;
/// Of the contrast, deviation of dips at the scan's resolution that is taken for at least: that of a scan of 17 dB.
/// Reconstructions make dips of one to six hundredths of the contrast without any film, in the plane of a gap that ends
/// there, along rings, beside edges; a film of a tenth of a voxel makes four. It is half as thick in steps of half the
/// resolution, and so is its dip.
constexpr double kLeastDip = 0.05;

Result<ContactReport> traced_in_scan(SurfaceModel& model, ContactRules rules, ImportedGrid& imported,
                                     Progress& progress) {
  ContactOptions options;
  options.rules = rules;
  if (imported.facts.blur) options.blur_variance = static_cast<float>(imported.facts.blur->variance);
  const Estimates& raw = imported.raw.estimates;
  options.least_deviation =
      static_cast<float>(kLeastDip * (raw.m_hi - raw.m_lo) / (imported.detail.resample() ? 2.0 : 1.0));
  options.halve_first = !imported.detail.resample();
  if (const auto& rays = imported.facts.rays; rays && rays->straightened)
    options.least_clay_step = static_cast<float>(kUnevenClay * rays->bent->after.clay * rays->bent->levels.contrast());
  std::optional<HalfResolutionSource> halved;
  if (imported.detail.resample() && !imported.cleaned_is_half()) halved.emplace(imported.cleaned());
  SlabSource& density = halved ? static_cast<SlabSource&>(*halved) : imported.cleaned();
  return trace_contact(model, density, options, progress);
}

}  // namespace

Result<ClosedModel> close_contact(SurfaceModel model, const ClosingOptions& options, ImportedGrid& imported,
                                  StageRun run) {
  ClosedModel closed{std::move(model), {}};
  ContactReport& contact = closed.contact;
  run.clock.start("contact", "point");
  DUBSAR_ASSIGN(contact, options.smooth ? follow_patches(closed.model, run.progress)
                                        : traced_in_scan(closed.model, options.rules, imported, run.progress));
  if (options.smooth) contact.why = *options.smooth;
  if (contact.labelled) {
    keep_below_limit();
    DUBSAR_ASSIGN(const LabelledSettling settled,
                  settle_labelled(closed.model, std::move(*contact.labelled), options.settle.curvature,
                                  options.settle.exact_normals, run.progress));
    contact.labelled.reset();
    log_debug("contact: {} vertices escape, polygons touched at {} cells, and do at {}", settled.escaped,
              settled.touching, settled.left);
    contact.touching = settled.left;
  }
  run.clock.finish(contact.points);
  return closed;
}

}  // namespace dubsar
