#pragma once
// Which vertices of the contact are neighbours.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/interface_mesh.h"

namespace dubsar {

/// A list of ids for each of some things, in one piece of memory.
class IdLists {
 public:
  std::size_t size() const noexcept { return first_.size() - 1; }
  std::span<const std::uint32_t> operator[](std::size_t i) const noexcept {
    return std::span(ids_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  void add(std::uint32_t id) { ids_.push_back(id); }
  void end_list() { first_.push_back(static_cast<std::uint32_t>(ids_.size())); }

 private:
  std::vector<std::uint32_t> first_{0}, ids_;
};

struct InterfaceRings {
  IdLists all;    ///< of each added vertex, ids as in triangles, each once, rising
  IdLists added;  ///< those of them that were added, as indices into `mesh.added`

  InterfaceRings(const InterfaceMesh& mesh, std::uint32_t dual) {
    std::vector<std::uint32_t> place(mesh.added.size() + 1);  // first the corners at each vertex, then where they lie
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        if (v >= dual) place[v - dual + 1] += 2;
    for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
    std::vector<std::uint32_t> around(place.back()), next(place.begin(), place.end() - 1);
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        if (v >= dual)
          for (const std::uint32_t w : t)
            if (w != v) around[next[v - dual]++] = w;
    for (std::size_t i = 0; i < mesh.added.size(); ++i) {
      const auto begin = around.begin() + std::ptrdiff_t{place[i]};
      auto end = around.begin() + std::ptrdiff_t{next[i]};
      std::sort(begin, end);
      end = std::unique(begin, end);
      for (auto w = begin; w != end; ++w) {
        all.add(*w);
        if (*w >= dual) added.add(*w - dual);
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
