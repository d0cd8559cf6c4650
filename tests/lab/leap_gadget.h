#pragma once
// The simulated Leap Motion Controller as a device on the bus.

#include "devices/leap/lmc1_simulator.h"
#include "tests/lab/usb_gadget.h"

namespace dubsar::lab {

class LeapGadget final : public UsbGadget {
 public:
  explicit LeapGadget(Lmc1Simulator simulator) : simulator_(std::move(simulator)) {}
  std::span<const std::uint8_t> device_descriptor() const override {
    return Lmc1Simulator::device_descriptor();
  }
  std::span<const std::uint8_t> configuration_descriptor() const override {
    return Lmc1Simulator::configuration_descriptor();
  }
  std::string text(int string_index) const override {
    return string_index == 1   ? Lmc1Simulator::kManufacturer
           : string_index == 2 ? Lmc1Simulator::kProduct
                               : "";
  }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data) override {
    return simulator_.control(request, data);
  }
  std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::byte> data) override {
    if (endpoint != lmc1::kBulkEndpoint) return std::nullopt;  // the interrupt endpoint never says anything
    const std::size_t length = simulator_.next_transfer(data);
    return length == 0 ? std::nullopt : std::optional(length);
  }
  Result<void> receive(std::uint8_t, std::span<const std::byte>) override {
    return fail(ErrorKind::kBadData, "leap simulator: it has no endpoint to write to");
  }

 private:
  Lmc1Simulator simulator_;
};

}  // namespace dubsar::lab
