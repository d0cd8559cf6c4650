#include "core/relief/occlusion/march_kernels.h"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/relief/occlusion/march_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, MarchStart::kMost / 2>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

struct Point {
  V x, y, z;
};

HWY_INLINE V multiply_add(const V a, const V b, const V c) { return hn::Add(hn::Mul(a, b), c); }

/// A cell, its low corner, and the distances at its corners, in steps.
struct Cell {
  M there;  ///< else no surface passes it
  Point low;
  V f000, f100, f010, f110, f001, f101, f011, f111;

  HWY_INLINE Cell(const M surface, const Point& corner, const VI lower, const VI upper)
      : there(surface),
        low(corner),
        f000(byte<0>(lower)),
        f100(byte<8>(lower)),
        f010(byte<16>(lower)),
        f110(byte<24>(lower)),
        f001(byte<0>(upper)),
        f101(byte<8>(upper)),
        f011(byte<16>(upper)),
        f111(byte<24>(upper)) {}
  HWY_INLINE V at(const Point& p) const {
    const V x = share(p.x, low.x), y = share(p.y, low.y), z = share(p.z, low.z);
    const V near = mix(mix(f000, f100, x), mix(f010, f110, x), y);
    const V far = mix(mix(f001, f101, x), mix(f011, f111, x), y);
    return mix(near, far, z);
  }

 private:
  template <int kBit>
  HWY_INLINE static V byte(const VI word) {
    return hn::ConvertTo(D(), hn::ShiftRight<24>(hn::ShiftLeft<24 - kBit>(word)));
  }
  HWY_INLINE static V mix(const V a, const V b, const V t) { return multiply_add(hn::Sub(b, a), t, a); }
  HWY_INLINE static V share(const V p, const V from) {
    return hn::Min(hn::Max(hn::Sub(p, from), hn::Zero(D())), hn::Set(D(), 1.0f));
  }
};

/// What all rays share.
struct Field {
  Field(const SurfaceBricks& from, const Sky& directions, float radius_vox)
      : bricks(from), sky(directions), radius(radius_vox) {
    const glm::ivec3 blocks = (from.size * SurfaceBricks::kEdge) >> from.block_bits;
    lines = (blocks + SurfaceBricks::kEdge - 1) / SurfaceBricks::kEdge;
    edge = static_cast<float>(1 << from.block_bits);
  }
  const SurfaceBricks& bricks;
  const Sky& sky;
  float radius;
  glm::ivec3 lines;  ///< of 4^3 blocks
  float edge;        ///< of a block, in cells
};

/// One ray a lane, each of its own start; a lane takes its next ray when the last has ended.
class March {
 public:
  HWY_INLINE void begin(const Field& field, const MarchStart& start, std::size_t first) {
    const D d;
    const DI di;
    const V zero = hn::Zero(d);
    first_ = first;
    const glm::vec3 origin = field.bricks.origin;
    o_ = {hn::Sub(load(start.origin[0]), hn::Set(d, origin.x)), hn::Sub(load(start.origin[1]), hn::Set(d, origin.y)),
          hn::Sub(load(start.origin[2]), hn::Set(d, origin.z))};
    sum_ = weight_ = t_ = end_ = before_ = zero;
    dir_ = inverse_ = {zero, zero, zero};
    ray_ = hn::Set(di, -1);
    ended_ = hn::Set(di, -1);
    const M inside = in_grid(field, o_);
    const MI within = hn::RebindMask(di, inside);
    const auto cell = [&](const V v) HWY_ATTR { return hn::IfThenElseZero(within, hn::ConvertTo(DI(), v)); };
    const Cell corner = cells_of(field, within, cell(o_.x), cell(o_.y), cell(o_.z));
    own_ = hn::IfThenElse(corner.there, corner.at(o_), hn::Set(d, kOpen));
    lost_ = hn::Not(vec(corner.there));
    // A start beyond the grid has no surface anywhere near.
    left_ = hn::IfThenElseZero(within, hn::Set(di, static_cast<int>(field.sky.count)));
  }

  /// False when all rays have ended.
  HWY_INLINE bool step(const Field& field, const MarchStart& start) {
    const D d;
    const DI di;
    // Lanes whose ray has ended take their next one; seldom enough that it does not cost much.
    if (hn::CountTrue(di, mask(ended_)) * 4 >= hn::Lanes(d) && !next_rays(field, start)) return false;
    const V inside = hn::Add(t_, hn::Set(d, kStep));
    const Point p = at(inside);
    const int bits = field.bricks.block_bits;
    const MI ended = mask(ended_);
    const VI cx = hn::ConvertTo(di, p.x), cy = hn::ConvertTo(di, p.y), cz = hn::ConvertTo(di, p.z);
    const VI bx = hn::ShiftRightSame(cx, bits), by = hn::ShiftRightSame(cy, bits), bz = hn::ShiftRightSame(cz, bits);
    const VI index = hn::Add(hn::ShiftLeft<6>(brick_of(field.lines, bx, by, bz)), place_of(bx, by, bz));
    const VI word = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(field.bricks.away.data()),
                                     hn::IfThenZeroElse(ended, index));
    const VI away = hn::And(word, hn::Set(di, 0xff));
    const MI surface = hn::AndNot(ended, hn::Eq(away, hn::Zero(di)));
    const M here = hn::RebindMask(d, surface), live = hn::Not(hn::RebindMask(d, ended));

    // The cube without surface around the block, or the cell: middle and half its edge.
    const V edge = hn::Set(d, field.edge), half_block = hn::Set(d, 0.5f * field.edge), half = hn::Set(d, 0.5f);
    const V reach = hn::IfThenElse(here, half, hn::Sub(hn::Mul(hn::ConvertTo(d, away), edge), half_block));
    const auto exit_of = [&](const VI c, const VI b, const V o, const V inverse) HWY_ATTR {
      const V middle = hn::IfThenElse(here, hn::Add(hn::ConvertTo(d, c), half),
                                      hn::Add(hn::Mul(hn::ConvertTo(d, b), edge), half_block));
      return hn::Add(hn::Mul(hn::Sub(middle, o), inverse), hn::Mul(reach, hn::Abs(inverse)));
    };
    const V exit = hn::Min(exit_of(cx, bx, o_.x, inverse_.x),
                           hn::Min(exit_of(cy, by, o_.y, inverse_.y), exit_of(cz, bz, o_.z, inverse_.z)));
    const V next = hn::Max(exit, inside);
    // Where the start has not come out of the surface within a voxel it is inside: dark.
    const M above = hn::Ge(before_, hn::Zero(d));
    M stop = hn::And(live, hn::AndNot(above, hn::Gt(t_, hn::Set(d, 1.0f))));
    V met = hn::Zero(d), after = hn::IfThenElse(above, hn::Set(d, kOpen), before_);
    if (!hn::AllFalse(di, surface)) {
      const Cell corner = cells_of(field, surface, cx, cy, cz);
      const V f1 = corner.at(at(next));
      const M from_air = hn::And(corner.there, hn::Eq(before_, hn::Set(d, kOpen)));
      // Seldom told from behind: what starts at the surface comes from outside, about half a voxel before it.
      V f0 = hn::IfThenElse(from_air, hn::Set(d, 0.5f * SurfaceBricks::kSteps), before_);
      if (const M lost = hn::And(from_air, maskf(lost_)); !hn::AllFalse(d, lost)) {
        const V found = corner.at(at(t_));
        stop = hn::Or(stop, hn::And(lost, hn::Lt(found, hn::Set(d, kBehind))));
        f0 = hn::IfThenElse(lost, hn::Max(found, hn::Zero(d)), f0);
      }
      const M front = hn::AndNot(stop, hn::And(hn::And(corner.there, above), hn::Lt(f1, hn::Zero(d))));
      const V share = hn::Div(f0, hn::Max(hn::Sub(f0, f1), hn::Set(d, 1e-6f)));
      met = hn::IfThenElseZero(front, multiply_add(hn::Sub(next, t_), hn::Min(share, hn::Set(d, 1.0f)), t_));
      stop = hn::Or(stop, front);
      after = hn::IfThenElse(corner.there, f1, after);
    }
    const V near = hn::Max(hn::Sub(hn::Set(d, 1.0f), hn::Mul(met, hn::Set(d, 1.0f / field.radius))), hn::Zero(d));
    sum_ = hn::Add(sum_, hn::IfThenElseZero(stop, hn::Mul(weight_, near)));
    before_ = after;
    t_ = next;
    ended_ = hn::Or(ended_, vec(hn::Or(stop, hn::Ge(next, end_))));
    return true;
  }

  HWY_INLINE void store(float* taken) const { hn::StoreU(sum_, D(), taken + first_); }

 private:
  static constexpr float kStep = 1e-3f;                              // voxels, into the next cell
  static constexpr float kOpen = 4096.0f;                            // in place of a distance where no surface is near
  static constexpr float kBehind = -0.125f * SurfaceBricks::kSteps;  // met from behind: more than cells may differ by

  using MI = hn::Mask<DI>;
  HWY_INLINE static MI mask(const VI v) { return hn::MaskFromVec(v); }
  HWY_INLINE static M maskf(const VI v) { return hn::RebindMask(D(), hn::MaskFromVec(v)); }
  HWY_INLINE static VI vec(const M m) { return hn::VecFromMask(DI(), hn::RebindMask(DI(), m)); }

  HWY_INLINE V load(const MarchStart::Values& values) const { return hn::LoadU(D(), values.data() + first_); }
  HWY_INLINE Point turn(const MarchStart& start, const V x, const V y, const V z) const {
    const auto& f = start.frame;
    return {multiply_add(load(f[0]), x, multiply_add(load(f[3]), y, hn::Mul(load(f[6]), z))),
            multiply_add(load(f[1]), x, multiply_add(load(f[4]), y, hn::Mul(load(f[7]), z))),
            multiply_add(load(f[2]), x, multiply_add(load(f[5]), y, hn::Mul(load(f[8]), z)))};
  }
  /// Large instead of infinite where the ray does not move.
  HWY_INLINE static V reciprocal(const V v) {
    const D d;
    return hn::Div(hn::Set(d, 1.0f), hn::CopySign(hn::Max(hn::Abs(v), hn::Set(d, 1e-9f)), v));
  }
  HWY_INLINE Point at(const V t) const {
    return {multiply_add(dir_.x, t, o_.x), multiply_add(dir_.y, t, o_.y), multiply_add(dir_.z, t, o_.z)};
  }
  HWY_INLINE static V limit(int bricks) {
    return hn::Set(D(), static_cast<float>(bricks * SurfaceBricks::kEdge) - 0.01f);
  }
  HWY_INLINE static M in_grid(const Field& field, const Point& p) {
    const glm::ivec3 size = field.bricks.size;
    const M low = hn::Ge(hn::Min(p.x, hn::Min(p.y, p.z)), hn::Set(D(), 0.01f));
    return hn::And(
        low, hn::And(hn::Lt(p.x, limit(size.x)), hn::And(hn::Lt(p.y, limit(size.y)), hn::Lt(p.z, limit(size.z)))));
  }

  static_assert(SurfaceBricks::kEdge == 4);
  HWY_INLINE static VI brick_of(glm::ivec3 size, const VI x, const VI y, const VI z) {
    const DI di;
    return hn::Add(
        hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<2>(z), hn::Set(di, size.y)), hn::ShiftRight<2>(y)), hn::Set(di, size.x)),
        hn::ShiftRight<2>(x));
  }
  HWY_INLINE static VI place_of(const VI x, const VI y, const VI z) {
    const VI three = hn::Set(DI(), 3);
    return hn::Or(hn::And(x, three), hn::Or(hn::ShiftLeft<2>(hn::And(y, three)), hn::ShiftLeft<4>(hn::And(z, three))));
  }

  /// The corners of cells, where `wanted` and where surface is.
  HWY_INLINE static Cell cells_of(const Field& field, const MI wanted, const VI cx, const VI cy, const VI cz) {
    const D d;
    const DI di;
    constexpr std::size_t kMost = MarchStart::kMost / 2;
    alignas(64) std::int32_t brick[kMost], place[kMost], low[kMost] = {}, high[kMost] = {}, there[kMost] = {};
    const SurfaceBricks& bricks = field.bricks;
    hn::Store(brick_of(bricks.size, cx, cy, cz), di, brick);
    hn::Store(place_of(cx, cy, cz), di, place);
    // Few lanes want one: by hand this is faster than gathers of all.
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(di, wanted, bytes);
    std::uint32_t bits = bytes[0] | std::uint32_t{bytes[1]} << 8;
    for (; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(bits));
      const std::int32_t at = bricks.table[static_cast<std::size_t>(brick[i])];
      if (at < 0) continue;
      const SurfaceBricks::Brick& found = bricks.bricks[static_cast<std::size_t>(at)];
      const std::uint8_t cell = found.cells[static_cast<std::size_t>(place[i])];
      if (cell == SurfaceBricks::kNone) continue;
      const std::int8_t* corners = bricks.corners[std::size_t{found.first_cell} + cell].data();
      std::memcpy(&low[i], corners, 4);
      std::memcpy(&high[i], corners + 4, 4);
      there[i] = -1;
    }
    return {maskf(hn::Load(di, there)),
            {hn::ConvertTo(d, cx), hn::ConvertTo(d, cy), hn::ConvertTo(d, cz)},
            hn::Load(di, low),
            hn::Load(di, high)};
  }

  /// Gives ended lanes their next ray; false: none has one.
  HWY_INLINE bool next_rays(const Field& field, const MarchStart& start) {
    const D d;
    const DI di;
    const MI ended = mask(ended_);
    const M fresh = hn::RebindMask(d, ended);
    ray_ = hn::IfThenElse(ended, hn::Add(ray_, hn::Set(di, 1)), ray_);
    const auto more = hn::Gt(left_, ray_);
    if (hn::AllFalse(di, more)) return false;
    const VI index = hn::Min(ray_, hn::Set(di, static_cast<int>(field.sky.count) - 1));
    const Point turned = turn(start, hn::GatherIndex(d, field.sky.x, index), hn::GatherIndex(d, field.sky.y, index),
                              hn::GatherIndex(d, field.sky.z, index));
    dir_ = {hn::IfThenElse(fresh, turned.x, dir_.x), hn::IfThenElse(fresh, turned.y, dir_.y),
            hn::IfThenElse(fresh, turned.z, dir_.z)};
    inverse_ = {reciprocal(dir_.x), reciprocal(dir_.y), reciprocal(dir_.z)};
    weight_ = hn::IfThenElse(fresh, hn::GatherIndex(d, field.sky.weight, index), weight_);
    t_ = hn::IfThenZeroElse(fresh, t_);
    before_ = hn::IfThenElse(fresh, own_, before_);
    const auto leave = [&](const V o, const V inverse, int size) HWY_ATTR {
      const V low = hn::Mul(hn::Sub(hn::Set(D(), 0.01f), o), inverse), high = hn::Mul(hn::Sub(limit(size), o), inverse);
      return hn::Max(low, high);
    };
    const glm::ivec3 size = field.bricks.size;
    end_ = hn::Min(hn::Min(hn::Set(d, field.radius), leave(o_.x, inverse_.x, size.x)),
                   hn::Min(leave(o_.y, inverse_.y, size.y), leave(o_.z, inverse_.z, size.z)));
    ended_ = hn::AndNot(hn::VecFromMask(di, more), ended_);
    return true;
  }

  Point o_, dir_, inverse_;
  V sum_, weight_, t_, end_;
  V own_;          ///< distance at the start
  V before_;       ///< distance where the ray is; kOpen where no surface is near
  VI ended_;       ///< a mask
  VI lost_;        ///< a mask: the start is not at the surface, but somewhere outside or inside
  VI ray_, left_;  ///< the ray that a lane follows, and how many it has
  std::size_t first_;
};

void march_all(const SurfaceBricks& bricks, const Sky& sky, float radius_vox, const MarchStart& start,
               MarchStart::Values& taken) {
  const Field field(bricks, sky, radius_vox);
  const std::size_t lanes = hn::Lanes(D());
  // Two vectors at a time, since each step waits for what the last one found.
  for (std::size_t first = 0; first < MarchStart::kMost; first += 2 * lanes) {
    March one, two;
    one.begin(field, start, first);
    two.begin(field, start, first + lanes);
    bool more_of_one = true, more_of_two = true;
    while (more_of_one && more_of_two) {
      more_of_one = one.step(field, start);
      more_of_two = two.step(field, start);
    }
    while (more_of_one) more_of_one = one.step(field, start);
    while (more_of_two) more_of_two = two.step(field, start);
    one.store(taken.data());
    two.store(taken.data());
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::kernels {
HWY_EXPORT(march_all);
void march(const SurfaceBricks& bricks, const Sky& sky, float radius_vox, const MarchStart& start,
           MarchStart::Values& taken) {
  HWY_DYNAMIC_DISPATCH(march_all)(bricks, sky, radius_vox, start, taken);
}
}  // namespace dubsar::kernels
#endif
