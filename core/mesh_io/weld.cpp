#include "core/mesh_io/weld.h"

#include <bit>

namespace dubsar {
namespace {
std::uint64_t mixed(std::uint64_t h) {  // finaliser of MurmurHash3
  h ^= h >> 33;
  h *= 0xff51afd7ed558ccdULL;
  h ^= h >> 33;
  h *= 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}
std::uint64_t hash_of(const glm::vec3& p) {
  const std::uint64_t xy = std::uint64_t{std::bit_cast<std::uint32_t>(p.x)} << 32 | std::bit_cast<std::uint32_t>(p.y);
  return mixed(mixed(xy) + std::bit_cast<std::uint32_t>(p.z));
}
}  // namespace

std::uint32_t PointWelder::id(glm::vec3 point) {
  point += glm::vec3(0.0f);  // -0 becomes +0
  if (points_.size() * 2 >= slots_.size()) grow();
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t slot = hash_of(point) & mask;; slot = (slot + 1) & mask) {
    if (slots_[slot] == 0) {
      points_.push_back(point);
      slots_[slot] = static_cast<std::uint32_t>(points_.size());
      return slots_[slot] - 1;
    }
    if (points_[slots_[slot] - 1] == point) return slots_[slot] - 1;
  }
}

void PointWelder::grow() {
  slots_.assign(slots_.empty() ? 1024 : slots_.size() * 2, 0);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    std::size_t slot = hash_of(points_[i]) & mask;
    while (slots_[slot] != 0) slot = (slot + 1) & mask;
    slots_[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

}  // namespace dubsar
