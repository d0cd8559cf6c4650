#include "core/contact/trace.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "core/contact/band.h"
#include "core/contact/clay_cavities.h"
#include "core/contact/clay_sides.h"
#include "core/contact/clays.h"
#include "core/contact/dips.h"
#include "core/contact/labelled/clay_labels.h"
#include "core/contact/labelled/labelled_contact.h"
#include "core/contact/pockets.h"
#include "core/contact/recentre.h"

namespace dubsar {
namespace {

constexpr float kSpacing = 1.0f;  ///< of samples of the patches, grid steps
/// Farthest that inferred contact is moved from the cut: staircases of the cut go, nothing runs through anything else.
constexpr float kMostMove = 1.5f;
/// Of the band where only the patches are asked: beyond the faces at their rim that vote (pockets.cpp).
constexpr float kPatchBand = 4.0f;
/// What being on the patches' other side costs there, faces of the cut: as much as its surface.
constexpr float kPatchVote = 1.0f;

bool is_tablet_in_envelope(const SurfaceModel& model) {
  return model.partitions.find(PartitionKind::kTablet) != nullptr &&
         model.partitions.find(PartitionKind::kEnvelopeInside) != nullptr;
}

/// The surface beside a band.
struct SurfaceBeside {
  EdgeIndex index;
  std::vector<BandFace> faces;
  RestPieces rest;
  std::vector<ClayCavity> pores;
  ClayBeyond beyond;

  static Result<SurfaceBeside> find(const SurfaceModel& model, const ContactBand& band,
                                    const std::vector<float>& strength) {
    DUBSAR_ASSIGN(EdgeIndex index, EdgeIndex::create(model.samples));
    std::vector<BandFace> faces = faces_of_band(model, index, band);
    RestPieces rest = rest_pieces(model, faces);
    std::vector<ClayCavity> pores = cavities_off_contact(rest, band, faces, strength);
    return SurfaceBeside{std::move(index), std::move(faces), std::move(rest), std::move(pores),
                         ClayBeyond(model.samples.signs, band)};
  }
};

Result<std::vector<ClaySide>> divide(const SurfaceModel& model, const ContactBand& band, const Dips& dips,
                                     const SurfaceBeside& beside, const std::vector<float>& votes, Progress& progress) {
  const std::vector<SurfaceHint> hints = hints_of_faces(model, band, beside.faces, beside.pores);
  DUBSAR_ASSIGN(std::vector<ClaySide> side, ClayDivision({band, dips, hints, votes, beside.pores}).sides(progress));
  if (progress.cancelled()) return cancelled_error();
  return side;
}

DividedClay divided(const ContactBand& band, const Dips& dips, const SurfaceBeside& beside,
                    const std::vector<ClaySide>& side) {
  return {.band = band,
          .beyond = beside.beyond,
          .dips = dips,
          .index = beside.index,
          .faces = beside.faces,
          .rest = beside.rest,
          .pores = beside.pores,
          .side = side};
}

Result<void> lay(SurfaceModel& model, const DividedClay& clay, const ContactSheet& sheet, ContactReport& report,
                 Progress& progress) {
  DUBSAR_ASSIGN(LabelledContact labelled, lay_labelled_contact(model, clay, sheet, progress));
  report.pockets = labelled.pockets;
  report.film_vertices = labelled.film_vertices;
  report.inferred_vertices = labelled.inferred_vertices;
  report.labelled = std::move(labelled.mesh);
  progress.end();
  return {};
}

}  // namespace

Result<ContactReport> trace_contact(SurfaceModel& model, SlabSource& density, const ContactOptions& options,
                                    Progress& progress) {
  ContactReport report;
  if (!is_tablet_in_envelope(model)) {
    report.why = "no tablet in an envelope";
    return report;
  }
  std::vector<PatchPoint> samples = sample_patches(model, kSpacing);
  if (samples.empty()) {
    report.why = "tablet and envelope do not touch";
    return report;
  }
  progress.begin("contact", 0, "step");
  const auto recentre = options.halve_first ? recentre_samples_at_half : recentre_samples;
  DUBSAR_ASSIGN(Recentred recentred, recentre(samples, model.samples.signs, density, progress, options.rules));
  log_debug("contact: looked for up to {:.1f} steps from the smooth patch", recentred.longest);
  DUBSAR_ASSIGN(ContactBand band, ContactBand::make(model.samples.signs, std::move(samples), options.reach, progress));
  BandDensity values = std::move(recentred.density);
  DUBSAR_TRY(values.follow(band, density, progress, {}));
  values.low_pass(band);
  std::optional<ClayContrast> clays = compare_clays(band, model.samples.signs, values, options.blur_variance);
  if (clays && std::abs(clays->step()) < options.least_clay_step) clays.reset();
  if (!clays) band.trim_envelope(options.out_reach);
  report.points = static_cast<std::int64_t>(band.nodes.size());
  DUBSAR_ASSIGN(Dips dips, find_dips(band, model.samples.signs, values, progress, options.least_deviation));
  values.drop_raw();
  DUBSAR_ASSIGN(const SurfaceBeside beside, SurfaceBeside::find(model, band, dips.strength));
  report.clays_differ = clays.has_value();
  std::vector<float> votes;
  if (clays) {
    dips.density.clear();  // it is least in the lighter clay, not between them
    votes = clay_votes(band, model.samples.signs, values, *clays);
    log_info("contact: the envelope's clay has {:.1f} % of the density of the tablet's",
             100.0f * clays->envelope / clays->tablet);
  }
  keep_below_limit();  // of all steps the next holds the most, and leaves the most pieces behind
  DUBSAR_ASSIGN(const std::vector<ClaySide> side, divide(model, band, dips, beside, votes, progress));
  keep_below_limit();
  const DividedClay clay = divided(band, dips, beside, side);
  DUBSAR_ASSIGN(
      const ContactSheet sheet,
      sheet_of_cut(model, clay, values,
                   {kMostMove, options.blur_variance, clays, dips.deviation, dips.plain, options.rules}, progress));
  values = {};
  DUBSAR_TRY(lay(model, clay, sheet, report, progress));
  report.traced = true;
  return report;
}

Result<ContactReport> follow_patches(SurfaceModel& model, Progress& progress) {
  ContactReport report;
  std::vector<PatchPoint> samples;
  if (is_tablet_in_envelope(model)) samples = sample_patches(model, kSpacing);
  if (samples.empty()) return report;
  progress.begin("contact", 0, "step");
  DUBSAR_ASSIGN(const ContactBand band,
                ContactBand::make(model.samples.signs, std::move(samples), kPatchBand, progress));
  report.points = static_cast<std::int64_t>(band.nodes.size());
  Dips nothing;
  nothing.strength.assign(band.nodes.size(), 0.0f);
  DUBSAR_ASSIGN(const SurfaceBeside beside, SurfaceBeside::find(model, band, nothing.strength));
  std::vector<float> votes(band.nodes.size(), 0.0f);
  for (std::size_t n = 0; n < votes.size(); ++n)
    if (!band.samples[band.nodes[n].sample].at_rim)
      votes[n] = kPatchVote * std::clamp(-band.nodes[n].height, -1.0f, 1.0f);
  DUBSAR_ASSIGN(const std::vector<ClaySide> side, divide(model, band, nothing, beside, votes, progress));
  DUBSAR_TRY(lay(model, divided(band, nothing, beside, side), sheet_of_patches(model), report, progress));
  return report;
}

}  // namespace dubsar
