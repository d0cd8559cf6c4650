#include "core/relief/smoothing/face_median.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/relief/smoothing/quads_around.h"
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
constexpr std::size_t kBatch = AroundGroup::kVertexBatch;

/// The faces [first, first + size) and where the sums of those that are open lie, four floats each: face i of the block
/// at i & mask; one more behind them takes what others would get.
struct MedianBlock {
  const QuadMesh* mesh;
  const float* faces;
  float* sums;
  std::uint32_t first, size, mask;
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
  const auto first = hn::Set(du, block.first), size = hn::Set(du, block.size), mask = hn::Set(du, block.mask),
             elsewhere = hn::Set(du, block.mask + 1);
  for (std::size_t lane = 0; lane < kBatch; lane += hn::Lanes(d)) {
    RowLanes<V> n[kAround];
    V sx[kAround], sy[kAround], sz[kAround];
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kAround; ++j) {
      const std::uint32_t* face = faces + j * kBatch + lane;
      n[j] = load_rows(d, [&](std::size_t l) HWY_ATTR { return from + 4 * std::size_t{face[l]}; });
      const auto place = hn::Sub(hn::LoadU(du, face), first);
      hn::Store(hn::IfThenElse(hn::Lt(place, size), hn::And(place, mask), elsewhere), du, places[j] + lane);
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
    const std::uint32_t place = to - block.first;
    add_row(block.sums + 4 * std::size_t{place < block.size ? place & block.mask : block.mask + 1}, row);
  }
}

template <std::size_t kAround>
const std::uint32_t* pull_run(const MedianBlock& block, const AroundGroup& group, const std::uint32_t* faces) {
  for (std::size_t i = 0; i < group.vertices[kAround]; i += kBatch, faces += kAround * kBatch)
    pull_batch<kAround>(block, faces, std::min<std::size_t>(kBatch, group.vertices[kAround] - i));
  return faces;
}

void pull_group(const MedianBlock& block, const AroundGroup& group, const std::uint32_t* quads) {
  const std::uint32_t* faces = quads + group.begin;
  faces = pull_run<2>(block, group, faces);
  faces = pull_run<3>(block, group, faces);
  faces = pull_run<4>(block, group, faces);
  faces = pull_run<5>(block, group, faces);
  faces = pull_run<6>(block, group, faces);
  faces = pull_run<7>(block, group, faces);
  pull_run<8>(block, group, faces);
  for (const std::uint32_t vertex : group.others) pull_many(block, vertex);
}

/// Calls work(i, sums, count) for faces [begin, end) of the block, whose rows of sums follow one another.
template <class Work>
HWY_INLINE void for_rows(const MedianBlock& block, std::uint32_t begin, std::uint32_t end, const Work& work) {
  while (begin < end) {
    const std::uint32_t row = begin & block.mask, count = std::min(end - begin, block.mask + 1 - row);
    work(begin, block.sums + 4 * std::size_t{row}, std::size_t{count});
    begin += count;
  }
}

/// Each face pulls at itself with twice its area.
void open_faces(const MedianBlock& block, std::uint32_t begin, std::uint32_t end) {
  const D d;
  const V scale = hn::Div(hn::Set(d, 2.0f), hn::Set(d, block.epsilon));
  for_rows(block, begin, end, [&](std::uint32_t face, float* sums, std::size_t count) HWY_ATTR {
    const float* from = block.faces + 4 * (std::size_t{block.first} + face);
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
      V x, y, z, w;
      hn::LoadInterleaved4(d, from + 4 * i, x, y, z, w);
      const V pull = hn::Mul(w, scale);
      hn::StoreInterleaved4(hn::Mul(pull, x), hn::Mul(pull, y), hn::Mul(pull, z), hn::Zero(d), d, sums + 4 * i);
    }
    for (; i < count; ++i) {
      const float pull = from[4 * i + 3] * (2.0f / block.epsilon);
      for (std::size_t a = 0; a < 3; ++a) sums[4 * i + a] = pull * from[4 * i + a];
      sums[4 * i + 3] = 0.0f;
    }
  });
}

/// Normals that cancel leave the face as it is.
void close_faces(const MedianBlock& block, std::uint32_t begin, std::uint32_t end, float* faces) {
  const D d;
  for_rows(block, begin, end, [&](std::uint32_t face, const float* sums, std::size_t count) HWY_ATTR {
    const float* from = block.faces + 4 * (std::size_t{block.first} + face);
    float* to = faces + 4 * (std::size_t{block.first} + face);
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
      V x, y, z, w, mx, my, mz, area;
      hn::LoadInterleaved4(d, sums + 4 * i, x, y, z, w);
      hn::LoadInterleaved4(d, from + 4 * i, mx, my, mz, area);
      const V length2 = squared(x, y, z);
      const auto valid = hn::Gt(length2, hn::Set(d, 1e-30f));
      const V scale = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(length2));
      hn::StoreInterleaved4(hn::IfThenElse(valid, hn::Mul(x, scale), mx), hn::IfThenElse(valid, hn::Mul(y, scale), my),
                            hn::IfThenElse(valid, hn::Mul(z, scale), mz), area, d, to + 4 * i);
    }
    for (; i < count; ++i) {
      const float *s = sums + 4 * i, *m = from + 4 * i;
      const float length2 = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], scale = 1.0f / std::sqrt(length2);
      for (std::size_t a = 0; a < 3; ++a) to[4 * i + a] = length2 > 1e-30f ? s[a] * scale : m[a];
      to[4 * i + 3] = m[3];
    }
  });
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(pull_group);
HWY_EXPORT(open_faces);
HWY_EXPORT(close_faces);
constexpr std::int64_t kLargestBlock = 1 << 18;

/// How the sums of a block are walked through: before group i of the block its faces below open[i] have a sum, after it
/// those below close[i] get no more.
struct BlockWalk {
  std::uint32_t first = 0, size = 0, rows = 1;
  std::vector<std::uint32_t> groups, open, close;
  /// Of groups that touch other blocks, too, what touches this one; else nothing. A surface that is cut by the border
  /// of the volume has the faces of its caps behind all others: a block of them touches many groups, and little of
  /// each.
  std::vector<std::optional<AroundGroup>> parts;
  std::vector<std::uint32_t> part_quads;

  const AroundGroup& group(const QuadsAround& all, std::size_t i) const {
    return parts[i] ? *parts[i] : all.groups[groups[i]];
  }
  const std::uint32_t* quads(const QuadsAround& all, std::size_t i) const {
    return parts[i] ? part_quads.data() : all.quads.data();
  }
};

BlockWalk walk_of(const QuadMesh& mesh, std::vector<std::uint32_t> touching, const QuadsAround& all, std::int64_t first,
                  std::int64_t size) {
  BlockWalk walk;
  walk.first = static_cast<std::uint32_t>(first);
  walk.size = static_cast<std::uint32_t>(size);
  walk.groups = std::move(touching);
  const std::size_t count = walk.groups.size();
  walk.open.resize(count, walk.size);
  walk.close.resize(count, walk.size);
  walk.parts.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const IdRange& everywhere = all.groups[walk.groups[i]].touched;
    if (everywhere.low < walk.first || everywhere.high - walk.first >= walk.size)
      walk.parts[i] = group_within(mesh, walk.groups[i], walk.first, walk.size, walk.part_quads);
  }
  const auto touched = [&](std::size_t i) -> const IdRange& { return walk.group(all, i).touched; };
  std::uint32_t open = 0, close = walk.size;
  for (std::size_t i = count; i-- > 1;) {
    close = std::min(close, touched(i).low - walk.first);
    walk.close[i - 1] = close;
  }
  for (std::size_t i = 0; i < count; ++i) {
    open = walk.open[i] = std::max(open, touched(i).high - walk.first + 1);
    walk.rows = std::max(walk.rows, open - (i == 0 ? 0 : walk.close[i - 1]));
  }
  walk.rows = std::bit_ceil(walk.rows);
  return walk;
}

/// Blocks of faces: the larger, the fewer groups touch two; enough for all threads.
std::vector<BlockWalk> walks_of(const QuadMesh& mesh, const QuadsAround& all) {
  const std::int64_t size =
      std::clamp(mesh.quad_count() / (std::int64_t{4} * thread_count()), kScatterBlock, kLargestBlock);
  ScatterBlocks blocks = vertex_groups_of_quads(mesh, size);
  std::vector<BlockWalk> walks(blocks.size());
  parallel_for(static_cast<std::int64_t>(blocks.size()), 1, [&](std::int64_t b) {
    const auto block = static_cast<std::size_t>(b);
    const std::int64_t first = b * size;
    walks[block] = walk_of(mesh, std::move(blocks[block]), all, first, std::min(size, mesh.quad_count() - first));
  });
  return walks;
}

/// One pass over the faces of a block, each of which is near while it is open.
void walk_block(const BlockWalk& walk, const QuadsAround& all, const MedianBlock& block, float* to) {
  std::uint32_t opened = 0, closed = 0;
  for (std::size_t i = 0; i < walk.groups.size(); ++i) {
    HWY_DYNAMIC_DISPATCH(open_faces)(block, opened, walk.open[i]);
    opened = walk.open[i];
    HWY_DYNAMIC_DISPATCH(pull_group)(block, walk.group(all, i), walk.quads(all, i));
    if (i + 1 == walk.groups.size()) break;
    HWY_DYNAMIC_DISPATCH(close_faces)(block, closed, walk.close[i], to);
    closed = walk.close[i];
  }
  HWY_DYNAMIC_DISPATCH(open_faces)(block, opened, walk.size);
  HWY_DYNAMIC_DISPATCH(close_faces)(block, closed, walk.size, to);
}
}  // namespace

Result<void> filter_face_normals(const QuadMesh& mesh, const NormalFilterOptions& options, LargeArray<glm::vec4>& faces,
                                 Progress& progress) {
  DUBSAR_CHECK(faces.size() == mesh.quads.size() && options.median_steps == 1);
  if (faces.empty()) return {};
  const QuadsAround all(mesh);
  const std::vector<BlockWalk> walks = walks_of(mesh, all);
  std::uint32_t rows = 1;
  for (const BlockWalk& walk : walks) rows = std::max(rows, walk.rows);
  ScatterMemory memory(4 * (std::size_t{rows} + 1));
  LargeArray<glm::vec4> next(faces.size());
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    parallel_for(static_cast<std::int64_t>(walks.size()), 1, [&](std::int64_t b) {
      if (progress.cancelled()) return;
      const BlockWalk& walk = walks[static_cast<std::size_t>(b)];
      auto sums = memory.take();
      const MedianBlock block{&mesh,     &faces.data()->x, sums->data(),   walk.first,
                              walk.size, walk.rows - 1,    options.epsilon};
      walk_block(walk, all, block, &next.data()->x);
      memory.give_back(std::move(sums));
      progress.advance(block.size);
    });
    if (progress.cancelled()) return cancelled_error();
    std::swap(faces, next);
  }
  return {};
}

}  // namespace dubsar
#endif
