#include "app/cli/default_output.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

namespace dubsar::app {

std::string output_beside(const std::string& in, const std::string& tail) {
  if (in.empty()) return {};
  std::error_code ignored;
  const auto colon = in.rfind(":/");
  const bool dataset = colon != std::string::npos && !std::filesystem::exists(in, ignored);
  std::filesystem::path path(dataset ? in.substr(0, colon) : in);
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = (std::filesystem::is_directory(path, ignored) ? path.filename() : path.stem()).string();
  return (path.parent_path() / (name + tail)).string();
}

std::string quoted(const std::string& name) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("/._-+,:@%").find(c) != std::string_view::npos || c >= 0x80;
  };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return name;
  std::string out = "'";
  for (const char c : name) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace dubsar::app
