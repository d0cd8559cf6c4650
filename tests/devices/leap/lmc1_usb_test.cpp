// The real libusb code path on a simulated kernel: umockdev answers the usbdevfs requests of unmodified libusb from the
// simulated device. Runs with libumockdev-preload (the test declaration sets it).

#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "devices/leap/lmc1_driver.h"
#include "devices/leap/lmc1_simulator.h"
#include "devices/usb/usb_transport.h"

namespace dubsar {
namespace {

using std::chrono::steady_clock;
constexpr const char* kNode = "/dev/bus/usb/001/002";
constexpr const char* kSysfs = "/sys/devices/pci0000:00/usb1/1-1";

/// The kernel's side of /dev/bus/usb/001/002.
class UsbKernel {
 public:
  explicit UsbKernel(Lmc1Simulator simulator) : simulator_(std::move(simulator)), bed_(umockdev_testbed_new()) {
    std::string descriptors;
    for (const auto part : {Lmc1Simulator::device_descriptor(), Lmc1Simulator::configuration_descriptor()})
      for (const std::uint8_t byte : part) descriptors += fmt::format("{:02X}", byte);
    const std::string text = fmt::format(
        "P: /devices/pci0000:00/usb1/1-1\nN: bus/usb/001/002={0}\nE: DEVNAME=/dev/bus/usb/001/002\nE: DEVTYPE=usb_device\n"
        "E: SUBSYSTEM=usb\nE: BUSNUM=001\nE: DEVNUM=002\nE: MAJOR=189\nE: MINOR=1\nA: idVendor=f182\\n\nA: "
        "idProduct=0003\\n\nA: busnum=1\\n\nA: devnum=2\\n\nA: bConfigurationValue=1\\n\nA: speed=480\\n\nH: "
        "descriptors={0}\n\n",
        descriptors);
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
        return complete(submit(argument) ? 0 : -1, simulator_.plugged() ? 0 : ENODEV);
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
    const int length = urb.head().buffer_length;
    if (length > 0)
      urb.buffer = umockdev_ioctl_data_resolve(urb.urb, offsetof(usbdevfs_urb, buffer), static_cast<gsize>(length), nullptr);
    if (urb.head().type != USBDEVFS_URB_TYPE_CONTROL) {
      if (urb.head().endpoint == lmc1::kBulkEndpoint)
        waiting_.push_back(urb);
      else
        finish(urb, -EPIPE, 0);
      return true;
    }
    std::uint8_t* setup = urb.buffer->data;
    const auto u16 = [&](int at) { return static_cast<std::uint16_t>(setup[at] | setup[at + 1] << 8); };
    const ControlRequest request{setup[0], setup[1], u16(2), u16(4)};
    const auto moved = simulator_.control(
        request, std::as_writable_bytes(std::span(setup + 8, static_cast<std::size_t>(u16(6)))));
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

  Lmc1Simulator simulator_;
  UMockdevTestbed* bed_;
  UMockdevIoctlBase* handler_ = nullptr;
  std::mutex mutex_;
  std::deque<Urb> waiting_, done_;
};

UsbOpenOptions leap_options() {
  UsbOpenOptions options;
  options.interfaces = {lmc1::kControlInterface, lmc1::kStreamInterface};
  options.read_endpoint = lmc1::kBulkEndpoint;
  options.transfer_bytes = lmc1::kMaxTransferBytes;
  return options;
}

template <class Condition>
bool eventually(const Condition& condition) {
  const auto until = steady_clock::now() + std::chrono::seconds(20);
  while (steady_clock::now() < until) {
    if (condition()) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return condition();
}

class Lmc1OverLibusb : public testing::Test {
 protected:
  void SetUp() override {
    const char* preload = std::getenv("LD_PRELOAD");
    if (preload == nullptr || std::string_view(preload).find("libumockdev-preload") == std::string_view::npos)
      GTEST_SKIP() << "needs LD_PRELOAD=libumockdev-preload.so.0 (ctest sets it)";
  }
};

TEST_F(Lmc1OverLibusb, IsListedReadCalibratedAndStreamedUntilItIsUnplugged) {
  Lmc1SimulatorOptions device;
  device.hands = [](std::uint64_t n) {
    HandPose pose;
    pose.palm.position_m = {0.001 * static_cast<double>(n), 0.25, 0.0};
    return std::vector{pose_hand(pose)};
  };
  device.paced = true;
  Lmc1Simulator simulator(device);
  UsbKernel kernel(simulator);

  const auto listed = list_usb_devices();
  ASSERT_TRUE(listed) << listed.error().message;
  ASSERT_EQ(listed->size(), 1U);
  EXPECT_EQ(listed->front().vendor_id, lmc1::kVendorId);
  EXPECT_EQ(listed->front().path, "usb:001/002");
  EXPECT_TRUE(listed->front().accessible);

  SteadyClock clock;
  Lmc1Options options;
  options.calibration_settle = milliseconds(0);
  auto driver = make_lmc1_driver(
      [&] { return open_usb_transport(lmc1::kVendorId, lmc1::kProductId, leap_options(), listed->front().path); }, options,
      clock);
  const auto started = driver->start();
  ASSERT_TRUE(started) << started.error().message;
  EXPECT_EQ(driver->calibration(), device.calibration);
  EXPECT_TRUE(simulator.led_on(lmc1::Switch::kLedRight));

  ASSERT_TRUE(eventually([&] { return driver->counters().frames >= 20; })) << driver->reason();
  EXPECT_EQ(driver->counters().dropped_frames, 0U);
  Frame frame;
  ASSERT_TRUE(driver->poll(frame));
  HandRenderer renderer(device.calibration, HandRenderOptions{});
  std::vector<std::uint8_t> left(640 * 240), right(640 * 240);
  renderer.render(device.hands(frame.sequence - 1), device.seed + frame.sequence - 1, left, right);
  EXPECT_TRUE(std::equal(left.begin(), left.end() - 6, frame.view(0).begin()));
  EXPECT_TRUE(std::equal(right.begin(), right.end() - 6, frame.view(1).begin()));

  kernel.unplug();
  EXPECT_TRUE(eventually([&] { return driver->state() == FrameSourceState::kLost; }));
  driver->stop();
  const auto after = list_usb_devices();
  ASSERT_TRUE(after);
  EXPECT_TRUE(after->empty());
  EXPECT_EQ(driver->start().error().kind, ErrorKind::kNoInput);
}

TEST_F(Lmc1OverLibusb, AStalledRequestIsBadDataAndTheDeviceStaysUsable) {
  Lmc1Simulator simulator(Lmc1SimulatorOptions{});
  UsbKernel kernel(simulator);
  auto transport = open_usb_transport(lmc1::kVendorId, lmc1::kProductId, leap_options());
  ASSERT_TRUE(transport) << transport.error().message;
  std::array<std::byte, 2> data{};
  const auto stalled = (*transport)->control(lmc1::get_current(9, 1), data, milliseconds(500));
  ASSERT_FALSE(stalled);
  EXPECT_EQ(stalled.error().kind, ErrorKind::kBadData);
  EXPECT_EQ((*transport)->control(lmc1::get_current(5, 7), data, milliseconds(500)), std::size_t{2});
  EXPECT_EQ((*transport)->read(data, milliseconds(5)), std::size_t{0});  // not streaming: nothing comes
}

}  // namespace
}  // namespace dubsar
