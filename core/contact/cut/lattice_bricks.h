#pragma once
// Points of a lattice in bricks of 4x4x4: a bit of a word each. Who is beside whom follows from the place within the
// brick; indices are kept for whole bricks alone.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/contact/brick_map.h"

namespace dubsar {

class LatticeBricks {
 public:
  static constexpr std::int32_t kEdge = 4;
  static constexpr std::uint32_t kPoints = 64;  ///< of a brick: x, then y, then z
  static constexpr std::uint32_t kWays = 6;     ///< 2 axis: up it, 2 axis + 1: down

  /// Bricks 1, 2, ... at these places, in bricks, all different, of a lattice of `dims` points. Brick 0 is nowhere, and
  /// beside those that have none there. 44 bytes a brick.
  LatticeBricks(const Dims& dims, std::vector<glm::ivec3> places);

  /// With brick 0. Points of brick b are 64 b to 64 b + 63.
  std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(beside_.size()); }
  const glm::ivec3& place(std::uint32_t brick) const noexcept { return places_[brick]; }
  std::uint32_t brick_beside(std::uint32_t brick, std::uint32_t way) const noexcept { return beside_[brick][way]; }

  glm::ivec3 position(std::uint32_t point) const noexcept {
    const auto k = static_cast<std::int32_t>(point % kPoints);
    return kEdge * places_[point / kPoints] + glm::ivec3(k & 3, k >> 2 & 3, k >> 4);
  }
  /// Below kPoints where there is no brick; so are points beside a brick that has none there.
  std::uint32_t at(const glm::ivec3& p) const noexcept {
    return kPoints * brick_.get(p.x >> 2, p.y >> 2, p.z >> 2) +
           static_cast<std::uint32_t>((p.z & 3) << 4 | (p.y & 3) << 2 | (p.x & 3));
  }
  std::uint32_t beside(std::uint32_t point, std::uint32_t way) const noexcept {
    const Step step = kSteps[way][point % kPoints];
    return kPoints * beside_[point / kPoints][step.brick] + step.point;
  }

  /// What `bits`, a word a brick, say of the points that lie that way beside those of a brick; or that way and another.
  std::uint64_t bits_beside(const std::vector<std::uint64_t>& bits, std::uint32_t brick, std::uint32_t way) const {
    return beside_in(bits[brick], way) | bits_across(bits[beside_[brick][way]], way ^ 1);
  }
  std::uint64_t bits_beside(const std::vector<std::uint64_t>& bits, std::uint32_t brick, std::uint32_t way,
                            std::uint32_t other) const {
    return beside_in(bits_beside(bits, brick, way), other) |
           bits_across(bits_beside(bits, beside_[brick][other], way), other ^ 1);
  }
  /// The points of the brick that lies that way which are beside these of another.
  static constexpr std::uint64_t bits_across(std::uint64_t points, std::uint32_t way) {
    const std::uint32_t axis = way / 2, far = 3 * step(axis);
    return way % 2 == 0 ? (points & last(axis)) >> far : (points & first(axis)) << far;
  }
  /// The points of a brick beside these of it.
  static constexpr std::uint64_t bits_around(std::uint64_t points) {
    std::uint64_t around = 0;
    for (std::uint32_t way = 0; way < kWays; ++way) around |= beside_in(points, way);
    return around;
  }
  /// The points of a brick at its side that way.
  static constexpr std::uint64_t side(std::uint32_t way) { return way % 2 == 0 ? last(way / 2) : first(way / 2); }

 private:
  struct Step {
    std::uint8_t brick, point;  ///< brick: the way, or kWays: its own
  };
  static constexpr std::uint64_t first(std::uint32_t axis) {
    return axis == 0 ? 0x1111111111111111u : axis == 1 ? 0x000f000f000f000fu : 0x000000000000ffffu;
  }
  static constexpr std::uint32_t step(std::uint32_t axis) { return 1u << 2 * axis; }
  static constexpr std::uint64_t last(std::uint32_t axis) { return first(axis) << 3 * step(axis); }
  /// What `bits` of a brick say of the points that lie that way in it.
  static constexpr std::uint64_t beside_in(std::uint64_t bits, std::uint32_t way) {
    const std::uint32_t axis = way / 2;
    return way % 2 == 0 ? bits >> step(axis) & ~last(axis) : bits << step(axis) & ~first(axis);
  }
  static constexpr std::array<std::array<Step, kPoints>, kWays> all_steps() {
    std::array<std::array<Step, kPoints>, kWays> steps{};
    for (std::uint32_t way = 0; way < kWays; ++way)
      for (std::uint32_t k = 0; k < kPoints; ++k) {
        const std::uint32_t shift = 2 * (way / 2), at = k >> shift & 3, to = (at + (way % 2 == 0 ? 1 : 3)) & 3;
        const bool leaves = way % 2 == 0 ? at == 3 : at == 0;
        steps[way][k] = {static_cast<std::uint8_t>(leaves ? way : kWays),
                         static_cast<std::uint8_t>((k & ~(3u << shift)) | to << shift)};
      }
    return steps;
  }
  static const std::array<std::array<Step, kPoints>, kWays> kSteps;

  std::vector<glm::ivec3> places_;
  std::vector<std::array<std::uint32_t, kWays + 1>> beside_;  ///< bricks: one a way, and itself
  BrickMap<std::uint32_t> brick_;                             ///< at each place
};

inline constexpr std::array<std::array<LatticeBricks::Step, LatticeBricks::kPoints>, LatticeBricks::kWays>
    LatticeBricks::kSteps = LatticeBricks::all_steps();

}  // namespace dubsar
