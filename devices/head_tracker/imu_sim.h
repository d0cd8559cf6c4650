#pragma once
// Rift and XREAL headsets in memory: a head that turns at a given rate, as their reports. Gravity is included.

#include <memory>

#include "devices/head_tracker/rift_protocol.h"
#include "devices/head_tracker/xreal_protocol.h"
#include "devices/transport/sim_transport.h"

namespace dubsar {

/// The readings of an ideal sensor in a head that turns; a real one adds noise.
class HeadMotion {
 public:
  /// Turns by `rate_rad_s` (head axes) for `dt_s` and reads the sensor afterwards.
  ImuSample turn(const glm::dvec3& rate_rad_s, double dt_s) noexcept;
  const glm::dquat& world_from_head() const noexcept { return world_from_head_; }

 private:
  glm::dquat world_from_head_{1.0, 0.0, 0.0, 0.0};
};

/// Falls silent when the last keep-alive is older than it asked for, as the real one does.
class RiftSim {
 public:
  explicit RiftSim(RiftModel model);
  /// Lets `count` readings (1 ms each) pass while the head turns, and sends one report.
  void step(const glm::dvec3& rate_rad_s, int count);
  bool silent() const noexcept;
  const HeadMotion& motion() const noexcept { return motion_; }
  SimDevice& device() noexcept { return device_; }

 private:
  struct Power {
    std::int64_t now_ms = 0;
    std::int64_t asleep_at_ms = 0;
  };
  RiftModel model_;
  HeadMotion motion_;
  std::shared_ptr<Power> power_ = std::make_shared<Power>();
  SimDevice device_{"simulated Rift"};
};

/// Sends nothing before it was told to stream; answers commands.
class XrealSim {
 public:
  XrealSim();
  void step(const glm::dvec3& rate_rad_s, double dt_s);
  bool streaming() const noexcept { return *streaming_; }
  const HeadMotion& motion() const noexcept { return motion_; }
  SimDevice& device() noexcept { return *device_; }

 private:
  HeadMotion motion_;
  double time_s_ = 0.0;
  std::shared_ptr<bool> streaming_ = std::make_shared<bool>(false);
  std::unique_ptr<SimDevice> device_ = std::make_unique<SimDevice>("simulated XREAL");
};

}  // namespace dubsar
