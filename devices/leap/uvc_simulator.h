#pragma once
// A bulk video class camera in memory below the USB transport: requests, probe and commit, payloads, packets,
// plug and unplug. What one kind of camera answers and shows comes from its model. Never chosen unless named.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"
#include "devices/uvc/uvc_descriptors.h"

namespace dubsar {

/// One kind of camera. The simulator calls it with its lock held.
class UvcCameraModel {
 public:
  virtual ~UvcCameraModel() = default;
  virtual std::span<const std::uint8_t> device_descriptor() const = 0;
  virtual std::span<const std::uint8_t> configuration_descriptor() const = 0;
  virtual std::span<const uvc::FrameSize> sizes() const = 0;
  virtual std::uint8_t default_frame() const = 0;   ///< of those sizes, taken where the host asks for none of them
  virtual std::uint32_t payload_bytes() const = 0;  ///< of one payload, its header included
  virtual std::uint8_t stream_interface() const = 0;
  /// A request to a unit or terminal of the control interface; kBadData is a stall.
  virtual Result<std::size_t> unit_request(const ControlRequest& request, std::span<std::byte> data) = 0;
  virtual bool crashed() const { return false; }  ///< the last request made the device fall off the bus
  virtual void commit(const uvc::FrameSize& size) = 0;
  /// Frame number n (from 0) of the committed size.
  virtual void make_frame(std::uint64_t n, std::span<std::byte> frame) = 0;
  virtual void power_on() = 0;  ///< settings are as after plugging in
};

struct UvcSimulatorOptions {
  std::uint64_t frame_limit = 0;  ///< sends no more frames than this; 0: no limit
  bool paced = false;             ///< frames come at the rate of the mode, not as fast as they are read
  /// Of the pace, frames that nobody read in time are left out; null: the steady clock. Outlives the
  /// simulator, any thread.
  const Clock* clock = nullptr;
};

/// Copies share one device, which outlives its transports. Any thread.
class UvcSimulator {
 public:
  UvcSimulator(std::shared_ptr<UvcCameraModel> model, const UvcSimulatorOptions& options);

  /// A class request to one of the interfaces, or the standard request for one of the descriptors; kBadData
  /// is a stall.
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data);
  /// The next bulk transfer, or 0 when there is none now: not streaming, limit reached, or paced and not due.
  /// It ends where the buffer is full or a payload ends with a short packet.
  std::size_t next_transfer(std::span<std::byte> transfer);

  void unplug();
  void plug();
  bool plugged() const;
  /// kUnavailable while unplugged. Lost for good once unplugged.
  Result<std::unique_ptr<Transport>> open();

 protected:
  /// Keeps the model to oneself.
  std::unique_lock<std::mutex> lock() const;

 private:
  struct Device;
  std::shared_ptr<Device> device_;
  friend class UvcSimulatedTransport;
};

}  // namespace dubsar
