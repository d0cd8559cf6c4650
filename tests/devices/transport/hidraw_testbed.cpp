#include "tests/devices/transport/hidraw_testbed.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace dubsar {
namespace {

constexpr const char* kUsb = "/devices/pci0000:00/usb1/1-1";

std::vector<std::byte> bytes_of(const guint8* data, std::size_t size) {
  const auto* const first = reinterpret_cast<const std::byte*>(data);
  return {first, first + size};
}

}  // namespace

/// Sysfs folder of the HID device; every plugging makes a new one, as the kernel does.
std::string HidrawTestbed::hid_folder() const {
  return fmt::format("{}/1-1:1.0/0003:{:04X}:{:04X}.{:04X}", kUsb, identity_.vendor, identity_.product, plugging_ + 1);
}

std::string HidrawTestbed::description() const {
  const std::string usb = kUsb, hid = hid_folder();
  const std::string usb_number = fmt::format("{:03}", plugging_ + 2), node = fmt::format("hidraw{}", plugging_);
  std::string descriptor;
  for (const std::uint8_t byte : identity_.descriptor) descriptor += fmt::format("{:02X}", byte);
  return "P: " + usb + "\nN: bus/usb/001/" + usb_number + "\nE: DEVNAME=/dev/bus/usb/001/" + usb_number +
         "\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nE: BUSNUM=001\nE: DEVNUM=" + usb_number +
         fmt::format(
             "\nA: idVendor={:04x}\\n\nA: idProduct={:04x}\\n\nA: manufacturer={}\\n\nA: product={}\\n\nA: "
             "serial={}\\n\n",
             identity_.vendor, identity_.product, identity_.manufacturer, identity_.name, identity_.serial) +
         "A: bcdDevice=0100\\n\nA: busnum=1\\n\nA: devnum=2\\n\n\n"
         "P: " +
         usb +
         "/1-1:1.0\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\nA: bInterfaceNumber=00\\n\n\n"
         "P: " +
         hid +
         fmt::format(
             "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:{:08X}:{:08X}\nE: HID_NAME={} {}\nE: HID_PHYS=usb-1/input0\nE: "
             "HID_UNIQ={}\n",
             identity_.vendor, identity_.product, identity_.manufacturer, identity_.name, identity_.serial) +
         "H: report_descriptor=" + descriptor +
         "\n\n"
         "P: " +
         hid + "/hidraw/" + node + "\nN: " + node + "\nE: DEVNAME=/dev/" + node +
         "\nE: SUBSYSTEM=hidraw\nE: MAJOR=240\nE: MINOR=" + std::to_string(plugging_) +
         "\nA: dev=240:" + std::to_string(plugging_) + "\\n\nL: device=../../../" + hid.substr(hid.rfind('/') + 1) +
         "\n\n";
}

HidrawTestbed::HidrawTestbed(HidIdentity identity)
    : identity_(std::move(identity)), testbed_(umockdev_testbed_new()), handler_(umockdev_ioctl_base_new()) {
  g_signal_connect(handler_, "handle-ioctl", reinterpret_cast<GCallback>(on_ioctl), this);
  g_signal_connect(handler_, "handle-write", reinterpret_cast<GCallback>(on_write), this);
}

HidrawTestbed::~HidrawTestbed() {
  unplug();
  g_object_unref(handler_);
  g_object_unref(testbed_);
}

void HidrawTestbed::plug() {
  GError* error = nullptr;
  ++plugging_;
  if (!umockdev_testbed_add_from_string(testbed_, description().c_str(), &error))
    throw std::runtime_error(error->message);
  if (!umockdev_testbed_attach_ioctl(testbed_, node().c_str(), handler_, &error))
    throw std::runtime_error(error->message);
  attached_ = true;
  const std::string real = node_in_testbed();
  ::unlink(real.c_str());
  if (::mkfifo(real.c_str(), 0666) != 0) throw std::runtime_error("mkfifo");
  fifo_ = ::open(real.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fifo_ < 0 || ::fcntl(fifo_, F_SETFL, O_RDWR | O_NONBLOCK | O_DIRECT) != 0)
    throw std::runtime_error("packet FIFO");
}

void HidrawTestbed::unplug() {
  if (fifo_ < 0) return;
  ::close(fifo_);
  fifo_ = -1;
  if (attached_) umockdev_testbed_detach_ioctl(testbed_, node().c_str(), nullptr);
  attached_ = false;
  // leaves first: removing a parent alone leaves its children's links in /sys/bus behind
  const std::string usb = std::string("/sys") + kUsb, hid = "/sys" + hid_folder();
  const std::string leaf = fmt::format("{}/hidraw/hidraw{}", hid, plugging_);
  umockdev_testbed_uevent(testbed_, leaf.c_str(), "remove");
  for (const std::string& path : {leaf, hid, usb + "/1-1:1.0", usb})
    umockdev_testbed_remove_device(testbed_, path.c_str());
  ::unlink(node_in_testbed().c_str());
}

bool HidrawTestbed::send(std::span<const std::byte> report) {
  return ::write(fifo_, report.data(), report.size()) == static_cast<::ssize_t>(report.size());
}

std::vector<std::vector<std::byte>> HidrawTestbed::written() {
  const std::lock_guard lock(mutex_);
  return written_;
}

std::vector<std::vector<std::byte>> HidrawTestbed::features_set() {
  const std::lock_guard lock(mutex_);
  return features_set_;
}

std::string HidrawTestbed::node() const { return fmt::format("/dev/hidraw{}", plugging_); }

std::string HidrawTestbed::node_in_testbed() const {
  char* const root = umockdev_testbed_get_root_dir(testbed_);
  const std::string path = root + this->node();
  g_free(root);
  return path;
}

gboolean HidrawTestbed::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self_pointer) {
  auto* const self = static_cast<HidrawTestbed*>(self_pointer);
  const gulong request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
  const std::size_t size = _IOC_SIZE(request);
  GError* error = nullptr;
  if (_IOC_TYPE(request) != 'H') return FALSE;
  const auto answer = [&](const void* data, std::size_t bytes, glong result) {
    UMockdevIoctlData* const memory = umockdev_ioctl_data_resolve(argument, 0, bytes, &error);
    umockdev_ioctl_data_update(memory, 0, static_cast<guint8*>(const_cast<void*>(data)), static_cast<gint>(bytes));
    g_object_unref(memory);
    umockdev_ioctl_client_complete(client, result, 0);
    return TRUE;
  };
  if (request == HIDIOCGRDESCSIZE) {
    const int bytes = static_cast<int>(self->identity_.descriptor.size());
    return answer(&bytes, sizeof bytes, 0);
  }
  if (request == HIDIOCGRDESC) {
    hidraw_report_descriptor descriptor{};
    descriptor.size = static_cast<__u32>(self->identity_.descriptor.size());
    std::copy(self->identity_.descriptor.begin(), self->identity_.descriptor.end(), descriptor.value);
    return answer(&descriptor, sizeof descriptor, 0);
  }
  if (_IOC_NR(request) == 6 || _IOC_NR(request) == 7) {  // set and get feature
    UMockdevIoctlData* const memory = umockdev_ioctl_data_resolve(argument, 0, size, &error);
    std::vector<std::byte> bytes = bytes_of(memory->data, size);
    g_object_unref(memory);
    if (_IOC_NR(request) == 6) {
      {
        const std::lock_guard lock(self->mutex_);
        self->features_set_.push_back(bytes);
      }
      if (self->answer_) self->answer_(bytes);
      umockdev_ioctl_client_complete(client, static_cast<glong>(size), 0);
      return TRUE;
    }
    for (std::size_t i = 1; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(0xA0 + i);
    return answer(bytes.data(), bytes.size(), static_cast<glong>(bytes.size()));
  }
  umockdev_ioctl_client_complete(client, -1, ENOTTY);
  return TRUE;
}

gboolean HidrawTestbed::on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self_pointer) {
  auto* const self = static_cast<HidrawTestbed*>(self_pointer);
  UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
  const auto size = static_cast<std::size_t>(argument->data_len);
  {
    const std::lock_guard lock(self->mutex_);
    self->written_.push_back(bytes_of(argument->data, size));
  }
  umockdev_ioctl_client_complete(client, static_cast<glong>(size), 0);
  return TRUE;
}

}  // namespace dubsar
