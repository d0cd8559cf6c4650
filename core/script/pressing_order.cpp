// Which of two overlapping wedges was pressed first.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel.h"
#include "core/script/explain_relief.h"

namespace dubsar {
namespace {

constexpr double kMeetReach = 0.4;   // widths from where the other one begins: how far clay is pushed
constexpr int kMeetFewest = 3;       // samples on either side
constexpr double kMeetLeast = 0.04;  // of a usual depth: what is shallower is nobody's
constexpr double kMeetClear =
    0.012;  // of a usual depth: what is less clear is not told; on phantoms a third of it is wrong
// Of a usual depth: the fuller one of two wedges that meet, in the median of a tablet. On phantoms whose clay moved (a
// fifth of the depth) .022 to .030, where none moved .004 to .013: there is no order in such clay to be read, and what
// two wedges differ by is how far the model's planes are from theirs.
constexpr double kMeetPushed = 0.018;
constexpr std::size_t kMeetPairs = 5;  // fewer do not say whether clay moved

}  // namespace

void ReliefExplanation::add_meeting(const PlacedImprint& one, const PlacedImprint& other, bool first,
                                    Meeting& meeting) const {
  const WedgeSite& site = sites_[one.site];
  DepthSamples samples = site.samples;
  const auto reset = [&] { std::fill(samples.others.begin(), samples.others.end(), 0.0f); };
  std::vector<float> own, third;
  imprint_depths(one.imprint, samples, own);
  reset();
  for (const std::uint32_t j : near_[one.site])
    if (fits_[j].active && j != other.site) add_other(site, placed_at(j), samples);
  third = samples.others;
  reset();
  add_other(site, other, samples);
  const auto least = static_cast<float>(kMeetLeast * scale_.usual().depth);
  const auto whose = [&](std::size_t i) {  // 0: one, 1: the other, 2: neither
    const float most = std::max(own[i], samples.others[i]);
    if (most < least || third[i] > most) return std::size_t{2};
    return own[i] > samples.others[i] ? std::size_t{0} : std::size_t{1};
  };
  std::vector<std::size_t> of[2];
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (const std::size_t k = whose(i); k < 2) of[k].push_back(i);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}})
    for (const std::size_t i : of[k]) {
      float near2 = 1e30f;
      for (const std::size_t j : of[1 - k]) {
        const float dx = samples.x[i] - samples.x[j], dy = samples.y[i] - samples.y[j];
        near2 = std::min(near2, dx * dx + dy * dy);
      }
      const double weight = 1.0 - std::sqrt(static_cast<double>(near2)) / kMeetReach;
      if (!(weight > 0.0)) continue;
      const std::size_t wedge = first ? k : 1 - k;
      meeting.sums[wedge] += weight * static_cast<double>(std::max(own[i], samples.others[i]) - samples.depth[i]);
      meeting.weights[wedge] += weight;
      ++meeting.counts[wedge];
    }
}

std::vector<PressedPair> ReliefExplanation::pressing_order(const std::vector<PlacedImprint>& placed) const {
  std::vector<std::vector<PressedPair>> found(placed.size());
  std::vector<std::vector<double>> fuller(placed.size());
  parallel_for(static_cast<std::int64_t>(placed.size()), 2, [&](std::int64_t i) {
    const auto a = static_cast<std::size_t>(i);
    const PlacedImprint& one = placed[a];
    for (std::size_t b = a + 1; b < placed.size(); ++b) {
      const PlacedImprint& other = placed[b];
      if (glm::distance(one.foot, other.foot) > 3.5 * scale_.width_mm || glm::dot(one.normal, other.normal) < 0.5)
        continue;
      Meeting meeting;
      add_meeting(one, other, true, meeting);
      add_meeting(other, one, false, meeting);
      if (std::min(meeting.counts[0], meeting.counts[1]) < kMeetFewest) continue;
      const double filled[2] = {meeting.sums[0] / meeting.weights[0], meeting.sums[1] / meeting.weights[1]};
      const double clear = (filled[0] - filled[1]) / scale_.usual().depth;
      fuller[a].push_back(std::max(filled[0], filled[1]) / scale_.usual().depth);
      if (std::abs(clear) < kMeetClear || fuller[a].back() < 0.0) continue;
      found[a].push_back(clear > 0.0 ? PressedPair{b, a, clear} : PressedPair{a, b, -clear});
    }
  });
  std::vector<double> all;
  for (const auto& some : fuller) all.insert(all.end(), some.begin(), some.end());
  std::vector<PressedPair> out;
  if (all.size() < kMeetPairs || median(all) < kMeetPushed) return out;
  for (const auto& some : found) out.insert(out.end(), some.begin(), some.end());
  return out;
}

}  // namespace dubsar
