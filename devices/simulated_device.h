#pragma once
// Devices without hardware: a person acts, and the device says what a real one would, as bytes below the transport
// seam. Named or never taken.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/numbers/pose.h"
#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// What a person's hand does to the cap of a SpaceMouse: -1..1 each, screen axes.
struct CapDeflection {
  glm::dvec3 push{0.0}, twist{0.0};
  bool operator==(const CapDeflection&) const = default;
};

/// A hand as an infrared camera sees it.
struct ShownHand {
  Pose palm;  ///< screen frame
  double grab = 0.0, pinch_m = 0.06;
  bool left = false;
};

/// Somebody before the display, for simulated devices to look at. One thread, that which reads the device.
class SimulatedPerson {
 public:
  virtual ~SimulatedPerson() = default;
  /// Lets the person act up to `now`, which never falls, from the first call on; true: there is something new to see.
  virtual bool act(TimestampNs now) = 0;
  /// How often a device should look.
  virtual TimestampNs period_ns() const = 0;

  /// When that was which is seen now: a device's latency ago.
  virtual TimestampNs time() const = 0;
  /// Of the hand that holds a SpaceMouse; nothing: it is not to be seen.
  virtual CapDeflection cap() const = 0;
  /// Between the eyes, facing along the screen's axis; nothing while an eye is not seen.
  virtual std::optional<Pose> head() const = 0;
  /// Turns head axes so that -Z points to the panel's centre.
  virtual glm::dquat gaze() const = 0;
  virtual std::vector<ShownHand> hands() const = 0;

  bool finished() const noexcept { return *ended_; }
  std::shared_ptr<const std::atomic<bool>> ended() const noexcept { return ended_; }

 protected:
  void end() noexcept { *ended_ = true; }

 private:
  std::shared_ptr<std::atomic<bool>> ended_ = std::make_shared<std::atomic<bool>>(false);
};

class SimulatedDevice {
 public:
  virtual ~SimulatedDevice() = default;
  /// Lets the person act up to `now` and the device say what it has to say by then.
  virtual void advance(TimestampNs now) = 0;
  /// The host's end of the device. What is said while it is closed is lost.
  virtual Result<std::unique_ptr<Transport>> open() = 0;
};

/// What a simulated device is made of.
struct Simulation {
  std::shared_ptr<SimulatedPerson> person;
  Pose screen_from_device{};     ///< where the device stands
  std::uint64_t seed = 1;        ///< of its noise
  const Clock* clock = nullptr;  ///< outlives it; may be read in any thread
};

/// A device that looks at its person again and again.
class PacedDevice : public SimulatedDevice {
 public:
  void advance(TimestampNs now) override {
    if (!next_) next_ = now;
    next_ = std::max(*next_, now - kMostBehindNs);
    for (; *next_ <= now; *next_ += step_) {
      const bool fresh = person_->act(*next_);
      say(*person_, fresh);
    }
  }

 protected:
  explicit PacedDevice(const Simulation& simulation, TimestampNs step_ns = 0)
      : person_(simulation.person), step_(step_ns > 0 ? step_ns : person_->period_ns()) {}
  /// `fresh`: as of SimulatedPerson::act().
  virtual void say(const SimulatedPerson& person, bool fresh) = 0;

 private:
  static constexpr TimestampNs kMostBehindNs = 1'000'000'000;
  std::shared_ptr<SimulatedPerson> person_;
  TimestampNs step_;
  std::optional<TimestampNs> next_;
};

}  // namespace dubsar
