#include "tests/lab/usbip_port.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace dubsar::lab {
namespace {

constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4;
constexpr int kHighSpeed = 3;
constexpr int kPorts = 15;  // of a bus, as Debian's kernel is built
constexpr std::size_t kMaxTransferBytes = std::size_t{1} << 20;

/// Numbers of the protocol are big-endian.
std::uint32_t number_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}
void put_number(std::span<std::byte> bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::byte>(value >> (24 - 8 * i) & 0xFFU);
}

std::size_t copy_some(std::span<const std::uint8_t> from, std::span<std::byte> to) {
  const std::size_t length = std::min(from.size(), to.size());
  std::memcpy(to.data(), from.data(), length);
  return length;
}

}  // namespace

Result<void> UsbipPort::plug() {
  unplug();
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail_errno(errno, "usbip: cannot make a connection");
  bool attached = false;
  for (int port = 0; port < kPorts && !attached; ++port) {
    std::ofstream file("/sys/devices/platform/vhci_hcd.0/attach");
    file << fmt::format("{} {} {} {}", port, ends[1], 0x10002, kHighSpeed) << std::flush;
    attached = file.good();
  }
  ::close(ends[1]);  // the kernel holds it now
  socket_ = ends[0];
  if (!attached) {
    unplug();
    return fail(ErrorKind::kUnavailable, "usbip: no free port in /sys/devices/platform/vhci_hcd.0");
  }
  thread_ = std::thread([this] { run(); });
  return {};
}

void UsbipPort::unplug() {
  if (socket_ < 0) return;
  ::shutdown(socket_, SHUT_RDWR);
  if (thread_.joinable()) thread_.join();
  ::close(socket_);
  socket_ = -1;
  waiting_.clear();
  configuration_ = 0;
}

void UsbipPort::run() {
  bool served = false;
  for (;;) {
    pollfd wait{socket_, POLLIN, 0};
    const int timeout = waiting_.empty() ? -1 : served ? 0 : 1;
    if (::poll(&wait, 1, timeout) > 0 && !take_request()) return;
    if (!serve_waiting(served)) return;
  }
}

bool UsbipPort::take_request() {
  Header header;
  if (!receive_all(header)) return false;
  const std::uint32_t number = number_at(header, 4);
  if (number_at(header, 0) == kUnlink) {
    const std::uint32_t victim = number_at(header, 20);
    const bool found = std::erase_if(waiting_, [&](const Waiting& w) { return w.number == victim; }) > 0;
    Header answer{};
    put_number(answer, 0, kUnlinked);
    put_number(answer, 4, number);
    put_number(answer, 20, static_cast<std::uint32_t>(found ? -ECONNRESET : 0));
    return send_all(answer);
  }
  if (number_at(header, 0) != kSubmit) return false;
  const bool to_host = number_at(header, 12) == 1;
  const auto endpoint = static_cast<std::uint8_t>(number_at(header, 16));
  const std::size_t length = number_at(header, 24);
  if (length > kMaxTransferBytes) return false;
  std::vector<std::byte> data(length);
  if (!to_host && !receive_all(data)) return false;
  if (endpoint == 0) return answer_control(number, header, data);
  if (to_host) {
    waiting_.push_back({number, static_cast<std::uint8_t>(0x80U | endpoint), std::move(data)});
    return true;
  }
  const bool taken = gadget_.receive(endpoint, data).has_value();
  return reply(number, taken ? 0 : -EPIPE, taken ? length : 0, {});
}

bool UsbipPort::answer_control(std::uint32_t number, const Header& header, std::vector<std::byte>& data) {
  const auto setup = [&](std::size_t i) { return std::to_integer<unsigned>(header[40 + i]); };
  const ControlRequest request{static_cast<std::uint8_t>(setup(0)), static_cast<std::uint8_t>(setup(1)),
                               static_cast<std::uint16_t>(setup(2) | setup(3) << 8),
                               static_cast<std::uint16_t>(setup(4) | setup(5) << 8)};
  const auto moved = standard_request(request, data);
  if (!moved) return reply(number, -EPIPE, 0, {});
  const std::size_t length = std::min(*moved, data.size());
  return reply(number, 0, length, request.to_host() ? std::span(data).first(length) : std::span<std::byte>());
}

/// USB 2.0, table 9-3; all else is the gadget's.
Result<std::size_t> UsbipPort::standard_request(const ControlRequest& request, std::span<std::byte> data) {
  constexpr std::uint8_t kGetStatus = 0, kClearFeature = 1, kGetDescriptor = 6, kGetConfiguration = 8,
                         kSetConfiguration = 9, kSetInterface = 11;
  const unsigned kind = request.request_type & 0x60U, recipient = request.request_type & 0x1FU;
  if (kind != 0) return gadget_.control(request, data);
  if (request.to_host() && request.request == kGetDescriptor && recipient == 0) {
    const int index = request.value & 0xFF;
    switch (request.value >> 8) {
      case 1:
        return copy_some(gadget_.device_descriptor(), data);
      case 2:
        return copy_some(gadget_.configuration_descriptor(), data);
      case 3: {
        std::vector<std::uint8_t> bytes{4, 3, 0x09, 0x04};  // the languages: English only
        if (index != 0) {
          const std::string text = gadget_.text(index);
          if (text.empty()) return fail(ErrorKind::kBadData, "usb: no string {}", index);
          bytes = {static_cast<std::uint8_t>(2 + 2 * text.size()), 3};
          for (const char c : text) bytes.insert(bytes.end(), {static_cast<std::uint8_t>(c), 0});
        }
        return copy_some(bytes, data);
      }
      default:
        return fail(ErrorKind::kBadData, "usb: no descriptor {:#06x}", request.value);
    }
  }
  if (request.to_host() && request.request == kGetStatus) {
    std::fill(data.begin(), data.end(), std::byte{0});
    return std::min<std::size_t>(2, data.size());
  }
  if (request.to_host() && request.request == kGetConfiguration && !data.empty()) {
    data[0] = std::byte{configuration_};
    return 1U;
  }
  if (!request.to_host() && request.request == kSetConfiguration && recipient == 0) {
    configuration_ = static_cast<std::uint8_t>(request.value);
    return 0U;
  }
  if (!request.to_host() && (request.request == kClearFeature || request.request == kSetInterface)) return 0U;
  return gadget_.control(request, data);
}

/// At most one transfer of each endpoint, in the order in which they were asked for.
bool UsbipPort::serve_waiting(bool& served) {
  served = false;
  std::array<bool, 256> silent{};
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    if (silent[it->endpoint]) {
      ++it;
      continue;
    }
    silent[it->endpoint] = true;
    const auto length = gadget_.send(it->endpoint, it->data);
    if (!length) {
      ++it;
      continue;
    }
    served = true;
    if (!reply(it->number, 0, *length, std::span(it->data).first(*length))) return false;
    it = waiting_.erase(it);
  }
  return true;
}

bool UsbipPort::reply(std::uint32_t number, int status, std::size_t moved, std::span<const std::byte> data) {
  Header header{};
  put_number(header, 0, kSubmitted);
  put_number(header, 4, number);
  put_number(header, 20, static_cast<std::uint32_t>(status));
  put_number(header, 24, static_cast<std::uint32_t>(moved));
  return send_all(header) && send_all(data);
}

bool UsbipPort::receive_all(std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ::ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return true;
}

bool UsbipPort::send_all(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ::ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace dubsar::lab
