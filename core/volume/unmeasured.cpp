#include "core/volume/unmeasured.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/volume/slice_border.h"
#include "core/volume/uneven_pads.h"

namespace dubsar {
namespace {

constexpr std::int64_t kLeastSlices = 3, kMostSlices = 7, kSmallScan = 50'000'000;
constexpr double kLevel = 0.15, kDark = 0.25;  ///< of the contrast
constexpr double kLeastSeparability = 0.75;    ///< a single Gaussian has .64
constexpr double kLeastDark = 0.05;            ///< share of what is measured
constexpr double kApart = 0.05;                ///< of the contrast, from air to a padding of several values

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

  void add(const BorderLook& look) {
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

/// Slices that have each a padding of their own: what some programs write that scale slice by slice.
struct OwnPadding {
  Found found;
  std::set<float> values;
  std::int64_t blank = 0;  ///< pixels of slices that are nothing else
  bool everywhere = true;

  void add(SliceBorder& slice) {
    const std::optional<float> value = slice.padding();
    everywhere = everywhere && value && std::isfinite(*value);
    if (!everywhere) return;
    const BorderLook look = slice.look(std::span(&*value, 1));
    if (look.blank())
      blank += look.pixels;
    else
      values.insert(*value);
    found.add(look);
  }
  bool is_one() const { return everywhere && values.size() > 1; }
};

std::vector<std::int64_t> slices_to_look_at(const SlabSource& scan) {
  const Dims d = scan.dims();
  const std::int64_t layers = (d.z + scan.preferred_height() - 1) / std::max<std::int64_t>(1, scan.preferred_height());
  const std::int64_t count =
      std::min(d.z, d.count() <= kSmallScan ? kMostSlices : std::clamp(layers / 8, kLeastSlices, kMostSlices));
  std::vector<std::int64_t> slices;
  for (std::int64_t i = 0; i < count; ++i) slices.push_back(count == 1 ? 0 : i * (d.z - 1) / (count - 1));
  return slices;
}

/// A padding of more values than one: found where it is a padding as a whole, and no values less than it.
struct WiderPad {
  std::vector<float> values;
  Found found;
  bool good() { return found.looked_at > 0 && found.beside() && found.convex() && begins_with_air(found) && apart(); }
  /// From the air that begins behind it: the noise of air that has few grey values is no padding.
  bool apart() {
    if (found.rim.empty() || found.inner.empty()) return false;
    const float low = quantile(found.rim, 0.02), high = quantile(found.rim, 0.98);
    const double contrast = static_cast<double>(quantile(found.inner, 0.98) - quantile(found.inner, 0.02));
    const double least = std::max(0.5 * static_cast<double>(high - low), kApart * contrast);
    return std::all_of(values.begin(), values.end(), [&](float v) {
      return static_cast<double>(low) - static_cast<double>(v) > least ||
             static_cast<double>(v) - static_cast<double>(high) > least;
    });
  }
};

/// Of those that hold all of `known` the widest; the slices are read again where there is one to be looked for.
Result<std::optional<WiderPad>> wider_pad(SlabSource& scan, const BorderValues& border,
                                          const std::vector<float>& known) {
  const Dims d = scan.dims();
  std::vector<float> pixels(static_cast<std::size_t>(d.slice()));
  const auto look_for = [&](const std::vector<std::vector<float>>& sets) -> Result<std::optional<WiderPad>> {
    std::vector<WiderPad> pads;
    for (const std::vector<float>& values : sets) pads.push_back({values, {}});
    for (const std::int64_t z : pads.empty() ? std::vector<std::int64_t>{} : slices_to_look_at(scan)) {
      DUBSAR_TRY(scan.read(z, z + 1, pixels));
      SliceBorder slice(pixels, d.x, d.y);
      for (WiderPad& pad : pads) {
        const BorderLook look = slice.look(pad.values);
        // What fills a slice without data counts, too.
        if (look.blank()) pad.found.outside += look.pixels, pad.found.looked_at += look.pixels;
        pad.found.add(look);
      }
    }
    std::optional<WiderPad> best;
    for (WiderPad& pad : pads)
      if (pad.good() && (!best || pad.found.outside > best->found.outside)) best = std::move(pad);
    return best;
  };
  const std::vector<std::vector<float>> runs = pad_runs(border);
  std::vector<std::vector<float>> wide;
  for (const std::vector<float>& run : runs)
    if (run.size() > 1) wide.push_back(run);
  const std::set<float> one_by_one(known.begin(), known.end());
  for (std::vector<float>& run : wide) {
    std::set<float> with(one_by_one);
    with.insert(run.begin(), run.end());
    run.assign(with.begin(), with.end());
  }
  DUBSAR_ASSIGN(std::optional<WiderPad> wider, look_for(wide));
  std::set<float> found(one_by_one);
  if (wider) found.insert(wider->values.begin(), wider->values.end());
  DUBSAR_ASSIGN(std::optional<WiderPad> joined, look_for(pad_unions(runs, found)));
  return joined ? std::move(joined) : std::move(wider);
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
  for (std::size_t i = 0, last = 0; i < unmeasured.outside.size(); i = last + 1) {
    for (last = i;
         last + 1 < unmeasured.outside.size() && unmeasured.outside[last + 1] == unmeasured.outside[last] + 1;)
      ++last;
    what += fmt::format("{}{:g}", what.empty() ? "" : ", ", unmeasured.outside[i]);
    if (last > i) what += fmt::format(" to {:g}", unmeasured.outside[last]);
  }
  if (unmeasured.each_slice)
    what =
        fmt::format("another value in each slice, {:g} to {:g}", unmeasured.outside.front(), unmeasured.outside.back());
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
  OwnPadding own;
  std::vector<float> measured;
  std::int64_t looked_at = 0, ignored = 0;
  const auto is_ignored = [&](float v) {
    return !std::isfinite(v) ||
           std::any_of(options.values.begin(), options.values.end(), [&](float other) { return v == other; });
  };
  const bool search = options.search && options.values.empty();
  BorderValues at_border;
  for (const std::int64_t z : slices_to_look_at(scan)) {
    DUBSAR_TRY(scan.read(z, z + 1, values));
    SliceBorder slice(values, d.x, d.y);
    bool blank = false;
    if (search) own.add(slice);
    for (const float value : slice.values()) {
      if (!is_ignored(value) && !search) continue;
      const BorderLook look = slice.look(std::span(&value, 1));
      blank = blank || look.blank();
      candidates[std::bit_cast<std::uint32_t>(value)].add(look);
    }
    for (const float value : search ? slice.values() : std::vector<float>{})
      if (std::isfinite(value)) at_border.frequent.insert(value);
    for (const float value : search ? slice.whole_values() : std::vector<float>{}) at_border.whole.insert(value);
    if (!blank) bordered.add(slice.look({}));
    const std::size_t every = values.size() / kMostSliceSamples + 1;
    for (std::size_t at = 0; at < values.size(); ++at) {
      ignored += is_ignored(values[at]) ? 1 : 0;
      if (at % every == 0 && !is_ignored(values[at])) measured.push_back(values[at]);
    }
    looked_at += d.slice();
  }
  std::vector<float> rim;
  std::int64_t outside = 0;
  result.each_slice = own.is_one() && begins_with_air(own.found);
  if (result.each_slice) {
    result.outside.assign(own.values.begin(), own.values.end());
    outside = own.found.outside + own.blank;
    rim = own.found.rim;
    rim.insert(rim.end(), own.found.behind.begin(), own.found.behind.end());
    candidates.clear();
  }
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
  if (search && !result.each_slice) {
    DUBSAR_ASSIGN(const std::optional<WiderPad> wider, wider_pad(scan, at_border, result.outside));
    if (wider) {
      result.outside = wider->values;
      outside = wider->found.outside;
      rim = wider->found.rim;
      rim.insert(rim.end(), wider->found.behind.begin(), wider->found.behind.end());
    }
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
