#include "core/seals/seal_mean.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

constexpr float kBelowMm = 0.06f;                       // below the ground: noise of a scan is half of that
constexpr float kErrorMm = 0.07f;                       // of heights that lie on each other
constexpr double kWornMm = 0.8;                         // of the neighbourhood that is worn or not, a deviation
constexpr float kPlacesAround = 6.0f, kMostOne = 2.0f;  // independent ones in it; one alone says at most that
constexpr int kWornRounds = 3;
constexpr float kLeastCounts = 1e-3f;  // where all are worn, the mean of all
constexpr float kShows = 0.25f;        // probability; nothing is known on the ground: .5

using SealViews = std::vector<const SealView*>;

/// Of what stands out most, in each view, against what does in any: worn places have none of it.
std::vector<std::vector<float>> shares_of_figures(const SealViews& views) {
  std::vector<float> most(views.front()->over.mm.size());
  for (const SealView* view : views)
    for (std::size_t k = 0; k < most.size(); ++k)
      if (view->over.shown[k] > 0.3f) most[k] = std::max(most[k], view->over.figure[k]);
  // Noise has some figures everywhere: their usual least.
  std::vector<float> level;
  for (const float figure : most)
    if (figure > 0.0f) level.push_back(figure);
  float noise = 1e-6f;
  if (!level.empty()) {
    const auto at = level.begin() + static_cast<std::ptrdiff_t>(level.size() / 10);
    std::nth_element(level.begin(), at, level.end());
    noise = std::max(noise, 0.3f * *at);
  }
  std::vector<std::vector<float>> out;
  for (const SealView* view : views) {
    out.emplace_back(most.size());
    for (std::size_t k = 0; k < most.size(); ++k) out.back()[k] = (view->over.figure[k] + noise) / (most[k] + noise);
  }
  return out;
}

/// Means by the probability that each view shows a place.
void average(const SealViews& views, const std::vector<std::vector<float>>& shows, SealImpression& out) {
  for (std::size_t k = 0; k < out.mm.size(); ++k) {
    float mm = 0.0f, raised = 0.0f, all = 0.0f;
    for (std::size_t v = 0; v < views.size(); ++v) {
      const SealImpression& over = views[v]->over;
      const float below = std::min(0.0f, over.mm[k]) / kBelowMm,
                  weight = over.shown[k] * (shows[v][k] + kLeastCounts) * std::exp(-below * below);
      mm += weight * over.mm[k];
      raised += weight * over.raised[k];
      all += weight;
    }
    out.mm[k] = all > 0.0f ? mm / all : 0.0f;
    out.raised[k] = all > 0.0f ? raised / all : 0.0f;
  }
}

/// How probably a view shows each place, if `mean` is the seal.
std::vector<float> shows_of(const SealImpression& over, const SealImpression& mean) {
  std::vector<float> log_ratio(over.mm.size());
  for (std::size_t k = 0; k < log_ratio.size(); ++k) {
    const float seal = std::max(0.0f, mean.mm[k]),
                ratio = seal * (2.0f * over.mm[k] - seal) / (2.0f * kErrorMm * kErrorMm);
    log_ratio[k] = std::clamp(ratio, -kMostOne, kMostOne);
  }
  std::vector<float> out = weighted_blur(log_ratio, over.shown, over.width, over.height, kWornMm / over.step_mm);
  for (float& value : out) value = 1.0f / (1.0f + std::exp(-kPlacesAround * value));
  return out;
}

}  // namespace

SealImpression mean_of_views(const std::vector<SealView>& views, std::size_t without, std::vector<float>* seen_by) {
  SealViews of;
  for (const SealView& view : views)
    if (view.impression != without) of.push_back(&view);
  if (of.empty()) return {};
  const SealImpression& raster = of.front()->over;
  const std::size_t cells = raster.mm.size();
  SealImpression out{raster.width, raster.height, raster.step_mm, {}, {}, {}, {}};
  for (std::vector<float>* each : {&out.mm, &out.shown, &out.raised, &out.figure}) each->resize(cells);
  std::vector<std::vector<float>> shows = shares_of_figures(of);
  average(of, shows, out);
  for (int round = 0; round < kWornRounds; ++round) {
    for (std::size_t v = 0; v < of.size(); ++v) shows[v] = shows_of(of[v]->over, out);
    average(of, shows, out);
  }
  if (seen_by) seen_by->assign(cells, 0.0f);
  for (std::size_t v = 0; v < of.size(); ++v)
    for (std::size_t k = 0; k < cells; ++k) {
      const SealImpression& over = of[v]->over;
      if (over.shown[k] < 0.3f) continue;
      out.shown[k] = std::max(out.shown[k], over.shown[k]);
      out.figure[k] = std::max(out.figure[k], over.figure[k]);
      if (seen_by && shows[v][k] >= kShows) (*seen_by)[k] += 1.0f;
    }
  return out;
}

}  // namespace dubsar
