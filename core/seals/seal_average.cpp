#include "core/seals/seal_average.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "core/seals/seal_mean.h"

namespace dubsar {
namespace {

constexpr int kPlacingRounds = 2;
constexpr double kTurnOffMm = 1.2, kFinerTurnStepMm = 0.1;  // the search takes the best within .8 mm

struct Canvas {
  int width = 0, height = 0;
  double step_mm = 1.0, turn_mm = 0.0;
  glm::dvec2 least{0.0};
  std::size_t cells() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

std::array<glm::dvec2, 4> corners_of(const SealImpression& of) {
  const glm::dvec2 size = of.step_mm * glm::dvec2(of.width - 1, of.height - 1);
  return {glm::dvec2(0.0), {size.x, 0.0}, {0.0, size.y}, size};
}

Canvas canvas_of(const std::vector<SealImpression>& impressions, const SealPlacing& placing,
                 const std::vector<std::uint8_t>& used) {
  Canvas out;
  out.step_mm = impressions.front().step_mm;
  out.turn_mm = placing.turn_mm;
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (std::size_t k = 0; k < impressions.size(); ++k) {
    if (!used[k]) continue;
    for (const glm::dvec2& corner : corners_of(impressions[k])) {
      low = glm::min(low, placing.seal_from_band[k](corner));
      high = glm::max(high, placing.seal_from_band[k](corner));
    }
  }
  out.least = low;
  if (out.turn_mm > 0.0) {
    out.least.x = 0.0;
    high.x = out.turn_mm;
  }
  out.width =
      std::max(2, static_cast<int>(std::ceil((high.x - out.least.x) / out.step_mm)) + (out.turn_mm > 0.0 ? 0 : 1));
  out.height = std::max(2, static_cast<int>((high.y - low.y) / out.step_mm) + 1);
  return out;
}

std::vector<SealView> views_of(const std::vector<SealImpression>& impressions, const SealPlacing& placing,
                               const std::vector<std::uint8_t>& used, const Canvas& canvas) {
  std::vector<SealView> out;
  for (std::size_t k = 0; k < impressions.size(); ++k) {
    if (!used[k]) continue;
    const PlacedOn& place = placing.seal_from_band[k];
    int first_turn = 0, last_turn = 0;
    if (canvas.turn_mm > 0.0) {
      constexpr double kBentMm = 1.0;  // corners do not say how far the rim between them bends out
      double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
      for (const glm::dvec2& corner : corners_of(impressions[k])) {
        low = std::min(low, place(corner).x - kBentMm);
        high = std::max(high, place(corner).x + kBentMm);
      }
      first_turn = static_cast<int>(std::floor(low / canvas.turn_mm));
      last_turn = static_cast<int>(std::floor(high / canvas.turn_mm));
    }
    for (int turn = first_turn; turn <= last_turn; ++turn) {
      SealView view{k, {canvas.width, canvas.height, canvas.step_mm, {}, {}, {}, {}}};
      view.over.mm.resize(canvas.cells());
      view.over.shown.resize(canvas.cells());
      view.over.figure.resize(canvas.cells());
      view.over.raised.resize(canvas.cells());
      bool any = false;
      for (int y = 0; y < canvas.height; ++y)
        for (int x = 0; x < canvas.width; ++x) {
          const glm::dvec2 p =
              canvas.least + canvas.step_mm * glm::dvec2(x, y) + glm::dvec2(turn * canvas.turn_mm, 0.0);
          const Sampled s = sampled(impressions[k], place.back(p));
          if (s.weight <= 0.0) continue;
          any = true;
          const std::size_t at = view.over.index(x, y);
          view.over.mm[at] = static_cast<float>(s.mm);
          view.over.shown[at] = static_cast<float>(s.weight);
          view.over.figure[at] = static_cast<float>(s.figure);
          view.over.raised[at] = static_cast<float>(s.raised);
        }
      if (any || out.empty()) out.push_back(std::move(view));
    }
  }
  return out;
}

/// How well what stands out in one view lies on that of the others.
double agreement(const std::vector<SealView>& views, const Canvas& canvas) {
  double out = 0.0;
  for (std::size_t k = 0; k < canvas.cells(); ++k) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (const SealView& view : views) {
      if (view.over.shown[k] < 0.5f) continue;
      const auto raised = static_cast<double>(view.over.raised[k]);
      sum += raised;
      squares += raised * raised;
      count += 1.0;
    }
    if (count > 1.0) out += (sum * sum - squares) / (count - 1.0);
  }
  return out;
}

/// The turn at which views agree best, near the one found.
double finer_turn(const std::vector<SealImpression>& impressions, SealPlacing placing,
                  const std::vector<std::uint8_t>& used) {
  const double turn = placing.turn_mm;
  double best = turn, most = -1.0;
  for (double off = -kTurnOffMm; off <= kTurnOffMm + 1e-9; off += kFinerTurnStepMm) {
    placing.turn_mm = turn + off;
    const Canvas canvas = canvas_of(impressions, placing, used);
    const double agree = agreement(views_of(impressions, placing, used, canvas), canvas) * turn / placing.turn_mm;
    if (agree > most) {
      most = agree;
      best = placing.turn_mm;
    }
  }
  return best;
}

}  // namespace

SealAverage average_seal(const std::vector<SealImpression>& impressions, const AverageOptions& options) {
  SealAverage out;
  out.placing = place_impressions(impressions, options.first, options.turn_mm);
  for (std::size_t k = 0; k < impressions.size(); ++k)
    out.used.push_back(k == out.placing.first || out.placing.likeness[k] > 0.0 ? 1 : 0);
  for (int round = 0; round <= kPlacingRounds; ++round) {
    if (out.placing.turn_mm > 0.0 && options.turn_mm == 0.0 && round < 2)
      out.placing.turn_mm = finer_turn(impressions, out.placing, out.used);
    const Canvas canvas = canvas_of(impressions, out.placing, out.used);
    const std::vector<SealView> views = views_of(impressions, out.placing, out.used, canvas);
    out.least_mm = canvas.least;
    if (round == kPlacingRounds) {
      out.relief = mean_of_views(views, impressions.size(), &out.seen_by);
      break;
    }
    PlacedOn to_canvas;
    to_canvas.shift = -canvas.least;
    PlacedOn from_canvas;
    from_canvas.shift = canvas.least;
    const SealPlacing before = out.placing;
    for (std::size_t k = 0; k < impressions.size(); ++k) {
      if (!out.used[k] || k == out.placing.first) continue;
      const SealImpression others = mean_of_views(views, k, nullptr);
      out.placing.seal_from_band[k] = after(
          from_canvas, refined(others, impressions[k], after(to_canvas, before.seal_from_band[k]), canvas.turn_mm));
    }
  }
  return out;
}

}  // namespace dubsar
