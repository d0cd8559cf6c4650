#pragma once
// Offsets that cost few bits: of those that are near enough to where a surface should cross, the ones that the network
// expects (rate-distortion quantisation; Sullivan & Wiegand 1998).

#include <cstdint>
#include <utility>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/surface_samples.h"

namespace dubsar {

/// What is lost with an offset, in bits. Called for the edges of a brick in canonical order; bricks that share no
/// vertex at the same time.
class OffsetPrices {
 public:
  virtual ~OffsetPrices() = default;
  /// The offsets to choose from, first and last, within those of samples.offset_bits; an edge whose offset stays has
  /// one.
  virtual std::pair<int, int> range(std::uint32_t number) const = 0;
  /// Of the offsets first..last, in order.
  virtual void prices(std::uint32_t number, int first, int last, double* to) const = 0;
  /// This one was chosen.
  virtual void take(std::uint32_t number, int offset) = 0;
};

/// Sets samples.offsets, brick by brick in the order of the code, to those that are cheapest together with the bits
/// that they take after those before them. The same for any number of threads. Only for up to kModelledBits bits.
/// kTryAgain beyond 2^32 - 2 edges; kCancelled.
Result<void> choose_offsets(SurfaceSamples& samples, OffsetPrices& prices, Progress& progress);

}  // namespace dubsar
