#include "core/phantom/stylus.h"

namespace dubsar::phantom {

WedgeSize stylus_wedge(float head_half_width, float tail_length, float rounding) {
  WedgeSize size;
  size.head_half_width = head_half_width;
  size.rounding = rounding;
  if (tail_length > 0.0f) {
    size.head_back = 0.62f * head_half_width;
    size.head_front = 1.65f * head_half_width;
    size.depth = 1.15f * head_half_width;
    size.tail_length = std::max(tail_length, 2.2f * head_half_width);
    size.tail_half_width = 0.46f * head_half_width;
    size.tail_depth = 0.68f * head_half_width;
  } else {
    size.head_back = 0.75f * head_half_width;
    size.head_front = 1.25f * head_half_width;
    size.depth = 1.10f * head_half_width;
  }
  return size;
}

WedgeField::WedgeField(const WedgeSize& size, Float4 place, Float4 along, Float4 across)
    : place_(place),
      along_(along),
      across_(across),
      rounding_(size.rounding),
      tail_length_(size.tail_length),
      back_(size.head_back),
      front_(size.head_front),
      nominal_(size.depth) {
  const auto flank = [](float length, float back, float half_width, float depth) {
    // Through (length, 0, 0), (-back, half_width, 0) and (0, 0, depth).
    const float u = 1.0f / length, v = (1.0f + back / length) / half_width, s = 1.0f / depth;
    const float norm = 1.0f / std::sqrt(u * u + v * v + s * s);
    return Plane{u * norm, v * norm, s * norm, -norm};
  };
  const float slope = size.head_back / size.depth, norm = 1.0f / std::sqrt(1.0f + slope * slope);
  head_back_ = {-norm, 0.0f, slope * norm, -size.head_back * norm};
  head_flank_ = flank(size.head_front, size.head_back, size.head_half_width, size.depth);
  if (tail_length_ > 0.0f) tail_flank_ = flank(size.tail_length, 0.0f, size.tail_half_width, size.tail_depth);
}

Dual WedgeField::evaluate(const Point& point, const Dual& depth_below_surface) const {
  const Dual u = point.along(place_, along_);
  const Dual v = smooth_abs(point.along(place_, across_), 0.5f * rounding_);
  const Dual head =
      smooth_max(head_back_.at(u, v, depth_below_surface), head_flank_.at(u, v, depth_below_surface), rounding_);
  if (tail_length_ <= 0.0f) return head;
  // Beyond its tip the groove's flank would stay near the surface for long: it is cut off there.
  const Dual ends = max(-u, u - tail_length_);
  const Dual tail = smooth_max(ends, tail_flank_.at(u, v, depth_below_surface), rounding_);
  return smooth_min(head, tail, rounding_);
}

/// How far below the undisturbed surface clay begins, above the middle of the tail.
float WedgeField::depth_at(float along) const {
  Point point;
  point.p = place_ + along_ * along;
  float air = 0.0f, clay = 1.5f * nominal_;
  for (int i = 0; i < 24; ++i) {
    const float middle = 0.5f * (air + clay);
    (evaluate(point, Dual{middle, Float4{}}).v < 0.0f ? air : clay) = middle;
  }
  return air;
}

bool WedgeField::meets(const WedgeField& other) const {
  constexpr int kPlaces = 16;
  const float length = std::max(front_, tail_length_) + back_, half = nominal_;
  for (int i = 0; i <= kPlaces; ++i)
    for (int j = 0; j <= kPlaces; ++j) {
      Point point;
      point.p = place_ + along_ * (length * static_cast<float>(i) / kPlaces - back_) +
                across_ * (half * (2.0f * static_cast<float>(j) / kPlaces - 1.0f));
      const Dual below{1.0f, Float4{}};
      if (evaluate(point, below).v < 0.0f && other.evaluate(point, below).v < 0.0f) return true;
    }
  return false;
}

float WedgeField::deepest_along() const {
  // It has one deepest place: golden sections.
  constexpr float kShare = 0.618034f;
  float low = -back_, high = front_;
  for (int i = 0; i < 32; ++i) {
    const float part = kShare * (high - low);
    if (depth_at(high - part) > depth_at(low + part))
      high = low + part;
    else
      low = high - part;
  }
  return 0.5f * (low + high);
}

}  // namespace dubsar::phantom
