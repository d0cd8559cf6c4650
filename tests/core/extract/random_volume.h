#pragma once
// Volumes that hit every cell configuration: noise, ties at the isovalue, NaN, infinities, constant regions.

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "core/volume/volume.h"

namespace dubsar {

/// Isovalue 0. `kind` 0..4: Gaussian noise, small integers (many ties), noise with NaN and infinities, noise with
/// constant boxes and slabs, biased noise.
inline Volume<float> random_volume(Dims dims, unsigned seed, int kind) {
  std::mt19937 bits(seed);
  const auto uniform = [&] { return static_cast<float>(bits() >> 8) * 0x1p-24f; };
  const auto gauss = [&] { return uniform() + uniform() + uniform() + uniform() - 2.0f; };
  Volume<float> volume(dims);
  for (std::int64_t i = 0; i < dims.count(); ++i) {
    float value = gauss();
    if (kind == 1) value = std::round(2.0f * value);
    if (kind == 2 && bits() % 20 == 0) {
      const float special[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max()};
      value = special[bits() % 4];
    }
    if (kind == 4) value += 0.7f;
    volume.voxels[i] = value;
  }
  if (kind == 3) {
    for (int box = 0; box < 4; ++box) {
      const float level = box % 2 == 0 ? 0.0f : -1.0f;
      const auto from = [&](std::int64_t n) { return static_cast<std::int64_t>(bits()) % n; };
      const std::int64_t x0 = from(dims.x), y0 = from(dims.y), z0 = from(dims.z);
      for (std::int64_t z = z0; z < std::min(dims.z, z0 + 9); ++z) {
        for (std::int64_t y = y0; y < std::min(dims.y, y0 + 9); ++y) {
          for (std::int64_t x = x0; x < std::min(dims.x, x0 + 9); ++x) volume.at(x, y, z) = level;
        }
      }
    }
  }
  return volume;
}

}  // namespace dubsar
