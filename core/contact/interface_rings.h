#pragma once
// Which vertices of the contact are neighbours.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/vertex_fans.h"

namespace dubsar {

/// A list of ids for each of some things, each with its weight in averages, in one piece of memory.
class IdLists {
 public:
  std::size_t size() const noexcept { return first_.size() - 1; }
  std::span<const std::uint32_t> operator[](std::size_t i) const noexcept {
    return std::span(ids_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  void add(std::uint32_t id, float weight) {
    ids_.push_back(id);
    weights_.push_back(weight);
  }
  void end_list() { first_.push_back(static_cast<std::uint32_t>(ids_.size())); }

  /// visit(id, weight) for those of a list. Returns the sum of the weights.
  template <class Visit>
  float each(std::size_t i, const Visit& visit) const {
    float weights = 0.0f;
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
      visit(ids_[k], weights_[k]);
      weights += weights_[k];
    }
    return weights;
  }

 private:
  std::vector<std::uint32_t> first_{0}, ids_;
  std::vector<float> weights_;
};

/// Neighbours along edges, and across quadrilaterals along both diagonals, whichever of them divides it: else averages
/// lean to one side, and a scan and its mirror image differ by a seventh of a step. A diagonal weighs a quarter of an
/// edge: averages are as round and as wide as over six neighbours, which are an ellipse of the same area.
struct InterfaceRings {
  static constexpr float kDiagonal = 0.25f;
  IdLists all;    ///< of each added vertex, ids as in triangles, each once, rising
  IdLists added;  ///< those of them that were added, as indices into `mesh.added`
  VertexFans fans;

  InterfaceRings(const InterfaceMesh& mesh, std::uint32_t dual) : fans(mesh, dual) {
    struct Neighbour {
      std::uint32_t id;
      float weight;
      bool operator<(const Neighbour& other) const {
        return id != other.id ? id < other.id : weight < other.weight;  // diagonals first
      }
    };
    std::vector<std::uint32_t> place(mesh.added.size() +
                                     1);  // first the neighbours of each vertex, then where they lie
    const auto each_pair = [&](const auto& visit) {
      for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t)
          for (const std::uint32_t w : t)
            if (w != v && v >= dual) visit(v - dual, Neighbour{w, 1.0f});
      for (const std::uint32_t first : mesh.quads) {
        const auto corner = corners_of_quad(mesh, first);
        for (std::size_t k = 0; k < 4; ++k)
          if (const std::uint32_t v = corner[k], w = corner[(k + 2) % 4]; w != v && v >= dual)
            visit(v - dual, Neighbour{w, kDiagonal});
      }
    };
    each_pair([&](std::uint32_t i, const Neighbour&) { ++place[i + 1]; });
    for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
    std::vector<Neighbour> around(place.back());
    std::vector<std::uint32_t> next(place.begin(), place.end() - 1);
    each_pair([&](std::uint32_t i, const Neighbour& neighbour) { around[next[i]++] = neighbour; });
    for (std::size_t i = 0; i < mesh.added.size(); ++i) {
      const auto begin = around.begin() + std::ptrdiff_t{place[i]}, end = around.begin() + std::ptrdiff_t{next[i]};
      std::sort(begin, end);
      for (auto n = begin; n != end; ++n) {
        if (n != begin && n->id == (n - 1)->id) continue;
        all.add(n->id, n->weight);
        if (n->id >= dual) added.add(n->id - dual, n->weight);
      }
      all.end_list();
      added.end_list();
    }
  }
};

/// visit(piece): the added vertices of `belongs` that hang together, from the first on, ring by ring.
template <class Visit>
void each_piece(const InterfaceRings& rings, const std::vector<bool>& belongs, const Visit& visit) {
  std::vector<bool> left = belongs;
  std::vector<std::uint32_t> piece;
  for (std::uint32_t i = 0; i < left.size(); ++i) {
    if (!left[i]) continue;
    left[i] = false;
    piece.assign(1, i);
    for (std::size_t k = 0; k < piece.size(); ++k)
      for (const std::uint32_t w : rings.added[piece[k]])
        if (left[w]) {
          left[w] = false;
          piece.push_back(w);
        }
    visit(piece);
  }
}

}  // namespace dubsar
