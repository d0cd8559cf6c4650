#pragma once
// Which vertices of the contact are neighbours.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/contact/vertex_fans.h"

namespace dubsar {

/// A list of ids for each of some things, each with its weight in averages, in one piece of memory.
class IdLists {
 public:
  IdLists() = default;
  /// The lists of all parts, one after another.
  explicit IdLists(const std::vector<IdLists>& parts) {
    std::vector<std::int64_t> first_list, first_id;
    for (const IdLists& part : parts) {
      first_list.push_back(static_cast<std::int64_t>(part.size()));
      first_id.push_back(static_cast<std::int64_t>(part.ids_.size()));
    }
    resize_large(first_, static_cast<std::size_t>(exclusive_scan(first_list)) + 1);
    resize_large(ids_, static_cast<std::size_t>(exclusive_scan(first_id)));
    resize_large(weights_, ids_.size());
    parallel_for(static_cast<std::int64_t>(parts.size()), 1, [&](std::int64_t p) {
      const auto at = static_cast<std::size_t>(p);
      const IdLists& part = parts[at];
      std::transform(part.first_.begin() + 1, part.first_.end(), first_.begin() + first_list[at] + 1,
                     [&](std::uint32_t end) { return static_cast<std::uint32_t>(first_id[at]) + end; });
      std::copy(part.ids_.begin(), part.ids_.end(), ids_.begin() + first_id[at]);
      std::copy(part.weights_.begin(), part.weights_.end(), weights_.begin() + first_id[at]);
    });
  }

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

  /// Has an added vertex neighbours that belong to the surface of the air, too?
  bool at_air(std::size_t i) const noexcept { return all[i].size() != added[i].size(); }

  InterfaceRings(const InterfaceMesh& mesh, std::uint32_t dual) : fans(mesh, dual) {
    struct Neighbour {
      std::uint32_t id;
      float weight;
      bool operator<(const Neighbour& other) const {
        return id != other.id ? id < other.id : weight < other.weight;  // diagonals first
      }
    };
    constexpr std::int64_t kTogether = 1 << 12;  ///< vertices whose neighbours one thread lists
    const auto count = static_cast<std::int64_t>(mesh.added.size());
    std::vector<IdLists> of_all(static_cast<std::size_t>((count + kTogether - 1) / kTogether)), of_added(of_all.size());
    parallel_chunks(count, kTogether, [&](std::int64_t begin, std::int64_t end) {
      const auto part = static_cast<std::size_t>(begin / kTogether);
      std::vector<Neighbour> around;
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        const auto own = static_cast<std::uint32_t>(dual + i);
        around.clear();
        for (const std::uint32_t t : fans.triangles[i])
          for (const std::uint32_t w : mesh.triangles[t])
            if (w != own) around.push_back({w, 1.0f});
        for (const std::uint32_t c : fans.corners[i])
          if (const std::uint32_t w = corners_of_quad(mesh, mesh.quads[c / 4])[(c + 2) % 4]; w != own)
            around.push_back({w, kDiagonal});
        std::sort(around.begin(), around.end());
        for (auto n = around.begin(); n != around.end(); ++n) {
          if (n != around.begin() && n->id == (n - 1)->id) continue;
          of_all[part].add(n->id, n->weight);
          if (n->id >= dual) of_added[part].add(n->id - dual, n->weight);
        }
        of_all[part].end_list();
        of_added[part].end_list();
      }
    });
    all = IdLists(of_all);
    added = IdLists(of_added);
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
