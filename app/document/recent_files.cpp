#include "app/document/recent_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/files/atomic_file.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;
constexpr const char* kListFormat = "dubsar recent files";
}  // namespace

std::vector<std::string> read_recent(const std::filesystem::path& list) {
  std::vector<std::string> out;
  if (list.empty()) return out;
  const auto text = read_text_file(list);
  if (!text) return out;
  const auto object = parse_json(*text, list.string());
  if (!object || !json_version(*object, kListFormat, 1, 1, list.string())) return out;
  const json files = object->value("files", json());
  if (!files.is_array()) return out;
  for (const json& file : files)
    if (file.is_string() && out.size() < kMostRecent)
      if (std::string path = file.get<std::string>();
          std::filesystem::path(path).is_absolute() && std::find(out.begin(), out.end(), path) == out.end())
        out.push_back(std::move(path));
  return out;
}

Result<void> remember_recent(const std::filesystem::path& list, const std::filesystem::path& file) {
  if (list.empty()) return {};
  std::error_code error;
  const std::string path = std::filesystem::absolute(file, error).lexically_normal().string();
  std::vector<std::string> files = read_recent(list);
  std::erase(files, path);
  files.insert(files.begin(), path);
  files.resize(std::min(files.size(), kMostRecent));
  std::filesystem::create_directories(list.parent_path(), error);
  const json out{{"format", kListFormat}, {"version", 1}, {"files", files}};
  return write_file_atomically(list, out.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace dubsar::app
