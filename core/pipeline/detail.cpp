#include "core/pipeline/detail.h"

#include <fmt/format.h>

#include "core/base/units.h"

namespace dubsar {
namespace {

/// Of a run on the scan's grid: the volume of floats, surfaces and the clay around their contact; 12.6 were measured.
constexpr double kBytesPerVoxel = 13.0;
/// Some minutes on two cores; a scan of the paper's size would take most of an hour.
constexpr std::int64_t kMostVoxels = 450'000'000;

}  // namespace

DetailChoice choose_detail(Detail wanted, const Dims& scan, std::uint64_t memory_left) {
  if (wanted != Detail::kAuto) return {wanted, "as set"};
  const double needed = kBytesPerVoxel * static_cast<double>(scan.count());
  if (scan.count() > kMostVoxels)
    return {Detail::kHalf,
            fmt::format("{:.0f} million voxels take long at the scan's resolution, half is taken up "
                        "from {:.0f} million",
                        static_cast<double>(scan.count()) * 1e-6, static_cast<double>(kMostVoxels) * 1e-6)};
  if (needed > 0.6 * static_cast<double>(memory_left))
    return {Detail::kHalf, fmt::format("the scan's resolution takes {:.1f} GiB, and {:.1f} GiB are left",
                                       gib_of(needed), gib_of(memory_left))};
  return {Detail::kScan,
          fmt::format("{:.{}f} million voxels fit in {:.1f} GiB", static_cast<double>(scan.count()) * 1e-6,
                      scan.count() < 10'000'000 ? 1 : 0, gib_of(memory_left))};
}

}  // namespace dubsar
