#include "display/render/mesh/lod.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr int kChunksPerAxis = 8;
constexpr double kUnit = 65535.0;  // PackedVertex positions
constexpr std::int64_t kGrain = 1 << 16;

glm::dvec3 unit_position(const PackedVertex& v) {
  return glm::dvec3(v.position[0], v.position[1], v.position[2]) / kUnit;
}

int main_direction(const glm::dvec3& normal) {
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * axis + (normal[axis] < 0 ? 1 : 0);
}

/// Which way the normal points, coarsely: signs of its code, so that both sides of a thin wall stay apart.
std::uint64_t octant_pair(const std::array<std::int16_t, 2>& code) {
  return (code[0] < 0 ? 1u : 0u) + (code[1] < 0 ? 2u : 0u);
}

PackedMesh empty_like(const PackedMesh& mesh) {
  PackedMesh out;
  out.box_mm = mesh.box_mm;
  out.partition_box_mm = mesh.partition_box_mm;
  out.has_shape = mesh.has_shape;
  out.has_ao = mesh.has_ao;
  out.mirrored = mesh.mirrored;
  return out;
}

struct Keyed {
  std::uint64_t key;
  std::uint32_t vertex;
};

/// Order of vertices by the cell that they fall into.
std::vector<Keyed> keyed_vertices(const PackedMesh& mesh, double cell_mm) {
  const glm::dvec3 cells = glm::ceil(mesh.box_mm.size() / cell_mm) + 1.0;
  std::vector<Keyed> out(mesh.vertices.size());
  parallel_for(static_cast<std::int64_t>(out.size()), kGrain, [&](std::int64_t i) {
    const PackedVertex& v = mesh.vertices[static_cast<std::size_t>(i)];
    const glm::dvec3 cell = glm::floor(unit_position(v) * mesh.box_mm.size() / cell_mm);
    std::uint64_t key = static_cast<std::uint64_t>(cell.x);
    key = key + static_cast<std::uint64_t>(cells.x) *
                    (static_cast<std::uint64_t>(cell.y) +
                     static_cast<std::uint64_t>(cells.y) * static_cast<std::uint64_t>(cell.z));
    key = key * 6 + static_cast<std::uint64_t>(main_direction(decode_octahedral(v.normal)));
    out[static_cast<std::size_t>(i)] = {key << 3 | (v.attributes >> 13), static_cast<std::uint32_t>(i)};
  });
  std::sort(out.begin(), out.end(),
            [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.vertex < b.vertex; });
  return out;
}

/// One vertex for those in [first, last).
PackedVertex merged(const PackedMesh& mesh, const Keyed* first, const Keyed* last, std::uint32_t& representative) {
  glm::dvec3 position(0.0), normal(0.0);
  for (const Keyed* k = first; k != last; ++k) {
    position += unit_position(mesh.vertices[k->vertex]);
    normal += decode_octahedral(mesh.vertices[k->vertex].normal);
  }
  position /= static_cast<double>(last - first);
  double nearest = 1e30;
  for (const Keyed* k = first; k != last; ++k) {
    const glm::dvec3 d = (unit_position(mesh.vertices[k->vertex]) - position) * mesh.box_mm.size();
    if (glm::dot(d, d) < nearest) nearest = glm::dot(d, d), representative = k->vertex;
  }
  PackedVertex out = mesh.vertices[representative];
  for (int a = 0; a < 3; ++a)
    out.position[static_cast<std::size_t>(a)] = static_cast<std::uint16_t>(std::lround(position[a] * kUnit));
  if (glm::dot(normal, normal) > 0) out.normal = encode_octahedral(glm::normalize(normal));
  return out;
}

}  // namespace

PackedMesh cluster_vertices(const PackedMesh& mesh, double cell_mm) {
  DUBSAR_CHECK(cell_mm > 0 && std::isfinite(cell_mm));
  PackedMesh out = empty_like(mesh);
  const std::vector<Keyed> order = keyed_vertices(mesh, cell_mm);
  std::vector<std::uint32_t> new_id(mesh.vertices.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && order[end].key == order[i].key) ++end;
    std::uint32_t representative = order[i].vertex;
    for (std::size_t k = i; k < end; ++k) new_id[order[k].vertex] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(merged(mesh, order.data() + i, order.data() + end, representative));
    if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[representative]);
    if (!mesh.source.empty()) out.source.push_back(mesh.source[representative]);
    i = end;
  }
  const auto add = [&](std::int64_t first, std::int64_t last) {
    const auto begin = static_cast<std::ptrdiff_t>(out.triangles.size());
    for (auto t = first; t < last; ++t) {
      Triangle triangle = mesh.triangles[static_cast<std::size_t>(t)];
      for (std::uint32_t& v : triangle) v = new_id[v];
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
      out.triangles.push_back(triangle);
    }
    std::sort(out.triangles.begin() + begin, out.triangles.end());
    out.triangles.erase(std::unique(out.triangles.begin() + begin, out.triangles.end()), out.triangles.end());
    return static_cast<std::int64_t>(out.triangles.size());
  };
  for (std::size_t p = 0; p < kMaxPartitions; ++p) {
    out.first_inferred[p] = add(mesh.first_triangle[p], mesh.first_inferred[p]);
    out.first_triangle[p + 1] = add(mesh.first_inferred[p], mesh.first_triangle[p + 1]);
  }
  return out;
}

PackedMesh quick_clusters(const PackedMesh& mesh, double cell_mm) {
  DUBSAR_CHECK(cell_mm > 0 && std::isfinite(cell_mm));
  PackedMesh out = empty_like(mesh);
  const glm::dvec3 cells = glm::ceil(mesh.box_mm.size() / cell_mm) + 1.0;
  const glm::dvec3 per_unit = mesh.box_mm.size() / (cell_mm * kUnit);
  const auto row = static_cast<std::uint64_t>(cells.x), layer = row * static_cast<std::uint64_t>(cells.y);
  constexpr std::uint32_t kFree = 0xffffffffu;
  struct Slot {
    std::uint64_t key;
    std::uint32_t id;
  };
  std::vector<Slot> slots(std::bit_ceil(std::max<std::size_t>(1024, mesh.vertices.size())), Slot{0, kFree});
  const std::uint64_t mask = slots.size() - 1;
  std::vector<std::uint32_t> new_id(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const PackedVertex& v = mesh.vertices[i];
    const std::uint64_t key =
        static_cast<std::uint64_t>(v.position[0] * per_unit.x) +
        row * static_cast<std::uint64_t>(v.position[1] * per_unit.y) +
        layer * (static_cast<std::uint64_t>(v.position[2] * per_unit.z) * 4 + octant_pair(v.normal));
    std::uint64_t at = key * 0x9e3779b97f4a7c15u >> 20 & mask;
    while (slots[at].id != kFree && slots[at].key != key) at = (at + 1) & mask;
    if (slots[at].id == kFree) {
      slots[at] = {key, static_cast<std::uint32_t>(out.vertices.size())};
      out.vertices.push_back(v);
      if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[i]);
      if (!mesh.source.empty()) out.source.push_back(mesh.source[i]);
    }
    new_id[i] = slots[at].id;
  }
  const auto add = [&](std::int64_t first, std::int64_t last) {
    for (auto t = first; t < last; ++t) {
      const Triangle& old = mesh.triangles[static_cast<std::size_t>(t)];
      const Triangle triangle{new_id[old[0]], new_id[old[1]], new_id[old[2]]};
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
        out.triangles.push_back(triangle);
    }
    return static_cast<std::int64_t>(out.triangles.size());
  };
  for (std::size_t p = 0; p < kMaxPartitions; ++p) {
    out.first_inferred[p] = add(mesh.first_triangle[p], mesh.first_inferred[p]);
    out.first_triangle[p + 1] = add(mesh.first_inferred[p], mesh.first_triangle[p + 1]);
  }
  return out;
}

void sort_into_chunks(PackedMesh& mesh) {
  constexpr int kBlocks = kChunksPerAxis * kChunksPerAxis * kChunksPerAxis;
  const auto block_of = [&](const Triangle& t) {
    int block = 0;
    for (std::size_t a = 3; a-- > 0;) {
      const unsigned sum =
          0u + mesh.vertices[t[0]].position[a] + mesh.vertices[t[1]].position[a] + mesh.vertices[t[2]].position[a];
      block = block * kChunksPerAxis + static_cast<int>(sum * kChunksPerAxis / (3u * 65536u));
    }
    return block;
  };
  mesh.chunks.clear();
  std::vector<Triangle> sorted(mesh.triangles.size());
  for (int group = 0; group < 2 * kMaxPartitions; ++group) {
    const int p = group / 2;
    const bool inferred = group % 2 != 0;
    const std::int64_t begin = inferred ? mesh.first_inferred[p] : mesh.first_triangle[p],
                       end = inferred ? mesh.first_triangle[p + 1] : mesh.first_inferred[p];
    std::vector<std::int64_t> next(kBlocks + 1, 0);
    for (std::int64_t t = begin; t < end; ++t)
      ++next[static_cast<std::size_t>(block_of(mesh.triangles[static_cast<std::size_t>(t)]) + 1)];
    for (std::size_t b = 0; b < kBlocks; ++b) next[b + 1] += next[b];
    const std::vector<std::int64_t> first = next;
    for (std::int64_t t = begin; t < end; ++t) {
      const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(t)];
      sorted[static_cast<std::size_t>(begin + next[static_cast<std::size_t>(block_of(triangle))]++)] = triangle;
    }
    for (std::size_t b = 0; b < kBlocks; ++b) {
      TriangleChunk chunk{begin + first[b], first[b + 1] - first[b], p, inferred, {}};
      if (chunk.count == 0) continue;
      glm::dvec3 low(1.0), high(0.0);
      for (std::int64_t t = chunk.first; t < chunk.first + chunk.count; ++t)
        for (const std::uint32_t v : sorted[static_cast<std::size_t>(t)]) {
          low = glm::min(low, unit_position(mesh.vertices[v]));
          high = glm::max(high, unit_position(mesh.vertices[v]));
        }
      chunk.box_mm = {mesh.box_mm.min + low * mesh.box_mm.size(), mesh.box_mm.min + high * mesh.box_mm.size()};
      mesh.chunks.push_back(chunk);
    }
  }
  mesh.triangles = std::move(sorted);
}

}  // namespace dubsar
