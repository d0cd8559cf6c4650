#include "core/parts/face_graph.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kGraphGrain = 1 << 14;

/// The face other than `face` with the directed side from -> to.
std::uint32_t find_face(const QuadMesh& mesh, std::uint32_t from, std::uint32_t to) {
  for (const std::uint32_t q : mesh.quads_of(from)) {
    if (!mesh.has_doubled(q)) {
      const auto& v = mesh.quads[q];
      for (unsigned i = 0; i < 4; ++i)
        if (v[i] == from && v[(i + 1) & 3] == to) return q;
      continue;
    }
    const Polygon polygon = mesh.polygon(q);
    for (int i = 0; i < polygon.size; ++i)
      if (polygon.vertex[static_cast<std::size_t>(i)] == from &&
          polygon.vertex[static_cast<std::size_t>((i + 1) % polygon.size)] == to)
        return q;
  }
  return FaceGraph::kNone;
}

}  // namespace

FaceNode face_node(const QuadMesh& mesh, std::uint32_t quad) {
  const Polygon polygon = mesh.polygon(quad);
  const auto size = static_cast<std::size_t>(polygon.size);
  FaceNode node;
  node.sides = polygon.size;
  glm::vec3 centre(0.0f), vector(0.0f);
  for (std::size_t i = 0; i < size; ++i) centre += mesh.positions[polygon.vertex[i]];
  centre /= static_cast<float>(size);
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint32_t a = polygon.vertex[i], b = polygon.vertex[(i + 1) % size];
    vector += glm::cross(mesh.positions[a] - centre, mesh.positions[b] - centre);
    node.neighbour[i] = find_face(mesh, b, a);
  }
  const float length = glm::length(vector);
  node.centre = centre;
  node.normal = length > 0.0f ? vector / length : glm::vec3(0.0f);
  node.area = 0.5f * length;
  return node;
}

Result<FaceGraph> FaceGraph::build(const QuadMesh& mesh, Progress& progress) {
  const std::size_t faces = mesh.quads.size();
  FaceGraph graph;
  graph.first_side.resize(faces + 1);
  auto doubled = mesh.doubled.begin();
  std::uint32_t extra = 0;
  for (std::size_t q = 0; q <= faces; ++q) {
    graph.first_side[q] = static_cast<std::uint32_t>(4 * q) + extra;
    for (; doubled != mesh.doubled.end() && doubled->quad == q; ++doubled) ++extra;
  }
  graph.neighbour.resize(graph.first_side.back());
  graph.centre.resize(faces);
  graph.normal.resize(faces);
  graph.area.resize(faces);
  parallel_chunks(static_cast<std::int64_t>(faces), kGraphGrain, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    for (auto q = static_cast<std::uint32_t>(begin); q < static_cast<std::uint32_t>(end); ++q) {
      const FaceNode node = face_node(mesh, q);
      std::copy_n(node.neighbour.begin(), node.sides, graph.neighbour.begin() + graph.first_side[q]);
      graph.centre[q] = node.centre;
      graph.normal[q] = node.normal;
      graph.area[q] = node.area;
    }
  });
  if (progress.cancelled()) return cancelled_error();
  return graph;
}

float FaceGraph::curvature(std::uint32_t a, std::uint32_t b) const noexcept {
  const glm::vec3 d = centre[b] - centre[a];
  const float length2 = glm::dot(d, d);
  return length2 > 1e-12f ? glm::dot(normal[b] - normal[a], d) / length2 : 0.0f;
}

}  // namespace dubsar
