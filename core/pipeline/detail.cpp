#include "core/pipeline/detail.h"

#include <fmt/format.h>

#include "core/base/numbers/units.h"
#include "core/pipeline/forecast.h"

namespace dubsar {
namespace {

/// Of the memory that is left: what a run takes is known to a fifth.
constexpr double kShare = 0.8;
/// Minutes on two cores; a scan of the paper's size takes a quarter of an hour, most of it for contact and light.
constexpr std::int64_t kMostVoxels = 1'000'000'000;

}  // namespace

DetailChoice choose_detail(Detail wanted, const Dims& scan, std::uint64_t memory_left) {
  if (wanted != Detail::kAuto) return {wanted, "as set"};
  const auto needed =
      static_cast<double>(bytes_of_run({scan, false, usual_vertices(scan), GridPlace::kMemory, /*contact=*/true}));
  if (scan.count() > kMostVoxels)
    return {Detail::kHalf,
            fmt::format("{:.0f} million voxels take long at the scan's resolution, half is taken up "
                        "from {:.0f} million",
                        static_cast<double>(scan.count()) * 1e-6, static_cast<double>(kMostVoxels) * 1e-6)};
  if (needed > kShare * static_cast<double>(memory_left))
    return {Detail::kHalf, fmt::format("the scan's resolution takes {:.1f} GiB, and {:.1f} GiB are left",
                                       gib_of(needed), gib_of(memory_left))};
  return {Detail::kScan,
          fmt::format("{:.{}f} million voxels fit in {:.1f} GiB", static_cast<double>(scan.count()) * 1e-6,
                      scan.count() < 10'000'000 ? 1 : 0, gib_of(memory_left))};
}

}  // namespace dubsar
