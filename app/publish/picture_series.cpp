#include "app/publish/picture_series.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <span>
#include <sstream>

#include "core/base/files/atomic_file.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/system/log.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kList = "film_pictures.json", kMade = "film_pictures.made", kName = "picture_",
                           kFormat = "dubsar film pictures";
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

/// What this program wrote into a folder: a line a picture, its name and the fingerprint of its file.
std::multimap<std::string, std::string> read_made(const fs::path& folder) {
  std::multimap<std::string, std::string> made;
  const auto text = read_text_file(folder / kMade, std::int64_t{256} << 20);
  if (!text) return made;
  std::istringstream lines(*text);
  for (std::string name, print; lines >> name >> print;)
    if (name.starts_with(kName) && name.find('/') == std::string::npos) made.emplace(name, print);
  return made;
}

/// Whether a file is as this program wrote it.
bool unchanged(const std::multimap<std::string, std::string>& made, const fs::path& file) {
  const auto [begin, end] = made.equal_range(file.filename().string());
  if (begin == end) return false;
  const auto print = file_fingerprint(file);
  return print && std::any_of(begin, end, [&](const auto& entry) { return entry.second == *print; });
}

void remove_made(const fs::path& folder) {
  const auto made = read_made(folder);
  std::error_code ignored;
  for (auto entry = made.begin(); entry != made.end(); entry = made.upper_bound(entry->first))
    if (unchanged(made, folder / entry->first)) fs::remove(folder / entry->first, ignored);
  fs::remove(folder / kMade, ignored);
}

bool is_running(int process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

/// Halves of pictures under the names that AtomicFile gives, of programs that have ended.
void remove_halves(const fs::path& folder) {
  static const std::regex half(
      "\\.(?:picture_[0-9]{5,}[^/]*|film_pictures\\.(?:made|json))\\.tmp-([0-9]{1,9})-[0-9a-f]{8}");
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    std::smatch found;
    std::error_code ignored;
    if (std::regex_match(name, found, half) && !is_running(std::stoi(found[1])) && entry.is_regular_file(ignored))
      fs::remove(entry.path(), ignored);
  }
}

int digits_of(int count) { return std::max(kDigits, static_cast<int>(std::to_string(count).size())); }

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
  PictureSeries out;
  out.folder_ = folder;
  out.suffix_ = suffix;
  out.facts_ = facts;
  bool anew = again;
  if (fs::exists(list, error)) {
    DUBSAR_ASSIGN(const std::string text, read_text_file(list));
    const auto there = parse_json(text, list.string());
    const std::string differs = !there || !there->is_object() ? "a damaged list" : difference(*there, wanted);
    if (!differs.empty() && !again)
      return fail(ErrorKind::kUsage,
                  "{} holds other pictures: {}; expected another folder, or --again to make them anew", folder.string(),
                  differs);
    anew = anew || !differs.empty();
  } else {
    anew = true;
  }
  remove_halves(folder);
  if (anew) {
    const auto made = read_made(folder);
    for (int i = 0; i < facts.pictures; ++i)
      if (const fs::path there = out.path(i); fs::exists(fs::symlink_status(there, error)) && !unchanged(made, there))
        return fail(ErrorKind::kCannotCreate,
                    "{} is not as this program made it, or is somebody else's, and would be lost; expected another "
                    "folder, or move it away",
                    there.string());
    remove_made(folder);
  }
  DUBSAR_TRY(write_file_atomically(list, wanted.dump(1) + "\n"));
  return out;
}

fs::path PictureSeries::path(int number) const {
  return folder_ / fmt::format("{}{:0{}}{}", kName, number + 1, digits_of(facts_.pictures), suffix_);
}

std::string PictureSeries::pattern() const {
  return fmt::format("{}%0{}d{}", kName, digits_of(facts_.pictures), suffix_);
}

Result<void> PictureSeries::wrote(int number) const {
  const fs::path file = path(number);
  DUBSAR_ASSIGN(const std::string print, file_fingerprint(file));
  const std::string line = fmt::format("{} {}\n", file.filename().string(), print);
  const fs::path made = folder_ / kMade;
  const int descriptor = ::open(made.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return fail_errno(errno, fmt::format("cannot open {}", made.string()));
  const ssize_t count = ::write(descriptor, line.data(), line.size());
  const int error = errno;
  ::close(descriptor);
  if (count != static_cast<ssize_t>(line.size()))
    return fail_errno(count < 0 ? error : ENOSPC, fmt::format("cannot write {}", made.string()));
  return {};
}

Result<void> PictureSeries::settle() const {
  const auto made = read_made(folder_);
  std::string text;
  for (int i = 0; i < facts_.pictures; ++i) {
    const std::string name = path(i).filename().string();
    // Of a picture that is as it was written, that; of one that was changed since, what was written last.
    DUBSAR_ASSIGN(std::string print, file_fingerprint(path(i)));
    const auto [begin, end] = made.equal_range(name);
    if (begin != end && std::none_of(begin, end, [&](const auto& entry) { return entry.second == print; }))
      print = std::prev(end)->second;
    text += fmt::format("{} {}\n", name, print);
  }
  return write_file_atomically(folder_ / kMade, text);
}

Result<std::vector<int>> PictureSeries::missing(Progress& progress) const {
  std::vector<int> out;
  const auto made = read_made(folder_);
  progress.begin("look", facts_.pictures, "picture");
  for (int i = 0; i < facts_.pictures; ++i) {
    if (progress.cancelled()) return cancelled_error();
    std::error_code error;
    const bool there = fs::exists(path(i), error);
    const auto image = there ? read_picture(path(i)) : fail(ErrorKind::kNoInput, "not there");
    if (image && (image->width != facts_.width || image->height != facts_.height) && !unchanged(made, path(i)))
      return fail(
          ErrorKind::kCannotCreate,
          "{} has {} x {} pixels and would be made again, which would lose it; expected another folder, or move "
          "it away",
          path(i).string(), image->width, image->height);
    if (!image || image->width != facts_.width || image->height != facts_.height) out.push_back(i);
    if (there && !image) log_info("animate: {} is damaged and is made again", path(i).string());
    progress.advance(1);
  }
  progress.end();
  return out;
}

void PictureSeries::remove() const {
  remove_made(folder_);
  std::error_code ignored;
  fs::remove(folder_ / kList, ignored);
  fs::remove(folder_, ignored);  // only when it is empty
}

}  // namespace dubsar::app
