#include "core/pipeline/room_check.h"

#include <fmt/format.h>

#include "core/base/system/log.h"
#include "core/pipeline/forecast.h"
#include "core/volume/grid_store.h"

namespace dubsar {
namespace {

/// Vertices of a voxel of the grid: more than scans of tablets have (phantoms .004 to .03, a noisy gyroid .04), so that
/// most scans need not be looked at.
constexpr double kMostVerticesPerVoxel = 0.08;
constexpr double kSurely = 0.75;  ///< of what was foretold is needed at least
constexpr double kGib = 1024.0 * 1024.0 * 1024.0;

}  // namespace

Result<void> check_room(const ImportOptions& scan, Detail wanted, StageRun run) {
  DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> volume, open_volume(scan));
  const std::uint64_t left = available_memory_bytes();
  const DetailChoice detail = choose_detail(wanted, volume->dims(), left);
  const Dims grid = grid_of(volume->dims(), detail.resample());
  const GridPlace place = place_for(grid_of(volume->dims(), true), scan.budget);
  const auto bytes_with = [&](double vertices) {
    return bytes_of_run({volume->dims(), detail.resample(), vertices, place, false});
  };
  const auto refusal = [&](std::uint64_t needed, const std::string& what) {
    return fail(ErrorKind::kTryAgain, "{} needs about {:.1f} GiB of memory at {} resolution, and {:.1f} GiB are left",
                what, static_cast<double>(needed) / kGib, detail.resample() ? "half the scan's" : "the scan's",
                static_cast<double>(left) / kGib);
  };
  const auto too_much = [&](std::uint64_t bytes) {
    return kSurely * static_cast<double>(bytes) > static_cast<double>(left);
  };
  if (const std::uint64_t least = bytes_with(0.0); too_much(least))
    return refusal(least, fmt::format("a grid of {} x {} x {}", grid.x, grid.y, grid.z));
  if (bytes_with(kMostVerticesPerVoxel * static_cast<double>(grid.count())) <= left) return {};

  run.clock.start("forecast", "voxel");
  DUBSAR_ASSIGN(const Unmeasured unmeasured, volume->unmeasured());
  const Result<Forecast> expected = forecast(
      *volume, {.detail = detail.detail, .budget = scan.budget, .left_out = unmeasured.left_out()}, run.progress);
  run.clock.finish(volume->dims().count());
  if (!expected) {
    const ErrorKind kind = expected.error().kind;
    if (kind == ErrorKind::kCancelled || kind == ErrorKind::kTryAgain) return tl::unexpected<Error>(expected.error());
    return {};
  }
  const std::uint64_t needed = bytes_with(static_cast<double>(expected->vertices));
  const std::string what =
      fmt::format("a surface of about {:.1f} million vertices", static_cast<double>(expected->vertices) * 1e-6);
  if (too_much(needed)) return refusal(needed, what);
  if (needed > left)
    log_warning("{} may need {:.1f} GiB of memory, and {:.1f} GiB are left", what, static_cast<double>(needed) / kGib,
                static_cast<double>(left) / kGib);
  return {};
}

}  // namespace dubsar
