#include "core/phantom/scan_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/system/parallel.h"

namespace dubsar::phantom {

StoredScan stored_scan(const ScannedVolume& scan, const FileOptions& options) {
  const std::span<const float> all = scan.per_mm.voxels.span();
  const auto [least, largest] = std::minmax_element(all.begin(), all.end());
  const auto low = static_cast<double>(*least), high = static_cast<double>(*largest);
  StoredScan stored;
  stored.circle = options.pad != Pad::kNone;
  double stored_low = low;
  if (options.type == ScanFile::kUint16) {
    stored.type = ScalarType::kU16;
    stored.map = {std::max(high - low, 1e-12) / 65535.0, low};
    stored_low = 0.0;
  } else if (options.type == ScanFile::kHu) {
    stored.type = ScalarType::kI16;
    stored.map = {scan.water_per_mm / 1000.0, scan.water_per_mm};
    stored_low = std::round((low - stored.map.offset) / stored.map.scale);
  }
  switch (options.pad) {
    case Pad::kNone:
      break;
    case Pad::kLeast:
      stored.outside = stored_low;
      break;
    case Pad::kNan:
      stored.outside = std::numeric_limits<double>::quiet_NaN();
      break;
    case Pad::kValue:
      stored.outside = options.pad_value;
      break;
  }
  return stored;
}

template <class T>
std::vector<T> store_slices(const ScannedVolume& scan, const StoredScan& stored, const FileOptions& options,
                            std::int64_t z_begin, std::int64_t z_end) {
  const Dims d = scan.per_mm.dims;
  std::vector<T> out(static_cast<std::size_t>((z_end - z_begin) * d.slice()));
  const auto as_stored = [&](double number) {
    if constexpr (std::is_floating_point_v<T>) return static_cast<T>(number);
    return static_cast<T>(std::clamp(std::round(number), static_cast<double>(std::numeric_limits<T>::lowest()),
                                     static_cast<double>(std::numeric_limits<T>::max())));
  };
  const T outside = as_stored(stored.outside);
  const double x_middle = 0.5 * static_cast<double>(d.x - 1), y_middle = 0.5 * static_cast<double>(d.y - 1);
  const double radius = 0.5 * static_cast<double>(std::max(d.x, d.y));
  parallel_for((z_end - z_begin) * d.y, 16, [&](std::int64_t item) {
    const std::int64_t y = item % d.y, z = z_begin + item / d.y;
    const bool blank = z < options.blank || z >= d.z - options.blank;
    for (std::int64_t x = 0; x < d.x; ++x) {
      const double away = std::hypot(static_cast<double>(x) - x_middle, static_cast<double>(y) - y_middle);
      out[static_cast<std::size_t>(item * d.x + x)] =
          blank || (stored.circle && away > radius)
              ? outside
              : as_stored((static_cast<double>(scan.per_mm.at(x, y, z)) - stored.map.offset) / stored.map.scale);
    }
  });
  return out;
}

template std::vector<float> store_slices(const ScannedVolume&, const StoredScan&, const FileOptions&, std::int64_t,
                                         std::int64_t);
template std::vector<std::uint16_t> store_slices(const ScannedVolume&, const StoredScan&, const FileOptions&,
                                                 std::int64_t, std::int64_t);
template std::vector<std::int16_t> store_slices(const ScannedVolume&, const StoredScan&, const FileOptions&,
                                                std::int64_t, std::int64_t);

}  // namespace dubsar::phantom
