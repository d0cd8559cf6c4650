#include "core/pipeline/detail.h"

#include <fmt/format.h>

#include "core/base/numbers/units.h"
#include "core/pipeline/forecast.h"

namespace dubsar {
namespace {

/// Of the memory that is left: what a run takes is known to a fifth.
constexpr double kShare = 0.8;
constexpr const char* kShareText = "four fifths";
/// A minute on two cores; a scan of the paper's size takes three, most of it for contact and the surface.
constexpr std::int64_t kMostVoxels = 1'000'000'000;

std::string size_text(double bytes) {
  return gib_of(bytes) < 1.0 ? fmt::format("{:.0f} MiB", mib_of(bytes)) : fmt::format("{:.1f} GiB", gib_of(bytes));
}

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
    return {Detail::kHalf, fmt::format("the scan's resolution takes about {}, more than {} of the {} that are left",
                                       size_text(needed), kShareText, size_text(static_cast<double>(memory_left)))};
  return {Detail::kScan, fmt::format("{:.{}f} million voxels fit in {}", static_cast<double>(scan.count()) * 1e-6,
                                     scan.count() < 10'000'000 ? 1 : 0, size_text(static_cast<double>(memory_left)))};
}

int sharers_of_rays(Detail detail, std::int64_t vertices) {
  constexpr std::int64_t kLarge = 1'000'000;
  constexpr int kSharers = 19;
  return detail == Detail::kScan && vertices >= kLarge ? kSharers : 1;
}

}  // namespace dubsar
