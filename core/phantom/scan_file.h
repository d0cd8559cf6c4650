#pragma once
// The numbers that a scanner's file holds.

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/numbers/scalar_type.h"
#include "core/phantom/scanner/scan.h"

namespace dubsar::phantom {

/// How attenuations become stored numbers: (value - map.offset) / map.scale, rounded where they are whole.
struct StoredScan {
  ScalarType type = ScalarType::kF32;
  ScalarMap map;
  double outside = 0.0;  ///< what stands beyond the circle and in blank slices, as stored
  bool circle = false;   ///< there is one
};

/// uint16: from the least to the largest value of the scan. HU: 1000 (value / water - 1).
StoredScan stored_scan(const ScannedVolume& scan, const FileOptions& options);

/// Slices [z_begin, z_end) as they are stored; the circle is as wide as the wider side of the grid. T is that of
/// `stored.type`.
template <class T>
std::vector<T> store_slices(const ScannedVolume& scan, const StoredScan& stored, const FileOptions& options,
                            std::int64_t z_begin, std::int64_t z_end);

}  // namespace dubsar::phantom
