#pragma once
// Calibrations from the maker's own service, Looking Glass Bridge 2, where it runs: JSON by HTTP PUT on this
// machine. Facts: Looking-Glass/bridge.js (the requests and the shape of their answers).

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

inline constexpr std::uint16_t kBridgePort = 33334;

struct BridgeDevice {
  std::string id;           ///< "LKG-P00671"; what the service calls hwid
  std::string hardware;     ///< "portrait", "go_p", ...
  std::string state;        ///< "ok" when it can be used
  std::string calibration;  ///< JSON text as in visual.json; empty for ordinary monitors
};

/// The token in the answer to enter_orchestration. kBadData: it is not there.
Result<std::string> parse_bridge_token(std::string_view json);

/// The displays in the answer to available_output_devices, in the service's order, ordinary monitors too.
Result<std::vector<BridgeDevice>> parse_bridge_devices(std::string_view json);

/// Asks the service. Each of the three requests has a stream of its own from `open`. kUnavailable: nobody
/// listens, or no answer within `time_limit` in all; kBadData: another service answers there. Blocks.
Result<std::vector<BridgeDevice>> read_bridge_devices(const OpenTransport& open, const Clock& clock,
                                                      TimestampNs time_limit = 2'000'000'000);

/// Opens streams to the service on this machine, and only on this one.
OpenTransport bridge_opener(std::uint16_t port = kBridgePort);

}  // namespace dubsar
