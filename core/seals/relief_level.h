#pragma once
// Of the relief of a band: what of it is the seal's, and where the impression is lost.

#include <vector>

#include "core/mesh/writing/height_map.h"

namespace dubsar {

/// One impression, level.
struct SealImpression {
  int width = 0, height = 0;
  double step_mm = 1.0;
  std::vector<float> mm;      ///< over the ground of the band; 0 where nothing is shown
  std::vector<float> shown;   ///< 0..1: measured, and not broken away
  std::vector<float> raised;  ///< mm, what stands out and is narrower than bodies of figures
  std::vector<float> figure;  ///< mm2: mean square of that around the place
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Means over a Gaussian of this deviation (cells), of values that count by their weights; 0 where no weight is.
/// Weights of the means too, if asked for.
std::vector<float> weighted_blur(const std::vector<float>& values, const std::vector<float>& weights, int width,
                                 int height, double deviation, std::vector<float>* mean_weight = nullptr);

/// The ground is what ground_under() finds. How far figures stand out is told by an opening with a paraboloid of 15 mm
/// radius (R. van den Boomgaard, A. Smeulders: The morphological structure of images, 1994): limbs and bodies are
/// narrower than it, and a step of what broke away leaves nothing. What lies lower than the ground by two fifths of
/// that broke away, and that, with what is within a limb's width of it, is not shown; breaks wider than 6 mm are
/// followed by the ground and read as worn.
SealImpression level_impression(const HeightMap& relief);

}  // namespace dubsar
