#include "core/contact/clay_cavities.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

/// Steps from air within which clay is dark: the disks of dips.cpp and the point spread reach as far.
constexpr int kFringe = 4;

/// One piece of dark clay, and where it lies.
struct DarkPiece {
  ClayCavity nodes;
  bool beside_air = false;
  float nearest = INFINITY, lowest = INFINITY, highest = -INFINITY;

  /// Its air begins half a step before its first point and ends half a step after its last.
  bool off_contact() const { return !beside_air && nearest - 0.5f > highest - lowest + 1.0f; }
};

}  // namespace

std::vector<ClayCavity> unseen_cavities(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
                                        float isovalue) {
  const auto is_dark = [&](std::uint32_t n) {
    const glm::ivec3 p = band.point(n);
    return density.get(p.x, p.y, p.z) < isovalue;
  };
  std::vector<bool> seen(band.nodes.size(), false);
  std::vector<ClayCavity> cavities;
  for (std::uint32_t first = 0; first < band.nodes.size(); ++first) {
    if (seen[first] || !is_dark(first)) continue;
    DarkPiece piece;
    piece.nodes.push_back(first);
    seen[first] = true;
    for (std::size_t i = 0; i < piece.nodes.size(); ++i) {
      const ContactBand::Node& node = band.nodes[piece.nodes[i]];
      piece.nearest = std::min(piece.nearest, node.distance);
      piece.lowest = std::min(piece.lowest, node.height);
      piece.highest = std::max(piece.highest, node.height);
      each_beside({node.x, node.y, node.z}, [&](const glm::ivec3& q) {
        if (!inside.get(q.x, q.y, q.z)) piece.beside_air = true;
        const std::uint32_t m = band.at(q);
        if (m == ContactBand::kNone || seen[m] || !is_dark(m)) return;
        seen[m] = true;
        piece.nodes.push_back(m);
      });
    }
    if (!piece.off_contact()) continue;
    std::sort(piece.nodes.begin(), piece.nodes.end());
    cavities.push_back(std::move(piece.nodes));
  }
  return cavities;
}

void blind_fringes(const ContactBand& band, const std::vector<ClayCavity>& cavities, Dips& dips) {
  std::vector<bool> fringe(band.nodes.size(), false);
  for (const ClayCavity& cavity : cavities)
    for (const std::uint32_t n : cavity) fringe[n] = true;
  grow(band, kFringe - 1, fringe);
  for (std::size_t n = 0; n < fringe.size(); ++n)
    if (fringe[n]) dips.strength[n] = std::min(dips.strength[n], 0.0f);
}

bool keep_whole(const ContactBand& band, const std::vector<ClayCavity>& cavities, std::vector<ClaySide>& side) {
  bool changed = false;
  for (const ClayCavity& cavity : cavities) {
    const auto of_tablet = static_cast<std::size_t>(
        std::count_if(cavity.begin(), cavity.end(), [&](std::uint32_t n) { return side[n] == ClaySide::kTablet; }));
    if (of_tablet == 0 || of_tablet == cavity.size()) continue;
    const ClaySide most = 2 * of_tablet >= cavity.size() ? ClaySide::kTablet : ClaySide::kEnvelope;
    for (const std::uint32_t n : cavity) {
      side[n] = most;
      each_beside(band.point(n), [&](const glm::ivec3& q) {
        if (const std::uint32_t m = band.at(q); m != ContactBand::kNone) side[m] = most;
      });
    }
    changed = true;
  }
  return changed;
}

}  // namespace dubsar
