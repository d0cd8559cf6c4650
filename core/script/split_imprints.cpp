// Two imprints in one pit: heads that lie less than a third of a width apart make one deepest place.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel.h"
#include "core/script/explain_relief.h"

namespace dubsar {
namespace {

constexpr double kSplitAside = 0.35;  // widths from one deepest place to the other
constexpr double kSplitApart = 0.4;   // radians between two ways that the first one is tried
constexpr std::size_t kSplitFirsts = 6;
constexpr int kSplitTurns = 3;
// A pit that is less like its planes than others on the tablet are, by so much, is asked for two heads of any
// direction; they have to explain a fifteenth of what a usual wedge does more than one. On ten phantoms 12 of the 16
// pits like that lay where a wedge had been missed.
constexpr double kSplitUnlike = 1.5, kSplitLess = 1.0 / 3.0;

}  // namespace

ReliefExplanation::Second ReliefExplanation::second_in(std::size_t k, bool both) const {
  const UsualImprint usual = scale_.usual();
  const Imprint& now = fits_[k].imprint;
  DepthSamples samples = sites_[k].samples, coarse = sites_[k].coarse;
  look_beside(k, samples);
  const std::vector<float> outside = samples.others;
  std::vector<std::size_t> fine_of;  // of each coarse sample
  for (std::size_t i = 0, j = 0; i < coarse.size(); ++i) {
    while (samples.x[j] != coarse.x[i] || samples.y[j] != coarse.y[i]) ++j;
    fine_of.push_back(j);
    coarse.others[i] = outside[j];
  }
  Second out;
  out.first = now;
  const double alone = imprint_energy(now, samples, usual, kFitTogether);
  double least = 1e30;
  std::vector<float> model;
  const auto beside = [&](const Imprint& imprint) {
    imprint_depths(imprint, samples, model);
    for (std::size_t i = 0; i < model.size(); ++i) samples.others[i] = std::max(outside[i], model[i]);
  };
  const double x = now.p[Imprint::kX], y = now.p[Imprint::kY];
  std::vector<Imprint> firsts{now};
  if (both) {
    std::vector<ImprintStart> starts = imprint_starts(coarse, usual, x, y, kStartDirections, kFitAlone);
    std::stable_sort(starts.begin(), starts.end(),
                     [](const ImprintStart& a, const ImprintStart& b) { return a.energy < b.energy; });
    for (const ImprintStart& start : starts)
      if (firsts.size() <= kSplitFirsts && std::all_of(firsts.begin() + 1, firsts.end(), [&](const Imprint& other) {
            return angle_apart(other.p[Imprint::kAngle], start.imprint.p[Imprint::kAngle]) > kSplitApart;
          }))
        firsts.push_back(start.imprint);
  }
  for (Imprint first : firsts) {
    beside(first);
    for (std::size_t i = 0; i < coarse.size(); ++i) coarse.others[i] = samples.others[fine_of[i]];
    ImprintStart best;
    best.energy = 1e30;
    for (int place = 0; place < 9; ++place) {
      const double angle = std::numbers::pi * place / 4.0, far = place == 8 ? 0.0 : kSplitAside;
      for (const ImprintStart& start : imprint_starts(coarse, usual, x + far * std::cos(angle),
                                                      y + far * std::sin(angle), kStartDirections / 2, kFitTogether))
        if (start.energy < best.energy) best = start;
    }
    double energy = 0.0;
    for (int turn = 0; turn < kSplitTurns; ++turn) {
      beside(first);
      energy = fit_imprint(best.imprint, samples, usual, kFitTogether);
      beside(best.imprint);
      energy = fit_imprint(first, samples, usual, kFitTogether);
    }
    if (energy >= least) continue;
    least = energy;
    out.first = first;
    out.second = best.imprint;
  }
  out.gain = alone - least;
  return out;
}

void ReliefExplanation::split(double cost) {
  std::vector<std::size_t> active;
  for (std::size_t k = 0; k < fits_.size(); ++k)
    if (fits_[k].active) active.push_back(k);
  std::vector<Second> seconds(active.size());
  std::vector<double> misfits(active.size());
  parallel_for(static_cast<std::int64_t>(active.size()), 4, [&](std::int64_t i) {
    PlacedImprint one = placed_at(active[static_cast<std::size_t>(i)]);
    measure(one);
    misfits[static_cast<std::size_t>(i)] = one.misfit;
  });
  const double unlike = kSplitUnlike * median(misfits);
  parallel_for(static_cast<std::int64_t>(active.size()), 1, [&](std::int64_t n) {
    const auto i = static_cast<std::size_t>(n);
    const bool both = misfits[i] > unlike;
    seconds[i] = second_in(active[i], both);
    seconds[i].least = both ? kSplitLess * cost : cost;
  });
  std::vector<std::size_t> order(active.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return seconds[a].gain > seconds[b].gain; });
  for (const std::size_t i : order) {
    if (seconds[i].gain < seconds[i].least) continue;
    const std::size_t k = active[i];
    // Another site may have explained the same since.
    DepthSamples samples = sites_[k].samples;
    look_beside(k, samples);
    const double alone = imprint_energy(fits_[k].imprint, samples, scale_.usual(), kFitTogether);
    std::vector<float> model;
    imprint_depths(seconds[i].first, samples, model);
    for (std::size_t s = 0; s < model.size(); ++s) samples.others[s] = std::max(samples.others[s], model[s]);
    const double gain = alone - imprint_energy(seconds[i].second, samples, scale_.usual(), kFitTogether);
    if (gain < seconds[i].least) continue;
    fits_[k].imprint = seconds[i].first;
    Fit fresh;
    fresh.imprint = seconds[i].second;
    fresh.ways = {{seconds[i].second, 0.0}};
    fresh.active = true;
    fresh.gain = gain;
    const auto made = static_cast<std::uint32_t>(sites_.size());
    sites_.push_back(WedgeSite(sites_[k]));
    fits_.push_back(fresh);
    near_.push_back(near_[k]);
    near_.back().push_back(static_cast<std::uint32_t>(k));
    for (const std::uint32_t j : near_.back()) near_[j].push_back(made);
  }
}

}  // namespace dubsar
