#pragma once
// All that the volume says about its isosurface, and nothing more: signs, face decisions, quantised crossings. The
// mesh (connectivity and unsmoothed positions) is a pure function of it, so it is what an EXA file stores.

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

/// Canonical order of active edges and ambiguous faces: grid rows (z, then y); within a row all items of axis x in
/// rising x, then axis y, then axis z. An edge of axis a starts at its grid point and ends one step along a; a face of
/// axis a lies perpendicular to a and starts at its smallest corner. Only edges and faces whose corners are all grid
/// points are listed here. A closed mesh has more: the virtual edges, between an inside point at the volume boundary
/// and the layer of outside points around the grid (x, y or z = -1 or n). They need no samples: their crossings lie at
/// the grid point, and a face that touches the layer is never ambiguous.
struct SurfaceSamples {
  Dims dims;  ///< grid points
  float isovalue = 0.0f;
  int offset_bits = 4;                 ///< N, 1..16
  bool closed = true;                  ///< closed at the volume boundary with flat caps, or open
  BitVolume signs;                     ///< 1 = inside: value >= isovalue; NaN is outside
  std::vector<std::uint8_t> joined;    ///< one per ambiguous face inside the grid: 1 = positives joined, else 0
  std::vector<std::uint16_t> offsets;  ///< one per active edge inside the grid: min(2^N - 1, floor(t 2^N))

  friend bool operator==(const SurfaceSamples&, const SurfaceSamples&) = default;
};

/// How many offsets and face decisions belong to a sign volume.
struct SampleCounts {
  std::int64_t edges = 0;
  std::int64_t faces = 0;
};

/// Cost: one pass over the bits, all threads.
SampleCounts count_samples(const BitVolume& signs);

/// Share of the points on the six faces of the grid that are inside.
double share_inside_at_border(const BitVolume& signs);

/// kBadData when the samples contradict each other: sizes, counts, values out of range, padding bits set. `counts` are
/// those of samples.signs.
Result<void> check_samples(const SurfaceSamples& samples, const SampleCounts& counts);

/// The part of it that does not need the counts: sizes and padding bits of the signs.
Result<void> check_signs(const SurfaceSamples& samples);

}  // namespace dubsar
