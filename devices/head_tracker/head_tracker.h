#pragma once
// Head trackers behind one interface, whatever their wire.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/registry.h"
#include "devices/driver.h"
#include "devices/head_tracker/head_sample.h"
#include "devices/transport/transport.h"

namespace dubsar {

class HeadTracker {
 public:
  virtual ~HeadTracker() = default;
  /// The newest sample since the last call; waits at most `timeout` for one. One thread.
  virtual std::optional<HeadSample> poll(TimestampNs now, milliseconds timeout = milliseconds(0)) = 0;
  virtual bool connected() const noexcept = 0;
  virtual const std::string& reason() const noexcept = 0;  ///< why there is no device; empty while there is one
  /// One sentence about a tracker that is open: what it was taken for, or why nothing comes of it; else empty.
  virtual std::string note() const = 0;
  virtual const DriverCounts& counts() const noexcept = 0;
  virtual void wake() noexcept = 0;  ///< a device node has appeared
  virtual void
  recentre() noexcept = 0;  ///< the present heading is "straight on", where the tracker has no absolute one
};

struct HeadTrackerConfig {
  OpenTransport open;             ///< how the device is reached
  std::array<bool, 6> invert{};   ///< opentrack: x, y, z, yaw, pitch, roll
  std::string sender;             ///< opentrack: "opentrack", "xrlinux"; empty: told by the datagrams' length
  std::string tracker;            ///< vrpn: name of the tracker, empty: the first
  int sensor = 0;                 ///< vrpn
  const Clock* stamps = nullptr;  ///< as of Driver
};

using HeadTrackerBackend = Backend<HeadTracker, HeadTrackerConfig>;

/// Gives where the head looks, but not where it is.
constexpr bool is_orientation_only(std::string_view tracker) noexcept {
  return tracker == "rift" || tracker == "xreal";
}

/// opentrack, vrpn, rift, xreal.
std::span<const HeadTrackerBackend> head_tracker_backends() noexcept;

}  // namespace dubsar
