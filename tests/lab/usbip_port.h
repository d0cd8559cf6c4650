#pragma once
// Plugs a simulated USB device into the kernel it runs on: the far end of a USB/IP connection (vhci-hcd) is
// this process instead of another machine. Protocol: Documentation/usb/usbip_protocol.rst of the Linux
// kernel.

#include <array>
#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <thread>
#include <vector>

#include "tests/lab/usb_gadget.h"

namespace dubsar::lab {

/// A high-speed device. One thread while plugged.
class UsbipPort {
 public:
  explicit UsbipPort(UsbGadget& gadget) : gadget_(gadget) {}
  ~UsbipPort() { unplug(); }
  UsbipPort(const UsbipPort&) = delete;
  UsbipPort& operator=(const UsbipPort&) = delete;

  /// kUnavailable: no vhci_hcd, or none of its ports is free. The kernel enumerates the device afterwards.
  Result<void> plug();
  void unplug();

 private:
  static constexpr std::size_t kHeaderBytes = 48;
  using Header = std::array<std::byte, kHeaderBytes>;
  struct Waiting {
    std::uint32_t number;
    std::uint8_t endpoint;
    std::vector<std::byte> data;
  };

  void run();
  bool take_request();
  bool answer_control(std::uint32_t number, const Header& header, std::vector<std::byte>& data);
  Result<std::size_t> standard_request(const ControlRequest& request, std::span<std::byte> data);
  bool serve_waiting(bool& served);
  bool reply(std::uint32_t number, int status, std::size_t moved, std::span<const std::byte> data);
  bool receive_all(std::span<std::byte> bytes);
  bool send_all(std::span<const std::byte> bytes);

  UsbGadget& gadget_;
  int socket_ = -1;
  std::thread thread_;
  std::list<Waiting> waiting_;  // the thread's: transfers to the host that have nothing to carry yet
  std::uint8_t configuration_ = 0;
};

}  // namespace dubsar::lab
