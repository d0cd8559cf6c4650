#include "tests/bench/training/sign_samples.h"

#include <algorithm>

#include "core/exa/signs/sign_brick.h"
#include "core/exa/signs/sign_model.h"
#include "core/exa/signs/topology.h"

namespace dubsar {
namespace {
/// Beyond the end the last slice is repeated.
bool sign_at(const BitVolume& signs, std::int64_t x, std::int64_t y, std::int64_t z) {
  const Dims& d = signs.dims();
  return signs.get(std::min(x, d.x - 1), std::min(y, d.y - 1), std::min(z, d.z - 1));
}

/// Walks a brick as its encoder does (sign_brick.h) and notes what the model would be asked.
struct Collector {
  const BitVolume& signs;
  std::array<std::int64_t, 3> low;
  bool coarse;
  const std::array<std::vector<SignTap>, 7>& taps;
  SignSamples& samples;
  std::size_t phase_index = 0;

  bool truth(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return sign_at(signs, low[0] + x, low[1] + y, low[2] + z);
  }
  bool flag(int, int level, int x, int y, int z) {
    const int s = 1 << level;
    const bool corner = truth(x * s, y * s, z * s);
    for (int dz = 0; dz <= s; ++dz)
      for (int dy = 0; dy <= s; ++dy)
        for (int dx = 0; dx <= s; ++dx)
          if (truth(x * s + dx, y * s + dy, z * s + dz) != corner) return true;
    return false;
  }
  void begin(const SignLattice&, int, int phase) {
    phase_index =
        static_cast<std::size_t>(std::find(kSignPhases.begin(), kSignPhases.end(), phase) - kSignPhases.begin());
  }
  void row(SignLattice& lattice, int level, int y, int z, std::span<const std::uint8_t> xs) {
    for (const int x : xs)
      if (point(lattice, level, x, y, z)) lattice.set(x, y, z);
  }
  bool point(const SignLattice& lattice, int level, int x, int y, int z) {
    SignSample sample;
    std::size_t t = 0;
    for (const SignTap& tap : taps[phase_index]) {
      if (lattice.get(x + tap.x, y + tap.y, z + tap.z)) sample.taps[t / 64] |= std::uint64_t{1} << t % 64;
      ++t;
    }
    sample.inside = truth(std::int64_t{x} << level, std::int64_t{y} << level, std::int64_t{z} << level);
    sample.level_class = static_cast<std::uint8_t>(coarse ? 2 : std::min(level, 2));
    samples[phase_index].push_back(sample);
    return sample.inside;
  }
};

void add_tier(const BitVolume& signs, bool coarse, SignSamples& samples) {
  std::array<std::vector<SignTap>, 7> taps;
  for (std::size_t p = 0; p < 7; ++p) taps[p] = sign_taps(kSignPhases[p]);
  const Dims eighth = coarse_dims(signs.dims());
  const std::array<std::int64_t, 3> cells{8 * (eighth.x - 1), 8 * (eighth.y - 1), 8 * (eighth.z - 1)};
  for (std::int64_t z = 0; z < cells[2]; z += kBrickCells)
    for (std::int64_t y = 0; y < cells[1]; y += kBrickCells)
      for (std::int64_t x = 0; x < cells[0]; x += kBrickCells) {
        const std::array<std::int64_t, 3> low{x, y, z};
        std::array<int, 3> top_cells{};
        for (std::size_t a = 0; a < 3; ++a)
          top_cells[a] = static_cast<int>(std::min<std::int64_t>(kBrickCells, cells[a] - low[a]) / 8);
        Collector collector{signs, low, coarse, taps, samples};
        SignLattice top(top_cells);
        for (int cz = 0; cz <= top_cells[2]; ++cz)
          for (int cy = 0; cy <= top_cells[1]; ++cy)
            for (int cx = 0; cx <= top_cells[0]; ++cx)
              if (collector.truth(8 * cx, 8 * cy, 8 * cz)) top.set(cx, cy, cz);
        SignBrick brick(std::move(top));
        for (int level = kBrickLevels - 1; level >= 0; --level) brick.refine(collector, level);
      }
}
}  // namespace

void add_sign_samples(const BitVolume& signs, SignSamples& samples) {
  add_tier(signs, false, samples);
  BitVolume coarse(coarse_dims(signs.dims()));
  const Dims& d = coarse.dims();
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) coarse.set(x, y, z, sign_at(signs, 8 * x, 8 * y, 8 * z));
  add_tier(coarse, true, samples);
}

}  // namespace dubsar
