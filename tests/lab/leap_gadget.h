#pragma once
// The simulated Leap Motion Controller as a device on the bus.

#include "devices/leap/lmc1_simulator.h"
#include "tests/lab/usb_gadget.h"
#include "tests/lab/usbip_port.h"

namespace dubsar::lab {

class LeapGadget final : public UsbGadget {
 public:
  explicit LeapGadget(Lmc1Simulator simulator) : simulator_(std::move(simulator)) {}
  std::span<const std::uint8_t> device_descriptor() const override { return Lmc1Simulator::device_descriptor(); }
  std::span<const std::uint8_t> configuration_descriptor() const override {
    return Lmc1Simulator::configuration_descriptor();
  }
  std::string text(int string_index) const override {
    return string_index == 1 ? Lmc1Simulator::kManufacturer : string_index == 2 ? Lmc1Simulator::kProduct : "";
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

/// With its connector, and a hand held still over it.
class PluggedLeap {
 public:
  static constexpr glm::dvec3 kPalmM{0.03, 0.3, 0.02};

  Result<void> plug() { return port_.plug(); }
  void unplug() {
    port_.unplug();
    simulator_.unplug();  // it loses its power and with it its settings
    simulator_.plug();
  }
  Lmc1Simulator& simulator() noexcept { return simulator_; }

 private:
  static Lmc1SimulatorOptions hand_above() {
    HandPose pose;
    pose.palm.position_m = kPalmM;
    Lmc1SimulatorOptions options;
    options.paced = true;
    options.hands = [hands = std::vector{pose_hand(pose)}](std::uint64_t) { return hands; };
    return options;
  }
  Lmc1Simulator simulator_{hand_above()};
  LeapGadget gadget_{simulator_};
  UsbipPort port_{gadget_};
};

}  // namespace dubsar::lab
