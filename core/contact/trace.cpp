#include "core/contact/trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "core/base/system/log.h"
#include "core/contact/band.h"
#include "core/contact/clay_cavities.h"
#include "core/contact/clay_sides.h"
#include "core/contact/clays.h"
#include "core/contact/dips.h"
#include "core/contact/interface_mesh.h"
#include "core/contact/interface_rest.h"
#include "core/contact/interface_shape.h"
#include "core/contact/kept_shape.h"
#include "core/contact/labelled/labelled_contact.h"
#include "core/contact/pockets.h"
#include "core/contact/recentre.h"
#include "core/extract/triangulate.h"
#include "core/mesh/evidence.h"
#include "core/parts/border_check.h"
#include "core/parts/fill/holes.h"
#include "core/parts/untangle.h"

namespace dubsar {
namespace {

constexpr float kSpacing = 0.7f;  ///< of samples of the patches, grid steps
/// Farthest that inferred contact is moved from the cut: staircases of the cut go, nothing runs through anything else.
constexpr float kMostMove = 1.5f;
constexpr int kMostAttempts = 8;  ///< to get round places where the contact would not close the parts
constexpr int kMostCrossed = 5;   ///< of those, to get round places where it would run through the surface

/// What tracing changes in a model.
struct Labels {
  std::vector<PartitionId> quads;
  PartitionTable table;
  std::vector<FillPatch> patches;
  std::vector<std::uint8_t> evidence;
};
Labels labels_of(const SurfaceModel& model) {
  return {model.quad_partition, model.partitions, model.patches, model.attributes.evidence};
}
void restore(const Labels& labels, SurfaceModel& model) {
  model.quad_partition = labels.quads;
  model.partitions = labels.table;
  model.patches = labels.patches;
  model.attributes.evidence = labels.evidence;
}

/// The attempt before.
struct LastAttempt {
  KeptShape shape;
  std::vector<glm::vec3> aside{};  ///< where the sides differ from those that it had
};

struct Traced {
  const ContactBand& band;
  const BandDensity& density;
  const Dips& dips;
  const EdgeIndex& index;
  const FaceGraph& graph;
  const Triangulation& surface;
  std::vector<BandFace> faces{};
  std::vector<ClayCavity> pores{};
  std::vector<SurfaceHint> hints{};
  std::vector<float> votes{};
  std::vector<ClaySide> side{};
  std::optional<ClayContrast> clays{};
  std::optional<LastAttempt> last{};
};

/// The contact between the sides, as the grid gives it: its vertices have not moved yet.
struct Laid {
  InterfaceMesh mesh;
  std::vector<FillPatch> others;  ///< patches beside it
  std::int64_t pockets = 0;
  std::vector<glm::vec3> open;  ///< middles of the edges at which tablet or envelope are not closed
};

FillPatch contact_patch(const SurfaceModel& model, InterfaceMesh mesh, std::vector<std::uint8_t> evidence) {
  FillPatch patch;
  patch.partition = model.partitions.find(PartitionKind::kTablet)->id;
  patch.reverse_partition = model.partitions.find(PartitionKind::kEnvelopeInside)->id;
  patch.extra_positions = std::move(mesh.added);
  patch.triangles = std::move(mesh.triangles);
  patch.evidence = std::move(evidence);
  return patch;
}

/// Moves the labels of faces beside the contact and puts it between the sides.
Result<Laid> lay_contact(SurfaceModel& model, const Traced& traced, Progress& progress) {
  Laid laid;
  laid.pockets = relabel_faces(model, traced.graph, traced.faces, traced.side);
  laid.mesh = make_interface(model, traced.index, traced.band, traced.side, traced.dips);
  DUBSAR_ASSIGN(const std::int64_t rest_loops, close_rest(model, traced.graph, laid.mesh, progress));
  part_shared_edges(model, laid.mesh);
  part_fans(static_cast<std::uint32_t>(model.mesh.positions.size()), laid.mesh);
  model.patches.clear();
  model.patches.push_back(contact_patch(model, laid.mesh, {}));
  HoleOptions beside;
  beside.keep_patches = true;
  beside.measure = false;
  DUBSAR_ASSIGN(const HoleReport holes, fill_holes(model, traced.graph, beside, progress));
  laid.others.assign(model.patches.begin() + 1, model.patches.end());
  log_debug("contact: {} points, {} pockets, {} loops closed, {} holes left", traced.band.nodes.size(), laid.pockets,
            rest_loops, holes.loops);
  const std::array<PartitionId, 2> bodies{
      model.partitions.body_of(model.partitions.find(PartitionKind::kTablet)->id),
      model.partitions.body_of(model.partitions.find(PartitionKind::kEnvelopeInside)->id)};
  laid.open = open_borders(model, traced.surface, bodies);
  return laid;
}

/// Moves its vertices to where the scan shows it and stores it in the model.
Result<void> shape_contact(SurfaceModel& model, const Laid& laid, Traced& traced, const ContactOptions& options,
                           ContactReport& report, Progress& progress) {
  InterfaceMesh mesh = laid.mesh;
  KeptShape::Known known;
  std::span<const glm::vec3> aside;
  if (traced.last) {
    known = traced.last->shape.shape(mesh);
    aside = traced.last->aside;
  } else {
    known.evidence = shape_interface(mesh, model.mesh.positions, traced.density,
                                     {options.film_margin, kMostMove, options.blur_variance, traced.clays,
                                      traced.dips.deviation, traced.dips.plain, options.rules});
  }
  report.traced = true;
  report.pockets = laid.pockets;
  report.film_vertices = std::count(known.evidence.begin(), known.evidence.end(), evidence_byte(Evidence::kFilm));
  report.inferred_vertices = static_cast<std::int64_t>(known.evidence.size()) - report.film_vertices;
  log_debug("contact: {} film and {} inferred vertices", report.film_vertices, report.inferred_vertices);
  model.patches = laid.others;
  model.patches.insert(model.patches.begin(), contact_patch(model, std::move(mesh), std::move(known.evidence)));
  DUBSAR_ASSIGN(report.patches,
                untangle_patches(
                    model, options.step, progress,
                    {.surface = &traced.surface, .home = laid.mesh.added, .settled = known.settled, .aside = aside}));
  std::vector<PatchSplit>& splits = report.patches.splits;
  splits.insert(splits.begin(), known.splits.begin(), known.splits.end());
  return {};
}

/// All clay within some steps of the places gets one side, that of most of it: the contact goes round them. Round those
/// that were near places of attempts `before` it goes farther.
void step_aside(const ContactBand& band, const std::vector<glm::vec3>& places,
                const std::vector<std::vector<glm::vec3>>& before, std::vector<ClaySide>& side) {
  constexpr float kAgain = 6.0f;
  for (const glm::vec3& place : places) {
    const auto was_near = [&](const std::vector<glm::vec3>& earlier) {
      return std::any_of(earlier.begin(), earlier.end(),
                         [&](const glm::vec3& p) { return glm::distance(p, place) < kAgain; });
    };
    const int reach = 2 + static_cast<int>(std::count_if(before.begin(), before.end(), was_near));
    const glm::ivec3 middle(glm::round(place));
    std::vector<std::uint32_t> near;
    std::int64_t tablet = 0;
    for (int z = -reach; z <= reach; ++z)
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
          if (x * x + y * y + z * z > reach * reach) continue;
          const std::uint32_t n = band.at(middle + glm::ivec3(x, y, z));
          if (n == ContactBand::kNone) continue;
          near.push_back(n);
          tablet += side[n] == ClaySide::kTablet;
        }
    const bool to_tablet = 2 * tablet >= static_cast<std::int64_t>(near.size());
    for (const std::uint32_t n : near) side[n] = to_tablet ? ClaySide::kTablet : ClaySide::kEnvelope;
  }
}

/// Until tablet and envelope are closed and nothing runs through anything else, or at least closed, or not at all.
Result<void> trace_until_closed(SurfaceModel& model, Traced traced, const ContactOptions& options,
                                ContactReport& report, Progress& progress) {
  const Labels before = labels_of(model);
  struct Closed {
    Labels labels;
    ContactReport report;
  };
  int crossed = 0;
  std::optional<Closed> best;
  std::vector<std::vector<glm::vec3>> tried;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    DUBSAR_ASSIGN(const Laid laid, lay_contact(model, traced, progress));
    std::vector<glm::vec3> places = laid.open;
    if (places.empty()) {
      DUBSAR_TRY(shape_contact(model, laid, traced, options, report, progress));
      places = report.patches.left;
      if (places.empty()) return measure_partitions(model);
      if (!best || best->report.patches.left.size() > places.size()) best = Closed{labels_of(model), report};
      if (++crossed == kMostCrossed) break;
      const FillPatch& contact = model.patches.front();
      traced.last.emplace(
          LastAttempt{KeptShape(laid.mesh.added, contact.extra_positions, contact.evidence,
                                static_cast<std::uint32_t>(model.mesh.positions.size()), report.patches.splits)});
    }
    restore(before, model);
    if (places.empty()) break;
    if (traced.last) traced.last->aside.insert(traced.last->aside.end(), places.begin(), places.end());
    step_aside(traced.band, places, tried, traced.side);
    tried.push_back(std::move(places));
    keep_whole(traced.band, traced.pores, traced.side);
    unpinch_sides(traced.band, traced.side);
  }
  if (best) {
    restore(best->labels, model);
    report = best->report;
    log_info("contact: closed, but {} pairs of triangles of patches cross others", report.patches.left.size());
    return measure_partitions(model);
  }
  restore(before, model);
  report.why = "the traced contact does not close tablet and envelope";
  log_info("contact: {}; the smooth patches stay", report.why);
  return {};
}

/// One mesh of labelled points instead.
Result<void> trace_labels(SurfaceModel& model, Traced& traced, const ContactOptions& options, ContactReport& report,
                          Progress& progress) {
  DUBSAR_ASSIGN(LabelledContact labelled,
                lay_labelled_contact(model,
                                     {.band = traced.band,
                                      .density = traced.density,
                                      .dips = traced.dips,
                                      .index = traced.index,
                                      .graph = traced.graph,
                                      .faces = traced.faces,
                                      .pores = traced.pores,
                                      .side = traced.side,
                                      .shape = {options.film_margin, kMostMove, options.blur_variance, traced.clays,
                                                traced.dips.deviation, traced.dips.plain, options.rules}},
                                     progress));
  report.traced = true;
  report.pockets = labelled.pockets;
  report.film_vertices = labelled.film_vertices;
  report.inferred_vertices = labelled.inferred_vertices;
  report.labelled = std::move(labelled.mesh);
  return {};
}

/// What is `known` of the density, where that is enough.
Result<BandDensity> density_of(const ContactBand& band, std::optional<BandDensity> known, SlabSource& density,
                               Progress& progress) {
  if (known && known->covers(band)) return std::move(*known);
  return BandDensity::read(band, density, progress);
}

}  // namespace

Result<ContactReport> trace_contact(SurfaceModel& model, SlabSource& density, const ContactOptions& options,
                                    Progress& progress) {
  ContactReport report;
  if (model.partitions.find(PartitionKind::kTablet) == nullptr ||
      model.partitions.find(PartitionKind::kEnvelopeInside) == nullptr) {
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
  DUBSAR_ASSIGN(const BandDensity values, density_of(band, std::move(recentred.density), density, progress));
  std::optional<ClayContrast> clays = compare_clays(band, model.samples.signs, values, options.blur_variance);
  if (clays && std::abs(clays->step()) < options.least_clay_step) clays.reset();
  if (!clays) band.trim_envelope(options.out_reach);
  report.points = static_cast<std::int64_t>(band.nodes.size());
  DUBSAR_ASSIGN(Dips dips, find_dips(band, model.samples.signs, values, progress));
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(model.samples));
  DUBSAR_ASSIGN(const FaceGraph graph, FaceGraph::build(model.mesh, progress));
  const Triangulation surface = triangulate(model.mesh, model.attributes.normals, 0, FacePoints::kNone);
  Traced traced{.band = band, .density = values, .dips = dips, .index = index, .graph = graph, .surface = surface};
  traced.faces = faces_of_band(model, index, band);
  traced.clays = clays;
  report.clays_differ = traced.clays.has_value();
  if (traced.clays) {
    dips.density.clear();  // it is least in the lighter clay, not between them
    traced.votes = clay_votes(band, model.samples.signs, values, *traced.clays);
    log_info("contact: the envelope's clay has {:.1f} % of the density of the tablet's",
             100.0f * traced.clays->envelope / traced.clays->tablet);
  }
  traced.pores = cavities_off_contact(model, graph, band, traced.faces);
  if (options.rules.has(ContactRule::kFringes)) blind_fringes(band, traced.pores, dips);
  traced.hints = hints_of_faces(model, band, traced.faces, traced.pores);
  DUBSAR_ASSIGN(traced.side, ClayDivision({band, dips, traced.hints, traced.votes, traced.pores}).sides(progress));
  if (progress.cancelled()) return cancelled_error();
  if (options.mesh == ContactMesh::kLabels) {
    DUBSAR_TRY(trace_labels(model, traced, options, report, progress));
  } else {
    DUBSAR_TRY(trace_until_closed(model, std::move(traced), options, report, progress));
  }
  progress.end();
  return report;
}

}  // namespace dubsar
