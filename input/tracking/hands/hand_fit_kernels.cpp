#include "input/tracking/hands/hand_fit_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "input/tracking/hands/hand_fit_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kHandLanes>;

void Deepen(const ConeTerms& cone, float id, const Outline& outline, const TileView& tile) {
  const Tag d;
  const auto set = [&](float value) HWY_ATTR { return hn::Set(d, value); };
  const auto zero = hn::Zero(d), one = set(1.0F);
  const auto least = set(1e-3F * cone.ee);
  for (std::size_t i = 0; i < kHandLanes; i += hn::Lanes(d)) {
    const auto x = hn::Load(d, tile.x + i), y = hn::Load(d, tile.y + i), z = hn::Load(d, tile.z + i);
    const auto ad = hn::MulAdd(set(cone.ax), x, hn::MulAdd(set(cone.ay), y, hn::Mul(set(cone.az), z)));
    const auto ed = hn::MulAdd(set(cone.ex), x, hn::MulAdd(set(cone.ey), y, hn::Mul(set(cone.ez), z)));
    // Across the ray.
    const auto aa = hn::NegMulAdd(ad, ad, set(cone.aa)), ae = hn::NegMulAdd(ad, ed, set(cone.ae));
    const auto ee = hn::Max(hn::NegMulAdd(ed, ed, set(cone.ee)), least);
    const auto s = hn::Min(one, hn::Max(zero, hn::Sub(set(cone.shift), hn::Div(ae, ee))));
    const auto square = hn::MulAdd(s, hn::MulAdd(s, ee, hn::Add(ae, ae)), aa);
    const auto rho = hn::Sqrt(hn::Max(square, set(1e-12F)));
    // Away from the axis, towards the light: what the rim is turned to the light more than to the eye.
    const auto along = hn::MulAdd(s, ed, ad);
    const auto out_x = hn::NegMulAdd(s, set(cone.ex), hn::MulAdd(along, x, set(-cone.ax)));
    const auto turned = hn::Div(hn::Mul(out_x, set(outline.light_x_m)), hn::Mul(rho, along));
    const auto dark = hn::Min(set(0.7F), hn::Max(zero, hn::Sub(set(outline.half), turned)));
    const auto part = hn::Sqrt(hn::NegMulAdd(dark, dark, one));
    const auto depth = hn::MulSub(part, hn::MulAdd(s, set(cone.radius_change), set(cone.radius_a)), rho);
    const auto before = hn::Load(d, tile.depth + i);
    hn::Store(hn::IfThenElse(hn::Gt(depth, before), set(id), hn::Load(d, tile.cone + i)), d, tile.cone + i);
    hn::Store(hn::Max(depth, before), d, tile.depth + i);
  }
}

float AddSamples(const ConeTerms* cones, const ConeSlopes* slopes, const Outline& outline, const TileView& tile,
                 float blur, NormalSums& sums) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  float squares = 0.0F;
  // Rows of the samples near the outline, and how much each adds to the gradient and to the matrix.
  alignas(64) float rows[kHandLanes * kHandLanes];
  std::array<float, kHandLanes> first, second;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kHandLanes; ++i) {
    const float weight = tile.weight[i];
    if (weight == 0.0F) continue;
    const float u = std::min(1.0F, std::max(-1.0F, tile.depth[i] / blur));
    const float residual = 0.5F + u * (0.75F - 0.25F * u * u) - tile.skin[i];
    squares += weight * residual * residual;
    const float slope = 0.75F * (1.0F - u * u) / blur;
    if (slope <= 0.0F) continue;
    const auto which = static_cast<std::size_t>(tile.cone[i]);
    const ConeTerms& c = cones[which];
    const ConeSlopes& v = slopes[which];
    const float x = tile.x[i], y = tile.y[i], z = tile.z[i];
    const float ad = c.ax * x + c.ay * y + c.az * z, ed = c.ex * x + c.ey * y + c.ez * z;
    const float s = std::min(1.0F, std::max(0.0F, c.shift - (c.ae - ad * ed) / std::max(c.ee - ed * ed, 1e-3F * c.ee)));
    const float along = ad + s * ed;
    const float ox = c.ax + s * c.ex - along * x, oy = c.ay + s * c.ey - along * y, oz = c.az + s * c.ez - along * z;
    const float inverse = 1.0F / std::max(1e-6F, std::sqrt(ox * ox + oy * oy + oz * oz));
    const float turned = -ox * inverse * outline.light_x_m / along;
    const float dark = std::min(0.7F, std::max(0.0F, outline.half - turned));
    const auto part = hn::Set(d, std::sqrt(1.0F - dark * dark));
    const auto sv = hn::Set(d, s), rest = hn::Set(d, 1.0F - s);
    const auto nx = hn::Set(d, ox * inverse), ny = hn::Set(d, oy * inverse), nz = hn::Set(d, oz * inverse);
    for (std::size_t j = 0; j < kHandLanes; j += lanes) {
      const auto at = [&](const float* p) HWY_ATTR { return hn::Load(d, p + j); };
      const auto a = hn::NegMulAdd(
          nx, at(v.ax), hn::NegMulAdd(ny, at(v.ay), hn::NegMulAdd(nz, at(v.az), hn::Mul(part, at(v.radius_a)))));
      const auto b = hn::NegMulAdd(
          nx, at(v.bx), hn::NegMulAdd(ny, at(v.by), hn::NegMulAdd(nz, at(v.bz), hn::Mul(part, at(v.radius_b)))));
      hn::Store(hn::MulAdd(rest, a, hn::Mul(sv, b)), d, rows + count * kHandLanes + j);
    }
    first[count] = weight * slope * residual;
    second[count++] = weight * slope * slope;
  }
  for (std::size_t j = 0; count > 0 && j < kHandLanes; j += lanes) {
    auto gradient = hn::Load(d, sums.gradient + j);
    for (std::size_t i = 0; i < count; ++i)
      gradient = hn::MulAdd(hn::Set(d, first[i]), hn::Load(d, rows + i * kHandLanes + j), gradient);
    hn::Store(gradient, d, sums.gradient + j);
    for (std::size_t k = 0; k < kHandParameters; ++k) {
      auto sum = hn::Load(d, sums.matrix + k * kHandLanes + j);
      for (std::size_t i = 0; i < count; ++i)
        sum = hn::MulAdd(hn::Set(d, second[i] * rows[i * kHandLanes + k]), hn::Load(d, rows + i * kHandLanes + j), sum);
      hn::Store(sum, d, sums.matrix + k * kHandLanes + j);
    }
  }
  return squares;
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::kernels {
HWY_EXPORT(Deepen);
HWY_EXPORT(AddSamples);

void deepen(const ConeTerms& cone, float id, const Outline& outline, const TileView& tile) {
  HWY_DYNAMIC_DISPATCH(Deepen)(cone, id, outline, tile);
}
float add_samples(const ConeTerms* cones, const ConeSlopes* slopes, const Outline& outline, const TileView& tile,
                  float blur, NormalSums& sums) {
  return HWY_DYNAMIC_DISPATCH(AddSamples)(cones, slopes, outline, tile, blur, sums);
}

}  // namespace dubsar::kernels
#endif
