#pragma once
// Hands from Ultraleap's tracking service through LeapC: connects, follows devices that come and go, delivers
// the newest frame with its time on our clock.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "devices/leap/leapc_protocol.h"
#include "devices/transport/transport.h"

namespace dubsar::leapc {

struct Options {
  std::string library;  ///< a file; empty: looked for where the vendor puts it
  Mode mode = Mode::kDesktop;
  milliseconds poll{25};          ///< one wait for a message; how long stop() may take
  milliseconds patience{2000};    ///< how long start() waits for the service; 0: it does not wait, nor fail
  milliseconds connecting{1000};  ///< so long a service that has not answered yet may still be about to
  milliseconds reopen{5000};      ///< a connection that stays without service so long is made anew
};

/// Everything the service saw at one moment, in the device's frame (leapc_protocol.h).
struct ServiceFrame {
  TimestampNs time = 0;  ///< when the device measured, on our clock
  std::int64_t number = 0;
  double frames_per_s = 0;
  std::vector<Hand> hands;
};

enum class State {
  kStopped,
  kNoService,  ///< the connection is lost; it comes back by itself
  kNoDevice,   ///< the service runs, no device that works is plugged in
  kTracking,
};

struct Counters {
  std::uint64_t frames = 0;
  std::uint64_t refused = 0;      ///< messages or hands that cannot be
  std::uint64_t errors = 0;       ///< polls that failed
  std::uint64_t connections = 0;  ///< times that the service answered
};

/// start, stop and poll from one thread.
class Connection {
 public:
  virtual ~Connection() = default;  ///< stops

  /// Loads the library, starts one thread and waits at most `patience` for the service. kUnavailable: no
  /// library, or no service; says what to do. A device may be missing (state kNoDevice).
  virtual Result<void> start() = 0;
  virtual void stop() noexcept = 0;

  /// Never waits. True: `newest` is a frame not returned before. `newest` lends its memory: hand in the same
  /// object.
  virtual bool poll(ServiceFrame& newest) = 0;
  virtual State state() const = 0;
  /// Why there are no hands, one sentence; empty while tracking.
  virtual std::string reason() const = 0;
  virtual Counters counters() const = 0;
};

/// `clock` outlives the connection and can be read from any thread.
std::unique_ptr<Connection> make_connection(const Options& options, const Clock& clock);

}  // namespace dubsar::leapc
