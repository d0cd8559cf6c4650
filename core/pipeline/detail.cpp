#include "core/pipeline/detail.h"

#include <fmt/format.h>

#include "core/base/numbers/units.h"

namespace dubsar {
namespace {

constexpr double kMostSeconds = 300.0;  ///< that somebody waits for a surface while doing nothing else

std::string seconds_text(double s) {
  return s < 100.0 ? fmt::format("{:.0f} s", s) : fmt::format("{:.1f} minutes", s / 60.0);
}

}  // namespace

DetailChoice choose_detail(Detail wanted, RunShape run, std::uint64_t room) {
  if (wanted != Detail::kAuto) return {wanted, "as set"};
  run.half = false;
  const RunCost cost = cost_of(run);
  const std::string time = fmt::format("about {} by the plan with {} threads", seconds_text(cost.wall_s), run.threads);
  const std::string memory = fmt::format("{} of the {} of memory that are left", memory_text(cost.bytes),
                                         memory_text(static_cast<double>(room)));
  if (cost.wall_s > kMostSeconds)
    return {Detail::kHalf, fmt::format("the scan's resolution takes {}, half of it is taken from {} on", time,
                                       seconds_text(kMostSeconds))};
  if (cost.bytes > static_cast<double>(room)) return {Detail::kHalf, "the scan's resolution would need " + memory};
  return {Detail::kScan, "the scan's resolution takes " + time + ", and " + memory};
}

}  // namespace dubsar
