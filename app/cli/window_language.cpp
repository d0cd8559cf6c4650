#include "app/cli/window_language.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "app/cli/config_folder.h"
#include "app/words/language.h"
#include "core/base/files/atomic_file.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {

std::string& begun_with() {
  static std::string code;
  return code;
}

std::filesystem::path language_file() {
  const std::filesystem::path folder = config_folder();
  return folder.empty() ? folder : folder / "language";
}

/// Empty: none is kept, or none that there is.
std::string kept_language() {
  std::error_code error;
  const std::filesystem::path file = language_file();
  if (file.empty() || !std::filesystem::is_regular_file(file, error)) return {};
  std::string text = read_text_file(file, 64).value_or("");
  text.erase(std::min(text.find('\n'), text.size()));
  const auto& all = language_codes();
  return std::find(all.begin(), all.end(), text) == all.end() ? std::string() : text;
}

std::string environment_language() {
  for (const char* const name : {"LC_ALL", "LC_MESSAGES", "LANG"})
    if (const char* const value = std::getenv(name); value != nullptr && *value != '\0')
      return language_of_locale(value);
  return "en";
}

}  // namespace

Result<void> choose_language(const std::string& asked, bool live) {
  std::string wanted = asked;
  if (wanted.empty() && live) wanted = kept_language();
  if (wanted.empty()) wanted = live ? environment_language() : "en";
  DUBSAR_TRY(use_language(wanted));
  begun_with() = language().code();
  return {};
}

void keep_language() {
  const std::string& now = language().code();
  const auto& all = language_codes();
  const std::filesystem::path file = language_file();
  if (now == begun_with() || file.empty() || std::find(all.begin(), all.end(), now) == all.end()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  if (const auto done = write_file_atomically(file, now + "\n"); !done) log_warning("{}", done.error().message);
}

}  // namespace dubsar::app
