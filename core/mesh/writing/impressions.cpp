#include "core/mesh/writing/impressions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr double kWidth = kStepsPerWedge;
constexpr int kClose = 6;               // steps: three quarters of a width, which closes a wedge
constexpr double kBall = 4.0 * kWidth;  // radius of what closes it: a wedge stays deep, a curved side stays bare
constexpr double kLeastDepth = 0.12;    // of a width: less is a ruling, a scratch, grain of the clay
constexpr double kMostDepth = 0.9;      // of a width: more is a rim, a hole
constexpr double kSteepest = 1.0;       // slope of the closed surface: beyond it another side sees the place better
constexpr int kApart = 2;               // steps between deepest places
constexpr int kReach = 13;              // steps of the patch that a wedge is fitted in
constexpr double kSeen = 0.7;           // of the patch, by weight
constexpr double kDeeper = 0.5;         // what a neighbour dug counts, and at most a quarter of the depth squared
constexpr std::size_t kMostImpressions = 1500;
constexpr float kOutside = -std::numeric_limits<float>::infinity();

/// Values on the lattice of a height map, in steps.
struct Lattice {
  int width = 0, height = 0;
  std::vector<float> values;
  float& at(int x, int y) {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  float at(int x, int y) const { return const_cast<Lattice&>(*this).at(x, y); }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

/// Largest of value - sag within kClose steps along one axis; -inf is nothing.
Lattice raised(const Lattice& in, int dx, int dy) {
  Lattice out{in.width, in.height, std::vector<float>(in.values.size(), kOutside)};
  for (int y = 0; y < in.height; ++y)
    for (int k = -kClose; k <= kClose; ++k) {
      const int from = y + k * dy;
      if (from < 0 || from >= in.height) continue;
      const auto sag = static_cast<float>(k * k / (2.0 * kBall));
      const int first = std::max(0, -k * dx), end = std::min(in.width, in.width - k * dx);
      float* const to = out.values.data() + static_cast<std::ptrdiff_t>(y) * in.width;
      const float* const values = in.values.data() + static_cast<std::ptrdiff_t>(from) * in.width + k * dx;
      for (int x = first; x < end; ++x) to[x] = std::max(to[x], values[x] - sag);
    }
  return out;
}

/// The surface that the ball touches: raised by it, and lowered again.
Lattice closed(const Lattice& heights) {
  Lattice up = raised(raised(heights, 1, 0), 0, 1);
  for (float& v : up.values) v = v == kOutside ? kOutside : -v;
  Lattice down = raised(raised(up, 1, 0), 0, 1);
  for (float& v : down.values) v = -v;
  return down;
}

/// Depth below the closed surface in widths; negative where nothing can be said.
Lattice depths(const HeightMap& map) {
  Lattice heights{map.width, map.height, std::vector<float>(map.mm.size())};
  for (std::size_t i = 0; i < map.mm.size(); ++i)
    heights.values[i] = std::isnan(map.mm[i]) ? kOutside : map.mm[i] / static_cast<float>(map.step_mm);
  const Lattice above = closed(heights);
  Lattice out{map.width, map.height, std::vector<float>(map.mm.size(), -1.f)};
  constexpr int kHalf = kStepsPerWedge / 2;
  for (int y = kHalf; y < map.height - kHalf; ++y)
    for (int x = kHalf; x < map.width - kHalf; ++x) {
      const float depth = (above.at(x, y) - heights.at(x, y)) / static_cast<float>(kWidth);
      const double right = static_cast<double>(above.at(x + kHalf, y) - above.at(x - kHalf, y)) / (2.0 * kHalf);
      const double up = static_cast<double>(above.at(x, y + kHalf) - above.at(x, y - kHalf)) / (2.0 * kHalf);
      if (depth < static_cast<float>(kMostDepth) && std::hypot(right, up) < kSteepest)
        out.at(x, y) = std::max(0.f, depth);
    }
  return out;
}

/// Binomial weights of three by three; nothing is said beside what nothing is said of.
Lattice blurred(const Lattice& in) {
  Lattice out{in.width, in.height, std::vector<float>(in.values.size(), -1.f)};
  for (int y = 1; y + 1 < in.height; ++y)
    for (int x = 1; x + 1 < in.width; ++x) {
      float sum = 0.f;
      bool known = true;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const float v = in.at(x + dx, y + dy);
          known = known && v >= 0.f;
          sum += v * static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy)));
        }
      if (known) out.at(x, y) = sum / 16.f;
    }
  return out;
}

/// Indices of the deepest places.
std::vector<std::size_t> deepest_places(const Lattice& depth) {
  std::vector<std::size_t> out;
  for (int y = kApart; y < depth.height - kApart; ++y)
    for (int x = kApart; x < depth.width - kApart; ++x) {
      const float here = depth.at(x, y);
      if (here < static_cast<float>(kLeastDepth)) continue;
      bool deepest = true;
      for (int dy = -kApart; dy <= kApart && deepest; ++dy)
        for (int dx = -kApart; dx <= kApart && deepest; ++dx) {
          const bool before = dy < 0 || (dy == 0 && dx < 0);
          const float there = depth.at(x + dx, y + dy);
          deepest = before ? there < here : there <= here;
        }
      if (deepest)
        out.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width) +
                      static_cast<std::size_t>(x));
    }
  std::stable_sort(out.begin(), out.end(),
                   [&](std::size_t a, std::size_t b) { return depth.values[a] > depth.values[b]; });
  if (out.size() > kMostImpressions) out.resize(kMostImpressions);
  return out;
}

constexpr int kSide = 2 * kReach + 1;
constexpr std::size_t kLanes = 16;  // sums side by side, so that they are one instruction
constexpr std::size_t kPatch = (static_cast<std::size_t>(kSide) * kSide + kLanes - 1) / kLanes * kLanes;
using Patch = std::array<float, kPatch>;

/// Wedges of unit depth with their deepest place in the middle of the patch: the head h before it, the tail's end L
/// after the head's edge; z = min(1 + a / h, 1 - a / (L - h) - |b| 2 L / ((L - h) W)), cut at 0.
struct Templates {
  static constexpr std::array<double, 3> kWidths{0.7, 1.0, 1.4};   // of the width that is searched for
  static constexpr std::array<double, 3> kLengths{1.2, 1.8, 2.6};  // of the wedge's own width
  static constexpr double kHead = 0.24;
  std::vector<Patch> wedges;  // those of a direction behind each other
  Patch weights{};

  Templates() {
    for (int d = 0; d < kTailDirections; ++d)
      for (const double w : kWidths)
        for (const double l : kLengths) wedges.push_back(wedge(2.0 * std::numbers::pi * d / kTailDirections, w, l));
    fill(weights, [](double x, double y) { return std::exp(-0.5 * (x * x + y * y) / (0.8 * 0.8)); });
  }

 private:
  template <class Value>
  static void fill(Patch& patch, const Value& value) {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        patch[static_cast<std::size_t>(y * kSide + x)] =
            static_cast<float>(value((x - kReach) / kWidth, (y - kReach) / kWidth));
  }
  static Patch wedge(double direction, double width, double lengths) {
    const double length = lengths * width, head = kHead * width, tail = length - head;
    const double c = std::cos(direction), s = std::sin(direction);
    Patch out{};
    fill(out, [&](double x, double y) {
      const double a = c * x + s * y, b = std::abs(c * y - s * x);
      return std::max(0.0, std::min(1.0 + a / head, 1.0 - a / tail - b * 2.0 * length / (tail * width)));
    });
    return out;
  }
};

/// The direction that fits, or -1 where too little of the patch is known.
int tail_direction(const Lattice& depth, int at_x, int at_y, const Templates& templates) {
  Patch found{}, weight{};
  const float deepest = depth.at(at_x, at_y);
  double seen = 0.0, all = 0.0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const auto i = static_cast<std::size_t>(y * kSide + x);
      const int mx = at_x + x - kReach, my = at_y + y - kReach;
      const bool known = depth.inside(mx, my) && depth.at(mx, my) >= 0.f;
      found[i] = known ? depth.at(mx, my) / deepest : 0.f;
      weight[i] = known ? templates.weights[i] : 0.f;
      seen += static_cast<double>(weight[i]);
      all += static_cast<double>(templates.weights[i]);
    }
  if (seen < kSeen * all) return -1;
  const std::size_t each = templates.wedges.size() / kTailDirections;
  std::size_t best = 0;
  float least = std::numeric_limits<float>::max();
  for (std::size_t t = 0; t < templates.wedges.size(); ++t) {
    const Patch& wedge = templates.wedges[t];
    std::array<float, kLanes> sums{};
    for (std::size_t i = 0; i < kPatch; i += kLanes)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float off = found[i + lane] - wedge[i + lane], over = std::max(off, 0.f), under = off - over;
        sums[lane] += weight[i + lane] * (under * under + static_cast<float>(kDeeper) * std::min(over * over, 0.25f));
      }
    const float sum = std::accumulate(sums.begin(), sums.end(), 0.f);
    if (sum < least) {
      least = sum;
      best = t;
    }
  }
  return static_cast<int>(best / each);
}

}  // namespace

std::vector<FoundWedge> find_impressions(const HeightMap& map) {
  if (std::min(map.width, map.height) <= kStepsPerWedge) return {};
  static const Templates templates;
  const Lattice depth = blurred(depths(map));
  const std::vector<std::size_t> places = deepest_places(depth);
  std::vector<int> tails(places.size());
  const auto width = static_cast<std::size_t>(map.width);
  parallel_for(static_cast<std::int64_t>(places.size()), 16, [&](std::int64_t k) {
    const std::size_t i = places[static_cast<std::size_t>(k)];
    tails[static_cast<std::size_t>(k)] =
        tail_direction(depth, static_cast<int>(i % width), static_cast<int>(i / width), templates);
  });
  std::vector<FoundWedge> out;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (tails[k] >= 0)
      out.push_back({tails[k], static_cast<float>(places[k] % width) / static_cast<float>(map.width - 1),
                     static_cast<float>(places[k] / width) / static_cast<float>(map.height - 1)});
  return out;
}

}  // namespace dubsar
