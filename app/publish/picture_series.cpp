#include "app/publish/picture_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "core/base/files/atomic_file.h"
#include "core/base/system/log.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kList = "film_pictures.json", kName = "picture_", kFormat = "dubsar film pictures";
constexpr int kDigits = 5;

class Fnv {
 public:
  void add(std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) sum_ = (sum_ ^ static_cast<std::uint64_t>(b)) * 1099511628211u;
  }
  std::string text() const { return fmt::format("{:016x}", sum_); }

 private:
  std::uint64_t sum_ = 14695981039346656037u;
};

json facts_json(const SeriesFacts& facts) {
  return {{"format", kFormat},          {"film", facts.film},        {"surface", facts.surface},
          {"display", facts.display},   {"style", facts.style},      {"program", facts.program},
          {"pictures", facts.pictures}, {"width", facts.width},      {"height", facts.height},
          {"samples", facts.samples},   {"frames_per_s", facts.fps}, {"file_format", facts.format}};
}

/// What differs, in words: "frames_per_s 24 there, 30 asked for".
std::string difference(const json& there, const json& wanted) {
  for (const auto& [key, value] : wanted.items()) {
    if (!there.contains(key)) return fmt::format("a list without {}", key);
    if (there.at(key) == value) continue;
    if (key == "film" || key == "surface") return fmt::format("another {}", key);
    return fmt::format("{} {} there, {} asked for", key, dump_json(there.at(key)), dump_json(value));
  }
  return {};
}

bool is_picture(const std::string& name) { return name.starts_with(kName) && name.size() > kName.size(); }

/// Pictures, and halves of them under the names that AtomicFile gives.
void remove_pictures(const fs::path& folder, bool halves_only) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool half = name.starts_with("." + std::string(kName)) && name.find(".tmp-") != std::string::npos;
    if (!half && (halves_only || !is_picture(name))) continue;
    std::error_code ignored;
    if (entry.is_regular_file(ignored)) fs::remove(entry.path(), ignored);
  }
}

int digits_of(int count) { return std::max(kDigits, static_cast<int>(std::to_string(count).size())); }

bool has_pictures(const fs::path& folder) {
  std::error_code error;
  const auto entries = fs::directory_iterator(folder, error);
  return !error && std::any_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return is_picture(entry.path().filename().string());
  });
}

}  // namespace

std::string fingerprint(std::string_view bytes) {
  Fnv sum;
  sum.add(std::as_bytes(std::span(bytes)));
  return sum.text();
}

std::string fingerprint(const TriMesh& mesh) {
  Fnv sum;
  const auto add = [&](const auto& values) { sum.add(std::as_bytes(std::span(values))); };
  add(mesh.positions);
  add(mesh.triangles);
  add(mesh.triangle_partition);
  add(mesh.shape);
  add(mesh.ao);
  add(mesh.evidence);
  add(mesh.colors);
  add(mesh.triangle_inferred);
  return sum.text();
}

Result<PictureSeries> PictureSeries::open(const fs::path& folder, const std::string& suffix, const SeriesFacts& facts,
                                          bool again) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    return fail(ErrorKind::kCannotCreate, "cannot write pictures into {}: it is a file, expected a folder",
                folder.string());
  fs::create_directories(folder, error);
  if (error) return fail(ErrorKind::kCannotCreate, "cannot make the folder {}: {}", folder.string(), error.message());
  const fs::path list = folder / kList;
  const json wanted = facts_json(facts);
  if (fs::exists(list, error)) {
    DUBSAR_ASSIGN(const std::string text, read_text_file(list));
    const auto there = parse_json(text, list.string());
    const std::string differs = !there || !there->is_object() ? "a damaged list" : difference(*there, wanted);
    if (!differs.empty() && !again)
      return fail(ErrorKind::kUsage,
                  "{} holds other pictures: {}; expected another folder, or --again to make them anew", folder.string(),
                  differs);
  } else if (has_pictures(folder) && !again) {
    return fail(ErrorKind::kUsage,
                "{} holds pictures, and no {} says what they show; expected another folder, or --again to make them "
                "anew",
                folder.string(), kList);
  }
  remove_pictures(folder, !again);
  DUBSAR_TRY(write_file_atomically(list, wanted.dump(1) + "\n"));
  PictureSeries out;
  out.folder_ = folder;
  out.suffix_ = suffix;
  out.facts_ = facts;
  return out;
}

fs::path PictureSeries::path(int number) const {
  return folder_ / fmt::format("{}{:0{}}{}", kName, number + 1, digits_of(facts_.pictures), suffix_);
}

std::string PictureSeries::pattern() const {
  return fmt::format("{}%0{}d{}", kName, digits_of(facts_.pictures), suffix_);
}

Result<std::vector<int>> PictureSeries::missing(Progress& progress) const {
  std::vector<int> out;
  progress.begin("look", facts_.pictures, "picture");
  for (int i = 0; i < facts_.pictures; ++i) {
    if (progress.cancelled()) return cancelled_error();
    std::error_code error;
    const bool there = fs::exists(path(i), error);
    const auto image = there ? read_picture(path(i)) : fail(ErrorKind::kNoInput, "not there");
    if (!image || image->width != facts_.width || image->height != facts_.height) out.push_back(i);
    if (there && !image) log_info("animate: {} is damaged and is made again", path(i).string());
    progress.advance(1);
  }
  progress.end();
  return out;
}

void PictureSeries::remove() const {
  remove_pictures(folder_, false);
  std::error_code ignored;
  fs::remove(folder_ / kList, ignored);
  fs::remove(folder_, ignored);  // only when it is empty
}

}  // namespace dubsar::app
