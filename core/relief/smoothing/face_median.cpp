#include "core/relief/smoothing/face_median.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/relief/smoothing/scatter_blocks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/relief/smoothing/face_median.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/relief/curvature/row_lanes-inl.h"

#ifndef DUBSAR_FACE_MEDIAN_JOB
#define DUBSAR_FACE_MEDIAN_JOB
namespace dubsar {
namespace {
constexpr std::size_t kBatch = 16, kMostAround = 8;

/// The faces around the vertices of a group, sixteen vertices with equally many at a time: of each batch of `around`
/// faces [face 0 .. around)[vertex], one size after the other from 2 on; the last batch of a size repeats its last.
struct VertexGroup {
  std::vector<std::uint32_t> faces;
  std::array<std::uint16_t, kMostAround + 1> vertices;  ///< by the number of faces
  std::vector<std::uint32_t> others;                    ///< vertices with more faces
};

/// The faces [first, first + size) and where their sums lie, four floats each; one more behind them takes all others.
struct MedianBlock {
  const QuadMesh* mesh;
  const float* faces;
  float* sums;
  std::uint32_t first, size;
  float epsilon;
};
}  // namespace
}  // namespace dubsar
#endif

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kBatch>;
using V = hn::Vec<D>;
typedef float Float4 __attribute__((vector_size(16), aligned(4), may_alias));

/// Products and sums are kept apart (no fused multiply-add), so that all SIMD targets give the same bits.
HWY_INLINE V squared(const V x, const V y, const V z) {
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}
HWY_INLINE void add_row(float* sum, const float* row) {
  *reinterpret_cast<Float4*>(sum) += *reinterpret_cast<const Float4*>(row);
}

/// What the kAround faces of each of up to 16 vertices pull at one another.
template <std::size_t kAround>
HWY_INLINE void pull_batch(const MedianBlock& block, const std::uint32_t* faces, std::size_t count) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const float* const from = block.faces;
  HWY_ALIGN float rows[kAround][kBatch * 4];
  HWY_ALIGN std::uint32_t places[kAround][kBatch];
  const V epsilon = hn::Set(d, block.epsilon), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const auto first = hn::Set(du, block.first), size = hn::Set(du, block.size);
  for (std::size_t lane = 0; lane < kBatch; lane += hn::Lanes(d)) {
    RowLanes<V> n[kAround];
    V sx[kAround], sy[kAround], sz[kAround];
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kAround; ++j) {
      const std::uint32_t* face = faces + j * kBatch + lane;
      n[j] = load_rows(d, [&](std::size_t l) HWY_ATTR { return from + 4 * std::size_t{face[l]}; });
      hn::Store(hn::Min(hn::Sub(hn::LoadU(du, face), first), size), du, places[j] + lane);
      sx[j] = sy[j] = sz[j] = zero;
    }
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kAround; ++i)
#pragma GCC unroll 8
      for (std::size_t j = i + 1; j < kAround; ++j) {
        const V apart = squared(hn::Sub(n[i].x, n[j].x), hn::Sub(n[i].y, n[j].y), hn::Sub(n[i].z, n[j].z));
        const V pull = hn::Div(one, hn::Add(hn::Sqrt(apart), epsilon));
        const V at_i = hn::Mul(pull, n[j].w), at_j = hn::Mul(pull, n[i].w);
        sx[i] = hn::Add(sx[i], hn::Mul(at_i, n[j].x));
        sy[i] = hn::Add(sy[i], hn::Mul(at_i, n[j].y));
        sz[i] = hn::Add(sz[i], hn::Mul(at_i, n[j].z));
        sx[j] = hn::Add(sx[j], hn::Mul(at_j, n[i].x));
        sy[j] = hn::Add(sy[j], hn::Mul(at_j, n[i].y));
        sz[j] = hn::Add(sz[j], hn::Mul(at_j, n[i].z));
      }
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kAround; ++j) hn::StoreInterleaved4(sx[j], sy[j], sz[j], zero, d, rows[j] + 4 * lane);
  }
  float* const sums = block.sums;
  for (std::size_t l = 0; l < count; ++l)
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kAround; ++j) add_row(sums + 4 * std::size_t{places[j][l]}, rows[j] + 4 * l);
}

/// Around one vertex, any number of faces.
void pull_many(const MedianBlock& block, std::uint32_t vertex) {
  const auto around = block.mesh->quads_of(vertex);
  for (const std::uint32_t to : around) {
    const float* n = block.faces + 4 * std::size_t{to};
    float row[4] = {};
    for (const std::uint32_t from : around) {
      if (from == to) continue;
      const float* m = block.faces + 4 * std::size_t{from};
      const float x = n[0] - m[0], y = n[1] - m[1], z = n[2] - m[2];
      const float pull = m[3] * (1.0f / (std::sqrt(x * x + y * y + z * z) + block.epsilon));
      for (int a = 0; a < 3; ++a) row[a] += pull * m[a];
    }
    add_row(block.sums + 4 * std::size_t{std::min(to - block.first, block.size)}, row);
  }
}

template <std::size_t kAround>
const std::uint32_t* pull_run(const MedianBlock& block, const VertexGroup& group, const std::uint32_t* faces) {
  for (std::size_t i = 0; i < group.vertices[kAround]; i += kBatch, faces += kAround * kBatch)
    pull_batch<kAround>(block, faces, std::min<std::size_t>(kBatch, group.vertices[kAround] - i));
  return faces;
}

void pull_group(const MedianBlock& block, const VertexGroup& group) {
  const std::uint32_t* faces = group.faces.data();
  faces = pull_run<2>(block, group, faces);
  faces = pull_run<3>(block, group, faces);
  faces = pull_run<4>(block, group, faces);
  faces = pull_run<5>(block, group, faces);
  faces = pull_run<6>(block, group, faces);
  faces = pull_run<7>(block, group, faces);
  pull_run<8>(block, group, faces);
  for (const std::uint32_t vertex : group.others) pull_many(block, vertex);
}

/// Each face pulls at itself with twice its area.
void begin_block(const MedianBlock& block) {
  const D d;
  const float* from = block.faces + 4 * std::size_t{block.first};
  const V scale = hn::Div(hn::Set(d, 2.0f), hn::Set(d, block.epsilon));
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= block.size; i += hn::Lanes(d)) {
    V x, y, z, w;
    hn::LoadInterleaved4(d, from + 4 * i, x, y, z, w);
    const V pull = hn::Mul(w, scale);
    hn::StoreInterleaved4(hn::Mul(pull, x), hn::Mul(pull, y), hn::Mul(pull, z), hn::Zero(d), d, block.sums + 4 * i);
  }
  for (; i < block.size; ++i) {
    const float pull = from[4 * i + 3] * (2.0f / block.epsilon);
    for (std::size_t a = 0; a < 3; ++a) block.sums[4 * i + a] = pull * from[4 * i + a];
    block.sums[4 * i + 3] = 0.0f;
  }
}

/// Normals that cancel leave the face as it is.
void end_block(const MedianBlock& block, float* to) {
  const D d;
  const float* from = block.faces + 4 * std::size_t{block.first};
  to += 4 * std::size_t{block.first};
  const auto unit_rows = [&](std::size_t i) HWY_ATTR {
    V x, y, z, w, mx, my, mz, area;
    hn::LoadInterleaved4(d, block.sums + 4 * i, x, y, z, w);
    hn::LoadInterleaved4(d, from + 4 * i, mx, my, mz, area);
    const V length2 = squared(x, y, z);
    const auto valid = hn::Gt(length2, hn::Set(d, 1e-30f));
    const V scale = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(length2));
    hn::StoreInterleaved4(hn::IfThenElse(valid, hn::Mul(x, scale), mx), hn::IfThenElse(valid, hn::Mul(y, scale), my),
                          hn::IfThenElse(valid, hn::Mul(z, scale), mz), area, d, to + 4 * i);
  };
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= block.size; i += hn::Lanes(d)) unit_rows(i);
  for (; i < block.size; ++i) {
    const float *s = block.sums + 4 * i, *m = from + 4 * i;
    const float length2 = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], scale = 1.0f / std::sqrt(length2);
    for (std::size_t a = 0; a < 3; ++a) to[4 * i + a] = length2 > 1e-30f ? s[a] * scale : m[a];
    to[4 * i + 3] = m[3];
  }
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(pull_group);
HWY_EXPORT(begin_block);
HWY_EXPORT(end_block);

std::vector<VertexGroup> group_vertices(const QuadMesh& mesh) {
  const std::int64_t count = (mesh.vertex_count() + kVertexGroup - 1) / kVertexGroup;
  std::vector<VertexGroup> groups(static_cast<std::size_t>(count));
  parallel_for(count, 16, [&](std::int64_t g) {
    VertexGroup& group = groups[static_cast<std::size_t>(g)];
    const auto begin = static_cast<std::uint32_t>(g * kVertexGroup);
    const auto end = static_cast<std::uint32_t>(std::min<std::int64_t>(begin + kVertexGroup, mesh.vertex_count()));
    const std::uint32_t* first = mesh.first_incident.data();
    group.vertices.fill(0);
    for (std::uint32_t v = begin; v < end; ++v) {
      const std::size_t around = first[v + 1] - first[v];
      if (around > kMostAround)
        group.others.push_back(v);
      else
        ++group.vertices[around];
    }
    std::array<std::size_t, kMostAround + 1> start{};  // of each size
    std::size_t all = 0;
    for (std::size_t k = 2; k <= kMostAround; ++k) {
      start[k] = all;
      all += (group.vertices[k] + kBatch - 1) / kBatch * kBatch * k;
    }
    group.faces.resize(all);
    std::array<std::size_t, kMostAround + 1> put{};
    const auto take = [&](std::uint32_t v, std::size_t around, std::size_t number) {
      std::uint32_t* batch = group.faces.data() + start[around] + number / kBatch * kBatch * around + number % kBatch;
      for (std::size_t j = 0; j < around; ++j) batch[j * kBatch] = mesh.incident[first[v] + j];
    };
    std::array<std::uint32_t, kMostAround + 1> latest{};
    for (std::uint32_t v = begin; v < end; ++v) {
      const std::size_t around = first[v + 1] - first[v];
      if (around < 2 || around > kMostAround) continue;
      take(v, around, put[around]++);
      latest[around] = v;
    }
    for (std::size_t k = 2; k <= kMostAround; ++k)
      while (put[k] % kBatch != 0) take(latest[k], k, put[k]++);
  });
  return groups;
}
}  // namespace

Result<void> filter_face_normals(const QuadMesh& mesh, const NormalFilterOptions& options,
                                 std::vector<glm::vec4>& faces, Progress& progress) {
  DUBSAR_CHECK(faces.size() == mesh.quads.size() && options.median_steps == 1);
  if (faces.empty()) return {};
  const std::vector<VertexGroup> groups = group_vertices(mesh);
  const ScatterBlocks blocks = vertex_groups_of_quads(mesh);
  ScatterMemory memory(4 * static_cast<std::size_t>(kScatterBlock + 1));
  auto next = large_array<std::vector<glm::vec4>>(faces.size());
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    parallel_for(static_cast<std::int64_t>(blocks.size()), 1, [&](std::int64_t b) {
      if (progress.cancelled()) return;
      auto sums = memory.take();
      const std::int64_t first = b * kScatterBlock;
      const MedianBlock block{&mesh,
                              &faces.front().x,
                              sums->data(),
                              static_cast<std::uint32_t>(first),
                              static_cast<std::uint32_t>(std::min(kScatterBlock, mesh.quad_count() - first)),
                              options.epsilon};
      HWY_DYNAMIC_DISPATCH(begin_block)(block);
      for (const std::uint32_t group : blocks[static_cast<std::size_t>(b)])
        HWY_DYNAMIC_DISPATCH(pull_group)(block, groups[group]);
      HWY_DYNAMIC_DISPATCH(end_block)(block, &next.front().x);
      memory.give_back(std::move(sums));
      progress.advance(block.size);
    });
    if (progress.cancelled()) return cancelled_error();
    faces.swap(next);
  }
  return {};
}

}  // namespace dubsar
#endif
