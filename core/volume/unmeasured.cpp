#include "core/volume/unmeasured.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

namespace dubsar {
namespace {

constexpr std::int64_t kLeastSlices = 3, kMostSlices = 7, kSmallScan = 50'000'000;
constexpr double kLeastOfBorder = 0.01;  ///< of a slice's border that has the value
constexpr double kLeastOutside = 0.005;  ///< of the slices with it
constexpr double kMostDents = 0.1;       ///< of what is outside: pixels in the convex hull of the region beside it
constexpr int kRimFrom = 2, kRimTo = 3, kBehindFrom = 5, kBehindTo = 8;  ///< steps from what is outside
constexpr std::size_t kMostSamples = 40'000;                             ///< of a slice
constexpr double kLevel = 0.15, kDark = 0.25;                            ///< of the contrast
constexpr double kLeastSeparability = 0.75;                              ///< a single Gaussian has .64
constexpr double kLeastDark = 0.05;                                      ///< share of what is measured

bool same(float value, float wanted) { return std::isfinite(wanted) ? value == wanted : !std::isfinite(value); }

/// One slice, as one value divides it into what is outside and a region.
struct Look {
  std::int64_t outside = 0, pixels = 0;
  std::int64_t dents = 0;  ///< pixels outside that the convex hull of the region has, too
  std::vector<float> rim, behind, inner;
  bool blank() const { return outside == pixels; }
};

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

class SliceLooks {
 public:
  SliceLooks(const std::vector<float>& values, std::int64_t width, std::int64_t height)
      : values_(values), width_(width), height_(height), steps_(values.size()) {}

  /// Values that a hundredth of the border has.
  std::vector<float> border_values() const {
    std::map<std::uint32_t, std::int64_t> counts;
    std::int64_t all = 0;
    each_at_border([&](std::int64_t at) {
      const float value = values_[static_cast<std::size_t>(at)];
      ++counts[std::isfinite(value) ? std::bit_cast<std::uint32_t>(value + 0.0f) : kNaN];
      ++all;
    });
    std::vector<float> found;
    for (const auto& [bits, count] : counts)
      if (static_cast<double>(count) > kLeastOfBorder * static_cast<double>(all))
        found.push_back(std::bit_cast<float>(bits));
    return found;
  }

  /// Without a value, the border itself is what is outside.
  Look look(std::optional<float> value) {
    Look result;
    result.pixels = width_ * height_;
    std::fill(steps_.begin(), steps_.end(), kUnknown);
    std::vector<std::int64_t> front;
    each_at_border([&](std::int64_t at) {
      std::uint8_t& step = steps_[static_cast<std::size_t>(at)];
      if (step != kUnknown || (value && !same(values_[static_cast<std::size_t>(at)], *value))) return;
      step = value ? kOutside : std::uint8_t{1};
      front.push_back(at);
    });
    int reached = 1;
    if (value) {
      for (std::size_t i = 0; i < front.size(); ++i)
        each_beside(front[i], [&](std::int64_t next) {
          if (steps_[static_cast<std::size_t>(next)] != kUnknown ||
              !same(values_[static_cast<std::size_t>(next)], *value))
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

 private:
  static constexpr std::uint8_t kUnknown = 0, kOutside = 255;
  static constexpr std::uint32_t kNaN = 0x7FC00000u;

  template <class Visit>
  void each_at_border(const Visit& visit) const {
    for (std::int64_t x = 0; x < width_; ++x) visit(x), visit((height_ - 1) * width_ + x);
    for (std::int64_t y = 1; y + 1 < height_; ++y) visit(y * width_), visit(y * width_ + width_ - 1);
  }
  template <class Visit>
  void each_beside(std::int64_t at, const Visit& visit) const {
    const std::int64_t x = at % width_;
    if (x > 0) visit(at - 1);
    if (x + 1 < width_) visit(at + 1);
    if (at >= width_) visit(at - width_);
    if (at + width_ < width_ * height_) visit(at + width_);
  }

  std::int64_t dents() const {
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

  void gather(Look& result) const {
    const auto region = static_cast<std::size_t>(result.pixels - result.outside);
    const std::size_t every = region / kMostSamples + 1;
    std::size_t seen = 0;
    for (std::size_t at = 0; at < values_.size(); ++at) {
      const int step = steps_[at];
      if (step == kOutside || !std::isfinite(values_[at])) continue;
      if (step >= kRimFrom && step <= kRimTo) result.rim.push_back(values_[at]);
      if (step >= kBehindFrom && step <= kBehindTo) result.behind.push_back(values_[at]);
      if (seen++ % every == 0) result.inner.push_back(values_[at]);
    }
  }

  const std::vector<float>& values_;
  std::int64_t width_, height_;
  std::vector<std::uint8_t> steps_;
};

float quantile(std::vector<float>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// All looks at slices with one value.
struct Found {
  std::int64_t outside = 0, dents = 0, looked_at = 0;
  bool blank = false;  ///< a slice has nothing else
  std::vector<float> rim, behind, inner;

  void add(const Look& look) {
    if (look.blank()) {
      blank = true;
      return;
    }
    outside += look.outside;
    dents += look.dents;
    looked_at += look.pixels;
    rim.insert(rim.end(), look.rim.begin(), look.rim.end());
    behind.insert(behind.end(), look.behind.begin(), look.behind.end());
    inner.insert(inner.end(), look.inner.begin(), look.inner.end());
  }
  bool beside() const {
    return outside > 0 && static_cast<double>(outside) >= kLeastOutside * static_cast<double>(looked_at);
  }
  bool convex() const { return static_cast<double>(dents) <= kMostDents * static_cast<double>(outside); }
};

/// Otsu's two classes of sorted values.
struct Classes {
  double low = 0.0, high = 0.0, dark_share = 0.0, separability = 0.0, threshold = 0.0;
};
Classes classes_of(const std::vector<float>& sorted) {
  const auto count = static_cast<double>(sorted.size());
  double sum = 0.0, squares = 0.0;
  const double origin = static_cast<double>(sorted.front());
  for (const float v : sorted) {
    const double d = static_cast<double>(v) - origin;
    sum += d;
    squares += d * d;
  }
  const double variance = squares / count - sum * sum / (count * count);
  Classes best;
  double best_between = 0.0, below = 0.0;
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    below += static_cast<double>(sorted[i]) - origin;
    if (sorted[i] == sorted[i + 1]) continue;
    const double n = static_cast<double>(i + 1), low = below / n, high = (sum - below) / (count - n);
    const double between = n / count * (1.0 - n / count) * (high - low) * (high - low);
    if (between <= best_between) continue;
    best_between = between;
    best = {origin + low, origin + high, n / count, between / variance, static_cast<double>(sorted[i])};
  }
  return best;
}

/// Does the region begin with air? Level behind its rim, and the darker of what it holds; else what lies outside is the
/// background of an object that ends there.
bool begins_with_air(Found& found) {
  if (found.rim.size() < 16 || found.behind.size() < 16 || found.inner.size() < 64) return false;
  const double rim = static_cast<double>(quantile(found.rim, 0.5));
  const double behind = static_cast<double>(quantile(found.behind, 0.5));
  const double spread =
      (static_cast<double>(quantile(found.rim, 0.75)) - static_cast<double>(quantile(found.rim, 0.25))) / 1.349;
  std::sort(found.inner.begin(), found.inner.end());
  const Classes classes = classes_of(found.inner);
  const double contrast = classes.high - classes.low;
  if (classes.separability >= kLeastSeparability && classes.dark_share >= kLeastDark)
    return std::abs(behind - rim) <= kLevel * contrast && rim <= classes.threshold &&
           std::abs(rim - classes.low) <= kDark * contrast;
  // An object that is small beside its air leaves one class; it stands out of it on one side only.
  const double top = static_cast<double>(quantile(found.inner, 0.998));
  const double bottom = static_cast<double>(quantile(found.inner, 0.002));
  return std::abs(behind - rim) <= spread && top - rim > 6.0 * spread && top - rim > 3.0 * (rim - bottom);
}

std::vector<std::int64_t> slices_to_look_at(const SlabSource& scan) {
  const Dims d = scan.dims();
  const std::int64_t layers = (d.z + scan.preferred_height() - 1) / std::max<std::int64_t>(1, scan.preferred_height());
  const std::int64_t count =
      std::min(d.z, d.count() <= kSmallScan ? kMostSlices : std::clamp(layers / 8, kLeastSlices, kMostSlices));
  std::vector<std::int64_t> slices;
  for (std::int64_t i = 0; i < count; ++i) slices.push_back(count == 1 ? 0 : i * (d.z - 1) / (count - 1));
  return slices;
}

}  // namespace

Result<IgnoredValues> parse_ignored(const std::vector<std::string>& texts) {
  IgnoredValues ignored;
  for (const std::string& text : texts) {
    if (text == "none") {
      ignored.search = false;
      continue;
    }
    float value = 0.0f;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      return fail(ErrorKind::kUsage,
                  "ignored value \"{}\" not understood, expected a grey value such as 0 or -1000, or none (NaN and Inf "
                  "are always ignored)",
                  text);
    ignored.values.push_back(value);
  }
  if (!ignored.search && !ignored.values.empty())
    return fail(ErrorKind::kUsage, "ignored values none and {:g} found, expected one or the other", ignored.values[0]);
  return ignored;
}

float fill_value(float value) noexcept {
  constexpr float kLeast = 0x1p-100f;  // far from numbers that processors are slow with
  if (std::abs(value) < kLeast) value = kLeast;
  constexpr std::uint32_t kDropped = 0x3Fu;  // 24 significant bits - 18
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(value + 0.0f) & ~kDropped) | (kDropped + 1));
}

std::string describe(const Unmeasured& unmeasured) {
  std::string what;
  for (const float value : unmeasured.outside) what += fmt::format("{}{:g}", what.empty() ? "" : ", ", value);
  for (const float value : unmeasured.ignored) what += fmt::format("{}{:g}", what.empty() ? "" : ", ", value);
  const std::string where = !unmeasured.outside.empty()   ? fmt::format("lie outside the field of view ({})", what)
                            : !unmeasured.ignored.empty() ? fmt::format("have a value to be ignored ({})", what)
                                                          : std::string("are NaN or Inf");
  return fmt::format("{:.{}f} % of the voxels {}: no measurement, left out of all estimates and taken as {:.6g}, {}",
                     100.0 * unmeasured.share, unmeasured.share < 0.001 ? 4 : 1, where,
                     std::abs(unmeasured.fill) < 1e-20f ? 0.0f : unmeasured.fill,
                     unmeasured.at_rim ? "the median of the air at its rim" : "the 5 % quantile of the others");
}

Result<Unmeasured> find_unmeasured(SlabSource& scan, const IgnoredValues& options) {
  const Dims d = scan.dims();
  Unmeasured result;
  result.ignored = options.values;
  std::vector<float> values(static_cast<std::size_t>(d.slice()));
  std::map<std::uint32_t, Found> candidates;
  Found bordered;  // slices that are not blank, by their border
  std::vector<float> measured;
  std::int64_t looked_at = 0, ignored = 0;
  const auto is_ignored = [&](float v) {
    return !std::isfinite(v) ||
           std::any_of(options.values.begin(), options.values.end(), [&](float other) { return v == other; });
  };
  for (const std::int64_t z : slices_to_look_at(scan)) {
    DUBSAR_TRY(scan.read(z, z + 1, values));
    SliceLooks slice(values, d.x, d.y);
    bool blank = false;
    for (const float value : slice.border_values()) {
      if (!is_ignored(value) && (!options.search || !options.values.empty())) continue;
      const Look look = slice.look(value);
      blank = blank || look.blank();
      candidates[std::bit_cast<std::uint32_t>(value)].add(look);
    }
    if (!blank) bordered.add(slice.look(std::nullopt));
    const std::size_t every = values.size() / kMostSamples + 1;
    for (std::size_t at = 0; at < values.size(); ++at) {
      ignored += is_ignored(values[at]) ? 1 : 0;
      if (at % every == 0 && !is_ignored(values[at])) measured.push_back(values[at]);
    }
    looked_at += d.slice();
  }
  std::vector<float> rim;
  std::int64_t outside = 0;
  for (auto& [bits, found] : candidates) {
    const float value = std::bit_cast<float>(bits);
    if (!found.beside()) {
      if (!found.blank) continue;
      found.rim = bordered.rim;
      found.behind = bordered.behind;
      found.inner = bordered.inner;
    }
    if ((found.beside() && !found.convex()) || !begins_with_air(found)) continue;
    rim.insert(rim.end(), found.rim.begin(), found.rim.end());
    rim.insert(rim.end(), found.behind.begin(), found.behind.end());
    if (is_ignored(value)) continue;
    result.outside.push_back(value);
    outside += found.outside;
  }
  if (measured.empty())
    return fail(ErrorKind::kBadData,
                "import: no voxel of {} slices is a measurement; expected at least one that is "
                "neither NaN nor Inf nor to be ignored",
                looked_at / std::max<std::int64_t>(1, d.slice()));
  result.at_rim = !rim.empty();
  result.fill = fill_value(result.at_rim ? quantile(rim, 0.5) : quantile(measured, 0.05));
  result.share = static_cast<double>(outside + ignored) / static_cast<double>(looked_at);
  return result;
}

}  // namespace dubsar
