#pragma once
// What every head tracker gives, whatever its bytes look like.

#include <glm/geometric.hpp>
#include <optional>

#include "core/base/clock.h"
#include "core/base/pose.h"

namespace dubsar {

/// Position in metres and orientation of the head in the tracker's frame, right-handed: x right, y up, z to the viewer.
struct HeadSample {
  TimestampNs time = 0;
  Pose pose;
  bool has_position = false;
  bool has_orientation = false;
};

/// Largest distance from the tracker's origin along any axis that is believed, and largest speed.
inline constexpr double kHeadBoxM = 2.0;
inline constexpr double kHeadSpeedMps = 5.0;

/// Limits the speed of the position to kHeadSpeedMps; a gap of more than 0.5 s starts afresh. Refuses positions outside
/// the box, rotations that are no unit quaternions within 1 % (they are renormalised), values that are not finite.
class HeadGate {
 public:
  std::optional<HeadSample> pass(HeadSample sample) noexcept;
  void reset() noexcept { last_.reset(); }

 private:
  std::optional<HeadSample> last_;
};

}  // namespace dubsar
