#pragma once
// A device in memory: the far end of a Transport, for simulators and tests. Never chosen unless named.

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "devices/transport/transport.h"

namespace dubsar {

/// What a simulated device does when the host talks to it. Called without locks held, in the host's thread.
struct SimBehaviour {
  std::function<Result<void>(std::span<const std::byte>)> on_write;
  std::function<Result<std::vector<std::byte>>(std::uint8_t id)> on_get_feature;
  std::function<Result<void>(std::span<const std::byte>)> on_set_feature;
  /// To the host: `data` is filled and the byte count returned; to the device: `data` is what was sent.
  std::function<Result<std::size_t>(const ControlRequest&, std::span<std::byte> data)> on_control;
};

/// The device side, which outlives plugging. Any thread.
class SimDevice {
 public:
  /// `messages` false: the transport is a byte stream, one read may return several pieces.
  explicit SimDevice(std::string name, bool messages = true, UsbId id = {});
  ~SimDevice();

  void set_behaviour(SimBehaviour behaviour);

  /// Queues one report for the host; dropped while unplugged or closed. At most kMaxQueued wait, the oldest goes first.
  void send(std::span<const std::byte> report);
  static constexpr std::size_t kMaxQueued = 4096;

  void unplug();  ///< open transports are lost for good, and nothing can be opened
  void plug();
  bool plugged() const;
  int open_count() const;  ///< transports alive now

  /// kUnavailable while unplugged. The transport may outlive the SimDevice, and is lost then.
  Result<std::unique_ptr<Transport>> open();

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace dubsar
