#pragma once
// What a simulated USB device is to the bus: descriptors, requests, endpoints.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "devices/transport/transport.h"

namespace dubsar::lab {

/// Called in one thread, the bus's.
class UsbGadget {
 public:
  virtual ~UsbGadget() = default;
  virtual std::span<const std::uint8_t> device_descriptor() const = 0;
  virtual std::span<const std::uint8_t> configuration_descriptor() const = 0;
  virtual std::string text(int string_index) const = 0;  ///< ASCII; "": there is no such string

  /// Requests other than those that every device answers alike; an error is a stall.
  virtual Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data) = 0;
  /// What an endpoint to the host has to say now; nothing: not yet.
  virtual std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::byte> data) = 0;
  /// What the host sends to an endpoint; an error is a stall.
  virtual Result<void> receive(std::uint8_t endpoint, std::span<const std::byte> data) = 0;
};

}  // namespace dubsar::lab
