#include "core/exa/offsets/settle_labelled.h"

#include <span>
#include <utility>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/exa/offsets/settle.h"
#include "core/exa/values/exact.h"
#include "core/extract/cell_box.h"
#include "core/extract/extract.h"
#include "core/extract/piece_moves.h"
#include "core/extract/quad_cuts.h"
#include "core/parts/labelled_model.h"
#include "core/relief/curvature/shape_class.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPlaceGrain = 1 << 14;

/// The place that a file can hold of a vertex that wants to be elsewhere.
glm::vec3 held_place(const glm::vec3& from, const glm::vec3& wanted) {
  if (from == wanted) return from;
  const auto k = escape_to(from, kept_in_cell(from, wanted));
  return k ? escaped(from, *k) : from;
}

/// Where the samples alone have the vertices of `labelled`.
Result<std::vector<glm::vec3>> places_of_samples(const SurfaceModel& model, const LabelledMesh& labelled,
                                                 Progress& progress) {
  DUBSAR_ASSIGN(const QuadMesh unlabelled, build_quad_mesh(model.samples, progress));
  std::vector<glm::vec3> places(labelled.first_mixed);
  for (std::uint32_t v = 0; v < labelled.first_mixed; ++v) places[v] = unlabelled.positions[labelled.unlabelled[v]];
  places.insert(places.end(), labelled.extracted.begin(), labelled.extracted.end());
  return places;
}

/// At the few cells where polygons touch, in few surfaces, vertices move to places where they do not.
Result<PieceMoves> part_labelled_pieces(const SurfaceModel& model, LabelledMesh& labelled, QuadCuts& cuts,
                                        Progress& progress) {
  if (cuts.touching.empty()) return PieceMoves{};
  DUBSAR_ASSIGN(const std::vector<glm::vec3> from, places_of_samples(model, labelled, progress));
  const PieceMoves moves = part_pieces(
      labelled.mesh, from, [&](std::uint32_t v, const glm::vec3& wanted) { return held_place(from[v], wanted); });
  cuts = find_cuts(labelled.mesh);
  return moves;
}

}  // namespace

Result<LabelledSettling> settle_labelled(SurfaceModel& model, LabelledMesh labelled, CurvatureMethod curvature,
                                         bool exact_normals, Progress& progress) {
  LabelledSettling report;
  const auto mixed = std::span(labelled.mesh.positions).subspan(labelled.first_mixed);
  if (mixed.size() != labelled.extracted.size())
    return fail(ErrorKind::kInternal, "exa: places of {} vertices of mixed cells found, {} expected",
                labelled.extracted.size(), mixed.size());
  parallel_for(static_cast<std::int64_t>(mixed.size()), kPlaceGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    mixed[v] = held_place(labelled.extracted[v], mixed[v]);
  });
  labelled.mesh.embedded = true;
  QuadCuts cuts = find_cuts(labelled.mesh);
  DUBSAR_ASSIGN(const PieceMoves moves, part_labelled_pieces(model, labelled, cuts, progress));
  report.touching = moves.touching;
  report.left = moves.left;
  for (std::size_t v = 0; v < mixed.size(); ++v) report.escaped += mixed[v] != labelled.extracted[v];
  if (progress.cancelled()) return cancelled_error();
  DUBSAR_TRY(put_labelled_mesh(model, labelled));
  VertexAttributes& attributes = model.attributes;
  if (!exact_normals && !attributes.normals.empty()) {
    DUBSAR_ASSIGN(attributes.normals, recomputed_normals(model.mesh, progress));
    if (!attributes.k_min.empty()) {
      DUBSAR_ASSIGN(Curvatures found, principal_curvatures(model.mesh, attributes.normals, curvature, progress));
      attributes.k_min = std::move(found.k_min);
      attributes.k_max = std::move(found.k_max);
      if (curvature == CurvatureMethod::kFit) model.settled_sum = settled_sum(model);
      if (!attributes.shape.empty()) attributes.shape = shape_classes(attributes.k_min, attributes.k_max);
    }
  }
  if (progress.cancelled()) return cancelled_error();
  draw_labelled_mesh(model, std::move(labelled), std::move(cuts));
  DUBSAR_TRY(measure_partitions(model));
  return report;
}

}  // namespace dubsar
