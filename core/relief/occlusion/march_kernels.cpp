#include "core/relief/occlusion/march_kernels.h"

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
  Point low;
  V f000, f100, f010, f110, f001, f101, f011, f111;

  HWY_INLINE Cell(const Point& corner, const VI lower, const VI upper)
      : low(corner),
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
  const SurfaceBricks& bricks;
  const Sky& sky;
  float radius;
  const std::int32_t* words() const { return reinterpret_cast<const std::int32_t*>(bricks.bricks.data()); }
  const std::int32_t* corners() const { return reinterpret_cast<const std::int32_t*>(bricks.corners.data()); }
};

/// One ray a lane, each of its own start. A lane leaps until its ray comes to a cell with surface, waits there until
/// enough do, and takes its next ray when enough have ended: each step does what most lanes have to do.
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
    sum_ = weight_ = t_ = end_ = before_ = next_ = zero;
    dir_ = inverse_ = {zero, zero, zero};
    ray_ = offset_ = octant_ = hn::Set(di, 0);
    const M inside = in_grid(field, o_);
    const auto cell = [&](const V v) HWY_ATTR { return hn::ConvertTo(di, hn::IfThenElseZero(inside, v)); };
    const VI cx = cell(o_.x), cy = cell(o_.y), cz = cell(o_.z);
    start_.brick = offset_of(field, cx, cy, cz);
    const VI word = hn::GatherOffset(di, field.words(), start_.brick);
    start_.at_surface = hn::And(inside, hn::RebindMask(d, surface_in(word, place_of(cx, cy, cz))));
    const Cell own = cell_of(field, start_.at_surface, start_.brick, cx, cy, cz);
    const V half = hn::Set(d, 0.5f);
    start_.middle = {hn::Add(own.low.x, half), hn::Add(own.low.y, half), hn::Add(own.low.z, half)};
    start_.distance = hn::IfThenElse(start_.at_surface, own.at(o_), hn::Set(d, kOpen));
    // A start beyond the grid has no surface anywhere near.
    lanes_.ended = inside;
    lanes_.wait = lanes_.leap = hn::FirstN(d, 0);
  }

  /// False when all rays have ended.
  HWY_INLINE bool step(const Field& field, const MarchStart& start) {
    const D d;
    const std::size_t leaping = hn::CountTrue(d, lanes_.leap), waiting = hn::CountTrue(d, lanes_.wait),
                      ended = hn::CountTrue(d, lanes_.ended);
    if (leaping >= waiting && leaping >= ended) {
      if (leaping == 0) return false;
      leap(field);
    } else if (waiting >= ended) {
      meet(field);
    } else {
      next_rays(field, start);
    }
    return true;
  }

  HWY_INLINE void store(float* taken) const { hn::StoreU(sum_, D(), taken + first_); }

 private:
  static constexpr float kStep = 1e-3f;                              // voxels, into the next cell
  static constexpr float kOpen = 4096.0f;                            // in place of a distance where no surface is near
  static constexpr float kBehind = -0.125f * SurfaceBricks::kSteps;  // met from behind: more than cells may differ by
  static constexpr int kCellBits = SurfaceBricks::kCellBits;

  using DU = hn::RebindToUnsigned<DI>;
  using MI = hn::Mask<DI>;
  HWY_INLINE static VI shift_right(const VI v, const VI bits) {
    return hn::BitCast(DI(), hn::Shr(hn::BitCast(DU(), v), hn::BitCast(DU(), bits)));
  }
  HWY_INLINE static VI count_bits(const VI v) { return hn::BitCast(DI(), hn::PopulationCount(hn::BitCast(DU(), v))); }
  HWY_INLINE static VI shift_left(const VI v, const VI bits) { return hn::Shl(v, bits); }

  /// From where rays are to the border of the cube without surface in front of them, or of their cell with surface.
  HWY_INLINE void leap(const Field& field) {
    const D d;
    const DI di;
    const V inside = hn::Add(t_, hn::Set(d, kStep));
    const Point p = at(inside);
    const VI cx = hn::ConvertTo(di, p.x), cy = hn::ConvertTo(di, p.y), cz = hn::ConvertTo(di, p.z);
    const VI offset = offset_of(field, cx, cy, cz);
    const VI word = hn::GatherOffset(
        di, field.words(),
        hn::IfThenElseZero(hn::RebindMask(di, lanes_.leap), hn::Add(offset, hn::And(octant_, hn::Set(di, 4)))));
    const MI passed = hn::Lt(word, hn::Zero(di));
    const VI place = place_of(cx, cy, cz);
    const MI open = hn::Eq(hn::And(word, hn::ShiftLeft<kCellBits>(ahead_of(place, octant_))), hn::Zero(di));
    const MI cell = hn::AndNot(open, passed);
    const M surface = hn::And(lanes_.leap, hn::RebindMask(d, hn::And(cell, surface_in(word, place))));
    // A brick that is passed elsewhere counts as one.
    const VI bricks = hn::IfThenElse(
        passed, hn::Set(di, 1),
        hn::And(shift_right(word, hn::ShiftLeft<3>(hn::And(octant_, hn::Set(di, 3)))), hn::Set(di, 0xff)));
    const V half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
    const M in_cell = hn::RebindMask(d, cell);
    const V reach = hn::IfThenElse(in_cell, half, hn::Sub(hn::ConvertTo(d, hn::Add(bricks, bricks)), one));
    const auto middle = [&](const VI c) HWY_ATTR {
      const VI low = hn::IfThenElse(cell, c, hn::AndNot(hn::Set(di, 1), c));
      return hn::Add(hn::ConvertTo(d, low), hn::IfThenElse(in_cell, half, one));
    };
    const V next = hn::Max(exit({middle(cx), middle(cy), middle(cz)}, reach), inside);
    next_ = hn::IfThenElse(surface, next, next_);
    offset_ = hn::IfThenElse(hn::RebindMask(di, surface), offset, offset_);
    lanes_.wait = hn::Or(lanes_.wait, surface);
    const M moved = hn::AndNot(surface, lanes_.leap);
    // Where the start has not come out of the surface within a voxel it is inside: dark.
    const M above = hn::Ge(before_, hn::Zero(d));
    const M stop = hn::And(moved, hn::AndNot(above, hn::Gt(next, one)));
    sum_ = hn::Add(sum_, hn::IfThenElseZero(stop, weight_));
    before_ = hn::IfThenElse(hn::And(moved, above), hn::Set(d, kOpen), before_);
    t_ = hn::IfThenElse(moved, next, t_);
    const M end = hn::And(moved, hn::Or(stop, hn::Ge(next, end_)));
    lanes_.ended = hn::Or(lanes_.ended, end);
    lanes_.leap = hn::AndNot(end, moved);
  }

  /// In cells with surface: whether it is met.
  HWY_INLINE void meet(const Field& field) {
    const D d;
    const DI di;
    // The first cell is the one that the start lies in.
    const M first = hn::And(start_.at_surface, hn::Eq(t_, hn::Zero(d)));
    const Point p = at(hn::IfThenZeroElse(first, hn::Add(t_, hn::Set(d, kStep))));
    const Cell cell =
        cell_of(field, lanes_.wait, offset_, hn::ConvertTo(di, p.x), hn::ConvertTo(di, p.y), hn::ConvertTo(di, p.z));
    const V zero = hn::Zero(d), f1 = cell.at(at(next_));
    const M above = hn::Ge(before_, zero), from_air = hn::Eq(before_, hn::Set(d, kOpen));
    M stop = hn::And(lanes_.wait, hn::AndNot(above, hn::Gt(t_, hn::Set(d, 1.0f))));
    // Seldom told from behind: what starts at the surface comes from outside, about half a voxel before it.
    V f0 = hn::IfThenElse(from_air, hn::Set(d, 0.5f * SurfaceBricks::kSteps), before_);
    if (const M lost = hn::And(lanes_.wait, hn::AndNot(start_.at_surface, from_air)); !hn::AllFalse(d, lost)) {
      const V found = cell.at(at(t_));
      stop = hn::Or(stop, hn::And(lost, hn::Lt(found, hn::Set(d, kBehind))));
      f0 = hn::IfThenElse(lost, hn::Max(found, zero), f0);
    }
    const M front = hn::And(lanes_.wait, hn::AndNot(stop, hn::And(above, hn::Lt(f1, zero))));
    const V share = hn::Div(f0, hn::Max(hn::Sub(f0, f1), hn::Set(d, 1e-6f)));
    const V met = hn::IfThenElseZero(front, multiply_add(hn::Sub(next_, t_), hn::Min(share, hn::Set(d, 1.0f)), t_));
    const V near = hn::Max(hn::Sub(hn::Set(d, 1.0f), hn::Mul(met, hn::Set(d, 1.0f / field.radius))), zero);
    stop = hn::Or(stop, front);
    sum_ = hn::Add(sum_, hn::IfThenElseZero(stop, hn::Mul(weight_, near)));
    before_ = hn::IfThenElse(lanes_.wait, f1, before_);
    t_ = hn::IfThenElse(lanes_.wait, next_, t_);
    const M end = hn::And(lanes_.wait, hn::Or(stop, hn::Ge(next_, end_)));
    lanes_.ended = hn::Or(lanes_.ended, end);
    lanes_.leap = hn::Or(lanes_.leap, hn::AndNot(end, lanes_.wait));
    lanes_.wait = hn::FirstN(d, 0);
  }

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
  /// Where rays leave the cube about `middle`; `reach` goes that far on from it along each axis.
  HWY_INLINE V exit(const Point& middle, const V reach) const {
    const auto along = [&](const V m, const V o, const V inverse) HWY_ATTR {
      return hn::Add(hn::Mul(hn::Sub(m, o), inverse), hn::Mul(reach, hn::Abs(inverse)));
    };
    return hn::Min(along(middle.x, o_.x, inverse_.x),
                   hn::Min(along(middle.y, o_.y, inverse_.y), along(middle.z, o_.z, inverse_.z)));
  }
  HWY_INLINE static V limit(int bricks) {
    return hn::Set(D(), static_cast<float>(bricks * SurfaceBricks::kEdge) - 0.01f);
  }
  HWY_INLINE static M in_grid(const Field& field, const Point& p) {
    const glm::ivec3 size = field.bricks.size();
    const M low = hn::Ge(hn::Min(p.x, hn::Min(p.y, p.z)), hn::Set(D(), 0.01f));
    return hn::And(
        low, hn::And(hn::Lt(p.x, limit(size.x)), hn::And(hn::Lt(p.y, limit(size.y)), hn::Lt(p.z, limit(size.z)))));
  }

  static_assert(SurfaceBricks::kEdge == 2);
  /// Of the first word of the bricks of cells, in bytes.
  HWY_INLINE static VI offset_of(const Field& field, const VI x, const VI y, const VI z) {
    const DI di;
    const glm::ivec3 tiles = field.bricks.tiles;
    const VI tile = hn::Add(hn::Mul(hn::ShiftRight<2>(z), hn::Set(di, tiles.x * tiles.y)),
                            hn::Add(hn::Mul(hn::ShiftRight<2>(y), hn::Set(di, tiles.x)), hn::ShiftRight<2>(x)));
    const VI two = hn::Set(di, 2);
    const VI brick = hn::Or(hn::ShiftLeft<2>(hn::And(x, two)),
                            hn::Or(hn::ShiftLeft<3>(hn::And(y, two)), hn::ShiftLeft<4>(hn::And(z, two))));
    return hn::Or(hn::ShiftLeft<6>(tile), brick);
  }
  /// Of cells in their brick.
  HWY_INLINE static VI place_of(const VI x, const VI y, const VI z) {
    const VI one = hn::Set(DI(), 1);
    return hn::Or(hn::And(x, one), hn::Or(hn::ShiftLeft<1>(hn::And(y, one)), hn::ShiftLeft<2>(hn::And(z, one))));
  }
  /// Where that cell has surface.
  HWY_INLINE static MI surface_in(const VI word, const VI place) {
    const VI bit = shift_left(hn::Set(DI(), 1 << kCellBits), place);
    return hn::And(hn::Lt(word, hn::Zero(DI())), hn::Ne(hn::And(word, bit), hn::Zero(DI())));
  }
  /// A bit of each cell of a brick that rays of an octant may pass from that place on.
  HWY_INLINE static VI ahead_of(const VI place, const VI octant) {
    const DI di;
    const VI far = hn::Xor(place, octant), all = hn::Set(di, 0xff);
    const auto side = [&](int bit, int low) HWY_ATTR {
      const VI which = hn::Set(di, 1 << bit);
      const VI own = shift_left(hn::Set(di, low), hn::And(place, which));
      return hn::IfThenElse(hn::Eq(hn::And(far, which), hn::Zero(di)), all, own);
    };
    return hn::And(side(0, 0x55), hn::And(side(1, 0x33), side(2, 0x0f)));
  }

  /// The corners of cells, where `wanted`; the first of all elsewhere.
  HWY_INLINE static Cell cell_of(const Field& field, const M wanted, const VI offset, const VI x, const VI y,
                                 const VI z) {
    const D d;
    const DI di;
    const MI mask = hn::RebindMask(di, wanted);
    const VI brick = hn::IfThenElseZero(mask, offset);
    const VI low = hn::GatherOffset(di, field.words(), brick),
             high = hn::GatherOffset(di, field.words(), hn::Add(brick, hn::Set(di, 4)));
    const VI below = hn::Sub(shift_left(hn::Set(di, 1 << kCellBits), place_of(x, y, z)), hn::Set(di, 1 << kCellBits));
    const VI first = hn::Or(hn::And(low, hn::Set(di, (1 << kCellBits) - 1)), hn::ShiftLeft<kCellBits>(high));
    const VI index = hn::IfThenElseZero(mask, hn::Add(first, count_bits(hn::And(low, below))));
    const VI word = hn::Add(index, index);
    return {{hn::ConvertTo(d, x), hn::ConvertTo(d, y), hn::ConvertTo(d, z)},
            hn::GatherIndex(di, field.corners(), word),
            hn::GatherIndex(di, field.corners(), hn::Add(word, hn::Set(di, 1)))};
  }

  /// Gives ended lanes their next ray, if they have one.
  HWY_INLINE void next_rays(const Field& field, const MarchStart& start) {
    const D d;
    const DI di;
    const VI count = hn::Set(di, static_cast<int>(field.sky.count));
    const M fresh = hn::And(lanes_.ended, hn::RebindMask(d, hn::Lt(ray_, count)));
    const VI index = hn::Min(ray_, hn::Sub(count, hn::Set(di, 1)));
    const Point turned = turn(start, hn::GatherIndex(d, field.sky.x, index), hn::GatherIndex(d, field.sky.y, index),
                              hn::GatherIndex(d, field.sky.z, index));
    ray_ = hn::IfThenElse(hn::RebindMask(di, fresh), hn::Add(ray_, hn::Set(di, 1)), ray_);
    dir_ = {hn::IfThenElse(fresh, turned.x, dir_.x), hn::IfThenElse(fresh, turned.y, dir_.y),
            hn::IfThenElse(fresh, turned.z, dir_.z)};
    inverse_ = {reciprocal(dir_.x), reciprocal(dir_.y), reciprocal(dir_.z)};
    const auto falls = [&](const V v, int octant)
                           HWY_ATTR { return hn::And(hn::BroadcastSignBit(hn::BitCast(di, v)), hn::Set(di, octant)); };
    octant_ = hn::Or(falls(dir_.x, 1), hn::Or(falls(dir_.y, 2), falls(dir_.z, 4)));
    weight_ = hn::IfThenElse(fresh, hn::GatherIndex(d, field.sky.weight, index), weight_);
    t_ = hn::IfThenZeroElse(fresh, t_);
    before_ = hn::IfThenElse(fresh, start_.distance, before_);
    const auto leave = [&](const V o, const V inverse, int size) HWY_ATTR {
      const V low = hn::Mul(hn::Sub(hn::Set(D(), 0.01f), o), inverse), high = hn::Mul(hn::Sub(limit(size), o), inverse);
      return hn::Max(low, high);
    };
    const glm::ivec3 size = field.bricks.size();
    end_ = hn::Min(hn::Min(hn::Set(d, field.radius), leave(o_.x, inverse_.x, size.x)),
                   hn::Min(leave(o_.y, inverse_.y, size.y), leave(o_.z, inverse_.z, size.z)));
    lanes_.ended = hn::FirstN(d, 0);
    const M waits = hn::And(fresh, start_.at_surface);
    offset_ = hn::IfThenElse(hn::RebindMask(di, waits), start_.brick, offset_);
    next_ = hn::IfThenElse(waits, hn::Max(exit(start_.middle, hn::Set(d, 0.5f)), hn::Set(d, kStep)), next_);
    lanes_.wait = hn::Or(lanes_.wait, waits);
    lanes_.leap = hn::Or(lanes_.leap, hn::AndNot(start_.at_surface, fresh));
  }

  /// What all rays of a lane share.
  struct Start {
    Point middle;  ///< of its cell
    V distance;    ///< kOpen where no surface is near
    M at_surface;  ///< else it lies somewhere outside or inside
    VI brick;      ///< its offset
  };
  /// What is next; none of these: the lane has no more rays.
  struct Lanes {
    M leap, wait, ended;
  };
  Start start_;
  Lanes lanes_;
  Point o_, dir_, inverse_;
  V sum_, weight_, t_, end_;
  V before_;   ///< distance where the ray is; kOpen where no surface is near
  V next_;     ///< of those that wait: where the ray leaves the cell
  VI offset_;  ///< of those that wait: of the cell's brick
  VI octant_;  ///< as of SurfaceBricks
  VI ray_;     ///< which comes next
  std::size_t first_;
};

void march_all(const SurfaceBricks& bricks, const Sky& sky, float radius_vox, const MarchStart& start,
               MarchStart::Values& taken) {
  const Field field{bricks, sky, radius_vox};
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
  if (bricks.bricks.empty()) return taken.fill(0.0f);
  HWY_DYNAMIC_DISPATCH(march_all)(bricks, sky, radius_vox, start, taken);
}
}  // namespace dubsar::kernels
#endif
