#include "input/simulated/simulated_server.h"

#include <array>
#include <thread>

#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/vrpn_server.h"
#include "devices/transport/socket_server.h"

namespace dubsar {
namespace {

constexpr milliseconds kTick{2};

/// Everything that the device has to say goes to the client. False: the client has left.
bool pass_on(Transport& device, Transport& client, LiveWireResult& result) {
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

Result<LiveWireResult> serve_live_wire(SimulatedDevice& person, const DeviceSpec& choice, const Clock& clock,
                                       const std::function<bool()>& over, const std::function<void(int)>& ready) {
  LiveWireResult result;
  const auto port = [&](std::uint16_t usual) {
    return choice.port == 0 ? usual : static_cast<std::uint16_t>(choice.port);
  };
  if (choice.driver == "opentrack") {
    DUBSAR_ASSIGN(const auto receiver, open_udp_sender(choice.address, port(kOpentrackPort)));
    DUBSAR_ASSIGN(const auto device, person.open());
    if (ready) ready(port(kOpentrackPort));
    for (; !person.finished() && !over(); std::this_thread::sleep_for(kTick)) {
      person.advance(clock.now());
      if (!pass_on(*device, *receiver, result))
        return fail(ErrorKind::kIo, "simulate: cannot send to {} port {}", choice.address, port(kOpentrackPort));
    }
    return result;
  }
  std::unique_ptr<StreamServer> server;
  if (choice.driver == "vrpn") {
    DUBSAR_ASSIGN(server, listen_tcp_and_calls(choice.address, choice.port < 0 ? std::uint16_t{0} : port(kVrpnPort),
                                               choice.allow_remote, parse_vrpn_call));
  } else if (choice.driver == "spacenav") {
    if (choice.socket.empty())
      return fail(ErrorKind::kUsage, "simulate spacenav: expected the path of the socket to serve");
    DUBSAR_ASSIGN(server, listen_unix(choice.socket));
  } else {
    return fail(ErrorKind::kUsage, "simulate: {} has no socket; write a recording instead", choice.driver);
  }
  if (ready) ready(server->port());
  std::unique_ptr<Transport> client, device;
  for (; !person.finished() && !over(); std::this_thread::sleep_for(kTick)) {
    person.advance(clock.now());
    if (!client && (client = server->accept(milliseconds(0)))) {
      DUBSAR_ASSIGN(device, person.open());
      ++result.clients;
    }
    if (client && (!listen_to(*device, *client) || !pass_on(*device, *client, result))) client.reset();
  }
  return result;
}

}  // namespace dubsar
