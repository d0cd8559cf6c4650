#include "core/contact/clay_cavities.h"

#include <algorithm>
#include <unordered_set>

namespace dubsar {
namespace {

/// Steps from the cavity between which its surroundings are looked at: nearer is the fringe of its own air.
constexpr int kAroundFrom = 4, kAroundTo = 6;
/// Strength that a tenth of the surroundings has where a film goes on, at least. Films of .5 and 1 voxel have 3.0 to
/// 7.1 there at 17 and 22 dB; pores have .6 to 1.7 and straw up to 2.3, seldom 2.9 (docs/evidence.md).
constexpr float kFilmAround = 2.65f;
constexpr std::size_t kLeastAround = 100;  ///< nodes; fewer say nothing

}  // namespace

bool lies_in_film(const ContactBand& band, const std::vector<float>& strength, const ClayCavity& cavity) {
  std::unordered_set<std::uint32_t> seen(cavity.begin(), cavity.end());
  std::vector<std::uint32_t> front = cavity, next;
  std::vector<float> around;
  for (int ring = 1; ring <= kAroundTo; ++ring) {
    for (const std::uint32_t n : front)
      each_beside(band.point(n), [&](const glm::ivec3& q) {
        const std::uint32_t m = band.at(q);
        if (m == ContactBand::kNone || !seen.insert(m).second) return;
        next.push_back(m);
        if (ring >= kAroundFrom) around.push_back(strength[m]);
      });
    front.swap(next);
    next.clear();
  }
  if (around.size() < kLeastAround) return false;
  const auto tenth = around.begin() + static_cast<std::ptrdiff_t>(around.size() * 9 / 10);
  std::nth_element(around.begin(), tenth, around.end());
  return *tenth >= kFilmAround;
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
