#include "core/relief/smoothing/quad_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/relief/smoothing/corner_weights.h"
#include "core/relief/smoothing/scatter_blocks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/relief/smoothing/quad_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/relief/curvature/row_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace dubsar::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kBatch = 16;
using D = hn::CappedTag<float, kBatch>;
using V = hn::Vec<D>;
typedef float Float4 __attribute__((vector_size(16), aligned(4), may_alias));

// Products and sums are kept apart (no fused multiply-add), so that all SIMD targets give the same bits.
struct Vec3 {
  V x, y, z;
};
HWY_INLINE Vec3 minus(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3 times(const Vec3& a, const V s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
HWY_INLINE V dot(const Vec3& a, const Vec3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}

/// Up to 16 x-quads from `first` on.
struct Batch {
  const QuadMesh* mesh;
  std::uint32_t first;
  std::size_t count;
  std::uint32_t doubled;  ///< one bit each

  Batch(const QuadMesh& of, std::int64_t begin, std::int64_t end)
      : mesh(&of),
        first(static_cast<std::uint32_t>(begin)),
        count(static_cast<std::size_t>(std::min<std::int64_t>(kBatch, end - begin))),
        doubled(static_cast<std::uint32_t>(of.doubled_bits[first >> 6] >> (first & 63)) & 0xFFFFu) {}
  const std::uint32_t* ids() const { return mesh->quads[first].data(); }
  /// Can rows of three floats be read as four? Not those of the last vertex.
  bool plain() const {
    const auto last = static_cast<std::uint32_t>(mesh->positions.size() - 1);
    if (doubled != 0 || count != kBatch) return false;
    const std::uint32_t* id = ids();
    bool found = false;
    for (std::size_t i = 0; i < 4 * kBatch; ++i) found |= id[i] == last;
    return !found;
  }
};

/// Corner c of x-quad l, from an array with three floats a vertex.
struct PlainRows {
  const float* from;
  const std::uint32_t* ids;
  HWY_INLINE const float* operator()(std::size_t c, std::size_t l) const {
    return from + 3 * std::size_t{ids[4 * l + c]};
  }
};
/// The same for any batch: copies, the mean of both vertices at a doubled corner, the last x-quad again behind the end.
struct CopiedRows {
  float rows[4][kBatch][4];
  CopiedRows(const Batch& batch, const float* from) {
    for (std::size_t l = 0; l < kBatch; ++l) {
      const auto quad = batch.first + static_cast<std::uint32_t>(std::min(l, batch.count - 1));
      const Polygon polygon = batch.mesh->polygon(quad);
      for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i) {
        const float* row = from + 3 * std::size_t{polygon.vertex[i]};
        const bool second = i > 0 && polygon.corner[i] == polygon.corner[i - 1];
        float* to = rows[polygon.corner[i]][l];
        for (std::size_t a = 0; a < 3; ++a) to[a] = second ? 0.5f * (to[a] + row[a]) : row[a];
        to[3] = 0.0f;
      }
    }
  }
  HWY_INLINE const float* operator()(std::size_t c, std::size_t l) const { return rows[c][l]; }
};

template <class Rows>
HWY_INLINE Vec3 corner(const Rows& rows, std::size_t c, std::size_t lane) {
  const auto r = load_rows(D(), [&](std::size_t l) HWY_ATTR { return rows(c, lane + l); });
  return {r.x, r.y, r.z};
}

template <class Rows>
void normals_of(const Rows& p, float* faces) {
  const D d;
  for (std::size_t lane = 0; lane < kBatch; lane += hn::Lanes(d)) {
    const Vec3 twice =
        cross(minus(corner(p, 2, lane), corner(p, 0, lane)), minus(corner(p, 3, lane), corner(p, 1, lane)));
    const Vec3 c = times(twice, hn::Set(d, 0.5f));
    const V area = hn::Sqrt(dot(c, c));
    const auto valid = hn::Gt(area, hn::Set(d, 1e-12f));
    const Vec3 n{hn::IfThenElseZero(valid, hn::Div(c.x, area)), hn::IfThenElseZero(valid, hn::Div(c.y, area)),
                 hn::IfThenElseZero(valid, hn::Div(c.z, area))};
    hn::StoreInterleaved4(n.x, n.y, n.z, hn::IfThenElseZero(valid, area), d, faces + 4 * lane);
  }
}

/// Newell's for polygons of any size.
void polygon_normal(const QuadMesh& mesh, std::uint32_t quad, float* face) {
  const Polygon polygon = mesh.polygon(quad);
  const glm::vec3 origin = mesh.positions[polygon.vertex[0]];
  glm::vec3 sum{0.0f}, before{0.0f};
  for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i) {
    const glm::vec3 p = mesh.positions[polygon.vertex[i]] - origin;
    sum += glm::vec3(before.y * p.z - p.y * before.z, before.z * p.x - p.z * before.x, before.x * p.y - p.x * before.y);
    before = p;
  }
  sum *= 0.5f;
  const float area = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  for (int a = 0; a < 3; ++a) face[a] = area > 1e-12f ? sum[a] / area : 0.0f;
  face[3] = area > 1e-12f ? area : 0.0f;
}

void fill_normals(const QuadMesh& mesh, std::int64_t begin, std::int64_t end, float* faces) {
  const float* positions = &mesh.positions[0].x;
  for (std::int64_t q = begin; q < end; q += static_cast<std::int64_t>(kBatch)) {
    const Batch batch(mesh, q, end);
    float* to = faces + 4 * q;
    if (batch.plain()) {
      normals_of(PlainRows{positions, batch.ids()}, to);
      continue;
    }
    HWY_ALIGN float rows[kBatch * 4];
    normals_of(CopiedRows(batch, positions), rows);
    std::memcpy(to, rows, batch.count * 4 * sizeof(float));
    for (std::uint32_t rest = batch.doubled; rest != 0; rest &= rest - 1) {
      const auto l = static_cast<std::uint32_t>(__builtin_ctz(rest));
      polygon_normal(mesh, batch.first + l, to + 4 * std::size_t{l});
    }
  }
}

/// Rows of the vertices of a batch, in floats from the first of the block.
template <std::size_t kFloats>
HWY_INLINE void places_of(const VertexSums& sums, const Batch& batch, std::uint32_t* places) {
  const std::uint32_t* ids = batch.ids();
  const std::uint32_t first = sums.first, size = sums.size;
  for (std::size_t i = 0; i < 4 * batch.count; ++i)
    places[i] = static_cast<std::uint32_t>(kFloats) * std::min(ids[i] - first, size);
}
HWY_INLINE void add_row(float* sum, const float* row) {
  *reinterpret_cast<Float4*>(sum) += *reinterpret_cast<const Float4*>(row);
}
template <std::size_t kFloats>
float* row_of(const VertexSums& sums, std::uint32_t vertex) {
  return sums.rows + kFloats * std::size_t{std::min(vertex - sums.first, sums.size)};
}

template <class Rows>
void weigh_corners(const Rows& p, const float* faces, float (*rows)[kBatch * 4]) {
  constexpr float kGuard = 1e-6f;  // as corner_weight()
  const D d;
  for (std::size_t lane = 0; lane < kBatch; lane += hn::Lanes(d)) {
    Vec3 n;
    V area;
    hn::LoadInterleaved4(d, faces + 4 * lane, n.x, n.y, n.z, area);
    const Vec3 at[4] = {corner(p, 0, lane), corner(p, 1, lane), corner(p, 2, lane), corner(p, 3, lane)};
    const Vec3 edge[4] = {minus(at[1], at[0]), minus(at[2], at[1]), minus(at[3], at[2]), minus(at[0], at[3])};
    const V length2[4] = {dot(edge[0], edge[0]), dot(edge[1], edge[1]), dot(edge[2], edge[2]), dot(edge[3], edge[3])};
#pragma GCC unroll 4
    for (std::size_t c = 0; c < 4; ++c) {
      const Vec3 normal = cross(edge[(c + 3) % 4], edge[c]);
      const V weight = hn::Div(hn::Sqrt(dot(normal, normal)),
                               hn::Add(hn::Mul(length2[c], length2[(c + 3) % 4]), hn::Set(d, kGuard)));
      const Vec3 row = times(n, weight);
      hn::StoreInterleaved4(row.x, row.y, row.z, hn::Zero(d), d, rows[c] + 4 * lane);
    }
  }
}

void corner_normals(const VertexSums& sums, std::uint32_t group) {
  const QuadMesh& mesh = *sums.mesh;
  const float* positions = &mesh.positions[0].x;
  const std::int64_t begin = std::int64_t{group} * kQuadGroup, end = std::min(begin + kQuadGroup, mesh.quad_count());
  for (std::int64_t q = begin; q < end; q += static_cast<std::int64_t>(kBatch)) {
    const Batch batch(mesh, q, end);
    HWY_ALIGN float rows[4][kBatch * 4];
    if (batch.plain()) {
      weigh_corners(PlainRows{positions, batch.ids()}, sums.faces + 4 * q, rows);
    } else {
      float faces[kBatch * 4] = {};
      std::memcpy(faces, sums.faces + 4 * q, batch.count * 4 * sizeof(float));
      weigh_corners(CopiedRows(batch, positions), faces, rows);
    }
    std::uint32_t places[4 * kBatch];
    places_of<kNormalFloats>(sums, batch, places);
    for (std::size_t l = 0; l < batch.count; ++l) {
      if ((batch.doubled >> l & 1u) == 0) {
#pragma GCC unroll 4
        for (std::size_t c = 0; c < 4; ++c) add_row(sums.rows + places[4 * l + c], rows[c] + 4 * l);
        continue;
      }
      const auto quad = batch.first + static_cast<std::uint32_t>(l);
      const Polygon polygon = mesh.polygon(quad);
      for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i) {
        const float weight = corner_weight(mesh, quad, polygon.vertex[i]);
        const float* n = sums.faces + 4 * std::size_t{quad};
        const float row[4] = {weight * n[0], weight * n[1], weight * n[2], 0.0f};
        add_row(row_of<kNormalFloats>(sums, polygon.vertex[i]), row);
      }
    }
  }
}

void unit_sums(const VertexSums& sums, float* normals) {
  const D d;
  normals += 3 * std::size_t{sums.first};
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= sums.size; i += hn::Lanes(d)) {
    Vec3 s;
    V rest;
    hn::LoadInterleaved4(d, sums.rows + 4 * i, s.x, s.y, s.z, rest);
    const V length = hn::Sqrt(dot(s, s));
    const auto valid = hn::Gt(length, hn::Set(d, 1e-12f));
    hn::StoreInterleaved3(hn::IfThenElseZero(valid, hn::Div(s.x, length)),
                          hn::IfThenElseZero(valid, hn::Div(s.y, length)),
                          hn::IfThenElse(valid, hn::Div(s.z, length), hn::Set(d, 1.0f)), d, normals + 3 * i);
  }
  for (; i < sums.size; ++i) {
    const float* s = sums.rows + 4 * i;
    const float length = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    for (std::size_t a = 0; a < 3; ++a) normals[3 * i + a] = length > 1e-12f ? s[a] / length : a == 2 ? 1.0f : 0.0f;
  }
}

template <class Rows>
void moments_of(const Rows& p, const Rows& n, float (*rows)[kBatch * 4]) {
  const D d;
  const V half = hn::Set(d, 0.5f);
  for (std::size_t lane = 0; lane < kBatch; lane += hn::Lanes(d)) {
    const Vec3 u = minus(corner(p, 2, lane), corner(p, 0, lane)), v = minus(corner(p, 3, lane), corner(p, 1, lane));
    const Vec3 a = minus(corner(n, 2, lane), corner(n, 0, lane)), b = minus(corner(n, 3, lane), corner(n, 1, lane));
    const auto both = [](V s, V t, V x, V y) HWY_ATTR { return hn::Add(hn::Mul(s, t), hn::Mul(x, y)); };
    const auto mixed = [&](V ux, V ay, V uy, V ax, V vx, V by, V vy, V bx)
                           HWY_ATTR { return hn::Mul(half, hn::Add(both(ux, ay, uy, ax), both(vx, by, vy, bx))); };
    hn::StoreInterleaved4(both(u.x, u.x, v.x, v.x), both(u.y, u.y, v.y, v.y), both(u.z, u.z, v.z, v.z),
                          both(u.x, u.y, v.x, v.y), d, rows[0] + 4 * lane);
    hn::StoreInterleaved4(both(u.x, u.z, v.x, v.z), both(u.y, u.z, v.y, v.z), both(u.x, a.x, v.x, b.x),
                          both(u.y, a.y, v.y, b.y), d, rows[1] + 4 * lane);
    hn::StoreInterleaved4(both(u.z, a.z, v.z, b.z), mixed(u.x, a.y, u.y, a.x, v.x, b.y, v.y, b.x),
                          mixed(u.x, a.z, u.z, a.x, v.x, b.z, v.z, b.x), mixed(u.y, a.z, u.z, a.y, v.y, b.z, v.z, b.y),
                          d, rows[2] + 4 * lane);
  }
}

void fit_moments(const VertexSums& sums, std::uint32_t group) {
  const QuadMesh& mesh = *sums.mesh;
  const float* positions = &mesh.positions[0].x;
  const std::int64_t begin = std::int64_t{group} * kQuadGroup, end = std::min(begin + kQuadGroup, mesh.quad_count());
  for (std::int64_t q = begin; q < end; q += static_cast<std::int64_t>(kBatch)) {
    const Batch batch(mesh, q, end);
    HWY_ALIGN float rows[3][kBatch * 4];
    if (batch.plain())
      moments_of(PlainRows{positions, batch.ids()}, PlainRows{sums.normals, batch.ids()}, rows);
    else
      moments_of(CopiedRows(batch, positions), CopiedRows(batch, sums.normals), rows);
    std::uint32_t places[4 * kBatch];
    places_of<kFitFloats>(sums, batch, places);
    const auto add = [&](float* sum, std::size_t l) HWY_ATTR {
      for (std::size_t r = 0; r < 3; ++r) add_row(sum + 4 * r, rows[r] + 4 * l);
    };
    for (std::size_t l = 0; l < batch.count; ++l) {
      if ((batch.doubled >> l & 1u) == 0) {
#pragma GCC unroll 4
        for (std::size_t c = 0; c < 4; ++c) add(sums.rows + places[4 * l + c], l);
        continue;
      }
      const Polygon polygon = mesh.polygon(batch.first + static_cast<std::uint32_t>(l));
      for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i)
        add(row_of<kFitFloats>(sums, polygon.vertex[i]), l);
    }
  }
}

/// [a b; b c] with the least error, its eigenvalues; of vertices [i, i + lanes).
HWY_INLINE void fit_lanes(const float* rows, const float* normals, float* k_min, float* k_max) {
  const D d;
  const auto r0 = load_rows(d, [&](std::size_t l) HWY_ATTR { return rows + kFitFloats * l; });
  const auto r1 = load_rows(d, [&](std::size_t l) HWY_ATTR { return rows + kFitFloats * l + 4; });
  const auto r2 = load_rows(d, [&](std::size_t l) HWY_ATTR { return rows + kFitFloats * l + 8; });
  Vec3 n;
  hn::LoadInterleaved3(d, normals, n.x, n.y, n.z);
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  // Tangent frame without branches (Duff et al. 2017).
  const V sign = hn::CopySign(one, n.z), s = hn::Div(hn::Neg(one), hn::Add(sign, n.z)),
          q = hn::Mul(hn::Mul(n.x, n.y), s);
  const Vec3 e0{hn::Add(one, hn::Mul(hn::Mul(hn::Mul(sign, n.x), n.x), s)), hn::Mul(sign, q),
                hn::Neg(hn::Mul(sign, n.x))};
  const Vec3 e1{q, hn::Add(sign, hn::Mul(hn::Mul(n.y, n.y), s)), hn::Neg(n.y)};
  const auto image = [](V xx, V yy, V zz, V xy, V xz, V yz, const Vec3& e) HWY_ATTR {
    return Vec3{hn::Add(hn::Add(hn::Mul(xx, e.x), hn::Mul(xy, e.y)), hn::Mul(xz, e.z)),
                hn::Add(hn::Add(hn::Mul(xy, e.x), hn::Mul(yy, e.y)), hn::Mul(yz, e.z)),
                hn::Add(hn::Add(hn::Mul(xz, e.x), hn::Mul(yz, e.y)), hn::Mul(zz, e.z))};
  };
  const Vec3 u0 = image(r0.x, r0.y, r0.z, r0.w, r1.x, r1.y, e0), u1 = image(r0.x, r0.y, r0.z, r0.w, r1.x, r1.y, e1);
  const Vec3 d0 = image(r1.z, r1.w, r2.x, r2.y, r2.z, r2.w, e0), d1 = image(r1.z, r1.w, r2.x, r2.y, r2.z, r2.w, e1);
  const V uu0 = dot(e0, u0), vv0 = dot(e1, u1), uv = dot(e0, u1);
  const V x = dot(e0, d0), z = dot(e1, d1), y = hn::Mul(hn::Set(d, 2.0f), dot(e0, d1));
  // The small ridge keeps collinear differences solvable (S is then 0 across them); relative error 1e-5.
  const V ridge = hn::Mul(hn::Set(d, 1e-5f), hn::Add(uu0, vv0));
  const auto valid = hn::Gt(ridge, zero);
  const V uu = hn::IfThenElse(valid, hn::Add(uu0, ridge), one), vv = hn::IfThenElse(valid, hn::Add(vv0, ridge), one);
  const V b = hn::Div(hn::Sub(y, hn::Mul(uv, hn::Add(hn::Div(x, uu), hn::Div(z, vv)))),
                      hn::Mul(hn::Add(uu, vv), hn::Sub(one, hn::Div(hn::Mul(uv, uv), hn::Mul(uu, vv)))));
  const V a = hn::Div(hn::Sub(x, hn::Mul(b, uv)), uu), c = hn::Div(hn::Sub(z, hn::Mul(b, uv)), vv);
  const V half = hn::Set(d, 0.5f), mean = hn::Mul(half, hn::Add(a, c)), apart = hn::Mul(half, hn::Sub(a, c));
  const V off = hn::Sqrt(hn::Add(hn::Mul(apart, apart), hn::Mul(b, b)));
  hn::StoreU(hn::IfThenElseZero(valid, hn::Sub(mean, off)), d, k_min);
  hn::StoreU(hn::IfThenElseZero(valid, hn::Add(mean, off)), d, k_max);
}

void fit_sums(const VertexSums& sums, float* k_min, float* k_max) {
  const std::size_t lanes = hn::Lanes(D());
  const float* normals = sums.normals + 3 * std::size_t{sums.first};
  std::size_t i = 0;
  for (; i + lanes <= sums.size; i += lanes)
    fit_lanes(sums.rows + kFitFloats * i, normals + 3 * i, k_min + sums.first + i, k_max + sums.first + i);
  if (i == sums.size) return;
  HWY_ALIGN float rows[kFitFloats * kBatch] = {}, last[3 * kBatch] = {}, low[kBatch], high[kBatch];
  const std::size_t rest = sums.size - i;
  std::memcpy(rows, sums.rows + kFitFloats * i, kFitFloats * rest * sizeof(float));
  std::memcpy(last, normals + 3 * i, 3 * rest * sizeof(float));
  fit_lanes(rows, last, low, high);
  std::memcpy(k_min + sums.first + i, low, rest * sizeof(float));
  std::memcpy(k_max + sums.first + i, high, rest * sizeof(float));
}

}  // namespace
}  // namespace dubsar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(fill_normals);
HWY_EXPORT(corner_normals);
HWY_EXPORT(unit_sums);
HWY_EXPORT(fit_moments);
HWY_EXPORT(fit_sums);
}  // namespace

void quad_normals(const QuadMesh& mesh, std::int64_t begin, std::int64_t end, glm::vec4* faces) {
  HWY_DYNAMIC_DISPATCH(fill_normals)(mesh, begin, end, &faces->x);
}
void add_corner_normals(const VertexSums& sums, std::uint32_t group) {
  HWY_DYNAMIC_DISPATCH(corner_normals)(sums, group);
}
void finish_normals(const VertexSums& sums, glm::vec3* normals) { HWY_DYNAMIC_DISPATCH(unit_sums)(sums, &normals->x); }
void add_fit_moments(const VertexSums& sums, std::uint32_t group) { HWY_DYNAMIC_DISPATCH(fit_moments)(sums, group); }
void finish_fit(const VertexSums& sums, float* k_min, float* k_max) {
  HWY_DYNAMIC_DISPATCH(fit_sums)(sums, k_min, k_max);
}
}  // namespace dubsar
#endif
