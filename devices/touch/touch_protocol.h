#pragma once
// Contacts of a touch panel out of the events of its kernel device (multi-touch, type B: slots). Facts:
// Documentation/input/multi-touch-protocol.rst of the kernel.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "devices/touch/evdev_event.h"
#include "devices/touch/touch_sample.h"
#include "devices/transport/device_timeline.h"
#include "devices/transport/transport.h"

namespace dubsar {

/// What is known of each slot: slots keep what is not said again, also from one finger to the next. One thread.
class TouchSlots {
 public:
  /// All axes of a panel, as they are now.
  struct State {
    EvdevAxis slot, id, x, y;
    std::optional<EvdevAxis> tool;  ///< none: the panel does not tell palms
  };

  TouchSlots() = default;
  /// kBadData: axes without a range, slots that do not agree. Fingers that are on the glass now are nobody's until they
  /// are lifted. `turn_deg`: 0, 90, 180 or 270, how far the panel's axes are turned clockwise against the picture.
  static Result<TouchSlots> create(const State& state, int turn_deg);
  /// After events were lost: fingers that are still there stay who they are. kBadData as create().
  Result<void> renew(const State& state);

  void take(const EvdevEvent& event) noexcept;  ///< of an axis
  /// The fingers that count, at a report. One that turns into a palm is cancelled and does not come back; after more
  /// than kMostTouches at once nothing counts until the glass is free.
  TouchFrame frame(TimestampNs time);

 private:
  struct Slot {
    std::int32_t tracking_id = -1, x = 0, y = 0, tool = 0;
    std::uint32_t contact = 0;  ///< grows with every finger
    bool ignored = false;
  };
  static Result<void> check(const State& state);
  void track(Slot& slot, std::int32_t id) noexcept;

  std::vector<Slot> slots_;
  std::array<std::int32_t, 4> range_{};  // of x, then of y
  std::int64_t current_ = 0;
  std::uint32_t contacts_ = 0;
  int turn_deg_ = 0;
  bool blob_ = false;
  std::vector<std::uint32_t> told_;  // fingers of the last frame
};

/// For Driver. After a loss of events (SYN_DROPPED) what comes is passed over up to the next report and until the
/// device was asked how its slots stand, which happens with the next poll.
class TouchProtocol {
 public:
  using Sample = TouchSample;
  static constexpr std::size_t kMostFrames = 256;  ///< that nobody has taken yet; then the oldest goes

  explicit TouchProtocol(int turn_deg = 0) : turn_deg_(turn_deg) {}
  Result<void> start(Transport& transport, TimestampNs now);
  Result<void> keep_up(Transport& transport, TimestampNs now);
  bool accept(std::span<const std::byte> bytes, TimestampNs now);
  std::optional<Sample> newest();

 private:
  enum class Loss { kNone, kUntilReport, kAsks };
  void add(TouchFrame frame);

  int turn_deg_;
  TouchSlots slots_;
  Loss loss_ = Loss::kNone;
  DeviceTimeline timeline_;
  std::vector<TouchFrame> frames_;
  std::vector<TouchContact> last_;
};

}  // namespace dubsar
