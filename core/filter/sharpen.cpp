#include "core/filter/sharpen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dubsar {
namespace {

constexpr double kWedgeWave = 6.0;  ///< voxels: what carries wedges of 5 to 7 voxels
/// Contrast that such waves keep on scans of a point spread of .58 voxel and 17 dB, as they are sharpened: these stay
/// as they are. Where so much less is left, all of it is given back.
constexpr double kGoodContrast = 0.80, kMuchLess = 0.08;
/// 10 log10 of the independent errors of a wedge's surface.
constexpr double kFootprintDb = 8.0;
constexpr double kNoneFromDb = 24.0, kAllOfItFromDb = 30.0;  ///< of the surface
/// A contrast below a half is not given back as a whole.
constexpr double kMostAmount = 1.5;

}  // namespace

float wide_sharpening(double blur, double snr_db, float amount) {
  const double frequency = 2.0 * std::numbers::pi / kWedgeWave;
  const auto gauss = [&](int window) { return std::pow(std::cos(0.5 * frequency), window - 1); };  // binomial
  const double left = std::exp(-0.5 * blur * frequency * frequency) * (1.0 + amount * (1.0 - gauss(3)));
  const double share = std::clamp((snr_db + kFootprintDb - kNoneFromDb) / (kAllOfItFromDb - kNoneFromDb), 0.0, 1.0);
  const double need = std::clamp((kGoodContrast - left) / kMuchLess, 0.0, 1.0);
  return static_cast<float>(share * need * std::clamp((1.0 / left - 1.0) / (1.0 - gauss(7)), 0.0, kMostAmount));
}

}  // namespace dubsar
