#include "core/relief/smoothing/normal_filter.h"

#include <algorithm>

#include "core/base/system/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/relief/smoothing/normal_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/relief/curvature/row_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, FaceNeighbours::kLanes>;
using V = hn::Vec<D>;

using Lanes4 = RowLanes<V>;

/// Products and sums are kept apart (no fused multiply-add), so that all SIMD targets give the same bits.
HWY_INLINE V dot(const V ax, const V ay, const V az, const V bx, const V by, const V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

constexpr std::uint32_t kMaxKept = 24;  ///< neighbours kept in registers and cache between the median steps

void filter_slice(const FaceNeighbours::Chunk& chunk, std::size_t slice, std::size_t lane, const float* from, float* to,
                  const NormalFilterOptions& options) {
  const D d;
  const std::size_t width = hn::Lanes(d);
  const std::uint32_t rows = chunk.first_row[slice + 1] - chunk.first_row[slice];
  const std::uint32_t* entries =
      chunk.entries.data() + std::size_t{chunk.first_row[slice]} * FaceNeighbours::kLanes + lane;
  const std::uint32_t* order = chunk.order.data() + slice * FaceNeighbours::kLanes + lane;
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;

  const Lanes4 self = load_rows(d, [&](std::size_t l) HWY_ATTR { return from + std::size_t{order[l]} * 4; });

  const auto load_row = [&](std::uint32_t j) HWY_ATTR {
    const std::uint32_t* row = entries + std::size_t{j} * FaceNeighbours::kLanes;
    Lanes4 n = load_rows(
        d, [&](std::size_t l) HWY_ATTR { return from + std::size_t{row[l] & FaceNeighbours::kIndexMask} * 4; });
    const auto shared = hn::ShiftRight<FaceNeighbours::kIndexBits>(hn::LoadU(du, row));
    n.w = hn::Mul(n.w, hn::ConvertTo(d, hn::BitCast(di, shared)));
    return n;
  };
  Lanes4 kept[kMaxKept];
  const std::uint32_t kept_rows = std::min(rows, kMaxKept);
  for (std::uint32_t j = 0; j < kept_rows; ++j) kept[j] = load_row(j);

  const V two = hn::Set(d, 2.0f), epsilon = hn::Set(d, options.epsilon), zero = hn::Zero(d);
  const V self_weight = hn::Mul(self.w, two);
  V mx = self.x, my = self.y, mz = self.z;
  for (int step = 0; step < options.median_steps; ++step) {
    V sx = zero, sy = zero, sz = zero;
    const auto add = [&](const V nx, const V ny, const V nz, const V weight) HWY_ATTR {
      const V dx = hn::Sub(nx, mx), dy = hn::Sub(ny, my), dz = hn::Sub(nz, mz);
      const V pull = hn::Div(weight, hn::Add(hn::Sqrt(dot(dx, dy, dz, dx, dy, dz)), epsilon));
      sx = hn::Add(sx, hn::Mul(pull, nx));
      sy = hn::Add(sy, hn::Mul(pull, ny));
      sz = hn::Add(sz, hn::Mul(pull, nz));
    };
    add(self.x, self.y, self.z, self_weight);
    for (std::uint32_t j = 0; j < kept_rows; ++j) add(kept[j].x, kept[j].y, kept[j].z, kept[j].w);
    for (std::uint32_t j = kMaxKept; j < rows; ++j) {
      const Lanes4 n = load_row(j);
      add(n.x, n.y, n.z, n.w);
    }
    const V length2 = dot(sx, sy, sz, sx, sy, sz);
    const auto valid = hn::Gt(length2, hn::Set(d, 1e-30f));  // normals that cancel leave m as it is
    const V scale = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(length2));
    mx = hn::IfThenElse(valid, hn::Mul(sx, scale), mx);
    my = hn::IfThenElse(valid, hn::Mul(sy, scale), my);
    mz = hn::IfThenElse(valid, hn::Mul(sz, scale), mz);
  }
  HWY_ALIGN float out[4 * FaceNeighbours::kLanes];
  hn::StoreInterleaved4(mx, my, mz, self.w, d, out);
  const std::size_t first = slice * FaceNeighbours::kLanes + lane;
  for (std::size_t l = 0; l < width && first + l < static_cast<std::size_t>(chunk.faces); ++l)
    std::copy_n(out + 4 * l, 4, to + std::size_t{order[l]} * 4);
}

}  // namespace

void filter_chunk(const FaceNeighbours::Chunk& chunk, const float* from, float* to,
                  const NormalFilterOptions& options) {
  for (std::size_t slice = 0; slice * FaceNeighbours::kLanes < static_cast<std::size_t>(chunk.faces); ++slice)
    for (std::size_t lane = 0; lane < FaceNeighbours::kLanes; lane += hn::Lanes(D()))
      filter_slice(chunk, slice, lane, from, to, options);
}

}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
HWY_EXPORT(filter_chunk);

Result<void> filter_normals(const FaceNeighbours& neighbours, const NormalFilterOptions& options,
                            std::vector<glm::vec4>& faces, Progress& progress) {
  DUBSAR_CHECK(static_cast<std::int64_t>(faces.size()) == neighbours.face_count());
  static_assert(sizeof(glm::vec4) == 4 * sizeof(float));
  if (faces.empty()) return {};
  std::vector<glm::vec4> next(faces.size());
  const auto& chunks = neighbours.chunks();
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    parallel_chunks(static_cast<std::int64_t>(chunks.size()), 16, [&](std::int64_t begin, std::int64_t end) {
      if (progress.cancelled()) return;
      std::int64_t done = 0;
      for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
        HWY_DYNAMIC_DISPATCH(filter_chunk)(chunks[c], &faces.front().x, &next.front().x, options);
        done += chunks[c].faces;
      }
      progress.advance(done);
    });
    if (progress.cancelled()) return cancelled_error();
    faces.swap(next);
  }
  return {};
}

}  // namespace dubsar
#endif
