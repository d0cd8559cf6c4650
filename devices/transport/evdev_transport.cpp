#include "devices/transport/evdev_transport.h"

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <optional>

#include "devices/touch/evdev_event.h"
#include "devices/transport/sysfs.h"
#include "devices/udev_rule.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

static_assert(sizeof(input_event) == kEvdevEventBytes, "events are those of 64-bit Linux");
constexpr int kWordBits = 64;

std::uint16_t hex_attribute(const fs::path& file) {
  return static_cast<std::uint16_t>(hex_number(sysfs_line(file)).value_or(0));
}

/// A bit of a mask as /sys writes it: words in hexadecimal, the lowest one last.
bool has_bit(std::string_view mask, int bit) {
  for (int word = 0; !mask.empty(); ++word) {
    const std::size_t space = mask.rfind(' ');
    const std::string digits(mask.substr(space == std::string_view::npos ? 0 : space + 1));
    if (bit < (word + 1) * kWordBits)
      return (std::strtoull(digits.c_str(), nullptr, 16) >> (bit % kWordBits) & 1U) != 0;
    mask = space == std::string_view::npos ? std::string_view() : mask.substr(0, space);
  }
  return false;
}

EvdevNode describe(int number) {
  EvdevNode node;
  node.path = fmt::format("/dev/input/event{}", number);
  const fs::path device = fs::path(fmt::format("/sys/class/input/event{}", number)) / "device";
  node.name = sysfs_line(device / "name");
  node.vendor_id = hex_attribute(device / "id" / "vendor");
  node.product_id = hex_attribute(device / "id" / "product");
  const std::string axes = sysfs_line(device / "capabilities" / "abs"), properties = sysfs_line(device / "properties");
  node.touch_panel =
      has_bit(properties, INPUT_PROP_DIRECT) && has_bit(axes, ABS_MT_POSITION_X) && has_bit(axes, ABS_MT_POSITION_Y);
  node.slots = has_bit(axes, ABS_MT_SLOT) && has_bit(axes, ABS_MT_TRACKING_ID);
  return node;
}

class EvdevTransport final : public Transport {
 public:
  EvdevTransport(int descriptor, std::string path, UsbId id)
      : descriptor_(descriptor), path_(std::move(path)), id_(id) {}
  ~EvdevTransport() override { ::close(descriptor_); }

  /// After opening, in this order.
  Result<void> begin() {
    const int clock = CLOCK_MONOTONIC;
    static_cast<void>(::ioctl(descriptor_, EVIOCSCLOCKID, &clock));  // else times start elsewhere, which is as good
    input_absinfo slot{};
    if (::ioctl(descriptor_, EVIOCGABS(ABS_MT_SLOT), &slot) < 0) return failed("cannot be asked for its slots", errno);
    const int last = std::clamp(slot.maximum, -1, static_cast<int>(kMostSlots) - 1);
    slots_ = last < 0 ? 0 : static_cast<std::size_t>(last) + 1;
    return hold_if_free();
  }

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    DUBSAR_TRY(check_present());
    pollfd waiting{descriptor_, POLLIN, 0};
    const auto patience = static_cast<int>(std::clamp<std::int64_t>(timeout.count(), 0, 3'600'000));
    if (::poll(&waiting, 1, patience) <= 0) return std::size_t{0};
    if ((waiting.revents & POLLIN) == 0) return lose(ENODEV);
    const ::ssize_t length = ::read(descriptor_, report.data(), report.size() / kEvdevEventBytes * kEvdevEventBytes);
    if (length < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
    if (length <= 0) return lose(length < 0 ? errno : ENODEV);
    if (held_) return static_cast<std::size_t>(length);
    DUBSAR_TRY(hold_if_free());
    return std::size_t{0};
  }

  Result<void> write(std::span<const std::byte>) override {
    return fail(ErrorKind::kUsage, "evdev: {} is only read", path_);
  }

  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    DUBSAR_TRY(check_present());
    DUBSAR_ASSIGN(const EvdevAxis axis, ask(id));
    const std::vector<std::byte> report = format_evdev_axis(id, axis);
    const std::size_t length = std::min(out.size(), report.size());
    std::copy_n(report.begin(), length, out.begin());
    return length;
  }

  UsbId usb_id() const noexcept override { return id_; }
  bool is_hardware() const noexcept override { return true; }

 private:
  Result<EvdevAxis> ask(std::uint8_t code) {
    if (code > ABS_MAX)
      return fail(ErrorKind::kUsage, "evdev: axis {:#x} asked for, expected one of the kernel's", code);
    input_absinfo facts{};
    if (::ioctl(descriptor_, EVIOCGABS(code), &facts) < 0) return failed("does not tell an axis", errno);
    EvdevAxis out{facts.value, facts.minimum, facts.maximum, {}};
    if (code <= ABS_MT_SLOT) return out;
    std::array<std::int32_t, 1 + kMostSlots> values{code};
    if (::ioctl(descriptor_, EVIOCGMTSLOTS(sizeof(std::int32_t) * (1 + slots_)), values.data()) < 0)
      return failed("does not tell its slots", errno);
    out.slots.assign(values.begin() + 1, values.begin() + 1 + static_cast<std::ptrdiff_t>(slots_));
    return out;
  }

  Result<void> hold_if_free() {
    DUBSAR_ASSIGN(const EvdevAxis fingers, ask(ABS_MT_TRACKING_ID));
    if (std::any_of(fingers.slots.begin(), fingers.slots.end(), [](std::int32_t id) { return id >= 0; })) return {};
    if (::ioctl(descriptor_, EVIOCGRAB, 1) < 0) {
      const int error = errno;
      if (error == EBUSY)
        return fail(ErrorKind::kUnavailable, "evdev: another program holds {}; end it, or take its hold away", path_);
      return failed("cannot be held", error);
    }
    held_ = true;
    return {};
  }

  tl::unexpected<Error> failed(std::string_view what, int error) {
    if (error == ENODEV) return lose(error);
    return fail(ErrorKind::kIo, "evdev: {} {}: {}", path_, what, std::strerror(error));
  }
  tl::unexpected<Error> lose(int error) {
    lost_reason_ = fmt::format("evdev: {}: the device is lost: {}", path_, std::strerror(error));
    return tl::unexpected<Error>({ErrorKind::kUnavailable, *lost_reason_});
  }
  Result<void> check_present() const {
    if (lost_reason_) return tl::unexpected<Error>({ErrorKind::kUnavailable, *lost_reason_});
    return {};
  }

  int descriptor_;
  std::string path_;
  UsbId id_;
  std::size_t slots_ = 0;
  bool held_ = false;
  std::optional<std::string> lost_reason_;
};

}  // namespace

std::vector<EvdevNode> list_evdev_nodes() {
  std::vector<int> numbers;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/sys/class/input", error)) {
    const std::string name = entry.path().filename();
    constexpr std::string_view kStem = "event";
    if (!name.starts_with(kStem) || name.size() == kStem.size() || name.size() > kStem.size() + 4 ||
        !std::all_of(name.begin() + kStem.size(), name.end(), [](char c) { return c >= '0' && c <= '9'; }))
      continue;
    numbers.push_back(std::atoi(name.c_str() + kStem.size()));
  }
  std::sort(numbers.begin(), numbers.end());
  std::vector<EvdevNode> out;
  out.reserve(numbers.size());
  for (const int number : numbers) out.push_back(describe(number));
  return out;
}

Result<std::unique_ptr<Transport>> open_evdev(const std::string& path, UsbId id) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    const int error = errno;
    if (error == EACCES || error == EPERM)
      return fail(ErrorKind::kPermission, "evdev: {} may not be opened by this user; {}", path, kUdevRemedy);
    if (error == ENOENT || error == ENODEV || error == ENXIO)
      return fail(ErrorKind::kUnavailable, "evdev: {} is not there", path);
    return fail_errno(error, "evdev: cannot open " + path);
  }
  auto out = std::make_unique<EvdevTransport>(descriptor, path, id);
  DUBSAR_TRY(out->begin());
  return out;
}

}  // namespace dubsar
