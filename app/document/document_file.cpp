#include "app/document/document_file.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "app/document/document_fields.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr int kOldest = 1;
constexpr const char* kSaves = "saves";

/// What ranges alone do not say.
std::string complaint_about(const Document& d) {
  for (const CameraPose* camera : {&d.home, &d.now})
    if (!(camera->zoom > 0)) return fmt::format("zoom is {}, expected more than 0", camera->zoom);
  if (!(d.unpack >= 0 && d.unpack <= 1)) return fmt::format("unpack is {}, expected 0 to 1", d.unpack);
  if (!(d.style.strength >= 0 && d.style.strength <= 2))
    return fmt::format("style.strength is {}, expected 0 to 2", d.style.strength);
  if (!(d.style.share >= 0 && d.style.share <= 1))
    return fmt::format("style.share is {}, expected 0 to 1", d.style.share);
  if (!(d.style.radiance >= 0 && d.style.radiance <= 2))
    return fmt::format("style.radiance is {}, expected 0 to 2", d.style.radiance);
  if (!(d.companion.difference_mm >= 0 && d.companion.difference_mm <= kMostDifferenceMm))
    return fmt::format("companion.difference_mm is {}, expected 0 to {}", d.companion.difference_mm, kMostDifferenceMm);
  for (const Part& part : d.parts)
    if (!(part.opacity >= 0 && part.opacity <= 1))
      return fmt::format("opacity of {} is {}, expected 0 to 1", part.name, part.opacity);
  const ScanView& scan = d.scan;
  const auto off = [](double value, double wanted) { return !(std::abs(value - wanted) <= 1e-6); };
  if (!(scan.zoom > 0) || scan.large < 0 || scan.large > 4 || off(glm::length(scan.free_right), 1) ||
      off(glm::length(scan.free_up), 1) || off(glm::dot(scan.free_right, scan.free_up), 0))
    return fmt::format(
        "scan has zoom {}, slice {} and a free slice that lies so or not at all, expected more than 0, 0 "
        "to 4 and two directions across each other",
        scan.zoom, scan.large);
  if (!(d.fog >= 0 && d.fog <= 1)) return fmt::format("fog is {}, expected 0 to 1", d.fog);
  for (const Measure& measure : d.measures)
    if (measure.points_mm.size() != points_of(measure.kind))
      return fmt::format("{} of {} places found, expected {}", measure_kind_name(measure.kind),
                         measure.points_mm.size(), points_of(measure.kind));
  return {};
}

/// Of a session's name: longer ones, and more of them, are nobody's.
constexpr std::size_t kLongestName = 100, kMostSessions = 10'000;

/// None: the text does not tell them.
Result<std::optional<Saves>> saves_of(const json& object, std::string_view source) {
  const auto at = object.find(kSaves);
  if (at == object.end() || (at->is_object() && at->empty())) return std::optional<Saves>();
  const auto wrong = fail(ErrorKind::kBadData, "{}: saves are no list of sessions with their numbers", source);
  if (!at->is_object() || at->size() > kMostSessions) return wrong;
  Saves out;
  for (const auto& [session, count] : at->items()) {
    if (session.size() > kLongestName || !count.is_number_integer() || count < 1) return wrong;
    out.counts[session] = count.get<std::int64_t>();
  }
  return std::optional(std::move(out));
}

json json_of(const Document& document) {
  Document copy = document;
  give_ids(copy);
  stored::Writer writer;
  fields(writer, copy);
  json out = writer.take();
  out["format"] = kDocumentFormat;
  out["version"] = kDocumentVersion;
  return out;
}

template <class Thing>
void give_ids_to(std::vector<Thing>& things) {
  std::set<std::string> taken;
  std::map<std::string, int> numbers;
  for (Thing& thing : things)
    if (!thing.id.empty() && !taken.insert(thing.id).second) thing.id.clear();  // somebody copied it by hand
  for (Thing& thing : things) {
    if (!thing.id.empty()) continue;
    stored::Writer writer;
    fields(writer, thing);
    const std::string id = bytes_checksum(writer.take().dump(-1, ' ', true, json::error_handler_t::replace));
    std::string free = id;
    int& number = numbers[id];  // of many that are alike none begins to count anew
    while (!taken.insert(free).second) free = fmt::format("{}-{}", id, ++number + 1);
    thing.id = std::move(free);
  }
}

}  // namespace

void give_ids(Document& document) {
  give_ids_to(document.notes);
  give_ids_to(document.measures);
  give_ids_to(document.edition.wedges);
}

std::string format_work(const Work& work) {
  json out = json_of(work.document);
  if (!work.saves.counts.empty()) out[kSaves] = work.saves.counts;
  return dump_json_rows(out) + "\n";
}

std::string format_document(const Document& document) { return format_work({document, {}}); }

Result<Work> parse_work(std::string_view text, std::string_view source) {
  DUBSAR_ASSIGN(const json object, parse_json(text, source, kLargestDocument));
  DUBSAR_ASSIGN(const int version, json_version(object, kDocumentFormat, kOldest, kDocumentVersion, source));
  Work out;
  std::string complaint;
  stored::Reader reader(object, "", complaint, version != kDocumentVersion);
  fields(reader, out.document);
  if (complaint.empty()) complaint = complaint_about(out.document);
  if (!complaint.empty()) return fail(ErrorKind::kBadData, "{}: {}", source, complaint);
  DUBSAR_ASSIGN(std::optional<Saves> saves, saves_of(object, source));
  out.saves = saves ? *std::move(saves) : Saves{{{"text " + bytes_checksum(text), 1}}};
  give_ids(out.document);
  return out;
}

Result<Document> parse_document(std::string_view text, std::string_view source) {
  DUBSAR_ASSIGN(Work work, parse_work(text, source));
  return std::move(work.document);
}

Result<Work> load_work(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(path, static_cast<std::int64_t>(kLargestDocument)));
  return parse_work(text, path.string());
}

}  // namespace dubsar::app
