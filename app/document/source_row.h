#pragma once
// How an input source of a session stands. Plain values.

#include <string>

namespace dubsar::app {

enum class SourceHealth {
  kPresent,
  kLost,     ///< it was started and its device is gone or silent; it may come back
  kMissing,  ///< it cannot be started; tried again every two seconds
  kOff,      ///< switched off by hand
};

struct SourceRow {
  std::string spec;
  SourceHealth health = SourceHealth::kMissing;
  std::string reason;  ///< of kMissing and kLost; what a present source wants to say
};

}  // namespace dubsar::app
