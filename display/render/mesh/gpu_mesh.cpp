#include "display/render/mesh/gpu_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "core/base/system/parallel.h"
#include "core/mesh/vertex_attributes.h"

namespace dubsar {
namespace {

constexpr std::int64_t kGrain = 1 << 16;

Box empty_box() {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  return {glm::dvec3(kInf), glm::dvec3(-kInf)};
}
void grow(Box& box, const glm::dvec3& p) {
  box.min = glm::min(box.min, p);
  box.max = glm::max(box.max, p);
}
bool is_empty(const Box& box) { return !(box.min.x <= box.max.x); }
bool finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Area-weighted, in mm, not normalised. One thread: the sums must not depend on the number of threads.
std::vector<glm::vec3> vertex_normals_mm(const TriMesh& mesh, const std::vector<Triangle>& triangles) {
  std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0));
  const glm::dvec3 step = mesh.frame.grid_voxel_mm();
  for (const Triangle& t : triangles) {
    const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const glm::vec3 n(glm::cross((b - a) * step, (c - a) * step));
    for (const std::uint32_t v : t) normals[v] += n;
  }
  return normals;
}

/// The vertices of a packed mesh: which one of the source each is, and the partition of its triangles.
struct LabelledVertices {
  std::vector<std::uint32_t> source;
  std::vector<PartitionId> partition;
};

/// Points the triangles of each partition at copies of those vertices that a lower partition has taken.
LabelledVertices split_by_partition(PackedMesh& mesh, std::size_t count) {
  LabelledVertices vertices{std::vector<std::uint32_t>(count), std::vector<PartitionId>(count, PartitionTable::kNone)};
  std::iota(vertices.source.begin(), vertices.source.end(), 0u);
  std::unordered_map<std::uint32_t, std::uint32_t> copies;  // of this partition
  for (int p = 0; p < kMaxPartitions; ++p) {
    copies.clear();
    for (std::int64_t t = mesh.first_triangle[p]; t < mesh.first_triangle[p + 1]; ++t)
      for (std::uint32_t& v : mesh.triangles[static_cast<std::size_t>(t)]) {
        if (vertices.partition[v] == PartitionTable::kNone) vertices.partition[v] = static_cast<PartitionId>(p);
        if (vertices.partition[v] == p) continue;
        const auto [copy, made] = copies.try_emplace(v, static_cast<std::uint32_t>(vertices.source.size()));
        if (made) {
          vertices.source.push_back(v);
          vertices.partition.push_back(static_cast<PartitionId>(p));
        }
        v = copy->second;
      }
  }
  std::replace(vertices.partition.begin(), vertices.partition.end(), PartitionTable::kNone, PartitionId{0});
  return vertices;
}

/// One chunk for all of a partition that the scan shows, one for what is inferred.
std::vector<TriangleChunk> whole_partitions(const PackedMesh& mesh) {
  std::vector<TriangleChunk> out;
  for (int p = 0; p < kMaxPartitions; ++p) {
    const std::int64_t begin = mesh.first_triangle[p], split = mesh.first_inferred[p], end = mesh.first_triangle[p + 1];
    if (begin < split) out.push_back({begin, split - begin, p, false, mesh.partition_box_mm[p]});
    if (split < end) out.push_back({split, end - split, p, true, mesh.partition_box_mm[p]});
  }
  return out;
}

/// False only when all of the box lies outside of one plane of the frustum.
bool may_be_seen(const glm::dmat4& clip_from_world, const Box& box) {
  const glm::dmat4 rows = glm::transpose(clip_from_world);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const glm::dvec4 plane = rows[3] + sign * rows[axis];  // inside: plane . (p, 1) >= 0
      double most = plane.w;
      for (int a = 0; a < 3; ++a) most += std::max(plane[a] * box.min[a], plane[a] * box.max[a]);
      if (most < 0) return false;
    }
  return true;
}

/// Of a box's middle in a view, -1 to 1; what is not before the eye counts as nearest.
double depth_of(const glm::dmat4& clip_from_world, const Box& box) {
  const glm::dvec4 middle = clip_from_world * glm::dvec4(box.centre(), 1.0);
  return middle.w > 0 ? std::clamp(middle.z / middle.w, -1.0, 1.0) : -1.0;
}

std::int16_t snorm16(double value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767));
}

std::uint16_t unorm16(double value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 1.0) * 65535));
}

}  // namespace

std::array<std::int16_t, 2> encode_octahedral(const glm::dvec3& unit) {
  const double sum = std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z);
  if (!(sum > 0) || !std::isfinite(sum)) return {0, 0};
  double x = unit.x / sum, y = unit.y / sum;
  if (unit.z < 0) {
    const double folded_x = (1 - std::abs(y)) * (x >= 0 ? 1 : -1);
    y = (1 - std::abs(x)) * (y >= 0 ? 1 : -1);
    x = folded_x;
  }
  return {snorm16(x), snorm16(y)};
}

glm::dvec3 decode_octahedral(const std::array<std::int16_t, 2>& code) {
  glm::dvec3 n(std::max(code[0] / 32767.0, -1.0), std::max(code[1] / 32767.0, -1.0), 0.0);
  n.z = 1.0 - std::abs(n.x) - std::abs(n.y);
  const double fold = std::max(-n.z, 0.0);
  n.x -= n.x >= 0 ? fold : -fold;
  n.y -= n.y >= 0 ? fold : -fold;
  return glm::normalize(n);
}

Box joined_box(const std::array<Box, kMaxPartitions>& boxes, std::uint8_t bits) {
  Box box = empty_box();
  for (std::size_t p = 0; p < boxes.size(); ++p)
    if ((bits >> p & 1) != 0) {
      grow(box, boxes[p].min);
      grow(box, boxes[p].max);
    }
  return is_empty(box) ? Box{} : box;
}

Box PackedMesh::box_of(std::uint8_t partitions) const {
  for (int p = 0; p < kMaxPartitions; ++p)
    if (first_triangle[p] == first_triangle[p + 1]) partitions = static_cast<std::uint8_t>(partitions & ~(1 << p));
  return joined_box(partition_box_mm, partitions);
}

std::int64_t PackedMesh::triangles_of(std::uint8_t partitions) const {
  std::int64_t count = 0;
  for (int p = 0; p < kMaxPartitions; ++p)
    if ((partitions >> p & 1) != 0) count += first_triangle[p + 1] - first_triangle[p];
  return count;
}

Result<PackedMesh> pack_mesh(const TriMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  DUBSAR_TRY(check_arrays(mesh, ErrorKind::kBadData, "render"));

  PackedMesh out;
  out.has_shape = !mesh.shape.empty();
  out.has_ao = !mesh.ao.empty();
  const glm::dvec3 step = mesh.frame.grid_voxel_mm();
  out.mirrored = step.x * step.y * step.z < 0;

  // Triangles by partition and evidence (counting sort), boxes on the way.
  const std::vector<std::uint8_t>& inferred = mesh.triangle_inferred;
  if (!inferred.empty() && inferred.size() != mesh.triangles.size())
    return fail(ErrorKind::kBadData, "render: {} triangles but {} marks of inferred ones, expected as many or none",
                mesh.triangles.size(), inferred.size());
  std::vector<char> usable(count);
  parallel_for(static_cast<std::int64_t>(count), kGrain,
               [&](std::int64_t i) { usable[static_cast<std::size_t>(i)] = finite(mesh.positions[i]); });
  constexpr std::size_t kNone = 2 * kMaxPartitions;
  const auto group_of = [&](std::size_t i) -> std::size_t {
    const Triangle& t = mesh.triangles[i];
    if (!usable[t[0]] || !usable[t[1]] || !usable[t[2]]) return kNone;
    return 2u * mesh.partition_of(i) + (inferred.empty() || inferred[i] == 0 ? 0u : 1u);
  };
  std::array<std::int64_t, kNone + 2> next{};
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) ++next[group_of(i) + 1];
  for (std::size_t g = 0; g < kNone; ++g) next[g + 1] += next[g];
  for (std::size_t p = 0; p < kMaxPartitions; ++p) {
    out.first_triangle[p + 1] = next[2 * p + 2];
    out.first_inferred[p] = next[2 * p + 1];
  }
  out.triangles.resize(static_cast<std::size_t>(next[kNone]));
  constexpr float kInf = std::numeric_limits<float>::infinity();
  std::array<glm::vec3, kMaxPartitions> low{}, high{};
  low.fill(glm::vec3(kInf));
  high.fill(glm::vec3(-kInf));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::size_t group = group_of(i);
    if (group == kNone) continue;
    const Triangle& t = mesh.triangles[i];
    out.triangles[static_cast<std::size_t>(next[group]++)] = t;
    for (const std::uint32_t v : t) {
      low[group / 2] = glm::min(low[group / 2], mesh.positions[v]);
      high[group / 2] = glm::max(high[group / 2], mesh.positions[v]);
    }
  }
  out.partition_box_mm.fill(empty_box());
  for (std::size_t p = 0; p < kMaxPartitions; ++p)
    if (low[p].x <= high[p].x) {
      grow(out.partition_box_mm[p], mesh.frame.mm_from_grid(low[p]));
      grow(out.partition_box_mm[p], mesh.frame.mm_from_grid(high[p]));
    }
  out.box_mm = out.box_of(0xff);

  const bool compute_normals = mesh.normals.empty();
  const std::vector<glm::vec3> computed =
      compute_normals ? vertex_normals_mm(mesh, out.triangles) : std::vector<glm::vec3>();
  const glm::dvec3 inverse_size = 1.0 / glm::max(out.box_mm.size(), glm::dvec3(std::numeric_limits<double>::min()));
  LabelledVertices labelled = split_by_partition(out, count);
  out.vertices.resize(labelled.source.size());
  parallel_for(static_cast<std::int64_t>(out.vertices.size()), kGrain, [&](std::int64_t at) {
    PackedVertex& v = out.vertices[static_cast<std::size_t>(at)];
    const std::size_t i = labelled.source[static_cast<std::size_t>(at)];
    const glm::dvec3 unit = (mesh.frame.mm_from_grid(mesh.positions[i]) - out.box_mm.min) * inverse_size;
    for (int a = 0; a < 3; ++a) v.position[a] = std::isfinite(unit[a]) ? unorm16(unit[a]) : std::uint16_t{0};
    const unsigned shape = mesh.shape.empty() ? 0u : mesh.shape[i] & 127u;
    const unsigned ao = mesh.ao.empty() ? 63u : std::min<unsigned>(mesh.ao[i], 63u);
    const unsigned partition = labelled.partition[static_cast<std::size_t>(at)];
    v.attributes = static_cast<std::uint16_t>(shape | ao << 7 | partition << 13);
    v.normal = encode_octahedral(compute_normals ? glm::dvec3(computed[i]) : glm::dvec3(mesh.normals[i]) / step);
  });
  if (!mesh.colors.empty())
    for (const std::uint32_t v : labelled.source)
      out.colors.push_back({mesh.colors[v][0], mesh.colors[v][1], mesh.colors[v][2], 255});
  out.source = std::move(labelled.source);
  return out;
}

Result<GpuMesh> GpuMesh::upload(const PackedMesh& mesh) {
  DUBSAR_ASSIGN(GpuMesh out, reserve(mesh));
  out.fill(mesh, std::numeric_limits<std::size_t>::max());
  out.source_ = mesh.source;
  DUBSAR_TRY(check_gl("uploading the mesh"));
  return out;
}

Result<GpuMesh> GpuMesh::reserve(const PackedMesh& mesh) {
  if (mesh.triangles.empty())
    return fail(ErrorKind::kBadData, "render: the mesh has no triangles, so there is nothing to draw");
  GpuMesh out;
  out.box_mm_ = mesh.box_mm;
  out.mirrored_ = mesh.mirrored;
  static std::atomic<std::uint64_t> uploads{0};
  out.version_ = ++uploads;
  out.chunks_ = mesh.chunks.empty() ? whole_partitions(mesh) : mesh.chunks;
  out.vertices_ = make_room(std::as_bytes(std::span(mesh.vertices)).size());
  out.indices_ = make_room(std::as_bytes(std::span(mesh.triangles)).size());
  out.vertex_array_ = make_vertex_array();
  const GLuint vao = out.vertex_array_;
  glVertexArrayElementBuffer(vao, out.indices_);
  glVertexArrayVertexBuffer(vao, 0, out.vertices_, 0, sizeof(PackedVertex));
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glEnableVertexArrayAttrib(vao, attribute);
    glVertexArrayAttribBinding(vao, attribute, 0);
  }
  glVertexArrayAttribFormat(vao, 0, 3, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(PackedVertex, position));
  glVertexArrayAttribIFormat(vao, 1, 1, GL_UNSIGNED_SHORT, offsetof(PackedVertex, attributes));
  glVertexArrayAttribFormat(vao, 2, 2, GL_SHORT, GL_TRUE, offsetof(PackedVertex, normal));
  if (!mesh.colors.empty()) {
    out.colors_ = make_room(std::as_bytes(std::span(mesh.colors)).size());
    glVertexArrayVertexBuffer(vao, 1, out.colors_, 0, 4);
    glEnableVertexArrayAttrib(vao, 3);
    glVertexArrayAttribBinding(vao, 3, 1);
    glVertexArrayAttribFormat(vao, 3, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0);
  }
  DUBSAR_TRY(check_gl("making room for the mesh"));
  return out;
}

/// True when all of it is there.
bool GpuMesh::fill(const PackedMesh& mesh, std::size_t bytes) {
  std::size_t begin = 0;  // of one of them among all bytes
  const auto put = [&](GLuint buffer, std::span<const std::byte> all) {
    if (uploaded_ >= begin && uploaded_ < begin + all.size()) {
      const std::size_t from = uploaded_ - begin, count = std::min(all.size() - from, bytes);
      if (count > 0)
        glNamedBufferSubData(buffer, static_cast<GLintptr>(from), static_cast<GLsizeiptr>(count), all.data() + from);
      uploaded_ += count;
      bytes -= count;
    }
    begin += all.size();
  };
  put(vertices_, std::as_bytes(std::span(mesh.vertices)));
  put(indices_, std::as_bytes(std::span(mesh.triangles)));
  put(colors_, std::as_bytes(std::span(mesh.colors)));
  return uploaded_ == begin;
}

Result<bool> GpuMesh::upload_some(PackedMesh& mesh, std::size_t bytes) {
  const bool whole = fill(mesh, bytes);
  if (whole) source_ = std::move(mesh.source);
  DUBSAR_TRY(check_gl("uploading the mesh"));
  return whole;
}

Result<void> GpuMesh::carry(const SurfaceFields& fields) {
  std::vector<CarriedField> values;
  values.reserve(source_.size());
  for (const std::uint32_t v : source_) values.push_back(fields.values[v]);
  fields_ = make_buffer(std::as_bytes(std::span(values)));
  constexpr GLuint kAttribute = 4, kBinding = 2;
  glVertexArrayVertexBuffer(vertex_array_, kBinding, fields_, 0, sizeof(CarriedField));
  glEnableVertexArrayAttrib(vertex_array_, kAttribute);
  glVertexArrayAttribBinding(vertex_array_, kAttribute, kBinding);
  glVertexArrayAttribFormat(vertex_array_, kAttribute, 4, GL_SHORT, GL_TRUE, 0);
  return check_gl("uploading figures of the surface");
}

TriangleRanges GpuMesh::visible_ranges(std::uint8_t partitions, std::span<const View> views,
                                       ShownEvidence evidence) const {
  std::vector<glm::dmat4> clips;
  for (const View& view : views) clips.push_back(view.clip_from_world());
  struct Seen {
    const TriangleChunk* chunk;
    double depth;
  };
  std::vector<Seen> seen;
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const TriangleChunk& chunk : chunks_) {
    if ((partitions >> chunk.partition & 1) == 0) continue;
    if (evidence != ShownEvidence::kBoth && chunk.inferred != (evidence == ShownEvidence::kInferred)) continue;
    if (std::none_of(clips.begin(), clips.end(),
                     [&](const glm::dmat4& clip) { return may_be_seen(clip, chunk.box_mm); }))
      continue;
    seen.push_back({&chunk, depth_of(clips.front(), chunk.box_mm)});
    nearest = std::min(nearest, seen.back().depth);
    farthest = std::max(farthest, seen.back().depth);
  }
  // More steps hide more of what lies behind, and are more calls.
  constexpr int kSteps = 4;
  const auto step_of = [&](const Seen& one) {
    const double share = farthest > nearest ? (one.depth - nearest) / (farthest - nearest) : 0.0;
    return std::min(static_cast<int>(share * kSteps), kSteps - 1);
  };
  TriangleRanges out;
  for (int step = 0; step < kSteps; ++step)
    for (const Seen& one : seen) {
      if (step_of(one) != step) continue;
      const TriangleChunk& chunk = *one.chunk;
      if (!out.empty() && out.back().first + out.back().second == chunk.first)
        out.back().second += chunk.count;
      else
        out.emplace_back(chunk.first, chunk.count);
    }
  return out;
}

}  // namespace dubsar
