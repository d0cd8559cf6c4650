#include "core/mesh/writing/tail_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dubsar {
namespace {

constexpr int kQuarter = kTailDirections / 4;

// Shares of kinds of wedges by the direction of the tail, and how far around it tails point. Horizontals and verticals
// alike: hands and periods differ in which is the more frequent. What is left are wrong fits, of any direction.
struct Kind {
  double degrees, share;
};
constexpr std::array<Kind, 4> kKinds{{{0.0, 0.32}, {-90.0, 0.32}, {-45.0, 0.09}, {45.0, 0.06}}};
constexpr double kSpreadDegrees = 14.0;

// Several pits are often of one wedge, and what one is fitted to is dug by its neighbours, too: they are not as many
// witnesses as there are pits. Chosen so that what is said with a probability of p is right in p of the cases, on
// windows of phantoms (docs/fatcross.md).
constexpr double kIndependent = 0.8;

// Shares of marks without a direction in a text; where more of them have none, it is no text but the grain of the clay
// or of the mesh, which may prefer a direction, too.
constexpr std::array<double, 7> kStray{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
constexpr double kNoText = 0.3;  // of sides and sizes

using Law = std::array<double, kTailDirections>;

Law law_of_tails() {
  Law out{};
  double rest = 1.0;
  for (const Kind& kind : kKinds) {
    Law bell{};
    double sum = 0.0;
    for (int d = 0; d < kTailDirections; ++d) {
      const double off = std::remainder(360.0 * d / kTailDirections - kind.degrees, 360.0) / kSpreadDegrees;
      sum += bell[static_cast<std::size_t>(d)] = std::exp(-0.5 * off * off);
    }
    for (int d = 0; d < kTailDirections; ++d)
      out[static_cast<std::size_t>(d)] += kind.share * bell[static_cast<std::size_t>(d)] / sum;
    rest -= kind.share;
  }
  for (double& p : out) p += rest / kTailDirections;
  return out;
}

std::size_t around(int direction) {
  return static_cast<std::size_t>(((direction % kTailDirections) + kTailDirections) % kTailDirections);
}

/// Log of the mean over the shares of stray marks of the likelihood ratio.
double log_ratio(const std::array<double, kTailDirections>& counts, const Law& law) {
  std::array<double, kStray.size()> logs{};
  for (std::size_t k = 0; k < kStray.size(); ++k)
    for (std::size_t d = 0; d < counts.size(); ++d)
      logs[k] += kIndependent * counts[d] * std::log(kStray[k] + (1.0 - kStray[k]) * law[d] * kTailDirections);
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double l : logs) sum += std::exp(l - most);
  return std::log(kNoText + (1.0 - kNoText) * std::exp(most) * sum / static_cast<double>(kStray.size()));
}

}  // namespace

TextTurns text_turns(std::span<const FoundWedge> impressions) {
  static const Law law = law_of_tails();
  std::array<double, kTailDirections> counts{};
  for (const FoundWedge& i : impressions) counts[around(i.tail)] += 1.0;
  TextTurns out;
  for (int turn = 0; turn < 4; ++turn) {
    Law written{}, mirrored{};
    for (int d = 0; d < kTailDirections; ++d) {
      const int of_text = d - kQuarter * turn;
      written[around(d)] = law[around(of_text)];
      mirrored[around(d)] = law[around(kTailDirections / 2 - of_text)];
    }
    out.written[static_cast<std::size_t>(turn)] = log_ratio(counts, written);
    out.mirrored[static_cast<std::size_t>(turn)] = log_ratio(counts, mirrored);
  }
  return out;
}

}  // namespace dubsar
