#pragma once
// Which vertices of the contact are neighbours.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/contact/interface_mesh.h"

namespace dubsar {

struct InterfaceRings {
  std::vector<std::vector<std::uint32_t>> all;    ///< of each added vertex, ids as in triangles, each once, rising
  std::vector<std::vector<std::uint32_t>> added;  ///< those of them that were added, as indices into `mesh.added`

  InterfaceRings(const InterfaceMesh& mesh, std::uint32_t dual) : all(mesh.added.size()), added(mesh.added.size()) {
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        if (v >= dual)
          for (const std::uint32_t w : t)
            if (w != v) all[v - dual].push_back(w);
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::sort(all[i].begin(), all[i].end());
      all[i].erase(std::unique(all[i].begin(), all[i].end()), all[i].end());
      for (const std::uint32_t w : all[i])
        if (w >= dual) added[i].push_back(w - dual);
    }
  }
};

}  // namespace dubsar
