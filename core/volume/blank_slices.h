#pragma once
// Slices that hold nothing but one value between slices that were measured, and what bridges them.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// One value in all pixels, or none that is finite.
bool is_blank(std::span<const float> slice) noexcept;

/// A blank slice and what was measured next to it on either side, as stored.
struct Bridge {
  std::int64_t slice = 0;
  std::int64_t below = 0, above = 0;  ///< slices
  std::vector<float> below_values, above_values;
};

/// Bridges for the slices [z_begin, z_end) of `scan`, whose values are `slab`. At most three blank slices lie between
/// two measured ones; their value is NaN, or `no_measurement` says so, or those two do not have it at their border:
/// the air of a scan without noise is a measurement. Slices beyond the slab are read. Errors: those of the source.
Result<std::vector<Bridge>> bridges_of(SlabSource& scan, std::int64_t z_begin, std::int64_t z_end,
                                       std::span<const float> slab, const std::function<bool(float)>& no_measurement);

/// Each pixel on the straight line between those of the two slices, once what is no measurement was taken out of them.
void cross(const Bridge& bridge, std::span<float> slice) noexcept;

/// For people: "slices 20, 21 hold one value each and no measurement: bridged from those beside them".
std::string describe_bridged(const std::vector<std::int64_t>& slices);

}  // namespace dubsar
