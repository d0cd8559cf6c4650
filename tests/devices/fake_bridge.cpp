#include "tests/devices/fake_bridge.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace dubsar::test {
namespace {
using nlohmann::json;

constexpr const char* kToken = "{0c8b2a1e-token}";

json typed(const char* type, const json& value) { return {{"type", type}, {"value", value}}; }

std::string reply_body(const char* name, const json& payload) {
  return json{{"name", name}, {"status", typed("COMPLETION", "Completion")}, {"payload", payload}}.dump();
}

bool readable(int descriptor, int stop) {
  std::array<pollfd, 2> waits{pollfd{descriptor, POLLIN, 0}, pollfd{stop, POLLIN, 0}};
  return ::poll(waits.data(), waits.size(), 10'000) > 0 && waits[1].revents == 0;
}

}  // namespace

FakeBridge::FakeBridge(const std::vector<FakeBridgeDevice>& devices, BridgeManners manners) : manners_(manners) {
  json list = json::object();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const json device{{"calibration", typed("CSTRING", devices[i].calibration)},
                      {"defaultQuilt", typed("CSTRING", "{}")},
                      {"hardwareVersion", typed("CSTRING", devices[i].hardware)},
                      {"hwid", typed("CSTRING", devices[i].id)},
                      {"index", typed("INT", i)},
                      {"state", typed("CSTRING", "ok")},
                      {"windowCoords", typed("IVEC2", {{"x", 0}, {"y", 0}})}};
    list[std::to_string(i)] = typed("VARIANT_MAP", device);
  }
  bodies_["enter_orchestration"] = reply_body("enter_orchestration", typed("CSTRING", kToken));
  bodies_["available_output_devices"] = reply_body("available_output_devices", typed("VARIANT_MAP", list));
  bodies_["exit_orchestration"] = reply_body("exit_orchestration", typed("CSTRING", kToken));

  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, generic, length) != 0 || ::listen(listener_, 4) != 0 ||
      ::getsockname(listener_, generic, &length) != 0 || ::pipe(stop_) != 0)
    std::abort();
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

FakeBridge::~FakeBridge() {
  ::close(stop_[1]);
  thread_.join();
  ::close(stop_[0]);
  ::close(listener_);
}

std::vector<std::string> FakeBridge::asked() const {
  const std::lock_guard lock(mutex_);
  return asked_;
}

void FakeBridge::serve() {
  while (readable(listener_, stop_[0])) {
    const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) return;
    answer(connection);
    ::close(connection);
  }
}

void FakeBridge::answer(int connection) {
  std::string request;
  std::size_t head_end = std::string::npos, need = 0;
  while (head_end == std::string::npos || request.size() < need) {
    std::array<char, 4096> piece;
    if (!readable(connection, stop_[0])) return;
    const ssize_t length = ::recv(connection, piece.data(), piece.size(), 0);
    if (length <= 0) return;
    request.append(piece.data(), static_cast<std::size_t>(length));
    head_end = request.find("\r\n\r\n");
    const std::size_t at = request.find("Content-Length: ");
    if (head_end != std::string::npos && at != std::string::npos)
      need = head_end + 4 + std::strtoul(request.c_str() + at + 16, nullptr, 10);
  }
  const std::string endpoint = request.starts_with("PUT /") ? request.substr(5, request.find(' ', 5) - 5) : "";
  {
    const std::lock_guard lock(mutex_);
    asked_.push_back(endpoint);
  }
  if (manners_.silent) {
    static_cast<void>(readable(connection, stop_[0]));  // until the asker gives up
    return;
  }
  const json body = json::parse(request.substr(head_end + 4), nullptr, false);
  const bool allowed =
      endpoint == "enter_orchestration" ? body.contains("name") : body.value("orchestration", "") == kToken;
  const auto found = bodies_.find(endpoint);
  const int status = found == bodies_.end() ? 404 : allowed ? 200 : 400;
  const std::string text = status == 200 ? found->second : "{}";
  std::string reply = fmt::format("HTTP/1.1 {} X\r\nContent-Type: application/json\r\n", status);
  if (manners_.chunked) {
    reply += "Transfer-Encoding: chunked\r\n\r\n";
    for (std::size_t from = 0; from < text.size(); from += 100) {
      const std::string piece = text.substr(from, 100);
      reply += fmt::format("{:x}\r\n{}\r\n", piece.size(), piece);
    }
    reply += "0\r\n\r\n";
  } else {
    reply += manners_.until_close ? "\r\n" + text : fmt::format("Content-Length: {}\r\n\r\n{}", text.size(), text);
  }
  if (manners_.cut_short) reply.resize(reply.size() - text.size() / 2);
  static_cast<void>(::send(connection, reply.data(), reply.size(), MSG_NOSIGNAL));
}

}  // namespace dubsar::test
