#pragma once
// Volumes of signs from a function of the point.

#include "core/extract/bit_volume.h"

namespace dubsar {

template <class Inside>
BitVolume volume(const Dims& dims, const Inside& inside) {
  BitVolume signs(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) signs.set(x, y, z, inside(x, y, z));
  return signs;
}

}  // namespace dubsar
