#include "core/script/line_cuts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dubsar {
namespace {

// Lengths in widths of a head.
constexpr double kCutBin = 0.1;
constexpr double kCutClimb = 5.0;   // degrees
constexpr double kCutSag = 1.0;     // of a line's middle below its ends, at most
constexpr double kClearer = 1.002;  // of the sum of squares: a steeper or more bent line has to be worth it
constexpr std::size_t kFewest = 4;  // bodies that can say how lines climb
constexpr double kLeastPitch = 2.0, kMostPitch = 6.0, kPitchStep = 1.03;
constexpr double kLeastBand = 0.7, kMostBand = 1.4;  // of the pitch
// Nats. How surely a body keeps within its line, and what a stray one costs at most; a band that is not as high as the
// others; a line. On phantoms .12 to .25, 4 to 12 and 8 to 14 number alike; with 2 a line lines fall apart into their
// rows of horizontals, with 16 two of few wedges are one.
constexpr double kBandEdge = 0.12, kBandStray = 6.0, kBandUneven = 12.0, kBandCost = 12.0;
constexpr double kNoCut = std::numeric_limits<double>::infinity();

/// A body in its side, along lines that are straight and level.
struct Row {
  double low, high, middle;
};

/// How lines of a side run: up by slope and bend (per mm) times the way along them from `middle`.
struct LineShape {
  double middle = 0.0, slope = 0.0, bend = 0.0;
  double height_at(double along) const { return (slope + bend * (along - middle)) * (along - middle); }
};

std::vector<Row> rows_of(const std::vector<TextBody>& bodies, const LineShape& shape, double width) {
  std::vector<Row> rows;
  for (const TextBody& b : bodies) {
    const double off = shape.height_at(b.along), low = (b.low - off) / width, high = (b.high - off) / width;
    rows.push_back({low, high, 0.5 * (low + high)});
  }
  return rows;
}

/// How clearly what is written stands apart: the sum of squares of how many bodies there are at each height.
double squares_of(const std::vector<Row>& rows) {
  double low = 1e30, high = -1e30;
  for (const Row& r : rows) low = std::min(low, r.low), high = std::max(high, r.high);
  std::vector<int> count(static_cast<std::size_t>((high - low) / kCutBin) + 2, 0);
  for (const Row& r : rows)
    for (auto k = static_cast<std::size_t>((r.low - low) / kCutBin);
         k <= static_cast<std::size_t>((r.high - low) / kCutBin); ++k)
      ++count[k];
  double sum = 0.0;
  for (const int c : count) sum += static_cast<double>(c) * c;
  return sum;
}

LineShape shape_of(const std::vector<TextBody>& bodies, double width) {
  LineShape out;
  if (bodies.size() < kFewest) return out;
  double left = 1e30, right = -1e30;
  for (const TextBody& b : bodies) left = std::min(left, b.along), right = std::max(right, b.along);
  out.middle = 0.5 * (left + right);
  const double half = 0.5 * std::max(right - left, width);
  double best = -1.0;
  const auto side_of = [](int k) { return (k % 2 ? -1.0 : 1.0) * ((k + 1) / 2); };  // 0, -1, 1, -2, 2 ..
  LineShape tried = out;
  for (int sag = 0; sag <= 8; ++sag)
    for (int climb = 0; climb <= 40; ++climb) {
      tried.bend = side_of(sag) / 4.0 * kCutSag * width / (half * half);
      tried.slope = std::tan(kCutClimb * side_of(climb) / 20.0 * std::numbers::pi / 180.0);
      const double sum = squares_of(rows_of(bodies, tried, width));
      if (sum > kClearer * best) {
        best = sum;
        out = tried;
      }
    }
  return out;
}

/// A side, and what each band of it would cost as a line: from a height, a number of bins high.
class SideBands {
 public:
  SideBands(const std::vector<TextBody>& bodies, double width)
      : rows_(rows_of(bodies, shape_of(bodies, width), width)), sorted_(rows_) {
    std::sort(sorted_.begin(), sorted_.end(), [](const Row& a, const Row& b) { return a.middle < b.middle; });
    constexpr double kBeyond = 0.5 * kMostPitch;  // a line may reach beyond what is written in it
    low_ = sorted_.front().middle - kBeyond;
    heights_ = static_cast<int>((sorted_.back().middle + kBeyond - low_) / kCutBin) + 2;
    costs_.resize(static_cast<std::size_t>(heights_) * kHighs);
    for (int from = 0; from < heights_; ++from)
      for (int bins = kLow; bins <= kHigh && from + bins < heights_; ++bins) cost(from, bins) = band_cost(from, bins);
  }

  /// The least cost with lines of this pitch; `cuts`, if wanted: the heights between and beside lines, rising.
  double least(double pitch, std::vector<double>* cuts) const {
    const double bins = pitch / kCutBin;
    const int low = std::max(kLow, static_cast<int>(kLeastBand * bins)),
              high = std::min(kHigh, static_cast<int>(kMostBand * bins));
    std::vector<double> best(static_cast<std::size_t>(heights_), kNoCut);
    std::vector<int> before(best.size(), -1);
    int end = -1;
    for (int at = 0; at < heights_; ++at) {
      const auto here = static_cast<std::size_t>(at);
      if (height(at) <= sorted_.front().middle) {
        best[here] = 0.0;
        continue;
      }
      for (int k = low; k <= std::min(high, at); ++k) {
        const double uneven = k / bins - 1.0;
        const double sum = best[here - static_cast<std::size_t>(k)] + cost(at - k, k) + kBandUneven * uneven * uneven;
        if (!(sum < best[here])) continue;
        best[here] = sum;
        before[here] = at - k;
      }
      if (height(at) > sorted_.back().middle && (end < 0 || best[here] < best[static_cast<std::size_t>(end)])) end = at;
    }
    for (int at = end; cuts && at >= 0; at = before[static_cast<std::size_t>(at)]) cuts->push_back(height(at));
    if (cuts) std::reverse(cuts->begin(), cuts->end());
    return end < 0 ? kNoCut : best[static_cast<std::size_t>(end)];
  }

  std::vector<int> numbered(double pitch) const {
    std::vector<double> cuts;
    least(pitch, &cuts);
    std::vector<int> out;
    for (const Row& r : rows_)
      out.push_back(static_cast<int>(cuts.end() - std::upper_bound(cuts.begin(), cuts.end(), r.middle)));
    return out;
  }

 private:
  static constexpr int kLow = static_cast<int>(kLeastPitch * kLeastBand / kCutBin);
  static constexpr int kHigh = static_cast<int>(kMostPitch * kMostBand / kCutBin);
  static constexpr std::size_t kHighs = kHigh + 1;

  double height(int k) const { return low_ + k * kCutBin; }
  double& cost(int from, int bins) {
    return costs_[static_cast<std::size_t>(from) * kHighs + static_cast<std::size_t>(bins)];
  }
  double cost(int from, int bins) const {
    return costs_[static_cast<std::size_t>(from) * kHighs + static_cast<std::size_t>(bins)];
  }
  double band_cost(int from, int bins) const {
    const double low = height(from), high = height(from + bins);
    const auto first =
        std::partition_point(sorted_.begin(), sorted_.end(), [&](const Row& r) { return r.middle < low; });
    double sum = kBandCost;
    auto at = first;
    for (; at != sorted_.end() && at->middle < high; ++at) {
      const double beyond = std::max(0.0, low - at->low) + std::max(0.0, at->high - high);
      sum += std::min(kBandStray, beyond / kBandEdge) +
             std::log(std::max(0.0, high - low - (at->high - at->low)) + kBandEdge);
    }
    return at == first ? kNoCut : sum;
  }

  std::vector<Row> rows_, sorted_;
  double low_ = 0.0;
  int heights_ = 0;
  std::vector<double> costs_;
};

}  // namespace

std::vector<std::vector<int>> lines_of(const std::vector<std::vector<TextBody>>& sides, double width_mm) {
  std::vector<std::vector<int>> out(sides.size());
  std::vector<SideBands> bands;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    out[s].assign(sides[s].size(), 1);
    if (!sides[s].empty() && width_mm > 0.0) bands.emplace_back(sides[s], width_mm);
  }
  double pitch = 0.0, best = kNoCut;
  for (double tried = kLeastPitch; tried <= kMostPitch && !bands.empty(); tried *= kPitchStep) {
    double sum = 0.0;
    for (const SideBands& side : bands) sum += side.least(tried, nullptr);
    if (!(sum < best)) continue;
    best = sum;
    pitch = tried;
  }
  if (!(pitch > 0.0)) return out;
  std::size_t next = 0;
  for (auto& lines : out)
    if (!lines.empty()) lines = bands[next++].numbered(pitch);
  return out;
}

}  // namespace dubsar
