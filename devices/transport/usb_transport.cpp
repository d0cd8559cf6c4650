#include "devices/transport/usb_transport.h"

#include <libusb.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>

#include "devices/uvc/uvc_descriptors.h"

namespace dubsar {
namespace {

using std::chrono::steady_clock;

struct ContextDeleter {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
};
using Context = std::unique_ptr<libusb_context, ContextDeleter>;

Result<Context> make_context() {
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context); error != 0)
    return fail(ErrorKind::kUnavailable, "usb: libusb cannot start: {}", libusb_strerror(error));
  return Context(context);
}

class DeviceList {
 public:
  explicit DeviceList(libusb_context* context) { count_ = libusb_get_device_list(context, &devices_); }
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;
  ~DeviceList() {
    if (devices_ != nullptr) libusb_free_device_list(devices_, 1);
  }
  std::span<libusb_device* const> devices() const {
    return {devices_, static_cast<std::size_t>(std::max<ssize_t>(count_, 0))};
  }

 private:
  libusb_device** devices_ = nullptr;
  ssize_t count_ = 0;
};

UsbDevice describe(libusb_device* device) {
  UsbDevice found;
  libusb_device_descriptor descriptor{};
  if (libusb_get_device_descriptor(device, &descriptor) == 0) {
    found.vendor_id = descriptor.idVendor;
    found.product_id = descriptor.idProduct;
  }
  found.bus = libusb_get_bus_number(device);
  found.address = libusb_get_device_address(device);
  found.path = fmt::format("usb:{:03}/{:03}", found.bus, found.address);
  found.node = fmt::format("/dev/bus/usb/{:03}/{:03}", found.bus, found.address);
  found.accessible = ::access(found.node.c_str(), R_OK | W_OK) == 0;
  return found;
}

class UsbTransport final : public Transport {
 public:
  UsbTransport(Context context, libusb_device_handle* handle, std::string name, UsbOpenOptions options)
      : context_(std::move(context)), handle_(handle), name_(std::move(name)), options_(std::move(options)) {}

  ~UsbTransport() override {
    for (const auto& slot : slots_)
      if (slot->in_flight) libusb_cancel_transfer(slot->transfer);
    // A cancelled transfer must come back before it may be freed; a lost device gives them all back at once.
    const auto give_up = steady_clock::now() + std::chrono::seconds(2);
    while (any_in_flight() && steady_clock::now() < give_up) (void)handle_events(milliseconds(20));
    for (auto& slot : slots_) {
      if (slot->in_flight)
        (void)slot.release();  // libusb may still write to it: better leaked than freed
      else
        libusb_free_transfer(slot->transfer);
    }
    // Backwards: a kernel driver that gets the first interface again looks for the others at once (uvcvideo).
    for (auto it = claimed_.rbegin(); it != claimed_.rend(); ++it) libusb_release_interface(handle_, *it);
    libusb_close(handle_);
  }

  /// Takes interfaces and endpoint from the device's own description.
  Result<void> find_camera() {
    DUBSAR_ASSIGN(const uvc::VideoFunction camera, uvc::read_camera(*this));
    options_.interfaces = {camera.control_interface, camera.stream_interface};
    options_.read_endpoint = camera.bulk_endpoint;
    return {};
  }

  Result<void> claim() {
    libusb_set_auto_detach_kernel_driver(handle_, 1);
    for (const int interface : options_.interfaces) {
      const int error = libusb_claim_interface(handle_, interface);
      if (error == LIBUSB_ERROR_BUSY)
        return fail(ErrorKind::kUnavailable,
                    "usb: interface {} of {} is in use by another program: stop it (for a Leap "
                    "Motion that is leapd) and try again",
                    interface, name_);
      if (error != 0)
        return fail(ErrorKind::kIo, "usb: cannot claim interface {} of {}: {}", interface, name_,
                    libusb_strerror(error));
      claimed_.push_back(interface);
    }
    return {};
  }

  bool is_hardware() const noexcept override { return true; }
  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    if (options_.read_endpoint == 0)
      return fail(ErrorKind::kUsage, "usb: {} was opened without an endpoint to read", name_);
    if (slots_.empty()) DUBSAR_TRY(start_reading());
    DUBSAR_TRY(submit_idle());
    const auto until = steady_clock::now() + timeout;
    while (done_.empty()) {
      if (lost_) return lost();
      const auto left = std::chrono::duration_cast<milliseconds>(until - steady_clock::now());
      DUBSAR_TRY(handle_events(std::max(left, milliseconds(0))));
      if (done_.empty() && !lost_ && steady_clock::now() >= until) return 0U;
    }
    Slot& slot = *done_.front();
    done_.pop_front();
    const libusb_transfer_status status = slot.transfer->status;
    const auto length = std::min(report.size(), static_cast<std::size_t>(std::max(slot.transfer->actual_length, 0)));
    if (status == LIBUSB_TRANSFER_COMPLETED) std::memcpy(report.data(), slot.buffer.data(), length);
    if (status == LIBUSB_TRANSFER_NO_DEVICE || status == LIBUSB_TRANSFER_CANCELLED) lost_ = true;
    if (lost_) return lost();
    if (status == LIBUSB_TRANSFER_STALL) libusb_clear_halt(handle_, options_.read_endpoint);
    idle_.push_back(&slot);  // asked for more at once, and if that is refused, by the next read
    if (const auto asked = submit_idle(); !asked && lost_) return lost();
    if (status != LIBUSB_TRANSFER_COMPLETED)
      return fail(ErrorKind::kIo, "usb: a transfer from {} failed (libusb status {})", name_, static_cast<int>(status));
    return length;
  }

  Result<void> write(std::span<const std::byte>) override {
    return fail(ErrorKind::kUsage, "usb: {} has no endpoint to write to", name_);
  }

  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    if (lost_) return lost();
    if (data.size() > 4096)
      return fail(ErrorKind::kUsage, "usb: control transfer of {} bytes, at most 4096", data.size());
    const int moved =
        libusb_control_transfer(handle_, request.request_type, request.request, request.value, request.index,
                                reinterpret_cast<unsigned char*>(data.data()), static_cast<std::uint16_t>(data.size()),
                                static_cast<unsigned>(std::max<std::int64_t>(timeout.count(), 1)));
    if (moved >= 0) return static_cast<std::size_t>(moved);
    if (moved == LIBUSB_ERROR_NO_DEVICE) {
      lost_ = true;
      return lost();
    }
    if (moved == LIBUSB_ERROR_PIPE)
      return fail(ErrorKind::kBadData, "usb: {} refused control request {:#04x} value {:#06x} index {:#06x}", name_,
                  request.request, request.value, request.index);
    return fail(ErrorKind::kIo, "usb: control request {:#04x} to {} failed: {}", request.request, name_,
                libusb_strerror(moved));
  }

 private:
  struct Slot {
    UsbTransport* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    std::vector<unsigned char> buffer;
    bool in_flight = false;
  };

  static void LIBUSB_CALL finished(libusb_transfer* transfer) {
    auto* slot = static_cast<Slot*>(transfer->user_data);
    slot->in_flight = false;
    slot->owner->done_.push_back(slot);
  }

  int submit(Slot& slot) {
    const int error = libusb_submit_transfer(slot.transfer);
    slot.in_flight = error == 0;
    return error;
  }

  /// Asks for data with all buffers that wait for nothing. An error only while none of them is on its way.
  Result<void> submit_idle() {
    for (std::size_t waiting = idle_.size(); waiting > 0; --waiting) {
      Slot& slot = *idle_.front();
      const int error = submit(slot);
      if (error == LIBUSB_ERROR_NO_DEVICE) {
        lost_ = true;
        return tl::unexpected<Error>(lost().error());
      }
      if (error != 0) {
        if (any_in_flight() || !done_.empty()) return {};
        return fail(ErrorKind::kIo, "usb: cannot ask {} for data: {}", name_, libusb_strerror(error));
      }
      idle_.pop_front();
    }
    return {};
  }

  Result<void> start_reading() {
    for (int i = 0; i < options_.transfers_in_flight; ++i) {
      auto slot = std::make_unique<Slot>();
      slot->owner = this;
      slot->buffer.resize(options_.transfer_bytes);
      slot->transfer = libusb_alloc_transfer(0);
      if (slot->transfer == nullptr) return fail(ErrorKind::kTryAgain, "usb: out of memory for transfers");
      libusb_fill_bulk_transfer(slot->transfer, handle_, options_.read_endpoint, slot->buffer.data(),
                                static_cast<int>(slot->buffer.size()), &UsbTransport::finished, slot.get(), 0);
      idle_.push_back(slot.get());
      slots_.push_back(std::move(slot));
    }
    return {};
  }

  Result<void> handle_events(milliseconds timeout) {
    timeval wait{timeout.count() / 1000, (timeout.count() % 1000) * 1000};
    const int error = libusb_handle_events_timeout_completed(context_.get(), &wait, nullptr);
    if (error != 0 && error != LIBUSB_ERROR_INTERRUPTED)
      return fail(ErrorKind::kIo, "usb: waiting for {} failed: {}", name_, libusb_strerror(error));
    return {};
  }

  bool any_in_flight() const {
    return std::any_of(slots_.begin(), slots_.end(), [](const auto& slot) { return slot->in_flight; });
  }
  Result<std::size_t> lost() const { return fail(ErrorKind::kUnavailable, "usb: {} is gone (unplugged?)", name_); }

  Context context_;
  libusb_device_handle* handle_;
  std::string name_;
  UsbOpenOptions options_;
  std::vector<int> claimed_;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::deque<Slot*> done_;  // in the order in which they came back
  std::deque<Slot*> idle_;  // neither on their way nor done
  bool lost_ = false;
};

}  // namespace

Result<std::vector<UsbDevice>> list_usb_devices() {
  DUBSAR_ASSIGN(const Context context, make_context());
  const DeviceList list(context.get());
  std::vector<UsbDevice> found;
  for (libusb_device* device : list.devices()) found.push_back(describe(device));
  std::sort(found.begin(), found.end(), [](const UsbDevice& a, const UsbDevice& b) {
    return std::pair(a.bus, a.address) < std::pair(b.bus, b.address);
  });
  return found;
}

Result<std::unique_ptr<Transport>> open_usb_transport(std::uint16_t vendor_id, std::uint16_t product_id,
                                                      const UsbOpenOptions& options, const std::string& path) {
  DUBSAR_ASSIGN(Context context, make_context());
  libusb_device_handle* handle = nullptr;
  std::string name;
  {
    const DeviceList list(context.get());
    for (libusb_device* device : list.devices()) {
      const UsbDevice found = describe(device);
      if (found.vendor_id != vendor_id || found.product_id != product_id) continue;
      if (!path.empty() && path != found.path) continue;
      name = fmt::format("{:04x}:{:04x} at {}", vendor_id, product_id, found.node);
      const int error = libusb_open(device, &handle);
      if (error == LIBUSB_ERROR_ACCESS)
        return fail(ErrorKind::kPermission,
                    "usb: not allowed to open {}: put the line {} into "
                    "/etc/udev/rules.d/70-dubsar.rules and plug the device in again",
                    name, usb_udev_rule(vendor_id, product_id));
      if (error != 0) return fail(ErrorKind::kIo, "usb: cannot open {}: {}", name, libusb_strerror(error));
      break;
    }
  }
  if (handle == nullptr)
    return fail(ErrorKind::kNoInput, "usb: no device {:04x}:{:04x} {} is plugged in", vendor_id, product_id,
                path.empty() ? std::string("of any path") : "at " + path);
  auto transport = std::make_unique<UsbTransport>(std::move(context), handle, std::move(name), options);
  if (options.camera) DUBSAR_TRY(transport->find_camera());
  DUBSAR_TRY(transport->claim());
  return transport;
}

std::string usb_udev_rule(std::uint16_t vendor_id, std::uint16_t product_id) {
  return fmt::format(
      "SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{:04x}\", ATTR{{idProduct}}==\"{:04x}\", TAG+=\"uaccess\"", vendor_id,
      product_id);
}

}  // namespace dubsar
