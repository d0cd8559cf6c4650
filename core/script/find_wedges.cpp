#include "core/script/find_wedges.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/numbers/median.h"
#include "core/script/arrange_text.h"
#include "core/script/usual_directions.h"
#include "core/script/wedge_echoes.h"
#include "core/script/wedge_measure.h"
#include "core/script/wedge_width.h"

namespace dubsar {
namespace {

constexpr double kFindLeastDepth = 0.35;  // of the usual depth, of the closed surface
constexpr double kFindCost = 0.0012;      // what a wedge has to explain, at most: a fifth of what a usual one does
// Noise of clay that nobody wrote on looks like small wedges that fit badly and would rather be broader: on phantoms
// misfits of .045 to .06 and breadths of 1.77 to 1.92 usual ones, of what is written .02 and .99 to 1.01 (seven
// voxels deep), .034 and 1.76 (three); on S264's coarse mesh a breadth of 1.4.
constexpr double kNoiseMisfit = 0.04, kNoiseBroad = 1.6;
constexpr int kFindRounds = 3;
constexpr int kFindVotes = 3;  // rounds in which the tablet's own directions count

void note_pressing(std::vector<ScriptWedge>& wedges, const PressedPair& pair) {
  const auto of = [&](std::size_t id) {
    return std::find_if(wedges.begin(), wedges.end(),
                        [&](const ScriptWedge& w) { return w.id == static_cast<int>(id); });
  };
  const auto later = of(pair.later), earlier = of(pair.earlier);
  if (later != wedges.end() && earlier != wedges.end()) later->pressed_after.push_back({earlier->order, pair.clear});
}

/// From the tablet's own axes to the frame of its mesh.
void turn_back(WedgesFound& found, const TabletFrame& frame) {
  const glm::dmat3 turn = glm::transpose(frame.tablet_from_model());
  for (ScriptWedge& w : found.wedges)
    for (glm::dvec3* v : {&w.head_mm, &w.corner_mm[0], &w.corner_mm[1], &w.tip_mm, &w.tail_mm, &w.normal, &w.direction})
      *v = turn * *v;
  TextSides sides(frame);
  for (std::size_t s = 0; s < kTextSideCount; ++s)
    sides.turn(static_cast<TextSide>(s), found.sides.turned(static_cast<TextSide>(s)));
  found.sides = sides;
}

}  // namespace

Result<WedgesFound> find_wedges(const TriMesh& mesh, const WedgeSearch& search, Progress& progress) {
  if (mesh.triangles.empty())
    return fail(ErrorKind::kBadData, "wedges: a surface without triangles found, expected a tablet");
  progress.begin("wedges", 3, "step");
  const auto frame = find_tablet_frame(mesh);
  // Patches, tiles and cells are laid by axes: where heads are two edges wide another attitude finds 15 or 21 of 27
  // (S264, 20,000 triangles). Where they are fourteen it hardly matters, and looking at tablets as they lie found .987
  // of 315 instead of .971.
  const bool turn = frame && mesh.triangles.size() <= kCoarseTriangles;
  SurfaceLevels surface(turn ? in_tablet_frame(mesh, *frame) : mesh);
  WedgesFound out;
  if (!surface.fine().empty()) out.scale = wedge_scale(surface, search.width_mm);
  progress.advance(1);
  if (progress.cancelled()) return cancelled_error();
  if (out.scale.width_mm > 0.0) DUBSAR_TRY(frame);
  if (out.scale.width_mm > 0.0) {
    const PatchCells& cells = surface.for_width(out.scale.width_mm);
    const std::vector<DeepPlace> places = deep_places(cells, out.scale, kFindLeastDepth, 1);
    out.places = static_cast<std::int64_t>(places.size());
    ReliefExplanation relief(surface, out.scale, places);
    progress.advance(1);
    if (progress.cancelled()) return cancelled_error();
    relief.explain(kFindRounds, kFindCost);
    TabletFrame own = *frame;
    if (turn) own.right = {1, 0, 0}, own.up = {0, 1, 0}, own.front = {0, 0, 1};
    TextSides sides(own);
    for (int round = 0; round < kFindVotes; ++round) {
      const std::vector<PlacedImprint> placed = relief.placed();
      if (round == 0) turn_sides(sides, placed);
      const UsualDirections usual(placed, sides);
      relief.prefer([usual, sides](const glm::dvec3& along, const glm::dvec3& normal, const Imprint& imprint) {
        return usual.surprise(sides.angle_of(along, normal).angle, is_long(imprint));
      });
      relief.explain(1, kFindCost);
    }
    out.sides = sides;
    const std::vector<PlacedImprint> placed = relief.measured();
    std::vector<double> misfits, widths;
    for (const PlacedImprint& one : placed) {
      misfits.push_back(one.misfit);
      widths.push_back(one.imprint.width());
    }
    if (!widths.empty()) out.scale.fitted = median(widths);
    out.scale.misfit = median(misfits);
    const bool noise = out.scale.misfit > kNoiseMisfit && out.scale.fitted > kNoiseBroad;
    for (std::size_t k = 0; k < placed.size() && !noise; ++k) {
      ScriptWedge wedge = measured_wedge(placed[k], out.scale);
      wedge.id = static_cast<int>(k);
      if (wedge.confidence >= search.least_confidence) out.wedges.push_back(wedge);
    }
    drop_echoes(out.wedges);
    arrange_text(out.wedges, sides);
    for (const PressedPair& pair : relief.pressing_order(placed)) note_pressing(out.wedges, pair);
    if (turn) turn_back(out, *frame);
  }
  progress.end();
  return out;
}

}  // namespace dubsar
