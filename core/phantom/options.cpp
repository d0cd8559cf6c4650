#include "core/phantom/options.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/system/budget.h"

namespace dubsar::phantom {
namespace {
// The paper's grid at 38 um: 71.1 x 38.0 x 65.5 mm around an object of 59 x 21 x 61 mm.
constexpr double kFieldMm[3] = {1871 * 0.038, 999 * 0.038, 1723 * 0.038};
}  // namespace

Result<PhantomOptions> parse_preset(std::string_view name) {
  PhantomOptions options;
  if (name == "tiny")
    options.dims = {96, 64, 96};
  else if (name == "demo")
    options.dims = {512, 272, 472};
  else if (name == "paper")
    options.dims = {1871, 999, 1723};
  else
    return fail(ErrorKind::kUsage, "phantom: preset \"{}\" is unknown, expected tiny, demo or paper", name);
  return complete(options);
}

Result<PhantomOptions> complete(PhantomOptions options) {
  const Dims d = options.dims;
  if (std::min({d.x, d.y, d.z}) < 32 || std::max({d.x, d.y, d.z}) > 65535)
    return fail(ErrorKind::kUsage, "phantom: size {}x{}x{} found, expected 32 to 65535 voxels along each axis", d.x,
                d.y, d.z);
  const std::array<std::uint64_t, 3> sizes{static_cast<std::uint64_t>(d.x), static_cast<std::uint64_t>(d.y),
                                           static_cast<std::uint64_t>(d.z)};
  if (sizes[0] * sizes[1] * sizes[2] > Budget{}.max_voxels)
    return fail(ErrorKind::kUsage, "phantom: size {}x{}x{} is more than {} voxels", d.x, d.y, d.z, Budget{}.max_voxels);
  if (std::isnan(options.snr_db) || options.snr_db < 0.0 || (options.snr_db > 120.0 && !std::isinf(options.snr_db)))
    return fail(ErrorKind::kUsage, "phantom: signal to noise ratio {} dB found, expected 0 to 120 or infinity",
                options.snr_db);
  if (options.voxel_mm == 0.0)
    options.voxel_mm = std::max({kFieldMm[0] / static_cast<double>(d.x), kFieldMm[1] / static_cast<double>(d.y),
                                 kFieldMm[2] / static_cast<double>(d.z)});
  if (!(options.voxel_mm > 1e-4 && options.voxel_mm < 10.0))
    return fail(ErrorKind::kUsage, "phantom: voxel edge {} mm found, expected 0.0001 to 10 mm", options.voxel_mm);
  struct Limit {
    const char* what;
    double value, least, most;
    bool zero;  ///< 0 is allowed too
  };
  for (const Limit& limit :
       {Limit{"film", options.film_vox, 0.05, 2.0, false},
        Limit{"share of contact", options.contact_share, 0.01, 0.6, true},
        Limit{"gap", options.gap_vox, 1.0, 64.0, true},
        Limit{"depth of wedges", options.wedge_depth_vox, 2.0, 64.0, true},
        Limit{"pushed clay", options.writing.pushed, 0.0, 0.5, true},
        Limit{"lost share of sealings", options.writing.seals_lost, 0.0, 0.9, true},
        Limit{"density of the envelope", options.envelope_density, 0.5, 1.5, false},
        Limit{"rings", options.rings, 0.0, 1.0, true}, Limit{"blur", options.blur_vox, 0.3, 1.1, false},
        Limit{"cupping", options.artefacts.cupping, 0.0, 0.5, true},
        Limit{"streaks", options.artefacts.streaks, 0.0, 0.3, true},
        Limit{"density of the holder", options.artefacts.holder, 0.02, 3.0, true}})
    if (!(limit.value >= limit.least && limit.value <= limit.most) && !(limit.zero && limit.value == 0.0))
      return fail(ErrorKind::kUsage, "phantom: {} {} found, expected {} to {}", limit.what, limit.value, limit.least,
                  limit.most);
  return options;
}

}  // namespace dubsar::phantom
