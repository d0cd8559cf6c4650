#include "app/kiosk/service_notify.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>

namespace dubsar::app {

ServiceNotify::ServiceNotify(std::string_view socket, std::int64_t watchdog_us) : address_(socket) {
  if (address_.size() < 2 || address_.size() >= sizeof(sockaddr_un::sun_path) ||
      (address_[0] != '/' && address_[0] != '@'))
    return;
  descriptor_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  every_ = watchdog_us > 0 ? watchdog_us * 1000 / 3 : 0;
}

ServiceNotify::~ServiceNotify() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ServiceNotify::alive(TimestampNs now) {
  if (every_ == 0 || (said_ >= 0 && now - said_ < every_ && now >= said_)) return;
  said_ = now;
  send("WATCHDOG=1");
}

void ServiceNotify::status(std::string_view words) {
  std::string text = "STATUS=";
  for (const char c : words) text += c == '\n' ? ' ' : c;
  send(text);
}

void ServiceNotify::send(std::string_view text) {
  if (descriptor_ < 0) return;
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  std::memcpy(to.sun_path, address_.data(), address_.size());
  if (address_[0] == '@') to.sun_path[0] = '\0';
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  // A manager that is gone or busy is no reason not to show a picture.
  static_cast<void>(
      ::sendto(descriptor_, text.data(), text.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to), length));
}

}  // namespace dubsar::app
