#pragma once
// Forward-mode differentiation: a value and its gradient in model space, so that every field of the phantom knows how
// far it is from metric (distance to first order = value / |gradient|).

#include <algorithm>
#include <cmath>

namespace dubsar::phantom {

using Float4 = float __attribute__((vector_size(16)));  ///< x, y, z and an unused lane that stays 0

struct Dual {
  float v = 0.0f;
  Float4 g{};
};

inline Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.g + b.g}; }
inline Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.g - b.g}; }
inline Dual operator-(const Dual& a) { return {-a.v, -a.g}; }
inline Dual operator+(const Dual& a, float b) { return {a.v + b, a.g}; }
inline Dual operator-(const Dual& a, float b) { return {a.v - b, a.g}; }
inline Dual operator*(const Dual& a, float b) { return {a.v * b, a.g * b}; }
inline Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.g * b.v + b.g * a.v}; }

inline float dot(Float4 a, Float4 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Dual max(const Dual& a, const Dual& b) { return a.v >= b.v ? a : b; }
inline Dual min(const Dual& a, const Dual& b) { return a.v <= b.v ? a : b; }

/// sqrt(a); the gradient at 0 is taken as 0.
inline Dual sqrt(const Dual& a) {
  const float root = std::sqrt(std::max(a.v, 0.0f));
  return {root, a.g * (root > 0.0f ? 0.5f / root : 0.0f)};
}

/// |a| rounded with radius about e at 0: sqrt(a^2 + e^2) - e.
inline Dual smooth_abs(const Dual& a, float e) {
  const float root = std::sqrt(a.v * a.v + e * e);
  return {root - e, a.g * (a.v / root)};
}

/// Polynomial smooth maximum: equal to max(a, b) where |a - b| >= k, at most k/4 above it in between.
inline Dual smooth_max(const Dual& a, const Dual& b, float k) {
  const float d = a.v - b.v;
  if (d >= k) return a;
  if (d <= -k) return b;
  const float t = 0.5f + 0.5f * d / k;
  return {b.v + d * t + k * t * (1.0f - t), b.g + (a.g - b.g) * t};
}
inline Dual smooth_min(const Dual& a, const Dual& b, float k) { return -smooth_max(-a, -b, k); }

/// (1 - x2 / r2)^2 for x2 < r2, else 0: a bump of height 1 with compact support and continuous slope.
inline Dual bump(const Dual& x2, float r2) {
  if (x2.v >= r2) return {};
  const float t = 1.0f - x2.v / r2;
  return {t * t, x2.g * (-2.0f * t / r2)};
}

/// 0 below lo, 1 above hi, cubic in between.
inline Dual smooth_step(const Dual& x, float lo, float hi) {
  if (x.v <= lo) return {};
  if (x.v >= hi) return {1.0f, Float4{}};
  const float t = (x.v - lo) / (hi - lo);
  return {t * t * (3.0f - 2.0f * t), x.g * (6.0f * t * (1.0f - t) / (hi - lo))};
}

/// A point of model space as three coordinates with unit gradients.
struct Point {
  Float4 p{};
  Dual operator[](int axis) const {
    Dual d{p[axis], Float4{}};
    d.g[axis] = 1.0f;
    return d;
  }
  /// (p - origin) . direction
  Dual along(Float4 origin, Float4 direction) const { return {dot(p - origin, direction), direction}; }
  /// |p - origin|^2
  Dual distance2(Float4 origin) const {
    const Float4 d = p - origin;
    return {dot(d, d), d * 2.0f};
  }
};

}  // namespace dubsar::phantom
