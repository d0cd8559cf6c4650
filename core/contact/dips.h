#pragma once
// Films of air between clay and clay: where the density dips across the contact, and how far out of the noise.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/band.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// Density at and around the points of a band.
class BandDensity {
 public:
  /// Reads the slices that the band needs and keeps its bricks of 8x8x8 points and `around` more on all sides. `source`
  /// has the band's grid, unfiltered: the less it was smoothed, the more is left of a film. Errors of the source,
  /// kCancelled.
  static Result<BandDensity> read(const ContactBand& band, SlabSource& source, Progress& progress, int around = 1);
  /// Bricks on all sides of a band's: layers of bricks where one of `least` is missing are read, to `most`.
  struct Room {
    int least = 1, most = 1;
  };
  /// The same for a band that has moved: all that is there already stays, layers (of 8 slices) where nothing of `least`
  /// is missing are not read. raw() alone, until low_pass(). Nothing is lost after an error.
  Result<void> follow(const ContactBand& band, SlabSource& source, Progress& progress, Room room);
  /// Makes get() and brick() of what raw() has around a band.
  void low_pass(const ContactBand& band, int around = 1);
  /// Low-passed by [1 2 1]/4 per axis; 0 before low_pass().
  float get(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept { return smooth_.get(x, y, z); }
  /// The values of a brick as get() has them (BrickMap::brick()).
  const float* brick(std::int64_t bx, std::int64_t by, std::int64_t bz) const noexcept {
    return smooth_.brick(bx, by, bz);
  }
  /// As the source has it, until it is dropped.
  const BrickMap<float>& raw() const noexcept { return raw_; }
  /// Half of the memory: nobody needs it behind find_dips().
  void drop_raw() { raw_ = BrickMap<float>({}, 0.0f); }
  /// Nothing.
  BandDensity() : raw_({}, 0.0f), smooth_({}, 0.0f) {}

 private:
  BrickMap<float> raw_, smooth_;
};

/// Strengths of dips along a cut through clay without a film: it seeks what is dark. As white noise makes them.
struct PlainClay {
  float strength = 1.1f;   ///< mean
  float deviation = 2.0f;  ///< of the mean of n neighbours, times the root of n
};

/// Mean strength of dips above that of plain clay in the faintest film that is looked for, of a fifth of a voxel.
inline constexpr float kFaintFilm = 0.6f;

/// Logarithm of how much likelier it is that `count` neighbours along a cut, whose strengths are `sum` together, lie in
/// a faint film than in plain clay: with means kFaintFilm apart, each adds to it from the middle between them on.
inline double log_likelihood_of_film(double sum, std::size_t count, const PlainClay& plain) {
  const double faint = static_cast<double>(kFaintFilm), deviation = static_cast<double>(plain.deviation),
               middle = static_cast<double>(plain.strength) + 0.5 * faint;
  return (sum - static_cast<double>(count) * middle) * faint / (deviation * deviation);
}

struct Dips {
  /// Of each node: how much denser the clay on both sides is on average than a disk through the node, at the best of
  /// the directions across the contact, in deviations of what clay without an interface shows.
  std::vector<float> strength;
  std::vector<float> density;  ///< low-passed, of that disk; empty: it does not say where the contact is
  float deviation = 0.0f;      ///< of the noise in `strength`, density
  PlainClay plain{};           ///< what chance makes of it
};

/// Disks of three grid steps across 49 directions, beside others two to four steps away. `least_deviation`: that noise
/// in `strength` is taken for at least, density. About 1.5 us a node and thread with AVX-512. kCancelled.
Result<Dips> find_dips(const ContactBand& band, const BitVolume& inside, const BandDensity& density, Progress& progress,
                       float least_deviation = 0.0f);

}  // namespace dubsar
