#pragma once
// One impression of the stylus: a triangular pyramid (the corner of the reed) with a tapering groove behind it.

#include "core/phantom/dual.h"

namespace dubsar::phantom {

/// Sizes of an impression in voxels. u runs along the tail, v across, s into the clay; the deepest point is u = v = 0.
struct WedgeSize {
  float head_half_width = 0.0f;  ///< of the head's straight edge
  float head_back = 0.0f;        ///< from that edge to the deepest point
  float head_front = 0.0f;       ///< from the deepest point to where the head's flanks meet
  float depth = 0.0f;
  float tail_length = 0.0f;  ///< from the deepest point; 0: Winkelhaken, no tail
  float tail_half_width = 0.0f;
  float tail_depth = 0.0f;
  float rounding = 0.0f;  ///< of inner edges
};

/// The usual proportions for a head of the given half width (tuned by eye on shaded pictures and photographs of Old
/// Assyrian letters). tail_length 0 makes a Winkelhaken.
WedgeSize stylus_wedge(float head_half_width, float tail_length, float rounding);

/// An impression at its place: negative inside the volume the stylus displaced, metric to first order.
class WedgeField {
 public:
  WedgeField() = default;
  /// `place`: point of the undisturbed surface above the deepest point; unit vectors along and across the tail.
  WedgeField(const WedgeSize& size, Float4 place, Float4 along, Float4 across);

  /// `depth_below_surface`: of the undisturbed surface, positive in clay; it replaces the third coordinate, so that an
  /// impression follows a curved surface.
  Dual evaluate(const Point& point, const Dual& depth_below_surface) const;

  float nominal() const noexcept { return nominal_; }  ///< depth, voxels
  /// Both are a voxel and more deep at some place.
  bool meets(const WedgeField& other) const;

  /// Voxels along the tail from its place to where the impression is deepest: rounding moves it there.
  float deepest_along() const;

 private:
  struct Plane {
    float u, v, s, offset;
    Dual at(const Dual& pu, const Dual& pv, const Dual& ps) const { return pu * u + pv * v + ps * s + offset; }
  };
  float depth_at(float along) const;

  Float4 place_{}, along_{}, across_{};
  Plane head_back_{}, head_flank_{}, tail_flank_{};
  float rounding_ = 1.0f;
  float tail_length_ = 0.0f;                           ///< 0: none
  float back_ = 0.0f, front_ = 0.0f, nominal_ = 0.0f;  ///< of the head, as in WedgeSize
};

}  // namespace dubsar::phantom
