#include "core/filter/sharpen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dubsar {
namespace {

constexpr int kWideWindow = 7;
constexpr double kWedgeWave = 6.0;  ///< voxels
/// 10 log10 of the independent errors of a wedge's surface.
constexpr double kFootprintDb = 8.0;
constexpr double kNoneFromDb = 24.0, kAllFromDb = 30.0;  ///< of the surface
/// A variance above 1.1 is not given back as a whole: there is half of such a wave left.
constexpr double kMostAmount = 1.5;

}  // namespace

Sharpening sharpening_for(double blur, double snr_db) {
  const double share = std::clamp((snr_db + kFootprintDb - kNoneFromDb) / (kAllFromDb - kNoneFromDb), 0.0, 1.0);
  const double frequency = 2.0 * std::numbers::pi / kWedgeWave;
  const double left = std::exp(-0.5 * blur * frequency * frequency);
  const double gauss = std::pow(std::cos(0.5 * frequency), kWideWindow - 1);  // of the binomial window
  return {static_cast<float>(share * std::min((1.0 / left - 1.0) / (1.0 - gauss), kMostAmount)), kWideWindow};
}

}  // namespace dubsar
