#include "app/document/document_file.h"

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "app/document/document_fields.h"
#include "core/base/files/atomic_file.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr int kVersion = 4, kOldest = 1;
constexpr std::string_view kFormat = "dubsar document";
constexpr TimestampNs kEveryNs = 5'000'000'000;  // half of what may be lost: writing takes its time, too

Result<void> save(const std::filesystem::path& file, const Document& document) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  return save_document(file, document);
}

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

}  // namespace

std::string format_document(const Document& document) {
  Document copy = document;
  stored::Writer writer;
  fields(writer, copy);
  json out = writer.take();
  out["format"] = kFormat;
  out["version"] = kVersion;
  return out.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<Document> parse_document(std::string_view text, std::string_view source) {
  DUBSAR_ASSIGN(const json object, parse_json(text, source));
  DUBSAR_ASSIGN(const int version, json_version(object, kFormat, kOldest, kVersion, source));
  Document out;
  std::string complaint;
  stored::Reader reader(object, "", complaint, version != kVersion);
  fields(reader, out);
  if (complaint.empty()) complaint = complaint_about(out);
  if (!complaint.empty()) return fail(ErrorKind::kBadData, "{}: {}", source, complaint);
  return out;
}

Result<void> save_document(const std::filesystem::path& path, const Document& document) {
  return write_file_atomically(path, format_document(document));
}

Result<Document> load_document(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(path));
  return parse_document(text, path.string());
}

std::filesystem::path Autosave::file_for(const std::filesystem::path& folder, const SourceFile& source) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a: names of any length and alphabet become file names
  for (const char c : source.path) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return folder / fmt::format("{:016x}.json", hash);
}

bool Autosave::has_left_behind() const {
  std::error_code error;
  return !file_.empty() && std::filesystem::exists(file_, error);
}

Result<Document> Autosave::left_behind(const SourceFile& source) const {
  DUBSAR_ASSIGN(Document found, load_document(file_));
  if (found.source != source)
    return fail(ErrorKind::kBadData, "{}: notes on {} of {} bytes found, expected {} of {} bytes", file_.string(),
                found.source.path, found.source.bytes, source.path, source.bytes);
  return found;
}

Result<void> Autosave::keep(TimestampNs now, const Document& document) {
  if (file_.empty()) return {};
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    DUBSAR_TRY(settle());
  }
  if (any_ && (now < next_ || document == written_)) return {};
  written_ = document;
  if (!std::exchange(any_, true)) return {};  // what it begins with is not work yet
  next_ = now + kEveryNs;
  writing_ = std::async(std::launch::async, save, file_, written_);
  return {};
}

Result<void> Autosave::settle() {
  if (!writing_.valid()) return {};
  auto done = writing_.get();
  if (!done) written_ = Document();  // it is tried again
  return done;
}

Result<void> Autosave::leave(const Document& document) {
  if (file_.empty()) return {};
  static_cast<void>(settle());  // what comes now replaces it
  return save(file_, document);
}

void Autosave::discard() {
  static_cast<void>(settle());
  std::error_code error;
  if (!file_.empty()) std::filesystem::remove(file_, error);
}

}  // namespace dubsar::app
