#pragma once
// A device as an input source: its reader runs on one thread, or in poll() where time is simulated.

#include <functional>
#include <memory>
#include <string>

#include "devices/transport/transport.h"
#include "input/input_source.h"

namespace dubsar {

/// Reads one device into an InputFrame. One thread at a time.
class SourceReader {
 public:
  virtual ~SourceReader() = default;
  /// Waits at most `timeout` for the device, opening it when that is due; true when `frame` (poses of the
  /// last time, no events, no touches) got something new. Its times are those of the session's clock.
  virtual bool read(TimestampNs now, milliseconds timeout, InputFrame& frame) = 0;
  virtual bool connected() const = 0;
  virtual std::string reason() const = 0;          ///< why it is not connected
  virtual void wake() = 0;                         ///< a device node has appeared
  virtual bool finished() const { return false; }  ///< a recording or script is over
  /// One sentence about an open device: what it was taken for, or why nothing comes of it; else empty.
  virtual std::string note() const { return {}; }
  virtual void recentre() {}  ///< the present heading is "straight on", where it drifts
};

struct ThreadedSourceTraits {
  std::string name;
  std::string note{};  ///< what its measurements lack
  bool has_end = false;
  /// Hands and heads older than this are not handed out any more.
  TimestampNs stale_ns = 300'000'000;
  /// Connected, but without a measurement for this long: lost. 0: a device that may be silent.
  TimestampNs silent_ns = 0;
  std::function<void()> before_poll{};  ///< in the session's thread
  TimestampNs retry_ns = 0;  ///< not 0: tries at least this often to open it (servers that no node announces)
};

std::unique_ptr<InputSource> make_threaded_source(ThreadedSourceTraits traits, std::unique_ptr<SourceReader> reader,
                                                  const InputConfig& config);

/// config.clock, or the steady clock.
const Clock& session_clock(const InputConfig& config);

}  // namespace dubsar
