#pragma once
// A simulated kernel for one USB camera: umockdev answers the usbdevfs requests of unmodified libusb from the
// simulated device. Runs with libumockdev-preload (the test declaration sets it).

#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "devices/leap/uvc_simulator.h"
#include "devices/uvc/uvc_descriptors.h"
#include "devices/uvc/uvc_protocol.h"

namespace dubsar {

inline constexpr const char* kNode = "/dev/bus/usb/001/002";
inline constexpr const char* kSysfs = "/sys/devices/pci0000:00/usb1/1-1";

/// The kernel's side of /dev/bus/usb/001/002.
class UsbKernel {
 public:
  explicit UsbKernel(UvcSimulator simulator) : simulator_(std::move(simulator)), bed_(umockdev_testbed_new()) {
    std::array<std::byte, 18> device{};
    std::vector<std::byte> configuration(4096);
    if (!simulator_.control(uvc::kGetDevice, device)) throw std::runtime_error("no device descriptor");
    configuration.resize(simulator_.control(uvc::kGetConfiguration, configuration).value());
    bulk_endpoint_ = uvc::parse_configuration(configuration).value().bulk_endpoint;
    std::string descriptors;
    for (const std::byte byte : device) descriptors += fmt::format("{:02X}", static_cast<int>(byte));
    for (const std::byte byte : configuration) descriptors += fmt::format("{:02X}", static_cast<int>(byte));
    const auto id = [&](std::size_t at) {
      return static_cast<int>(device[at]) | static_cast<int>(device[at + 1]) << 8;
    };
    const std::string text = fmt::format(
        "P: /devices/pci0000:00/usb1/1-1\nN: bus/usb/001/002={0}\nE: DEVNAME=/dev/bus/usb/001/002\nE: "
        "DEVTYPE=usb_device\n"
        "E: SUBSYSTEM=usb\nE: BUSNUM=001\nE: DEVNUM=002\nE: MAJOR=189\nE: MINOR=1\nA: "
        "idVendor={1:04x}\\n\nA: "
        "idProduct={2:04x}\\n\nA: busnum=1\\n\nA: devnum=2\\n\nA: bConfigurationValue=1\\n\nA: "
        "speed=480\\n\nH: "
        "descriptors={0}\n\n",
        descriptors, id(8), id(10));
    GError* error = nullptr;
    if (!umockdev_testbed_add_from_string(bed_, text.c_str(), &error)) throw std::runtime_error(error->message);
    handler_ = umockdev_ioctl_base_new();
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(&UsbKernel::on_ioctl), this);
    if (!umockdev_testbed_attach_ioctl(bed_, kNode, handler_, &error)) throw std::runtime_error(error->message);
  }
  UsbKernel(const UsbKernel&) = delete;
  UsbKernel& operator=(const UsbKernel&) = delete;
  ~UsbKernel() {
    umockdev_testbed_detach_ioctl(bed_, kNode, nullptr);
    g_object_unref(handler_);
    g_object_unref(bed_);
  }

  /// The next bulk requests are refused for want of memory.
  void refuse(int count) { refuse_ = count; }

  void unplug() {
    simulator_.unplug();
    umockdev_testbed_uevent(bed_, kSysfs, "remove");
    umockdev_testbed_remove_device(bed_, kSysfs);
  }

 private:
  struct Urb {
    UMockdevIoctlData* urb;
    UMockdevIoctlData* buffer;
    gulong address;
    usbdevfs_urb& head() const { return *reinterpret_cast<usbdevfs_urb*>(urb->data); }
  };

  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    static_cast<UsbKernel*>(self)->answer(client);
    return TRUE;
  }

  void answer(UMockdevIoctlClient* client) {
    const std::lock_guard lock(mutex_);
    const auto complete = [&](long result, int error) { umockdev_ioctl_client_complete(client, result, error); };
    UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
    switch (static_cast<unsigned>(umockdev_ioctl_client_get_request(client))) {
      case static_cast<unsigned>(USBDEVFS_GET_CAPABILITIES): {
        UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, 4, nullptr);
        std::uint32_t flags =
            USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
        umockdev_ioctl_data_update(data, 0, reinterpret_cast<guint8*>(&flags), 4);
        g_object_unref(data);
        return complete(0, 0);
      }
      case static_cast<unsigned>(USBDEVFS_CLAIMINTERFACE):
      case static_cast<unsigned>(USBDEVFS_RELEASEINTERFACE):
      case static_cast<unsigned>(USBDEVFS_DISCONNECT_CLAIM):
      case static_cast<unsigned>(USBDEVFS_CLEAR_HALT):
        return complete(0, 0);
      case static_cast<unsigned>(USBDEVFS_GETDRIVER):
      case static_cast<unsigned>(USBDEVFS_IOCTL):
        return complete(-1, ENODATA);
      case static_cast<unsigned>(USBDEVFS_SUBMITURB):
        return complete(submit(argument) ? 0 : -1, simulator_.plugged() ? ENOMEM : ENODEV);
      case static_cast<unsigned>(USBDEVFS_REAPURB):
      case static_cast<unsigned>(USBDEVFS_REAPURBNDELAY): {
        fill_bulk();
        if (done_.empty()) {
          if (!simulator_.plugged()) return complete(-1, ENODEV);
          return complete(-1, EAGAIN);
        }
        const Urb urb = done_.front();
        done_.pop_front();
        UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr);
        umockdev_ioctl_data_set_ptr(data, 0, urb.urb);
        g_object_unref(data);
        return complete(0, 0);
      }
      case static_cast<unsigned>(USBDEVFS_DISCARDURB): {
        gulong address = 0;
        std::memcpy(&address, argument->data, sizeof address);
        for (auto it = waiting_.begin(); it != waiting_.end(); ++it)
          if (it->address == address) {
            finish(*it, -ENOENT, 0);
            waiting_.erase(it);
            return complete(0, 0);
          }
        return complete(-1, EINVAL);
      }
      default:
        return complete(-1, ENOTTY);
    }
  }

  bool submit(UMockdevIoctlData* argument) {
    if (!simulator_.plugged()) return false;
    Urb urb{};
    urb.urb = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
    urb.address = urb.urb->client_addr;
    if (urb.head().type == USBDEVFS_URB_TYPE_BULK && refuse_ > 0) {
      --refuse_;
      return false;
    }
    const int length = urb.head().buffer_length;
    if (length > 0)
      urb.buffer =
          umockdev_ioctl_data_resolve(urb.urb, offsetof(usbdevfs_urb, buffer), static_cast<gsize>(length), nullptr);
    if (urb.head().type != USBDEVFS_URB_TYPE_CONTROL) {
      if (urb.head().endpoint == bulk_endpoint_)
        waiting_.push_back(urb);
      else
        finish(urb, -EPIPE, 0);
      return true;
    }
    std::uint8_t* setup = urb.buffer->data;
    const auto u16 = [&](int at) { return static_cast<std::uint16_t>(setup[at] | setup[at + 1] << 8); };
    const ControlRequest request{setup[0], setup[1], u16(2), u16(4)};
    const auto moved =
        simulator_.control(request, std::as_writable_bytes(std::span(setup + 8, static_cast<std::size_t>(u16(6)))));
    finish(urb, moved ? 0 : -EPIPE, moved ? static_cast<int>(*moved) : 0);
    return true;
  }

  void fill_bulk() {
    while (done_.empty() && !waiting_.empty()) {
      const Urb urb = waiting_.front();
      if (!simulator_.plugged()) {
        finish(urb, -ESHUTDOWN, 0);
        waiting_.pop_front();
        continue;
      }
      const std::size_t length = simulator_.next_transfer(
          std::as_writable_bytes(std::span(urb.buffer->data, static_cast<std::size_t>(urb.head().buffer_length))));
      if (length == 0) return;
      finish(urb, 0, static_cast<int>(length));
      waiting_.pop_front();
    }
  }

  void finish(const Urb& urb, int status, int length) {
    urb.head().status = status;
    urb.head().actual_length = length;
    done_.push_back(urb);
  }

  UvcSimulator simulator_;
  std::uint8_t bulk_endpoint_ = 0;
  UMockdevTestbed* bed_;
  UMockdevIoctlBase* handler_ = nullptr;
  std::atomic<int> refuse_{0};
  std::mutex mutex_;
  std::deque<Urb> waiting_, done_;
};

template <class Condition>
bool eventually(const Condition& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < until) {
    if (condition()) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return condition();
}

class OverLibusb : public testing::Test {
 protected:
  void SetUp() override {
    const char* preload = std::getenv("LD_PRELOAD");
    if (preload == nullptr || std::string_view(preload).find("libumockdev-preload") == std::string_view::npos)
      GTEST_SKIP() << "needs LD_PRELOAD=libumockdev-preload.so.0 (ctest sets it)";
  }
};

}  // namespace dubsar
