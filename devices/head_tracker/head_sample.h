#pragma once
// What every head tracker gives, whatever its bytes look like.

#include <glm/geometric.hpp>
#include <optional>

#include "core/base/numbers/pose.h"
#include "core/base/system/clock.h"

namespace dubsar {

/// Position in metres and orientation of the head in the tracker's frame, right-handed: x right, y up, z to the viewer.
struct HeadSample {
  TimestampNs time = 0;
  Pose pose;
  bool has_position = false;
  bool has_orientation = false;
};

/// Largest distance along any axis that is believed of a tracker that stands before the viewer, and of one whose origin
/// lies anywhere in a hall; largest speed.
inline constexpr double kHeadBoxM = 2.0, kHallM = 100.0;
inline constexpr double kHeadSpeedMps = 5.0;

/// Limits the speed of the position to kHeadSpeedMps; a gap of more than 0.5 s starts afresh. Refuses positions further
/// than `box_m` along any axis, rotations that are no unit quaternions within 1 % (they are renormalised), values that
/// are not finite.
class HeadGate {
 public:
  explicit HeadGate(double box_m = kHeadBoxM) noexcept : box_m_(box_m) {}
  std::optional<HeadSample> pass(HeadSample sample) noexcept;
  void reset() noexcept { last_.reset(); }

 private:
  double box_m_;
  std::optional<HeadSample> last_;
};

}  // namespace dubsar
