#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "devices/camera/webcam.h"

namespace dubsar {
namespace {

namespace fs = std::filesystem;
constexpr std::uint16_t kLeapVendor = 0xf182, kLeapProduct = 0x0003, kUltraleapVendor = 0x2936;

std::uint16_t hex_attribute(const fs::path& file) {
  std::ifstream stream(file);
  std::string text;
  std::getline(stream, text);
  return static_cast<std::uint16_t>(std::strtoul(text.c_str(), nullptr, 16));
}

/// The USB device above a node's interface; not every camera has one.
void read_usb_ids(const std::string& node, DeviceInfo& info) {
  const fs::path usb = fs::path("/sys/class/video4linux") / node / "device" / "..";
  info.vendor_id = hex_attribute(usb / "idVendor");
  info.product_id = hex_attribute(usb / "idProduct");
}

/// What the node says; nothing for one that delivers no pictures (webcams have a second one for metadata).
std::optional<DeviceInfo> ask(const std::string& node) {
  DeviceInfo info;
  info.driver = "webcam";
  info.path = "/dev/" + node;
  info.name = "camera";
  read_usb_ids(node, info);
  const int descriptor = ::open(info.path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    const int error = errno;
    if (error == EACCES || error == EPERM) {
      info.state = DeviceState::kNoPermission;
      info.reason = "this user may not open " + info.path;
      info.remedy = "usermod -aG video $USER and log in again";
    } else if (error == EBUSY) {
      info.state = DeviceState::kBusy;
      info.reason = "another program holds it";
      info.remedy = "end that program (lsof " + info.path + ")";
    } else {
      info.state = DeviceState::kBroken;
      info.reason = info.path + ": " + std::strerror(error);
      info.remedy = "plug the camera in again";
    }
    return info;
  }
  v4l2_capability capability{};
  const bool answered = ::ioctl(descriptor, VIDIOC_QUERYCAP, &capability) == 0;
  ::close(descriptor);
  if (!answered) {
    info.state = DeviceState::kBroken;
    info.reason = info.path + " does not answer as a camera";
    info.remedy = "plug the camera in again";
    return info;
  }
  const std::uint32_t can =
      (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0) return std::nullopt;
  const auto* const card = reinterpret_cast<const char*>(capability.card);
  info.name.assign(card, ::strnlen(card, sizeof capability.card));
  if ((info.vendor_id == kLeapVendor && info.product_id == kLeapProduct) || info.vendor_id == kUltraleapVendor) {
    info.state = DeviceState::kIgnored;
    info.reason = "its infrared pictures show no faces";
    info.remedy = "none needed: the leap driver uses it";
  }
  return info;
}

}  // namespace

std::vector<DeviceInfo> list_cameras() {
  std::vector<int> numbers;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/dev", error)) {
    const std::string name = entry.path().filename();
    if (name.rfind("video", 0) != 0 || name.size() == 5 ||
        !std::all_of(name.begin() + 5, name.end(), [](char c) { return c >= '0' && c <= '9'; }) || name.size() > 9)
      continue;
    numbers.push_back(std::atoi(name.c_str() + 5));
  }
  std::sort(numbers.begin(), numbers.end());
  std::vector<DeviceInfo> cameras;
  for (const int number : numbers)
    if (auto info = ask(fmt::format("video{}", number))) cameras.push_back(*std::move(info));
  return cameras;
}

}  // namespace dubsar
