#include "app/kiosk/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {

std::tm local_time(std::int64_t unix_s) {
  const auto time = static_cast<std::time_t>(unix_s);
  std::tm out{};
  localtime_r(&time, &out);
  return out;
}

std::string stamp(std::int64_t unix_s) {
  const std::tm t = local_time(unix_s);
  char text[40];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &t);
  return {text, length};
}

}  // namespace

std::string Journal::words(std::string_view name, std::string_view words) {
  return fmt::format("\"{}\": {}", name, dump_json(nlohmann::json(std::string(words))));
}

std::filesystem::path Journal::file(std::int64_t unix_s) const {
  const std::tm t = local_time(unix_s);
  return folder_ / fmt::format("kiosk-{:04}-{:02}-{:02}.jsonl", t.tm_year + 1900, t.tm_mon + 1, t.tm_mday);
}

std::int64_t Journal::visits(std::int64_t unix_s) const {
  if (folder_.empty()) return 0;
  std::ifstream in(file(unix_s));
  std::int64_t out = 0;
  for (std::string line; std::getline(in, line);) out += line.find("\"what\": \"visit\"") != std::string::npos;
  return out;
}

Result<void> Journal::add(std::int64_t unix_s, std::string_view what, std::string_view figures) {
  if (folder_.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const std::filesystem::path path = file(unix_s);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor < 0) return fail_errno(errno, "journal: cannot write " + path.string());
  const std::string line = fmt::format("{{\"time\": \"{}\", \"what\": \"{}\"{}{}}}\n", stamp(unix_s), what,
                                       figures.empty() ? "" : ", ", figures);
  const ssize_t written = ::write(descriptor, line.data(), line.size());
  const int number = errno;
  ::close(descriptor);
  if (written == static_cast<ssize_t>(line.size())) return {};
  return fail_errno(written < 0 ? number : ENOSPC, "journal: cannot write " + path.string());
}

}  // namespace dubsar::app
