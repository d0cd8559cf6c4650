#include "tests/core/phantom/contact_score.h"

#include <cmath>
#include <map>

#include "core/base/system/parallel.h"

namespace dubsar::phantom {

ContactScore judge_contact(const Phantom& phantom, const JudgedMesh& tablet, std::span<const std::uint8_t> evidence) {
  constexpr double kSlit = 1.5, kFalseDepth = 2.5;
  constexpr std::uint8_t kPocket = 1, kFilm = 2;
  ContactScore score;
  const std::vector<double> depths = wedge_depths(phantom, tablet);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const Wedge& w = phantom.wedges()[i];
    if (w.owner != Owner::kTablet) continue;
    if (w.state == WedgeCase::kFree && phantom.gap_width(w.position) < kSlit * tablet.grid_step) continue;
    CaseScore& one = score.cases[static_cast<std::size_t>(w.state)];
    ++one.wedges;
    one.kept += std::abs(depths[i] - w.depth) <= 0.2 * w.depth;
    one.shown += depths[i] >= 0.5 * w.depth && depths[i] < 2.5 * w.depth;
  }
  struct Place {
    bool contact = false;
    float off = 0.0f, below = 0.0f;
  };
  std::vector<Place> places(tablet.positions.size());
  parallel_for(static_cast<std::int64_t>(places.size()), 2048, [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    const glm::dvec3 p(tablet.positions[i]);
    places[i].contact = phantom.in_contact(p);
    if (!places[i].contact) return;
    places[i].off = static_cast<float>(phantom.tablet_distance(p));
    places[i].below = -places[i].off;
  });
  std::map<std::array<std::int64_t, 3>, FalseWedge> known_below;  // by cubes of 8 voxels
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i].contact) continue;
    ++score.contact_vertices;
    score.near_truth += std::abs(places[i].off) <= 1.0f;
    ++score.evidence[evidence[i]];
    if ((evidence[i] != kPocket && evidence[i] != kFilm) || static_cast<double>(places[i].below) <= kFalseDepth)
      continue;
    const glm::dvec3 p(tablet.positions[i]);
    FalseWedge& wedge = known_below[{std::lround(p.x / 8.0), std::lround(p.y / 8.0), std::lround(p.z / 8.0)}];
    wedge.place += p;
    wedge.deepest = std::max(wedge.deepest, static_cast<double>(places[i].below));
    ++wedge.vertices;
    wedge.of_pockets += evidence[i] == kPocket;
    wedge.of_pores += phantom.nearest_part(p) == Part::kPore;
  }
  constexpr int kLeastVertices = 6;
  for (auto& [cube, wedge] : known_below) {
    if (wedge.vertices < kLeastVertices) continue;
    wedge.place /= wedge.vertices;
    score.invented.push_back(wedge);
  }
  return score;
}

}  // namespace dubsar::phantom
