#include "core/contact/clay_cavities.h"

#include <algorithm>

namespace dubsar {
namespace {

/// Steps from air within which clay is dark: the disks of dips.cpp and the point spread reach as far.
constexpr int kFringe = 4;

}  // namespace

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
