#pragma once
// A small reproducible random sequence (splitmix64, Steele et al. 2014), the same on every machine.

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace dubsar::phantom {

constexpr std::uint64_t hash64(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

class Random {
 public:
  /// Streams with different names are independent.
  Random(std::uint64_t seed, std::uint64_t stream) : state_(hash64(seed ^ hash64(stream))) {}
  std::uint64_t next() noexcept { return hash64(state_++); }
  /// [0, 1)
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double lo, double hi) noexcept { return lo + (hi - lo) * uniform(); }
  /// 0 .. count - 1
  int index(int count) noexcept { return static_cast<int>(uniform() * count); }
  glm::dvec3 direction() noexcept {
    for (;;) {
      const glm::dvec3 d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      const double length = glm::length(d);
      if (length > 0.1 && length < 1.0) return d / length;
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace dubsar::phantom
