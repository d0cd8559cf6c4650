#include "core/volume/formats/hdf5_no_measurement.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dubsar {
namespace {

void add(NoMeasurement& none, double value) {
  if (std::isnan(value)) return;  // is one in any case
  const auto end = none.values.begin() + none.count;
  if (none.count < NoMeasurement::kMost && std::find(none.values.begin(), end, value) == end)
    none.values[static_cast<std::size_t>(none.count++)] = value;
}

/// A signed number of a dataset that is read as unsigned: its bits.
double as_meant(double value, bool meant_unsigned, const Hdf5DatasetInfo& info) {
  if (!meant_unsigned || !(value < 0.0)) return value;
  return value + std::ldexp(1.0, static_cast<int>(8 * scalar_bytes(*info.scalar)));
}

}  // namespace

NoMeasurement hdf5_no_measurement(const Hdf5Volume& volume, const ScalarMap& map) {
  const Hdf5File& file = *volume.file;
  const std::string& path = volume.info.path;
  NoMeasurement none;
  bool filled = false;
  const bool meant_unsigned =
      volume.info.scalar && !dubsar::is_float(*volume.info.scalar) && file.string(path, "_Unsigned").has_value();
  for (const char* name : {"_FillValue", "missing_value", "nodata", "nodata_value", "no_data_value", "fill_value"})
    if (const auto values = file.numbers(path, name)) {
      filled = true;
      for (const double value : *values)
        add(none, volume.info.scalar == ScalarType::kF32 ? static_cast<double>(static_cast<float>(value))
                                                         : as_meant(value, meant_unsigned, volume.info));
    }
  if (!filled && volume.info.fill.defined && file.string("/", "_NCProperties"))
    add(none, as_meant(volume.info.fill.value, meant_unsigned, volume.info));

  // In stored numbers; of floats for packed whole numbers, in what they mean.
  const auto limit = [&](const char* name, std::size_t which) -> std::optional<double> {
    const auto values = file.numbers(path, name);
    if (!values || values->size() <= which) return std::nullopt;
    const bool packed = !map.identity() && volume.info.scalar && !dubsar::is_float(*volume.info.scalar);
    const double value = (*values)[which];
    return packed && file.is_float(path, name) ? (value - map.offset) / map.scale
                                               : as_meant(value, meant_unsigned, volume.info);
  };
  auto least = limit("valid_min", 0), most = limit("valid_max", 0);
  if (const auto range = file.numbers(path, "valid_range"); range && range->size() == 2) {
    least = limit("valid_range", 0);
    most = limit("valid_range", 1);
  }
  if (least && most && *least > *most) std::swap(least, most);  // of a negative factor
  if (least && std::isfinite(*least)) none.least = *least;
  if (most && std::isfinite(*most)) none.most = *most;
  // A float's limit unpacked and packed again may miss by its rounding.
  const double slack = map.identity() ? 0.0 : 1e-6;
  none.least -= std::abs(none.least) < HUGE_VAL ? slack * (1.0 + std::abs(none.least)) : 0.0;
  none.most += std::abs(none.most) < HUGE_VAL ? slack * (1.0 + std::abs(none.most)) : 0.0;
  return none;
}

}  // namespace dubsar
