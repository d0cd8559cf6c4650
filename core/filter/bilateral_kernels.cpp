#include "core/filter/bilateral_kernels.h"

#include <array>
#include <cstdlib>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/bilateral_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off
#include <hwy/contrib/math/math-inl.h>  // after the target is known
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace dubsar::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// Rounded twice, as processors without fused multiplication do: a scan gives the same surface on all of them, to the
// byte. (Where a factor is a power of two, both are the same.)
HWY_INLINE V add_product(V a, V b, V sum) { return hn::Add(sum, hn::Mul(a, b)); }

struct Tukey {
  HWY_INLINE static V weight(V difference) {
    const D d;
    const V t = hn::Max(hn::Sub(hn::Set(d, 1.0F), hn::Mul(difference, difference)), hn::Zero(d));
    return hn::Mul(t, t);
  }
};

struct Gauss {
  HWY_INLINE static V weight(V difference) {
    const D d;
    const V square = hn::Mul(difference, difference);
    // Below e^-80 a weight changes nothing but runs into slow denormal numbers.
    return hn::IfThenElseZero(hn::Lt(square, hn::Set(d, 80.0F)), hn::Exp(d, hn::Neg(square)));
  }
};

// The 26 neighbours come in three classes of equal spatial weight; summing each class apart saves 26 products.
template <class Range>
struct Window3 {
  const float* image[9];
  const float* guide[9];

  explicit Window3(const Window& window) {
    for (int k = 0; k < 9; ++k) {
      image[k] = window.image[k];
      guide[k] = window.guide[k];
    }
  }

  template <int kRow, int kDx>
  HWY_INLINE void tap(std::int64_t x, V centre, V* weights, V* values) const {
    constexpr int kClass = (kRow % 3 != 1) + (kRow / 3 != 1) + (kDx != 0);
    if constexpr (kClass > 0) {
      const D d;
      const V w = Range::weight(hn::Sub(hn::LoadU(d, guide[kRow] + x + kDx), centre));
      weights[kClass - 1] = hn::Add(weights[kClass - 1], w);
      values[kClass - 1] = add_product(w, hn::LoadU(d, image[kRow] + x + kDx), values[kClass - 1]);
    }
  }
  template <int kRow>
  HWY_INLINE void row(std::int64_t x, V centre, V* weights, V* values) const {
    tap<kRow, -1>(x, centre, weights, values);
    tap<kRow, 0>(x, centre, weights, values);
    tap<kRow, 1>(x, centre, weights, values);
  }

  HWY_INLINE V operator()(std::int64_t x) const {
    const D d;
    const V zero = hn::Zero(d), centre = hn::LoadU(d, guide[4] + x);
    V weights[3] = {zero, zero, zero}, values[3] = {zero, zero, zero};
    row<0>(x, centre, weights, values);
    row<1>(x, centre, weights, values);
    row<2>(x, centre, weights, values);
    row<3>(x, centre, weights, values);
    row<4>(x, centre, weights, values);
    row<5>(x, centre, weights, values);
    row<6>(x, centre, weights, values);
    row<7>(x, centre, weights, values);
    row<8>(x, centre, weights, values);
    const V own = hn::LoadU(d, image[4] + x), half = hn::Set(d, 0.5F), quarter = hn::Set(d, 0.25F),
            eighth = hn::Set(d, 0.125F);
    const V weight =
        hn::MulAdd(eighth, weights[2], hn::MulAdd(quarter, weights[1], hn::MulAdd(half, weights[0], hn::Set(d, 1.0F))));
    const V value = hn::MulAdd(eighth, values[2], hn::MulAdd(quarter, values[1], hn::MulAdd(half, values[0], own)));
    return finite_or(hn::Div(value, weight), own);
  }

  // Only sums of values beyond 5e36 are not finite; such a voxel stays as it is.
  HWY_INLINE static V finite_or(V value, V own) {
    const D d;
    const auto finite = hn::Le(hn::Abs(value), hn::Set(d, std::numeric_limits<float>::max()));
    return hn::IfThenElse(finite, value, own);
  }
};

// Averages the differences from the centre: with hundreds of taps the sums of the values themselves would round.
template <class Range>
struct WindowAny {
  const float* const* image;
  const float* const* guide;
  int radius;
  float binomial[2 * kMaxRadius + 1];  ///< 1 at the centre

  explicit WindowAny(const Window& window) : image(window.image), guide(window.guide), radius(window.radius) {
    constexpr float kBinomial[3][7] = {{1, 2, 1}, {1, 4, 6, 4, 1}, {1, 6, 15, 20, 15, 6, 1}};
    for (int k = 0; k <= 2 * radius; ++k) binomial[k] = kBinomial[radius - 1][k] / kBinomial[radius - 1][radius];
  }

  HWY_INLINE V operator()(std::int64_t x) const {
    const D d;
    const int side = 2 * radius + 1, middle = radius * side + radius;
    const V centre = hn::LoadU(d, guide[middle] + x), own = hn::LoadU(d, image[middle] + x);
    V weights = hn::Zero(d), values = hn::Zero(d);
    for (int row = 0; row < side * side; ++row) {
      const float row_weight = binomial[row / side] * binomial[row % side];
      V row_weights = hn::Zero(d), row_values = hn::Zero(d);
      for (int k = 0; k < side; ++k) {
        const V range = Range::weight(hn::Sub(hn::LoadU(d, guide[row] + x + k - radius), centre));
        const V w = hn::Mul(range, hn::Set(d, binomial[k]));
        row_weights = hn::Add(row_weights, w);
        row_values = add_product(w, hn::Sub(hn::LoadU(d, image[row] + x + k - radius), own), row_values);
      }
      weights = add_product(hn::Set(d, row_weight), row_weights, weights);
      values = add_product(hn::Set(d, row_weight), row_values, values);
    }
    return Window3<Range>::finite_or(hn::Add(own, hn::Div(values, weights)), own);
  }
};

// Forgetful selection: among any n/2 + 2 values neither the least nor the greatest is the median of n, so both are
// dropped and the next value comes in, until three are left.
struct Median27 {
  const float* rows[9];
  explicit Median27(const Window& window) {
    for (int k = 0; k < 9; ++k) rows[k] = window.image[k];
  }

  HWY_INLINE static void exchange(V& low, V& high) {
    const V least = hn::Min(low, high);
    high = hn::Max(low, high);
    low = least;
  }
  // Moves the least of v[0, kCount) to v[0] and the greatest to v[kCount - 1].
  template <int kCount>
  HWY_INLINE static void extremes_out(V* v) {
    for (int k = 0; k < kCount / 2; ++k) exchange(v[k], v[kCount - 1 - k]);
    for (int k = 1; k < (kCount + 1) / 2; ++k) exchange(v[0], v[k]);
    for (int k = kCount / 2; k < kCount - 1; ++k) exchange(v[k], v[kCount - 1]);
  }
  // v[0, kCount) are the candidates; the values from kNext on are still to come in.
  template <int kCount, int kNext>
  HWY_INLINE V select(std::int64_t x, V* v) const {
    extremes_out<kCount>(v);
    if constexpr (kCount == 3) {
      return v[1];
    } else {
      v[0] = value<kNext>(x);
      return select<kCount - 1, kNext + 1>(x, v);
    }
  }
  template <int kIndex>
  HWY_INLINE V value(std::int64_t x) const {
    const D d;
    return hn::LoadU(d, rows[kIndex / 3] + x + kIndex % 3 - 1);
  }
  HWY_INLINE V operator()(std::int64_t x) const {
    V v[15] = {value<0>(x),  value<1>(x),  value<2>(x),  value<3>(x),  value<4>(x),
               value<5>(x),  value<6>(x),  value<7>(x),  value<8>(x),  value<9>(x),
               value<10>(x), value<11>(x), value<12>(x), value<13>(x), value<14>(x)};
    return select<15, 15>(x, v);
  }
};

// Larger windows: bisection on the bit patterns, which order like the values once negative ones are flipped.
struct MedianAny {
  const float* const* rows;
  int radius;
  explicit MedianAny(const Window& window) : rows(window.image), radius(window.radius) {}

  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;
  HWY_INLINE static VI flip(VI bits) {
    const DI di;
    return hn::Xor(bits, hn::And(hn::BroadcastSignBit(bits), hn::Set(di, 0x7FFFFFFF)));
  }
  HWY_INLINE VI key(int row, std::int64_t x) const {
    const D d;
    const DI di;
    return flip(hn::BitCast(di, hn::LoadU(d, rows[row] + x)));
  }
  HWY_INLINE V operator()(std::int64_t x) const {
    const D d;
    const DI di;
    const int side = 2 * radius + 1;
    VI low = key(0, x), high = low;
    for (int row = 0; row < side * side; ++row)
      for (int k = -radius; k <= radius; ++k) {
        const VI at = key(row, x + k);
        low = hn::Min(low, at);
        high = hn::Max(high, at);
      }
    const VI half = hn::Set(di, side * side * side / 2);
    while (!hn::AllFalse(di, hn::Lt(low, high))) {
      // floor((low + high) / 2) without overflow
      const VI middle = hn::Add(hn::And(low, high), hn::ShiftRight<1>(hn::Xor(low, high)));
      VI above = hn::Zero(di);  // minus the number of values above the middle
      for (int row = 0; row < side * side; ++row)
        for (int k = -radius; k <= radius; ++k)
          above = hn::Add(above, hn::VecFromMask(di, hn::Gt(key(row, x + k), middle)));
      const auto upper = hn::Gt(hn::Neg(above), half);
      low = hn::IfThenElse(upper, hn::Add(middle, hn::Set(di, 1)), low);
      high = hn::IfThenElse(upper, high, middle);
    }
    return hn::BitCast(d, flip(low));
  }
};

// Whole vectors; the last one is computed past the end and cut. Lanes do not depend on their place in a vector.
template <class Filter>
HWY_INLINE void filter_row(const Window& window, std::int64_t begin, std::int64_t end, float* HWY_RESTRICT out) {
  const D d;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  const Filter filter(window);
  std::int64_t x = begin;
  for (; x + lanes <= end; x += lanes) hn::StoreU(filter(x), d, out + x);
  if (x == end) return;
  HWY_ALIGN float last[hn::MaxLanes(d)];
  hn::Store(filter(x), d, last);
  for (std::int64_t k = 0; x + k < end; ++k) out[x + k] = last[k];
}

void BilateralTukey(const Window& window, std::int64_t begin, std::int64_t end, float* out) {
  if (window.radius == 1) return filter_row<Window3<Tukey>>(window, begin, end, out);
  filter_row<WindowAny<Tukey>>(window, begin, end, out);
}

void BilateralGauss(const Window& window, std::int64_t begin, std::int64_t end, float* out) {
  if (window.radius == 1) return filter_row<Window3<Gauss>>(window, begin, end, out);
  filter_row<WindowAny<Gauss>>(window, begin, end, out);
}

void Median(const Window& window, std::int64_t begin, std::int64_t end, float* out) {
  if (window.radius == 1) return filter_row<Median27>(window, begin, end, out);
  filter_row<MedianAny>(window, begin, end, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar::kernels {

HWY_EXPORT(BilateralTukey);
HWY_EXPORT(BilateralGauss);
HWY_EXPORT(Median);

void bilateral_tukey(const Window& window, std::int64_t begin, std::int64_t end, float* out) {
  HWY_DYNAMIC_DISPATCH(BilateralTukey)(window, begin, end, out);
}
void bilateral_gauss(const Window& window, std::int64_t begin, std::int64_t end, float* out) {
  HWY_DYNAMIC_DISPATCH(BilateralGauss)(window, begin, end, out);
}
void median(const Window& window, std::int64_t begin, std::int64_t end, float* out) {
  HWY_DYNAMIC_DISPATCH(Median)(window, begin, end, out);
}

}  // namespace dubsar::kernels
#endif
