#include "input/simulated/simulated_server.h"

#include <array>
#include <thread>

#include "devices/transport/socket_server.h"

namespace dubsar {
namespace {

constexpr milliseconds kTick{2};

/// Everything that the device has to say goes to the client. False: the client has left.
bool pass_on(Transport& device, Transport& client, ServerResult& result) {
  std::array<std::byte, 4096> buffer;
  for (;;) {
    const auto length = device.read(buffer, milliseconds(0));
    if (!length || *length == 0) return length.has_value();
    if (!client.write(std::span(buffer).first(*length))) return false;
    ++result.messages;
  }
}

/// What the client says goes to the device.
bool listen_to(Transport& device, Transport& client) {
  std::array<std::byte, 4096> buffer;
  for (;;) {
    const auto length = client.read(buffer, milliseconds(0));
    if (!length) return false;
    if (*length == 0) return true;
    if (!device.write(std::span(buffer).first(*length))) return false;
  }
}

}  // namespace

Result<ServerResult> serve_simulated(const DriverEntry& driver, const SimulatedFeed& feed,
                                     const std::vector<Option>& where, const Clock& clock,
                                     const std::function<bool()>& over, const std::function<void(int)>& ready) {
  ServerResult result;
  OptionReader options(where, fmt::format("simulate {}", driver.name));
  const auto finished = [&] { return feed.person->finished() || over(); };
  if (driver.bus == Bus::kUdp) {
    const std::string address = options.text("address", "127.0.0.1");
    const auto port = static_cast<std::uint16_t>(options.integer("port", 1, 65535, driver.port));
    DUBSAR_TRY(options.finish());
    DUBSAR_ASSIGN(const auto receiver, open_udp_sender(address, port));
    DUBSAR_ASSIGN(const auto device, feed.device->open());
    if (ready) ready(port);
    for (; !finished(); std::this_thread::sleep_for(kTick)) {
      feed.device->advance(clock.now());
      if (!pass_on(*device, *receiver, result))
        return fail(ErrorKind::kIo, "simulate: cannot send to {} port {}", address, port);
    }
    return result;
  }
  std::unique_ptr<StreamServer> server;
  if (driver.bus == Bus::kTcp) {
    const std::string address = options.text("address", "127.0.0.1");
    const int port = options.integer("port", 0, 65535, driver.port);
    const bool remote = options.flag("remote");
    DUBSAR_TRY(options.finish());
    const auto number = static_cast<std::uint16_t>(port);
    if (driver.calls != nullptr) {
      DUBSAR_ASSIGN(server, listen_tcp_and_calls(address, number, remote, driver.calls));
    } else {
      DUBSAR_ASSIGN(server, listen_tcp(address, number, remote));
    }
  } else if (driver.bus == Bus::kUnixSocket) {
    const std::string path = options.text("socket");
    DUBSAR_TRY(options.finish());
    if (path.empty())
      return fail(ErrorKind::kUsage, "simulate {}: expected the path of the socket to serve", driver.name);
    DUBSAR_ASSIGN(server, listen_unix(path));
  } else {
    return fail(ErrorKind::kUsage, "simulate: {} has no socket; write a recording instead", driver.name);
  }
  if (ready) ready(server->port());
  std::unique_ptr<Transport> client, device;
  for (; !finished(); std::this_thread::sleep_for(kTick)) {
    feed.device->advance(clock.now());
    if (!client && (client = server->accept(milliseconds(0)))) {
      DUBSAR_ASSIGN(device, feed.device->open());
      ++result.clients;
    }
    if (client && (!listen_to(*device, *client) || !pass_on(*device, *client, result))) client.reset();
  }
  return result;
}

}  // namespace dubsar
