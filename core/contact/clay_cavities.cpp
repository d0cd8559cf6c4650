#include "core/contact/clay_cavities.h"

#include <algorithm>

namespace dubsar {
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
