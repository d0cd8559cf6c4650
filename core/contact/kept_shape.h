#pragma once
// Where an attempt at the contact has put its vertices, for the next one, whose cut differs in a few places.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/contact/interface_mesh.h"
#include "core/parts/untangle.h"

namespace dubsar {

class KeptShape {
 public:
  /// Vertices that lay at `cut` came to lie at `places`; `places` and `evidence` go on with one vertex for each split
  /// (untangle.h) of edges between them and the first `surface` ids. Borrows nothing.
  KeptShape(std::span<const glm::vec3> cut, std::span<const glm::vec3> places, std::span<const std::uint8_t> evidence,
            std::uint32_t surface, std::vector<PatchSplit> splits);

  /// What it knows of a mesh.
  struct Known {
    std::vector<std::uint8_t> evidence;  ///< of the added vertices
    std::vector<std::uint8_t> settled;   ///< 1: where it was before
    std::vector<PatchSplit> splits;      ///< those that were made again; each added a vertex
  };

  /// Moves the added vertices that the cut has put where one was before, bit by bit, to where that came to lie. All
  /// others stay in the cut: the contact was made to step aside there, and they are inferred. Edges that were split and
  /// are there are split again.
  Known shape(InterfaceMesh& mesh) const;

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

  void split_again(std::vector<std::uint32_t> id_now, InterfaceMesh& mesh, Known& known) const;

  struct Vertex {
    glm::vec3 place;
    std::uint8_t evidence;
    std::uint32_t next;  ///< the next one of the same place in the cut
  };
  std::vector<Vertex> vertices_;  ///< those of the cut, then those on splits
  std::unordered_map<Bits, std::uint32_t, Hash> first_;
  std::uint32_t surface_;
  std::vector<PatchSplit> splits_;
};

}  // namespace dubsar
