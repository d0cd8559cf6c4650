#pragma once
// A simulated HID device plugged into the kernel it runs on (/dev/uhid): hidraw, hidapi and everything above
// them see a real one.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "devices/transport/transport.h"

namespace dubsar::lab {

struct HidIdentity {
  std::uint16_t vendor_id = 0, product_id = 0;
  std::string name, serial;
  std::span<const std::uint8_t> report_descriptor;
};

/// Bridges a simulator to /dev/uhid: what the simulator sends become input reports; output and feature
/// reports from the host become write(), set_feature() and get_feature() of the simulator's transport.
///
/// One thread per plugged device. It also calls `live` every `period`: simulators are moved there, and
/// nowhere else.
class UhidDevice {
 public:
  UhidDevice(HidIdentity identity, OpenTransport simulator, std::function<void()> live, milliseconds period);
  ~UhidDevice() { unplug(); }
  UhidDevice(const UhidDevice&) = delete;
  UhidDevice& operator=(const UhidDevice&) = delete;

  /// kPermission or kUnavailable: there is no /dev/uhid for us. The hidraw node comes a little later.
  Result<void> plug();
  void unplug();

 private:
  void run(Transport& simulator);
  bool answer(Transport& simulator);

  HidIdentity identity_;
  OpenTransport open_simulator_;
  std::function<void()> live_;
  milliseconds period_;
  int uhid_ = -1;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace dubsar::lab
