#include "tests/core/script/wedge_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>
#include <vector>

#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr double kCauseTurned = 15.0;  // degrees: the direction that a real one has

double angle_between(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& out) {
  const auto flat = [&](const glm::dvec3& v) { return glm::normalize(v - out * glm::dot(v, out)); };
  return std::acos(std::clamp(glm::dot(flat(a), flat(b)), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// Share of the surface within a head's width of a wedge's deepest place that is inferred, and how far the nearest
/// vertex is from that place, voxels.
struct Clay {
  double inferred = 0.0, away = 1e9;
};

Clay clay_at(const TriMesh& mesh, const phantom::Wedge& w, double voxel) {
  const glm::dvec3 tip = w.position - w.depth * w.outward;
  const double near = 2.0 * w.head_half_width;
  double all = 0.0, inferred = 0.0;
  Clay out;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::dvec3 p = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])) / voxel;
    out.away = std::min(out.away, glm::distance(p, tip));
    if (glm::distance(p, w.place.head) > near && glm::distance(p, w.position) > near) continue;
    all += 1.0;
    inferred += !mesh.evidence.empty() && mesh.evidence[v] == evidence_byte(Evidence::kInferred);
  }
  out.inferred = all > 0.0 ? inferred / all : 1.0;
  return out;
}

}  // namespace

void WedgeCauses::add(const phantom::Phantom& truth, const TriMesh& mesh, const WedgesFound& found,
                      const WedgesFound& every, const WedgeScore& score) {
  const double voxel = truth.options().voxel_mm;
  const auto& wedges = truth.wedges();
  SurfaceLevels surface(mesh);
  std::vector<DeepPlace> places;
  if (found.scale.width_mm > 0.0) places = deep_places(surface.for_width(found.scale.width_mm), found.scale, 0.35, 1);
  const auto judged_every = judge_wedges(truth, every.wedges, {.grid_step = mesh.frame.scale.x});
  const std::set<int> missed(score.missed.begin(), score.missed.end());
  const auto found_anyhow = [&](std::size_t t) {
    return std::any_of(judged_every.judged.begin(), judged_every.judged.end(),
                       [&](const JudgedWedge& j) { return j.truth == static_cast<int>(t); });
  };
  for (std::size_t t = 0; t < wedges.size(); ++t) {
    const phantom::Wedge& w = wedges[t];
    if (w.owner != phantom::Owner::kTablet || !w.has_air()) continue;
    if (w.state == phantom::WedgeCase::kFree && truth.gap_width(w.position) < 1.5 * mesh.frame.scale.x) continue;
    const bool miss = missed.contains(static_cast<int>(t));
    ++wanted_, missed_ += miss;
    const auto count = [&](const std::string& place) { ++places_[place].wanted, places_[place].missed += miss; };
    bool later = false, earlier = false;
    for (std::size_t u = 0; u < wedges.size(); ++u)
      if (u != t && truth.overlap(t, u)) (u > t ? later : earlier) = true;
    const Clay clay = clay_at(mesh, w, voxel);
    const auto side = static_cast<std::size_t>(w.side);
    const auto& normal = phantom::kSideFrames[side].normal;
    glm::dvec3 square(0.0);
    square[normal.axis == 0 ? 0 : normal.axis] = normal.sign;
    const bool round = glm::dot(square, w.outward) < 0.9;
    const double gap = truth.gap_width(w.position);
    count(side < 2 ? (round ? "broad side, round edge" : "broad side")
                   : (round ? "narrow side, round edge" : "narrow side"));
    count(later && earlier ? "overlaps a later and an earlier one"
          : later          ? "a later one overlaps it"
          : earlier        ? "overlaps an earlier one"
                           : "overlaps none");
    count(clay.inferred > 0.25  ? "a quarter and more inferred"
          : clay.inferred > 0.0 ? "beside inferred surface"
                                : "all around measured");
    count(gap < 3.0 ? "gap below 3 voxels" : gap < 5.0 ? "gap 3 to 5 voxels" : "gap above 5 voxels");
    count(fmt::format("state {}", name_in(phantom::kWedgeCases, w.state)));
    count(fmt::format("kind {}", name_in(phantom::kStrokeKinds, w.kind)));
    count(clay.away > 1.5 ? "surface 1.5 voxels and more from its tip" : "surface at its tip");
    count(w.depth < 6.0 ? "shallower than 6 voxels" : w.depth < 8.0 ? "6 to 8 voxels" : "deeper than 8 voxels");
    if (!miss) continue;
    double candidate = 1e9, off = 1e9, turned = 0.0;
    for (const DeepPlace& p : places) candidate = std::min(candidate, glm::distance(p.foot / voxel, w.position));
    const double half = w.head_half_width;
    for (const ScriptWedge& f : every.wedges) {
      const double apart = glm::distance(f.head_mm / voxel, w.place.head) / half;
      if (apart < off) off = apart, turned = angle_between(f.direction, w.tail, w.outward);
    }
    double tip = 1e9, tip_turned = 0.0;
    for (const ScriptWedge& f : every.wedges) {
      const double apart = glm::distance(f.tip_mm / voxel, w.position - w.depth * w.outward) / half;
      if (apart < tip) tip = apart, tip_turned = angle_between(f.direction, w.tail, w.outward);
    }
    const std::string cause = clay.away > 2.5                   ? "no surface in it (2.5 voxels and more from its tip)"
                              : clay.inferred > 0.5             ? "half of it inferred"
                              : found_anyhow(t)                 ? "below the bound of confidence, or left out"
                              : off <= 1.0                      ? "head right, direction not"
                              : tip <= 0.6 && tip_turned > 90.0 ? "tip right, turned by a third"
                              : tip <= 0.6                      ? "tip right, head off"
                              : candidate > 0.7 * half          ? "not a candidate"
                                                                : "a candidate that explained too little";
    ++causes_[cause];
    fmt::print(
        "MISS t{} {} side {} depth {:.1f} half {:.1f} gap {:.1f} inferred {:.2f} away {:.1f} candidate {:.1f} head off "
        "{:.2f} "
        "turned {:.0f} tip off {:.2f} turned {:.0f} {}{}{}: {}\n",
        t, name_in(phantom::kStrokeKinds, w.kind), side, w.depth, half, gap, clay.inferred, clay.away, candidate, off,
        turned, tip, tip_turned, later ? "later " : "", earlier ? "earlier " : "", round ? "round" : "", cause);
  }
  for (std::size_t f = 0; f < found.wedges.size(); ++f) {
    ++drawn_;
    const JudgedWedge& j = score.judged[f];
    if (j.truth >= 0) continue;
    ++false_;
    const ScriptWedge& d = found.wedges[f];
    double tip = 1e9, turned = 0.0;
    int of = -1;
    for (std::size_t t = 0; t < wedges.size(); ++t) {
      const phantom::Wedge& w = wedges[t];
      if (w.owner != phantom::Owner::kTablet) continue;
      const double apart = glm::distance(d.tip_mm / voxel, w.position - w.depth * w.outward) / w.head_half_width;
      if (apart < tip) tip = apart, turned = angle_between(d.direction, w.tail, w.outward), of = static_cast<int>(t);
    }
    const bool taken =
        std::any_of(score.judged.begin(), score.judged.end(), [&](const JudgedWedge& o) { return o.truth == of; });
    const Clay clay = clay_at(mesh, wedges[static_cast<std::size_t>(of)], voxel);
    const bool filled = !wedges[static_cast<std::size_t>(of)].has_air();
    const std::string cause = tip > 1.2               ? "nothing pressed there"
                              : taken                 ? "a second one on a wedge"
                              : filled                ? "of a wedge that the envelope filled"
                              : turned > 90.0         ? "turned by a third"
                              : turned > kCauseTurned ? "direction off"
                                                      : "head off";
    ++false_causes_[cause];
    fmt::print(
        "FALSE {} conf {:.2f} depth {:.1f} width {:.1f} length {:.1f}; t{} {} side {} depth {:.1f} tip off {:.2f} "
        "turned {:.0f} inferred {:.2f} away {:.1f}: {}\n",
        name_in(kWedgeKinds, d.kind), d.confidence, d.depth_mm / voxel, d.width_mm / voxel, d.length_mm / voxel, of,
        name_in(phantom::kStrokeKinds, wedges[static_cast<std::size_t>(of)].kind),
        static_cast<int>(wedges[static_cast<std::size_t>(of)].side), wedges[static_cast<std::size_t>(of)].depth, tip,
        turned, clay.inferred, clay.away, cause);
  }
}

std::string WedgeCauses::text() const {
  std::string out = fmt::format("missed {} of {}\n", missed_, wanted_);
  for (const auto& [place, tally] : places_)
    out += fmt::format("  {:<44} {:>4} of {:>4} {:.3f}\n", place, tally.missed, tally.wanted,
                       static_cast<double>(tally.missed) / tally.wanted);
  out += "missed because\n";
  for (const auto& [cause, count] : causes_) out += fmt::format("  {:<52} {}\n", cause, count);
  out += fmt::format("false {} of {}\n", false_, drawn_);
  for (const auto& [cause, count] : false_causes_) out += fmt::format("  {:<52} {}\n", cause, count);
  return out;
}

}  // namespace dubsar
