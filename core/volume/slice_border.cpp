#include "core/volume/slice_border.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>

namespace dubsar {
namespace {

constexpr double kLeastOfBorder = 0.01;                                  ///< of a slice's border that has the value
constexpr int kRimFrom = 2, kRimTo = 3, kBehindFrom = 5, kBehindTo = 8;  ///< steps from what is outside
constexpr std::uint32_t kNaNBits = 0x7FC00000u;

bool same(float value, std::span<const float> wanted) {
  for (const float one : wanted)
    if (std::isfinite(one) ? value == one : !std::isfinite(value)) return true;
  return false;
}

struct Point {
  std::int64_t x, y;
};
std::int64_t turn(const Point& o, const Point& a, const Point& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Pixels in the convex hull of a region that is given by the first and last pixel of its rows.
std::int64_t pixels_of_hull(const std::vector<Point>& ends) {  // sorted by y, then x
  std::vector<Point> hull;
  for (const bool up : {true, false}) {
    const std::size_t base = hull.size();
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Point& p = up ? ends[i] : ends[ends.size() - 1 - i];
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // begins the other half
  }
  if (hull.empty()) return 1;
  std::int64_t twice = 0, on_border = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point &a = hull[i], &b = hull[(i + 1) % hull.size()];
    twice += a.x * b.y - a.y * b.x;
    on_border += std::gcd(std::abs(a.x - b.x), std::abs(a.y - b.y));
  }
  return (std::abs(twice) + on_border) / 2 + 1;  // Pick's theorem
}

}  // namespace

bool BorderLook::beside() const noexcept {
  return outside > 0 && static_cast<double>(outside) >= kLeastOutside * static_cast<double>(pixels);
}

bool BorderLook::convex() const noexcept {
  return static_cast<double>(dents) <= kMostDents * static_cast<double>(outside);
}

SliceBorder::SliceBorder(std::span<const float> values, std::int64_t width, std::int64_t height)
    : values_(values), width_(width), height_(height), steps_(values.size()) {}

template <class Visit>
void SliceBorder::each_at_border(const Visit& visit) const {
  for (std::int64_t x = 0; x < width_; ++x) visit(x), visit((height_ - 1) * width_ + x);
  for (std::int64_t y = 1; y + 1 < height_; ++y) visit(y * width_), visit(y * width_ + width_ - 1);
}

template <class Visit>
void SliceBorder::each_beside(std::int64_t at, const Visit& visit) const {
  const std::int64_t x = at % width_;
  if (x > 0) visit(at - 1);
  if (x + 1 < width_) visit(at + 1);
  if (at >= width_) visit(at - width_);
  if (at + width_ < width_ * height_) visit(at + width_);
}

std::vector<float> SliceBorder::values() const {
  std::map<std::uint32_t, std::int64_t> counts;
  std::int64_t all = 0;
  each_at_border([&](std::int64_t at) {
    const float value = values_[static_cast<std::size_t>(at)];
    ++counts[std::isfinite(value) ? std::bit_cast<std::uint32_t>(value + 0.0f) : kNaNBits];
    ++all;
  });
  std::vector<float> found;
  for (const auto& [bits, count] : counts)
    if (static_cast<double>(count) > kLeastOfBorder * static_cast<double>(all))
      found.push_back(std::bit_cast<float>(bits));
  return found;
}

std::vector<float> SliceBorder::whole_values() const {
  std::set<float> found;
  bool whole = true;
  each_at_border([&](std::int64_t at) {
    const float value = values_[static_cast<std::size_t>(at)];
    if (!std::isfinite(value) || !whole) return;
    whole = value == std::round(value);
    found.insert(value);
  });
  return whole ? std::vector<float>(found.begin(), found.end()) : std::vector<float>{};
}

BorderLook SliceBorder::look(std::span<const float> values) {
  const bool any = !values.empty();
  BorderLook result;
  result.pixels = width_ * height_;
  std::fill(steps_.begin(), steps_.end(), kUnknown);
  std::vector<std::int64_t> front;
  each_at_border([&](std::int64_t at) {
    std::uint8_t& step = steps_[static_cast<std::size_t>(at)];
    if (step != kUnknown || (any && !same(values_[static_cast<std::size_t>(at)], values))) return;
    step = any ? kOutside : std::uint8_t{1};
    front.push_back(at);
  });
  int reached = 1;
  if (any) {
    for (std::size_t i = 0; i < front.size(); ++i)
      each_beside(front[i], [&](std::int64_t next) {
        if (steps_[static_cast<std::size_t>(next)] != kUnknown ||
            !same(values_[static_cast<std::size_t>(next)], values))
          return;
        steps_[static_cast<std::size_t>(next)] = kOutside;
        front.push_back(next);
      });
    result.outside = static_cast<std::int64_t>(front.size());
    reached = 0;
  }
  if (result.outside > 0) result.dents = dents();
  std::vector<std::int64_t> next_front;
  for (; reached < kBehindTo; ++reached, front.swap(next_front)) {
    next_front.clear();
    for (const std::int64_t at : front)
      each_beside(at, [&](std::int64_t next) {
        if (steps_[static_cast<std::size_t>(next)] != kUnknown) return;
        steps_[static_cast<std::size_t>(next)] = static_cast<std::uint8_t>(reached + 1);
        next_front.push_back(next);
      });
  }
  gather(result);
  return result;
}

std::optional<float> SliceBorder::padding() {
  std::optional<float> found;
  for (const float value : values()) {
    const BorderLook seen = look(std::span(&value, 1));
    if (!seen.blank() && !(seen.beside() && seen.convex())) continue;
    if (found) return std::nullopt;
    found = value;
  }
  return found;
}

std::int64_t SliceBorder::dents() const {
  std::vector<Point> ends;
  std::int64_t region = 0;
  for (std::int64_t y = 0; y < height_; ++y) {
    std::int64_t first = width_, last = -1;
    for (std::int64_t x = 0; x < width_; ++x) {
      if (steps_[static_cast<std::size_t>(y * width_ + x)] == kOutside) continue;
      first = std::min(first, x);
      last = x;
      ++region;
    }
    if (last < 0) continue;
    ends.push_back({first, y});
    if (last > first) ends.push_back({last, y});
  }
  return ends.empty() ? 0 : pixels_of_hull(ends) - region;
}

void SliceBorder::gather(BorderLook& result) const {
  const auto region = static_cast<std::size_t>(result.pixels - result.outside);
  const std::size_t every = region / kMostSliceSamples + 1;
  std::size_t seen = 0;
  for (std::size_t at = 0; at < values_.size(); ++at) {
    const int step = steps_[at];
    if (step == kOutside || !std::isfinite(values_[at])) continue;
    if (step >= kRimFrom && step <= kRimTo) result.rim.push_back(values_[at]);
    if (step >= kBehindFrom && step <= kBehindTo) result.behind.push_back(values_[at]);
    if (seen++ % every == 0) result.inner.push_back(values_[at]);
  }
}

}  // namespace dubsar
