#pragma once
// Levels of 0..63 of the vertices around one, of those that are known: what LightCode expects, without a branch for
// each neighbour.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/extract/quad_mesh.h"

namespace dubsar {

/// Over known_surroundings(): the sum of share x level, of shares, and the extremes.
struct KnownLevels {
  int sum = 0, shares = 0, lowest = 63, highest = 0;
  /// (sum + shares / 2) / shares, rounded down; shares is not 0. Without a division for up to 63 shares.
  int mean() const noexcept {
    const auto twice = static_cast<std::uint32_t>(sum + shares / 2);
    if (shares >= static_cast<int>(kInverse.size())) return static_cast<int>(twice) / shares;
    return static_cast<int>(twice * kInverse[static_cast<std::size_t>(shares)] >> kInverseBits);
  }

 private:
  static constexpr int kInverseBits = 19;  ///< sums are below 2^12, errors below 2^6
  static constexpr std::array<std::uint32_t, 64> kInverse = [] {
    std::array<std::uint32_t, 64> inverse{};
    for (std::uint32_t n = 1; n < inverse.size(); ++n) inverse[n] = (1u << kInverseBits) / n + 1;
    return inverse;
  }();
};

/// The levels of vertices [first, end), as they become known.
class LevelsAround {
 public:
  LevelsAround(std::uint32_t first, std::uint32_t end) : first_(first), size_(end - first), known_(size_ + 1, 0) {}

  void set(std::uint32_t v, std::uint8_t level) {
    known_[v - first_] = std::uint32_t{level} | std::uint32_t{63u - level} << 8 | 1u << 16;
  }

  /// Of vertex v, which is not known yet.
  KnownLevels of(const QuadMesh& mesh, std::uint32_t v) const {
    Four sums{}, extremes{};
    for (const std::uint32_t q : mesh.quads_of(v)) {
      if (mesh.has_doubled(q)) {
        add_polygon(mesh.polygon(q), v, sums, extremes);
        continue;
      }
      const auto& quad = mesh.quads[q];
      const Four known{at(quad[0]), at(quad[1]), at(quad[2]), at(quad[3])};
      const Four ids{quad[0], quad[1], quad[2], quad[3]};
      // The share of all is 2; the one opposite to v, which itself counts nothing, has 1 too many.
      const Four opposite = __builtin_shufflevector(known, known, 2, 3, 0, 1) & static_cast<Four>(ids == v);
      sums += 2 * (known & kSums) - (opposite & kSums);
      const Bytes a = reinterpret_cast<Bytes>(extremes), b = reinterpret_cast<Bytes>(known);
      extremes = reinterpret_cast<Four>(a > b ? a : b);
    }
    const std::uint32_t all = sums[0] + sums[1] + sums[2] + sums[3];
    KnownLevels found{static_cast<int>(all & 0xFFFF), static_cast<int>(all >> 16), 63, 0};
    for (int i = 0; i < 4; ++i) {
      found.highest = std::max(found.highest, static_cast<int>(extremes[i] & 255));
      found.lowest = std::min(found.lowest, 63 - static_cast<int>(extremes[i] >> 8 & 255));
    }
    return found;
  }

 private:
  /// Four entries: bits 0-7 the level, 8-15 63 - level, 16 set; all 0 where it is not known.
  typedef std::uint32_t Four __attribute__((vector_size(16)));
  typedef std::uint8_t Bytes __attribute__((vector_size(16)));
  static constexpr std::uint32_t kSums = 0xFF00FF;

  std::uint32_t at(std::uint32_t v) const { return known_[std::min(v - first_, size_)]; }
  void add_polygon(const Polygon& polygon, std::uint32_t v, Four& sums, Four& extremes) const {
    const auto size = static_cast<std::size_t>(polygon.size);
    std::size_t own = 0;
    while (polygon.vertex[own] != v) ++own;
    for (std::size_t step = 1; step < size; ++step) {
      const std::uint32_t known = at(polygon.vertex[(own + step) % size]);
      sums[0] += (step == 1 || step + 1 == size ? 2 : 1) * (known & kSums);
      const std::uint32_t level = std::max(extremes[0] & 255, known & 255),
                          below = std::max(extremes[0] >> 8 & 255, known >> 8 & 255);
      extremes[0] = level | below << 8;
    }
  }

  std::uint32_t first_, size_;
  std::vector<std::uint32_t> known_;  ///< one more: of vertices outside, never known
};

}  // namespace dubsar
