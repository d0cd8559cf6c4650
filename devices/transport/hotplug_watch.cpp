#include "devices/transport/hotplug_watch.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "devices/transport/hotplug_bell.h"

namespace dubsar {

Result<HotplugWatch> HotplugWatch::create(std::span<const std::filesystem::path> folders) {
  HotplugWatch watch(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  int error = watch.descriptor_ < 0 ? errno : ENOENT;
  bool any = false;
  for (const auto& folder : folders) {
    if (watch.descriptor_ < 0) break;
    if (::inotify_add_watch(watch.descriptor_, folder.c_str(), IN_CREATE | IN_DELETE | IN_ATTRIB | IN_MOVED_TO) >= 0)
      any = true;
    else
      error = errno;
  }
  if (!any) return fail(ErrorKind::kUnavailable, "hotplug: cannot watch device nodes: {}", std::strerror(error));
  return watch;
}

std::vector<std::filesystem::path> HotplugWatch::device_folders() {
  std::vector<std::filesystem::path> out{"/dev", "/dev/input"};
  std::error_code error;
  for (std::filesystem::directory_iterator bus("/dev/bus/usb", error), end; !error && bus != end; bus.increment(error))
    out.push_back(bus->path());
  return out;
}

std::shared_ptr<HotplugBell> HotplugBell::of_this_machine() {
  auto watch = HotplugWatch::create(HotplugWatch::device_folders());
  return watch ? std::make_shared<HotplugBell>(std::move(*watch)) : std::make_shared<HotplugBell>();
}

HotplugWatch::HotplugWatch(HotplugWatch&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

HotplugWatch& HotplugWatch::operator=(HotplugWatch&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

HotplugWatch::~HotplugWatch() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool HotplugWatch::changed() noexcept {
  bool any = false;
  alignas(inotify_event) char events[4096];
  while (::read(descriptor_, events, sizeof events) > 0) any = true;
  return any;
}

}  // namespace dubsar
