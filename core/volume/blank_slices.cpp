#include "core/volume/blank_slices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/volume/slice_border.h"

namespace dubsar {
namespace {

constexpr std::int64_t kMostBridged = 3;  ///< blank slices; what is lost in more of them is as thick as a rim

/// Slices of a scan: of the slab that was read, or read one by one.
class BridgeSlices {
 public:
  BridgeSlices(SlabSource& scan, std::int64_t z_begin, std::int64_t z_end, std::span<const float> slab)
      : scan_(scan), z_begin_(z_begin), z_end_(z_end), slab_(slab) {}

  Result<std::vector<float>> at(std::int64_t z) {
    const auto size = static_cast<std::size_t>(scan_.dims().slice());
    if (z >= z_begin_ && z < z_end_) {
      const auto slice = slab_.subspan(static_cast<std::size_t>(z - z_begin_) * size, size);
      return std::vector<float>(slice.begin(), slice.end());
    }
    std::vector<float> values(size);
    DUBSAR_TRY(scan_.read(z, z + 1, values));
    return values;
  }

  /// The first slice from `z` on that is not blank, at most kMostBridged steps away.
  Result<std::optional<std::int64_t>> measured(std::int64_t z, std::int64_t step, std::vector<float>& values) {
    for (std::int64_t k = 1; k <= kMostBridged; ++k) {
      const std::int64_t at_slice = z + k * step;
      if (at_slice < 0 || at_slice >= scan_.dims().z) break;
      DUBSAR_ASSIGN(values, at(at_slice));
      if (!is_blank(values)) return std::optional<std::int64_t>(at_slice);
    }
    return std::optional<std::int64_t>();
  }

 private:
  SlabSource& scan_;
  std::int64_t z_begin_, z_end_;
  std::span<const float> slab_;
};

bool has_at_border(std::span<const float> slice, const Dims& dims, float value) {
  const std::vector<float> values = SliceBorder(slice, dims.x, dims.y).values();
  return std::find(values.begin(), values.end(), value) != values.end();
}

}  // namespace

bool is_blank(std::span<const float> slice) noexcept {
  const float first = slice.front();
  if (std::isfinite(first)) return std::all_of(slice.begin(), slice.end(), [&](float v) { return v == first; });
  return std::none_of(slice.begin(), slice.end(), [](float v) { return std::isfinite(v); });
}

Result<std::vector<Bridge>> bridges_of(SlabSource& scan, std::int64_t z_begin, std::int64_t z_end,
                                       std::span<const float> slab, const std::function<bool(float)>& no_measurement) {
  const Dims dims = scan.dims();
  const auto size = static_cast<std::size_t>(dims.slice());
  BridgeSlices slices(scan, z_begin, z_end, slab);
  std::vector<Bridge> bridges;
  for (std::int64_t z = std::max<std::int64_t>(1, z_begin); z < std::min(z_end, dims.z - 1); ++z) {
    const auto slice = slab.subspan(static_cast<std::size_t>(z - z_begin) * size, size);
    if (!is_blank(slice)) continue;
    Bridge bridge;
    DUBSAR_ASSIGN(const auto below, slices.measured(z, -1, bridge.below_values));
    if (!below) continue;
    DUBSAR_ASSIGN(const auto above, slices.measured(z, 1, bridge.above_values));
    if (!above || *above - *below - 1 > kMostBridged) continue;
    const float value = slice.front();
    if (std::isfinite(value) && !no_measurement(value) &&
        (has_at_border(bridge.below_values, dims, value) || has_at_border(bridge.above_values, dims, value)))
      continue;
    bridge.slice = z;
    bridge.below = *below;
    bridge.above = *above;
    bridges.push_back(std::move(bridge));
  }
  return bridges;
}

void cross(const Bridge& bridge, std::span<float> slice) noexcept {
  const float share = static_cast<float>(bridge.slice - bridge.below) / static_cast<float>(bridge.above - bridge.below);
  for (std::size_t at = 0; at < slice.size(); ++at) {
    const float below = bridge.below_values[at], above = bridge.above_values[at];
    slice[at] = below == above ? below : (1.0f - share) * below + share * above;  // a fill value stays as it is
  }
}

std::string describe_bridged(const std::vector<std::int64_t>& slices) {
  constexpr std::size_t kMostNamed = 5;
  const std::vector<std::int64_t> named(
      slices.begin(), slices.begin() + static_cast<std::ptrdiff_t>(std::min(slices.size(), kMostNamed)));
  const bool one = slices.size() == 1;
  return fmt::format(
      "slice{} {}{} hold{} one value and no measurement: bridged straight from those beside {}, so that "
      "nothing there is known",
      one ? "" : "s", fmt::join(named, ", "),
      slices.size() > kMostNamed ? fmt::format(" and {} more", slices.size() - kMostNamed) : "", one ? "s" : "",
      one ? "it" : "them");
}

}  // namespace dubsar
