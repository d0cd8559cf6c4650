#include "app/document/recent_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "core/base/files/kept_file.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;
constexpr const char* kListFormat = "dubsar recent files";

/// None: it is no list of this version.
std::optional<std::vector<std::string>> parse_recent(const std::string& text, const std::string& name) {
  const auto object = parse_json(text, name);
  if (!object || !json_version(*object, kListFormat, 1, 1, name)) return std::nullopt;
  std::vector<std::string> out;
  const json files = object->value("files", json());
  if (!files.is_array()) return out;
  for (const json& file : files)
    if (file.is_string() && out.size() < kMostRecent)
      if (std::string path = file.get<std::string>();
          std::filesystem::path(path).is_absolute() && std::find(out.begin(), out.end(), path) == out.end())
        out.push_back(std::move(path));
  return out;
}
}  // namespace

std::vector<std::string> read_recent(const std::filesystem::path& list) {
  if (list.empty()) return {};
  const auto text = KeptFile(list).read();
  return text && *text ? parse_recent(**text, list.string()).value_or(std::vector<std::string>())
                       : std::vector<std::string>();
}

Result<void> remember_recent(const std::filesystem::path& list, const std::filesystem::path& file) {
  if (list.empty()) return {};
  std::error_code error;
  const std::string path = std::filesystem::absolute(file, error).lexically_normal().string();
  std::filesystem::create_directories(list.parent_path(), error);
  constexpr int kMostTries = 4;  // other windows write it, too
  for (int i = 0; i < kMostTries; ++i) {
    KeptFile kept(list);
    DUBSAR_ASSIGN(const std::optional<std::string> text, kept.read());
    auto files = text ? parse_recent(*text, list.string()) : std::vector<std::string>();
    if (!files) DUBSAR_TRY(kept.set_aside());  // of a newer version, or damaged
    if (!files) files.emplace();
    std::erase(*files, path);
    files->insert(files->begin(), path);
    files->resize(std::min(files->size(), kMostRecent));
    const json out{{"format", kListFormat}, {"version", 1}, {"files", *files}};
    DUBSAR_ASSIGN(const Kept done, kept.write(out.dump(1, ' ', false, json::error_handler_t::replace) + "\n"));
    if (done == Kept::kDone) return {};
  }
  return fail(ErrorKind::kTryAgain, "{} is changed by others all the time", list.string());
}

}  // namespace dubsar::app
