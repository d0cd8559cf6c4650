#include "core/seals/ground_spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace dubsar {
namespace {

constexpr double kCellMm = 0.5;             // of the plate: marks of fingers are some millimetres wide
constexpr int kMostAcross = 64;             // cells of the shorter side
constexpr double kUnmeasuredCounts = 1e-4;  // of a measured cell, towards what was there before

struct PlateRound {
  double stiff_mm;  ///< what is narrower is bridged
  double width;     ///< of the biweight, shares of what figures stand out
};
// From bodies' own breadth and more than they stand out to half of a body and somewhat more than noise.
constexpr std::array<PlateRound, 3> kPlateRounds{{{8.0, 1.1}, {4.0, 0.75}, {2.0, 0.37}}};
constexpr int kRepeats = 3;  // of each
constexpr double kLastStiffMm = 1.5;
constexpr int kLastRounds = 2;
constexpr double kFigureShare = 0.45;  // of what figures stand out: more, up or down, is none of the ground
constexpr double kFootMm = 0.3;        // beside that: its flank

/// A symmetric positive matrix of `size` rows whose entries lie at most `band` beside the diagonal; row by row, the
/// diagonal first and then what is left of it.
class BandMatrix {
 public:
  BandMatrix(int size, int band) : size_(size), band_(band), at_(static_cast<std::size_t>(size) * stride()) {}

  double& at(int row, int column) {
    return at_[static_cast<std::size_t>(row) * stride() + static_cast<std::size_t>(row - column)];
  }
  void scale(double by) {
    for (double& entry : at_) entry *= by;
  }
  void add_square(std::span<const int> places, std::span<const double> factors, double weight) {
    for (std::size_t a = 0; a < places.size(); ++a)
      for (std::size_t b = 0; b < places.size(); ++b)
        if (places[a] >= places[b]) at(places[a], places[b]) += weight * factors[a] * factors[b];
  }
  /// Cholesky's factors take the place of the matrix; then the solution that of the right side.
  void solve(std::vector<double>& x) {
    for (int r = 0; r < size_; ++r) {
      for (int c = std::max(0, r - band_); c <= r; ++c) {
        double sum = at(r, c);
        for (int k = std::max(0, r - band_); k < c; ++k) sum -= at(r, k) * at(c, k);
        at(r, c) = c < r ? sum / at(c, c) : std::sqrt(sum);
      }
      double sum = x[static_cast<std::size_t>(r)];
      for (int k = std::max(0, r - band_); k < r; ++k) sum -= at(r, k) * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(r)] = sum / at(r, r);
    }
    for (int r = size_ - 1; r >= 0; --r) {
      const double value = x[static_cast<std::size_t>(r)] /= at(r, r);
      for (int k = std::max(0, r - band_); k < r; ++k) x[static_cast<std::size_t>(k)] -= at(r, k) * value;
    }
  }

 private:
  std::size_t stride() const { return static_cast<std::size_t>(band_) + 1; }
  int size_, band_;
  std::vector<double> at_;
};

/// The plate's cells; neighbours in memory lie along the shorter side of the raster.
class Plate {
 public:
  explicit Plate(const GroundRaster& raster) : raster_(raster), upright_(raster.width >= raster.height) {
    const double shorter = raster.step_mm * std::min(raster.width, raster.height),
                 longer = raster.step_mm * std::max(raster.width, raster.height);
    cell_mm_ = std::max(kCellMm, shorter / kMostAcross);
    across_ = std::max(3, static_cast<int>(std::ceil(shorter / cell_mm_)));
    along_ = std::max(3, static_cast<int>(std::ceil(longer / cell_mm_)));
    BandMatrix bends(cells(), 2 * across_);
    constexpr std::array<double, 3> kSecond{1.0, -2.0, 1.0};
    constexpr std::array<double, 4> kTwist{1.0, -1.0, -1.0, 1.0};
    for (int i = 0; i < along_; ++i)
      for (int j = 0; j < across_; ++j) {
        if (i + 2 < along_) bends.add_square(std::array{cell(i, j), cell(i + 1, j), cell(i + 2, j)}, kSecond, 1.0);
        if (j + 2 < across_) bends.add_square(std::array{cell(i, j), cell(i, j + 1), cell(i, j + 2)}, kSecond, 1.0);
        if (i + 1 < along_ && j + 1 < across_)
          bends.add_square(std::array{cell(i, j), cell(i, j + 1), cell(i + 1, j), cell(i + 1, j + 1)}, kTwist, 2.0);
      }
    bends_ = std::move(bends);
  }

  int cells() const { return along_ * across_; }
  int cell_of(int x, int y) const {
    const auto part = [&](int k, int count) {
      return std::min(static_cast<int>((k + 0.5) * raster_.step_mm / cell_mm_), count - 1);
    };
    return upright_ ? cell(part(x, along_), part(y, across_)) : cell(part(y, along_), part(x, across_));
  }

  /// Goes through the heights of cells as much as they weigh; `height` was the last plate, and is the next.
  void settle(const std::vector<double>& heights, const std::vector<double>& weights, double stiff_mm,
              std::vector<double>& height) const {
    // A wave of this length sinks to half where each cell weighs one.
    const double stiff = 0.1 * std::pow(0.5 * stiff_mm / cell_mm_, 4);
    BandMatrix matrix = bends_;
    matrix.scale(stiff);
    for (int k = 0; k < cells(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      matrix.at(k, k) += weights[at] + kUnmeasuredCounts;
      height[at] = weights[at] * heights[at] + kUnmeasuredCounts * height[at];
    }
    matrix.solve(height);
  }

  /// Means over the cells and how full they are, of values that count by their weights.
  void gather(const std::vector<float>& values, const std::vector<float>& weights, std::vector<double>& means,
              std::vector<double>& full) const {
    means.assign(static_cast<std::size_t>(cells()), 0.0);
    full.assign(means.size(), 0.0);
    for (int y = 0; y < raster_.height; ++y)
      for (int x = 0; x < raster_.width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.width) +
                               static_cast<std::size_t>(x),
                          k = static_cast<std::size_t>(cell_of(x, y));
        means[k] += static_cast<double>(weights[at] * values[at]);
        full[k] += static_cast<double>(weights[at]);
      }
    for (std::size_t k = 0; k < means.size(); ++k) {
      means[k] = full[k] > 0.0 ? means[k] / full[k] : 0.0;
      full[k] *= raster_.step_mm * raster_.step_mm / (cell_mm_ * cell_mm_);
    }
  }

  /// Between middles of cells.
  std::vector<float> over_raster(const std::vector<double>& height) const {
    std::vector<float> out;
    out.reserve(static_cast<std::size_t>(raster_.width) * static_cast<std::size_t>(raster_.height));
    for (int y = 0; y < raster_.height; ++y)
      for (int x = 0; x < raster_.width; ++x) {
        const auto place = [&](int k, int count) {
          return std::clamp((k + 0.5) * raster_.step_mm / cell_mm_ - 0.5, 0.0, count - 1.000001);
        };
        const double u = place(upright_ ? x : y, along_), v = place(upright_ ? y : x, across_);
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        const auto at = [&](int a, int b) { return height[static_cast<std::size_t>(cell(a, b))]; };
        const double near = (1 - (v - j)) * at(i, j) + (v - j) * at(i, j + 1),
                     far = (1 - (v - j)) * at(i + 1, j) + (v - j) * at(i + 1, j + 1);
        out.push_back(static_cast<float>((1 - (u - i)) * near + (u - i) * far));
      }
    return out;
  }

 private:
  int cell(int i, int j) const { return i * across_ + j; }
  GroundRaster raster_;
  bool upright_;
  double cell_mm_ = kCellMm;
  int along_ = 0, across_ = 0;
  BandMatrix bends_{1, 1};
};

/// 1 where a value is within `reach` places of one, in squares.
std::vector<float> grown(std::vector<float> marks, const GroundRaster& raster, int reach) {
  const auto pass = [&](int lines, int line_stride, int count, int stride) {
    std::vector<float> out(marks.size());
    for (int line = 0; line < lines; ++line)
      for (int k = 0, last = -reach - 1; k < count + reach; ++k) {
        const auto at = [&](int i) { return static_cast<std::size_t>(line * line_stride + i * stride); };
        if (k < count && marks[at(k)] > 0.0f) last = k;
        if (k >= reach && last >= k - 2 * reach) out[at(k - reach)] = 1.0f;
      }
    marks = std::move(out);
  };
  pass(raster.height, raster.width, raster.width, 1);
  pass(raster.width, 1, raster.height, raster.width);
  return marks;
}

}  // namespace

std::vector<float> ground_under(const std::vector<float>& mm, const std::vector<float>& measured,
                                const GroundRaster& raster, double stands_mm) {
  const Plate plate(raster);
  std::vector<double> heights, full, weights;
  plate.gather(mm, measured, heights, full);
  std::vector<double> known;
  for (std::size_t k = 0; k < heights.size(); ++k)
    if (full[k] > 0.0) known.push_back(heights[k]);
  double middle = 0.0;
  if (!known.empty()) {
    const auto at = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), at, known.end());
    middle = *at;
  }
  std::vector<double> height(heights.size(), middle);
  for (const PlateRound& round : kPlateRounds)
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      weights.assign(heights.size(), 0.0);
      for (std::size_t k = 0; k < weights.size(); ++k) {
        const double t = (heights[k] - height[k]) / (round.width * stands_mm);
        if (std::abs(t) < 1.0) weights[k] = full[k] * (1.0 - t * t) * (1.0 - t * t);
      }
      plate.settle(heights, weights, round.stiff_mm, height);
    }
  for (int round = 0; round < kLastRounds; ++round) {
    const std::vector<float> sheet = plate.over_raster(height);
    std::vector<float> figures(mm.size()), ground(mm.size());
    for (std::size_t k = 0; k < mm.size(); ++k)
      figures[k] = static_cast<double>(std::abs(mm[k] - sheet[k])) > kFigureShare * stands_mm ? measured[k] : 0.0f;
    figures = grown(std::move(figures), raster, static_cast<int>(kFootMm / raster.step_mm));
    for (std::size_t k = 0; k < mm.size(); ++k) ground[k] = measured[k] * (1.0f - figures[k]);
    plate.gather(mm, ground, heights, weights);
    plate.settle(heights, weights, kLastStiffMm, height);
  }
  return plate.over_raster(height);
}

}  // namespace dubsar
