#pragma once
// The simulated XREAL Air glasses as a device on the bus: the inertial reports are those of HID interface 3,
// among others that are not ours.

#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include "devices/head_tracker/imu_sim.h"
#include "tests/lab/usb_gadget.h"

namespace dubsar::lab {

class XrealGadget final : public UsbGadget {
 public:
  static constexpr std::uint16_t kAir = 0x0424;
  static constexpr int kInertialInterface = 3, kControlInterface = 4;
  static constexpr const char* kName = "XREAL Air";

  static constexpr milliseconds kPeriod{2};  ///< of the reports

  /// The head turns at `rate_rad_s` about its own axes during the first reports after switching on, then it
  /// is still.
  XrealGadget(const glm::dvec3& rate_rad_s, int turning_reports);
  void switch_off();  ///< between two pluggings

  std::span<const std::uint8_t> device_descriptor() const override;
  std::span<const std::uint8_t> configuration_descriptor() const override { return configuration_; }
  std::string text(int string_index) const override {
    return string_index == 1 ? "XREAL" : string_index == 2 ? kName : "";
  }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data) override;
  std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::byte> data) override;
  Result<void> receive(std::uint8_t endpoint, std::span<const std::byte> data) override;

 private:
  glm::dvec3 rate_rad_s_;
  int turning_reports_, reports_ = 0;
  std::chrono::steady_clock::time_point due_{};
  std::vector<std::uint8_t> configuration_;
  std::unique_ptr<XrealSim> glasses_;
  std::unique_ptr<Transport> wire_;
};

}  // namespace dubsar::lab
