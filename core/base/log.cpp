#include "core/base/log.h"

#include <mutex>

namespace dubsar {
namespace {
std::mutex& log_mutex() {
  static std::mutex mutex;
  return mutex;
}
LogHandler& log_handler() {
  static LogHandler handler;
  return handler;
}
}  // namespace

void set_log_handler(LogHandler handler) {
  const std::lock_guard lock(log_mutex());
  log_handler() = std::move(handler);
}

void log(LogLevel level, std::string_view message) {
  const std::lock_guard lock(log_mutex());
  if (log_handler()) log_handler()(level, message);
}

}  // namespace dubsar
