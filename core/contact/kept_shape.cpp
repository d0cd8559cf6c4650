#include "core/contact/kept_shape.h"

#include <bit>

#include "core/base/result.h"
#include "core/mesh/evidence.h"

namespace dubsar {

std::size_t KeptShape::Hash::operator()(const Bits& b) const noexcept {
  std::uint64_t h = (std::uint64_t{b.x} << 32 | b.y) * 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 29 ^ b.z) * 0xbf58476d1ce4e5b9u;
  return static_cast<std::size_t>(h ^ h >> 32);
}

KeptShape::Bits KeptShape::bits_of(const glm::vec3& p) {
  return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y), std::bit_cast<std::uint32_t>(p.z)};
}

KeptShape::KeptShape(std::span<const glm::vec3> cut, std::span<const glm::vec3> places,
                     std::span<const std::uint8_t> evidence)
    : vertices_(cut.size()) {
  DUBSAR_CHECK(places.size() >= cut.size() && evidence.size() >= cut.size());
  first_.reserve(cut.size());
  for (std::size_t i = cut.size(); i-- > 0;) {
    const auto [at, fresh] = first_.try_emplace(bits_of(cut[i]), kNone);
    vertices_[i] = {places[i], evidence[i], at->second};
    at->second = static_cast<std::uint32_t>(i);
  }
}

std::vector<std::uint8_t> KeptShape::shape(InterfaceMesh& mesh) const {
  std::vector<std::uint8_t> evidence(mesh.added.size(), evidence_byte(Evidence::kInferred));
  std::unordered_map<std::uint32_t, std::uint32_t> taken;  // of places with several vertices: those come in their order
  for (std::size_t i = 0; i < mesh.added.size(); ++i) {
    const auto found = first_.find(bits_of(mesh.added[i]));
    if (found == first_.end()) continue;
    std::uint32_t at = found->second;
    if (vertices_[at].next != kNone) {
      const auto [next, fresh] = taken.try_emplace(at, at);
      at = next->second;
      if (at == kNone) continue;
      next->second = vertices_[at].next;
    }
    mesh.added[i] = vertices_[at].place;
    evidence[i] = vertices_[at].evidence;
  }
  return evidence;
}

}  // namespace dubsar
