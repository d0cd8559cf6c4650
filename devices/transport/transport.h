#pragma once
// Transport: bytes to and from one device, whether it is real, recorded, replayed, simulated or faulty. Protocols above
// it know only bytes; makers below it know only descriptors (hid_transport.h, socket_transport.h, ...).

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/base/result.h"

namespace dubsar {

using std::chrono::milliseconds;

/// No report, control answer or bulk block is longer.
inline constexpr std::size_t kMaxReportBytes = std::size_t{1} << 20;

/// One USB control request (USB 2.0 section 9.3); bit 7 of `request_type` set: device to host.
struct ControlRequest {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  bool operator==(const ControlRequest&) const = default;
  bool to_host() const noexcept { return (request_type & 0x80U) != 0; }
};

/// Who made a device and which of his products it is, as USB and HID tell it; zeros where nobody says.
struct UsbId {
  std::uint16_t vendor = 0, product = 0;
  bool operator==(const UsbId&) const = default;
};

/// What came and was not handed on, because it is nothing that the protocol above could read.
struct DroppedInput {
  std::uint64_t count = 0;
  std::size_t last_bytes = 0;  ///< length of the last one
};

/// One open device, used by one thread at a time.
///
/// Errors of every call: kUnavailable means that the device is lost (unplugged, the peer has closed, the recording is
/// at its end), and then every later call says so too: drop the object and open it again (see Reconnector). kBadData
/// and kIo concern this one call. What the device cannot do at all (features of a socket) is kUsage.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Waits for one report, datagram or bulk block at most `timeout` (0: only looks; at most 1 h) and returns its
  /// length, or 0 when none came. Stream transports return some bytes instead. A longer report is cut to the buffer, so
  /// give one byte more than the longest valid one.
  virtual Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) = 0;

  /// Sends one report; for HID its first byte is the report number, 0 where the device has none.
  virtual Result<void> write(std::span<const std::byte> report) = 0;

  /// Reads feature report `id` into `out` (its first byte is the id) and returns its length.
  virtual Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out);

  /// Sends a feature report; its first byte is the id.
  virtual Result<void> set_feature(std::span<const std::byte> report);

  /// For protocols whose bytes mean different things on different models.
  virtual UsbId usb_id() const noexcept { return {}; }
  /// Since it was opened.
  virtual DroppedInput dropped() const noexcept { return {}; }
  /// Hardware at the other end, which needs the pauses that hardware needs.
  virtual bool is_hardware() const noexcept { return false; }

  /// USB control transfer: `data` is filled (to host) or sent (to device). Returns the bytes moved. kBadData: the
  /// device stalled the request.
  virtual Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout);
};

/// Opens a device again and again, for Reconnector and the registries of drivers.
using OpenTransport = std::function<Result<std::unique_ptr<Transport>>()>;

}  // namespace dubsar
