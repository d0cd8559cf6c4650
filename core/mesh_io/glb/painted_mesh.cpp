#include "core/mesh_io/glb/painted_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr int kMostParts = 16;  // of an edge
constexpr std::int64_t kGrain = 1 << 14;

double pixels_of(const PaintedMesh& mesh, const Triangle& t) {
  const GlbPaint& paint = mesh.paints[mesh.paint[t[0]]];
  if (paint.photo == nullptr) return 0.0;
  const glm::dvec2 size(paint.photo->width, paint.photo->height);
  const glm::dvec2 a = size * paint.place(mesh.uv[t[0]]), b = size * paint.place(mesh.uv[t[1]]) - a,
                   c = size * paint.place(mesh.uv[t[2]]) - a;
  const double area = 0.5 * std::abs(b.x * c.y - b.y * c.x);
  return std::isfinite(area) ? std::min(area, size.x * size.y) : 0.0;
}

bool comes_before(const glm::dvec3& a, const glm::dvec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

class Refiner {
 public:
  Refiner(PaintedMesh& mesh, int parts) : mesh_(mesh), parts_(parts) {}
  void run() {
    std::vector<Triangle> triangles;
    std::vector<PartitionId> partitions;
    const auto n = static_cast<std::size_t>(parts_);
    triangles.reserve(n * n * mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      divide(mesh_.triangles[t], triangles);
      partitions.insert(partitions.end(), n * n, mesh_.partitions[t]);
    }
    mesh_.triangles = std::move(triangles);
    mesh_.partitions = std::move(partitions);
  }

 private:
  /// Between vertices, with weights that add up to 1.
  std::uint32_t add(const Triangle& of, const glm::dvec3& weights) {
    const auto mean = [&](const auto& values) {
      return weights.x * values[of[0]] + weights.y * values[of[1]] + weights.z * values[of[2]];
    };
    const glm::dvec3 normal = mean(mesh_.normals);
    const double length = glm::length(normal);
    mesh_.places.push_back(mean(mesh_.places));
    mesh_.normals.push_back(length > 0 ? normal / length : normal);
    mesh_.own.push_back(mean(mesh_.own));
    mesh_.uv.push_back(mean(mesh_.uv));
    mesh_.paint.push_back(mesh_.paint[of[0]]);
    return static_cast<std::uint32_t>(mesh_.places.size() - 1);
  }

  /// Vertex i of 0..parts on the edge from a to b.
  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, int i) {
    if (i == 0) return a;
    if (i == parts_) return b;
    // From the same end whichever triangle asks, and on both sides of a seam.
    const bool turned = mesh_.places[a] == mesh_.places[b] ? a > b : comes_before(mesh_.places[b], mesh_.places[a]);
    if (turned) std::swap(a, b), i = parts_ - i;
    const auto [found, made] = edges_.try_emplace({a, b}, 0);
    if (made)
      for (int k = 1; k < parts_; ++k) {
        const double share = static_cast<double>(k) / parts_;
        const std::uint32_t id = add({a, b, b}, {1.0 - share, share, 0.0});
        if (k == 1) found->second = id;
      }
    return found->second + static_cast<std::uint32_t>(i - 1);
  }

  void divide(const Triangle& t, std::vector<Triangle>& out) {
    // Row r of the points has r + 1 of them, from the side of t[1] to that of t[2]; row 0 is t[0].
    std::vector<std::uint32_t> before, row;
    for (int r = 0; r <= parts_; ++r) {
      row.clear();
      for (int c = 0; c <= r; ++c) {
        if (c == 0) {
          row.push_back(on_edge(t[0], t[1], r));
        } else if (c == r) {
          row.push_back(on_edge(t[0], t[2], r));
        } else if (r == parts_) {
          row.push_back(on_edge(t[1], t[2], c));
        } else {
          const double down = static_cast<double>(r) / parts_, across = static_cast<double>(c) / parts_;
          row.push_back(add(t, {1.0 - down, down - across, across}));
        }
      }
      for (std::size_t c = 0; c + 1 < row.size(); ++c) {
        out.push_back({before[c], row[c], row[c + 1]});
        if (c + 1 < before.size()) out.push_back({before[c], row[c + 1], before[c + 1]});
      }
      before = row;
    }
  }

  PaintedMesh& mesh_;
  int parts_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_;  // the first of their new vertices
};

}  // namespace

double photo_pixels(const PaintedMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) sum += pixels_of(mesh, t);
  return sum;
}

void refine_to_photo(PaintedMesh& mesh, std::size_t most) {
  if (mesh.triangles.empty()) return;
  const auto count = static_cast<double>(mesh.triangles.size());
  // Twice as many triangles as vertices.
  const double wanted = std::sqrt(2.0 * photo_pixels(mesh) / count),
               room = std::sqrt(static_cast<double>(most) / count);
  const int parts = static_cast<int>(std::min({wanted + 0.5, room, double{kMostParts}}));
  if (parts > 1) Refiner(mesh, parts).run();
}

std::vector<std::array<std::uint8_t, 3>> painted_colors(const PaintedMesh& mesh) {
  std::vector<std::array<std::uint8_t, 3>> out(mesh.places.size());
  const double side = std::sqrt(photo_pixels(mesh) / static_cast<double>(std::max<std::size_t>(out.size(), 1)));
  parallel_for(static_cast<std::int64_t>(out.size()), kGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    out[v] = mesh.paints[mesh.paint[v]].color(mesh.uv[v], side, mesh.own[v]);
  });
  return out;
}

}  // namespace dubsar
