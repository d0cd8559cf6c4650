#include "devices/looking_glass/bridge_client.h"

#include <nlohmann/json.hpp>

#include "core/base/text/json_text.h"
#include "devices/transport/http_exchange.h"
#include "devices/transport/socket_transport.h"

namespace dubsar {
namespace {
using nlohmann::json;

constexpr const char* kLoopback = "127.0.0.1";
constexpr milliseconds kConnectTimeout{500};
constexpr std::size_t kMaxDevices = 64;

/// object.name.value, when it is a text.
std::string text_of(const json& object, const char* name) {
  if (!object.is_object() || !object.contains(name)) return {};
  const json& field = object.at(name);
  if (!field.is_object() || !field.contains("value") || !field.at("value").is_string()) return {};
  return field.at("value").get<std::string>();
}

/// payload.value of an answer.
Result<json> payload_of(std::string_view text) {
  DUBSAR_ASSIGN(json answer, parse_json(text, "answer of Looking Glass Bridge"));
  if (!answer.is_object() || !answer.contains("payload") || !answer["payload"].is_object() ||
      !answer["payload"].contains("value"))
    return fail(ErrorKind::kBadData, "looking glass bridge: the answer has no payload.value");
  return std::move(answer["payload"]["value"]);
}

Result<std::string> ask(const OpenTransport& open, std::string_view endpoint, const json& body, const Clock& clock,
                        TimestampNs deadline) {
  DUBSAR_ASSIGN(const auto stream, open());
  DUBSAR_ASSIGN(HttpReply reply,
                http_put(*stream, "localhost", endpoint, dump_json(body), clock, deadline - clock.now()));
  if (reply.status != 200)
    return fail(ErrorKind::kBadData, "looking glass bridge: {} was answered with status {}, expected 200", endpoint,
                reply.status);
  return std::move(reply.body);
}

}  // namespace

Result<std::string> parse_bridge_token(std::string_view text) {
  DUBSAR_ASSIGN(const json value, payload_of(text));
  if (!value.is_string() || value.get_ref<const std::string&>().empty())
    return fail(ErrorKind::kBadData, "looking glass bridge: enter_orchestration was answered without a token");
  return value.get<std::string>();
}

Result<std::vector<BridgeDevice>> parse_bridge_devices(std::string_view text) {
  DUBSAR_ASSIGN(const json value, payload_of(text));
  std::vector<BridgeDevice> devices;
  if (value.is_null() || (value.is_string() && value.get_ref<const std::string&>().empty())) return devices;
  if (!value.is_object() || value.size() > kMaxDevices)
    return fail(ErrorKind::kBadData, "looking glass bridge: the list of displays is not an object of at most {}",
                kMaxDevices);
  for (const auto& [index, entry] : value.items()) {
    if (!entry.is_object() || !entry.contains("value") || !entry.at("value").is_object())
      return fail(ErrorKind::kBadData, "looking glass bridge: display \"{}\" has no value", index);
    const json& device = entry.at("value");
    devices.push_back({text_of(device, "hwid"), text_of(device, "hardwareVersion"), text_of(device, "state"),
                       text_of(device, "calibration")});
  }
  return devices;
}

Result<std::vector<BridgeDevice>> read_bridge_devices(const OpenTransport& open, const Clock& clock,
                                                      TimestampNs time_limit) {
  const TimestampNs deadline = clock.now() + time_limit;
  DUBSAR_ASSIGN(const std::string entered, ask(open, "enter_orchestration", {{"name", "dubsar"}}, clock, deadline));
  DUBSAR_ASSIGN(const std::string token, parse_bridge_token(entered));
  const json with_token{{"orchestration", token}};
  DUBSAR_ASSIGN(const std::string listed, ask(open, "available_output_devices", with_token, clock, deadline));
  static_cast<void>(ask(open, "exit_orchestration", with_token, clock, deadline));  // politeness; the answer is here
  return parse_bridge_devices(listed);
}

OpenTransport bridge_opener(std::uint16_t port) {
  return [port] { return open_tcp_stream(kLoopback, port, kConnectTimeout); };
}

}  // namespace dubsar
