#include "core/mesh/side_relief.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "core/mesh/quadratic_sheet.h"

namespace dubsar {
namespace {

constexpr double kMostSteps = 1600.0;
constexpr int kReach = 12;         // steps: wider than a wedge, narrower than the curve of a side
constexpr double kRim = 1.3;       // slope of the neighbourhood, above it the surface turns to another side
constexpr double kSteepest = 1.5;  // slopes count up to this: walls beyond it are steps of the height map
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// Sums over rectangles in constant time; NaN counts as nothing.
class Sums {
 public:
  Sums(const std::vector<float>& values, int width, int height) : width_(width), height_(height) {
    sum_.assign(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1), 0.0);
    count_.assign(sum_.size(), 0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float v =
            values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
        const bool known = !std::isnan(v);
        sum_[index(x + 1, y + 1)] =
            (known ? static_cast<double>(v) : 0.0) + sum_[index(x, y + 1)] + sum_[index(x + 1, y)] - sum_[index(x, y)];
        count_[index(x + 1, y + 1)] =
            (known ? 1 : 0) + count_[index(x, y + 1)] + count_[index(x + 1, y)] - count_[index(x, y)];
      }
  }
  /// The mean around (x, y) and the share of places that are known.
  std::array<double, 2> mean(int x, int y, int reach) const {
    const int x0 = std::max(0, x - reach), x1 = std::min(width_, x + reach + 1);
    const int y0 = std::max(0, y - reach), y1 = std::min(height_, y + reach + 1);
    const double sum = sum_[index(x1, y1)] - sum_[index(x0, y1)] - sum_[index(x1, y0)] + sum_[index(x0, y0)];
    const auto count = static_cast<double>(count_[index(x1, y1)] - count_[index(x0, y1)] - count_[index(x1, y0)] +
                                           count_[index(x0, y0)]);
    const double all = (2.0 * reach + 1) * (2.0 * reach + 1);
    return {count > 0 ? sum / count : 0.0, count / all};
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<double> sum_;
  std::vector<std::int64_t> count_;
};

/// Slopes between neighbours; NaN where one is missing.
std::vector<float> slopes(const HeightMap& map, int dx, int dy) {
  std::vector<float> out(map.mm.size(), kNothing);
  for (int y = dy; y < map.height - dy; ++y)
    for (int x = dx; x < map.width - dx; ++x)
      out[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x)] =
          static_cast<float>((map.at(x + dx, y + dy) - map.at(x - dx, y - dy)) / (2.0 * map.step_mm));
  return out;
}

void fill(HeightMap& map, const std::array<glm::dvec3, 3>& p) {  // in steps; z in mm
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  if (!(area > 1e-12)) return;  // turned away, or edge on
  const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({p[0].x, p[1].x, p[2].x}))));
  const int x1 = std::min(map.width - 1, static_cast<int>(std::floor(std::max({p[0].x, p[1].x, p[2].x}))));
  const int y0 = std::max(0, static_cast<int>(std::ceil(std::min({p[0].y, p[1].y, p[2].y}))));
  const int y1 = std::min(map.height - 1, static_cast<int>(std::floor(std::max({p[0].y, p[1].y, p[2].y}))));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double a = ((p[1].x - x) * (p[2].y - y) - (p[2].x - x) * (p[1].y - y)) / area;
      const double b = ((p[2].x - x) * (p[0].y - y) - (p[0].x - x) * (p[2].y - y)) / area;
      const double c = 1.0 - a - b;
      if (a < 0 || b < 0 || c < 0) continue;
      float& height =
          map.mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x)];
      const auto found = static_cast<float>(a * p[0].z + b * p[1].z + c * p[2].z);
      if (std::isnan(height) || found > height) height = found;
    }
}

}  // namespace

HeightMap height_map(std::span<const glm::dvec3> points_mm, std::span<const Triangle> triangles, const SideAxes& side,
                     double step_mm) {
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  std::vector<glm::dvec3> places(points_mm.size());  // along the axes of the side; a vertex is of six triangles
  for (std::size_t v = 0; v < places.size(); ++v) {
    const glm::dvec3& p = points_mm[v];
    places[v] = {glm::dot(p, side.right), glm::dot(p, side.up), glm::dot(p, side.front)};
    low = glm::min(low, glm::dvec2(places[v]));
    high = glm::max(high, glm::dvec2(places[v]));
  }
  HeightMap map;
  map.step_mm = std::max({step_mm, (high.x - low.x) / kMostSteps, (high.y - low.y) / kMostSteps});
  map.width = static_cast<int>((high.x - low.x) / map.step_mm) + 1;
  map.height = static_cast<int>((high.y - low.y) / map.step_mm) + 1;
  map.mm.assign(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), kNothing);
  for (glm::dvec3& p : places) {
    p.x = (p.x - low.x) / map.step_mm;
    p.y = (p.y - low.y) / map.step_mm;
  }
  for (const Triangle& t : triangles) fill(map, {places[t[0]], places[t[1]], places[t[2]]});
  return map;
}

std::array<double, 2> slope_skew(const HeightMap& map) {
  const std::vector<float> right = slopes(map, 1, 0), up = slopes(map, 0, 1);
  const Sums mean_right(right, map.width, map.height), mean_up(up, map.width, map.height);
  std::array<double, 2> skew{0.0, 0.0};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
      if (std::isnan(right[i]) || std::isnan(up[i])) continue;
      const auto [broad_right, known] = mean_right.mean(x, y, kReach);
      const double broad_up = mean_up.mean(x, y, kReach)[0];
      if (known < 0.85 || std::hypot(broad_right, broad_up) > kRim) continue;
      const double a = std::clamp(static_cast<double>(right[i]) - broad_right, -kSteepest, kSteepest);
      const double b = std::clamp(static_cast<double>(up[i]) - broad_up, -kSteepest, kSteepest);
      skew[0] += a * a * a;
      skew[1] += b * b * b;
    }
  for (double& s : skew) s *= map.step_mm * map.step_mm;
  return skew;
}

namespace {

constexpr double kInner = 0.8;       // of the extents each way
constexpr int kFitSteps = 160;       // places looked at each way
constexpr double kImpression = 0.6;  // deviations below the sheet: an impression
constexpr double kBump = 2.5;        // and above it: something that does not belong to it

}  // namespace

double side_rise_mm(const HeightMap& map) {
  struct Place {
    SheetTerms terms;
    double mm;
    bool used = true;
  };
  std::vector<Place> places;
  for (int j = 0; j < kFitSteps; ++j)
    for (int i = 0; i < kFitSteps; ++i) {
      const auto place = [](int step, int size) {
        return static_cast<int>(std::lround(0.5 * (size - 1) * (1.0 + kInner * (2.0 * step / (kFitSteps - 1) - 1.0))));
      };
      const int column = place(i, map.width), row = place(j, map.height);
      const double x = 2.0 * column / std::max(1, map.width - 1) - 1.0;
      const double y = 2.0 * row / std::max(1, map.height - 1) - 1.0;
      const float mm = map.at(column, row);
      if (!std::isnan(mm)) places.push_back({sheet_terms(x, y), static_cast<double>(mm)});
    }
  SheetTerms sheet{};
  for (int turn = 0; turn < 12; ++turn) {
    SheetEquations equations;
    for (const Place& place : places)
      if (place.used) equations.add(place.terms, place.mm);
    sheet = equations.solved(1e-9).value_or(SheetTerms{});
    const auto above = [&](const Place& place) { return place.mm - sheet_height(sheet, place.terms); };
    double squares = 0.0;
    int count = 0;
    for (const Place& place : places) {
      if (!place.used) continue;
      squares += above(place) * above(place);
      ++count;
    }
    if (count < 10 * static_cast<int>(kSheetTerms)) return 0.0;
    const double deviation = std::sqrt(squares / count);
    for (Place& place : places) {
      const double d = above(place);
      place.used = d > -kImpression * deviation && d < kBump * deviation;
    }
  }
  return -kInner * kInner * (sheet[3] + sheet[5]);
}

double written_below(const HeightMap& map) {
  const std::vector<float> right = slopes(map, 1, 0), up = slopes(map, 0, 1);
  const Sums mean_right(right, map.width, map.height), mean_up(up, map.width, map.height);
  std::array<double, 2> steep{}, area{};  // of the lower quarter, of the rest
  const int low = map.height / 10, quarter = 3 * map.height / 10, high = map.height - low;
  for (int y = low; y < high; ++y)
    for (int x = map.width / 10; x < map.width - map.width / 10; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
      if (std::isnan(right[i]) || std::isnan(up[i])) continue;
      const auto [broad_right, known] = mean_right.mean(x, y, kReach);
      if (known < 0.85) continue;
      const double a = static_cast<double>(right[i]) - broad_right;
      const double b = static_cast<double>(up[i]) - mean_up.mean(x, y, kReach)[0];
      const std::size_t where = y < quarter ? 0 : 1;
      area[where] += 1.0;
      steep[where] += std::hypot(a, b) > 0.3 ? 1.0 : 0.0;
    }
  if (area[0] < 100 || area[1] < 100 || steep[1] <= 0.01 * area[1]) return 1.0;
  return std::min(1.0, (steep[0] / area[0]) / (steep[1] / area[1]));
}

}  // namespace dubsar
