#pragma once
// What to make: size, seed and noise of a phantom.

#include <cstdint>
#include <string_view>

#include "core/base/result.h"
#include "core/volume/volume.h"

namespace dubsar::phantom {

struct PhantomOptions {
  Dims dims{512, 272, 472};
  std::uint64_t seed = 1;
  double snr_db = 17.0;   ///< 20 log10((clay - air) / sigma); infinity: no noise
  double voxel_mm = 0.0;  ///< 0: the envelope (5.9 x 2.1 x 6.1 cm, as AO 8295 in the paper) fills the grid
};

/// "tiny" 96x64x96, "demo" 512x272x472, "paper" 1871x999x1723 (38 um). kUsage for any other name.
Result<PhantomOptions> parse_preset(std::string_view name);

/// Checks size (32 voxels to 65535 along each axis, and the memory budget's voxel limit), noise (0..120 dB or infinity)
/// and voxel edge, and fills in voxel_mm when it is 0. kUsage.
Result<PhantomOptions> complete(PhantomOptions options);

// Mass-attenuation-like grey values of the paper's scan (figures 6 to 8).
inline constexpr float kClayDensity = 0.0017f;
inline constexpr float kAirDensity = 0.0f;
inline constexpr float kOrganicDensity = 0.0006f;
inline constexpr float kGrainDensity = 0.0032f;

}  // namespace dubsar::phantom
