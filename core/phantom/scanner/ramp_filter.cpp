#include "core/phantom/scanner/ramp_filter.h"

#include <bit>
#include <cmath>
#include <numbers>

#include "core/phantom/scanner/ray_kernels.h"

namespace dubsar::phantom {
namespace {

using kernels::kLanes;

void make_circle(std::int64_t length, std::vector<float>& cosine, std::vector<float>& sine) {
  for (std::int64_t k = 0; k < length / 2; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length);
    cosine.push_back(static_cast<float>(std::cos(angle)));
    sine.push_back(static_cast<float>(std::sin(angle)));
  }
}

std::int64_t reversed(std::int64_t k, std::int64_t length) {
  std::int64_t out = 0;
  for (std::int64_t bit = 1; bit < length; bit *= 2) out = out * 2 + ((k / bit) & 1);
  return out;
}

double window_at(Window window, double of_nyquist) {
  const double x = 0.5 * std::numbers::pi * of_nyquist;
  switch (window) {
    case Window::kShepp:
      return of_nyquist > 0.0 ? std::sin(x) / x : 1.0;
    case Window::kCosine:
      return std::cos(x);
    case Window::kHann:
      return 0.5 + 0.5 * std::cos(2.0 * x);
    default:
      return 1.0;
  }
}

}  // namespace

RampFilter::RampFilter(std::int64_t columns, double pitch_mm, Window window)
    : columns_(columns), length_(static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(2 * columns)))) {
  make_circle(length_, cosine_, sine_);
  make_circle(2 * length_, cosine2_, sine2_);
  // The kernel's own transform, a sum of cosines: exact at zero frequency, where |w| sampled is not.
  for (std::int64_t k = 0; k <= length_ / 2; ++k) {
    double sum = 0.25;
    for (std::int64_t n = 1; n <= length_ / 2; n += 2) {
      const double h = -1.0 / (std::numbers::pi * std::numbers::pi * static_cast<double>(n * n));
      const double both = 2 * n == length_ ? 1.0 : 2.0;
      sum += both * h *
             std::cos(2.0 * std::numbers::pi * static_cast<double>(k * n % length_) / static_cast<double>(length_));
    }
    const double nyquist = 2.0 * static_cast<double>(k) / static_cast<double>(length_);
    gain_.push_back(static_cast<float>(sum * window_at(window, nyquist) / (pitch_mm * static_cast<double>(length_))));
  }
  gain_.back() *= 0.5f;  // the highest frequency stands at both ends of the wider spectrum
  for (std::int64_t k = 0; k < length_; ++k) from_.push_back(reversed(k, length_));
  for (std::int64_t k = 0; k < 2 * length_; ++k) to_.push_back(reversed(k, 2 * length_));
}

void RampFilter::apply(const float* view, std::int64_t stride, float* out) const {
  const std::int64_t wide = 2 * length_;
  thread_local std::vector<float> re, im, re2, im2;
  for (std::int64_t row = 0; row < stride;
       row += 2 * kLanes) {  // 16 rows are the real parts, 16 more the imaginary ones
    const bool both = row + kLanes < stride;
    re.assign(static_cast<std::size_t>(length_ * kLanes), 0.0f);
    im.assign(re.size(), 0.0f);
    re2.assign(2 * re.size(), 0.0f);
    im2.assign(2 * re.size(), 0.0f);
    for (std::int64_t column = 0; column < columns_; ++column) {
      const float* from = view + column * stride + row;
      std::copy_n(from, kLanes, re.data() + column * kLanes);
      if (both) std::copy_n(from + kLanes, kLanes, im.data() + column * kLanes);
    }
    kernels::transform(cosine_, sine_, re, im);
    const auto carry = [&](std::int64_t k, std::int64_t k2, float gain) {
      const std::int64_t a = from_[static_cast<std::size_t>(k)] * kLanes,
                         b = to_[static_cast<std::size_t>(k2)] * kLanes;
      for (std::int64_t r = 0; r < kLanes; ++r) {
        re2[static_cast<std::size_t>(b + r)] = gain * re[static_cast<std::size_t>(a + r)];
        im2[static_cast<std::size_t>(b + r)] = gain * im[static_cast<std::size_t>(a + r)];
      }
    };
    for (std::int64_t k = 0; k <= length_ / 2; ++k) carry(k, k, gain_[static_cast<std::size_t>(k)]);
    for (std::int64_t k = 1; k <= length_ / 2; ++k) carry(length_ - k, wide - k, gain_[static_cast<std::size_t>(k)]);
    kernels::transform_back(cosine2_, sine2_, re2, im2);
    for (std::int64_t column = 0; column < columns_out(); ++column) {
      float* to = out + column * stride + row;
      std::copy_n(re2.data() + column * kLanes, kLanes, to);
      if (both) std::copy_n(im2.data() + column * kLanes, kLanes, to + kLanes);
    }
  }
}

}  // namespace dubsar::phantom
