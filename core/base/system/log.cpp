#include "core/base/system/log.h"

#include <mutex>

#include "core/base/text/plain_text.h"

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
  thread_local bool handling = false;  // what the handler itself logs is dropped: it would never end
  if (handling) return;
  const std::string plain = plain_text(message);  // names from files go through here
  const std::lock_guard lock(log_mutex());
  if (!log_handler()) return;
  struct Handling {
    Handling() { handling = true; }
    ~Handling() { handling = false; }
  } const mark;
  log_handler()(level, plain);
}

}  // namespace dubsar
