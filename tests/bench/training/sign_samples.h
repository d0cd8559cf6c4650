#pragma once
// What the networks of signs learn from: every coded point of a volume with the signs around it (docs/exa.md, "Signs").

#include <array>
#include <cstdint>
#include <vector>

#include "core/extract/bit_volume.h"

namespace dubsar {

/// One point. `taps`: bit t is the sign at sign_taps(phase)[t].
struct SignSample {
  std::array<std::uint64_t, 3> taps{};
  bool inside = false;
  std::uint8_t level_class = 0;
};

/// By place in kSignPhases.
using SignSamples = std::array<std::vector<SignSample>, 7>;

/// Appends the points of all bricks of a volume, and of the volume of every eighth point, as the encoder meets them.
void add_sign_samples(const BitVolume& signs, SignSamples& samples);

}  // namespace dubsar
