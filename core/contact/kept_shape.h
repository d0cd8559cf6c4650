#pragma once
// Where an attempt at the contact has put its vertices, for the next one, whose cut differs in a few places.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/contact/interface_mesh.h"

namespace dubsar {

class KeptShape {
 public:
  /// Vertices that lay at `cut` came to lie at `places`; `places` and `evidence` may go on. Borrows nothing.
  KeptShape(std::span<const glm::vec3> cut, std::span<const glm::vec3> places, std::span<const std::uint8_t> evidence);

  /// Moves the added vertices that the cut has put where one was before, bit by bit, to where that came to lie. All
  /// others stay in the cut: the contact was made to step aside there, and they are inferred. Returns the evidence.
  std::vector<std::uint8_t> shape(InterfaceMesh& mesh) const;

 private:
  struct Bits {
    std::uint32_t x, y, z;
    friend bool operator==(const Bits&, const Bits&) = default;
  };
  struct Hash {
    std::size_t operator()(const Bits& b) const noexcept;
  };
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static Bits bits_of(const glm::vec3& p);

  struct Vertex {
    glm::vec3 place;
    std::uint8_t evidence;
    std::uint32_t next;  ///< the next one of the same place in the cut
  };
  std::vector<Vertex> vertices_;
  std::unordered_map<Bits, std::uint32_t, Hash> first_;
};

}  // namespace dubsar
