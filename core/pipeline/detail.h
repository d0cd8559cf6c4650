#pragma once
// On which grid the surface is found: that of the scan, or one of half its resolution.

#include <cstdint>
#include <string>

#include "core/base/text/enum_names.h"
#include "core/volume/volume.h"

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

/// `memory_left` in bytes.
DetailChoice choose_detail(Detail wanted, const Dims& scan, std::uint64_t memory_left);

/// How many neighbours share the rays of ambient light (occlusion.h): 1 but for large surfaces of the scan's own
/// resolution, where light would take longer than all else.
int sharers_of_rays(Detail detail, std::int64_t vertices);

}  // namespace dubsar
