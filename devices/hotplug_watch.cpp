#include "devices/hotplug_watch.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace dubsar {

Result<HotplugWatch> HotplugWatch::create(const std::filesystem::path& folder) {
  HotplugWatch watch(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (watch.descriptor_ < 0 ||
      ::inotify_add_watch(watch.descriptor_, folder.c_str(), IN_CREATE | IN_DELETE | IN_ATTRIB | IN_MOVED_TO) < 0)
    return fail(ErrorKind::kUnavailable, "hotplug: cannot watch {}: {}", folder.string(), std::strerror(errno));
  return watch;
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
