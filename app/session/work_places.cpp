#include "app/session/work_places.h"

#include <algorithm>
#include <system_error>

#include "app/document/join.h"
#include "core/base/files/kept_file.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

constexpr std::string_view kBeside = ".dubsar.json", kOfScan = "_of_";
constexpr std::size_t kMostFiles = 300;  // of others, that are looked into

/// Names of a folder that fit, in their order.
void list(const fs::path& folder, const auto& fits, std::vector<OtherPlace>& out) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (fits(at->path().filename().string())) found.push_back(at->path());
  std::sort(found.begin(), found.end());
  for (fs::path& file : found)
    if (out.size() < kMostFiles) out.push_back({std::move(file), false});
}

bool holds(const std::string& text, std::string_view piece) { return text.find(piece) != std::string::npos; }

}  // namespace

WorkPlaces places_of(const SourceFile& source, const fs::path& state_folder) {
  WorkPlaces out;
  if (!source.path.empty()) out.beside = source.path + std::string(kBeside);
  if (!state_folder.empty() && !source.content.empty())
    out.state =
        state_folder / fmt::format("{}{}{}.json", source.content, source.scan.empty() ? "" : kOfScan, source.scan);
  return out;
}

fs::path old_place_of(const SourceFile& source, const fs::path& state_folder) {
  if (state_folder.empty()) return {};
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : source.path) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return state_folder / fmt::format("{:016x}.json", hash);
}

Belonging belonging(const SourceFile& found, const SourceFile& surface, bool had_its_place) {
  const bool known = !found.content.empty() && !surface.content.empty();
  const bool same = known ? found.content == surface.content : had_its_place && found.bytes == surface.bytes;
  if (same) return Belonging::kThisSurface;
  if (!surface.scan.empty() && found.scan == surface.scan) return Belonging::kSameScan;
  return had_its_place ? Belonging::kSameName : Belonging::kNobody;
}

std::vector<OtherPlace> other_places(const SourceFile& source, const fs::path& state_folder) {
  const WorkPlaces places = places_of(source, state_folder);
  std::vector<OtherPlace> out;
  for (const fs::path& place : {places.beside, places.state, old_place_of(source, state_folder)})
    if (!place.empty())
      for (fs::path& aside : set_aside_of(place)) out.push_back({std::move(aside), true});
  if (const fs::path old = old_place_of(source, state_folder); !old.empty()) out.push_back({old, true});
  const std::size_t own = out.size();
  if (!state_folder.empty())
    list(
        state_folder,
        [&](const std::string& name) {
          return (!source.content.empty() && name.starts_with(source.content)) ||
                 (!source.scan.empty() && holds(name, fmt::format("{}{}.json", kOfScan, source.scan)));
        },
        out);
  list(
      fs::path(source.path).parent_path(), [](const std::string& name) { return holds(name, kBeside); }, out);
  const auto is_own = [&](const OtherPlace& other) {
    return other.file == places.beside || other.file == places.state ||
           std::any_of(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(own),
                       [&](const OtherPlace& mine) { return mine.file == other.file; });
  };
  std::vector<OtherPlace> distinct(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(own));
  std::copy_if(out.begin() + static_cast<std::ptrdiff_t>(own), out.end(), std::back_inserter(distinct),
               [&](const OtherPlace& other) { return !is_own(other); });
  return distinct;
}

Work join_copies(const Work& a, const Work& b) {
  const bool a_has = a.saves.contains(b.saves), b_has = b.saves.contains(a.saves);
  if (a_has && (!b_has || format_document(a.document) == format_document(b.document))) return a;
  if (b_has && !a_has) return b;
  Work out{join(nullptr, a.document, b.document), a.saves};
  out.saves.join(b.saves);
  return out;
}

}  // namespace dubsar::app
