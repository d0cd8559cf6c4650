#pragma once
// On which grid the surface is found: that of the scan, or one of half its resolution.

#include <cstdint>
#include <string>

#include "core/base/text/enum_names.h"
#include "core/pipeline/plan.h"

namespace dubsar {

enum class Detail {
  kAuto,  ///< that of the scan where time and memory allow it
  kScan,
  kHalf,  ///< after Gauss 3x3x3 and 2:1, as in the paper
};

inline constexpr EnumName<Detail> kDetails[] = {
    {Detail::kAuto, "auto"}, {Detail::kScan, "scan"}, {Detail::kHalf, "half"}};
static_assert(names_all(kDetails, static_cast<std::size_t>(Detail::kHalf) + 1));

struct DetailChoice {
  Detail detail = Detail::kHalf;  ///< kScan or kHalf
  std::string why;                ///< one sentence
  bool resample() const noexcept { return detail == Detail::kHalf; }
};

/// kAuto: the scan's resolution where the plan's cost is at most five minutes with its threads and its memory fits
/// `room` bytes. `run.half` does not matter; `run.vertices` are those at the scan's resolution. The same scan, threads
/// and room give the same choice: nothing is measured for it.
DetailChoice choose_detail(Detail wanted, RunShape run, std::uint64_t room);

}  // namespace dubsar
