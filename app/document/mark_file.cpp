#include "app/document/mark_file.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/document/field_json.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/files/kept_file.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::string_view kAnnotationContext = "http://www.w3.org/ns/anno.jsonld";

ordered_json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
ordered_json place_json(const glm::dvec3& mm) {
  return {stored::rounded_mm(mm.x), stored::rounded_mm(mm.y), stored::rounded_mm(mm.z)};
}
ordered_json path_json(const std::vector<glm::dvec3>& points) {
  ordered_json out = ordered_json::array();
  for (const glm::dvec3& p : points) out.push_back(place_json(p));
  return out;
}

ordered_json file_of(std::string_view format, const Document& document) {
  return {{"format", format}, {"version", 1}, {"source", document.source.path}, {"frame", "mm of the scan"}};
}

ordered_json camera_json(const CameraPose& camera) {
  const glm::dquat& q = camera.rotation;
  return {{"rotation_wxyz", {q.w, q.x, q.y, q.z}}, {"zoom", camera.zoom}, {"pan", {camera.pan.x, camera.pan.y}}};
}

std::string text_of(const ordered_json& out) { return dump_json_rows(json(out)) + "\n"; }

/// A path as a file URI (RFC 8089): letters beyond ASCII and signs are coded.
std::string file_uri(const std::string& path) {
  std::string out = "file://";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') || (byte >= '0' && byte <= '9') ||
                       std::string_view("/-._~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return out;
}

/// A path in three dimensions, as Well-Known Text (ISO 19125) has it.
std::string wkt_of(const std::vector<glm::dvec3>& points) {
  std::string out;
  for (const glm::dvec3& p : points)
    out += fmt::format("{}{:.3f} {:.3f} {:.3f}", out.empty() ? "" : ", ", p.x, p.y, p.z);
  return "LINESTRING Z (" + out + ")";
}

/// What a file of this program says it is; empty: it is none. Annotations say what wrote them.
std::string format_of(std::string_view text) {
  const auto object = parse_json(text, "", static_cast<std::size_t>(KeptFile::kLargest));
  if (!object || !object->is_object()) return {};
  const auto word = [](const json& in, const char* name) {
    const auto at = in.find(name);
    return at != in.end() && at->is_string() ? at->get<std::string>() : std::string();
  };
  if (const std::string format = word(*object, "format"); format.starts_with("dubsar ")) return format;
  const auto by = object->find("generator");
  const bool ours = by != object->end() && by->is_object() && word(*by, "name") == "dubsar";
  return ours ? word(*object, "type") : std::string();
}

}  // namespace

std::string format_measures(const Document& document) {
  ordered_json out = file_of("dubsar measures", document);
  out["measures"] = ordered_json::array();
  for (const Measure& measure : document.measures) {
    const MeasureFigures& f = measure.figures;
    ordered_json row{{"kind", measure_kind_name(measure.kind)}, {"name", measure.name}, {"part", measure.part}};
    row["points_mm"] = path_json(measure.points_mm);
    if (measure.kind == MeasureKind::kDistance || measure.kind == MeasureKind::kProfile) {
      row["straight_mm"] = stored::rounded_figure_mm(f.straight_mm);
      row["surface_mm"] =
          f.surface_mm > 0 ? ordered_json(stored::rounded_figure_mm(f.surface_mm)) : ordered_json(nullptr);
    }
    if (measure.kind == MeasureKind::kAngle) row["angle_deg"] = f.angle_deg;
    if (measure.kind == MeasureKind::kDepth || measure.kind == MeasureKind::kProfile)
      row["depth_mm"] = stored::rounded_figure_mm(f.depth_mm);
    if (f.uncertainty_mm) row["uncertainty_mm"] = stored::rounded_figure_mm(*f.uncertainty_mm);
    if (!f.path_mm.empty()) row["path_mm"] = path_json(f.path_mm);
    out["measures"].push_back(std::move(row));
  }
  return text_of(out);
}

std::string format_notes(const Document& document) {
  ordered_json out = file_of("dubsar notes", document);
  out["notes"] = ordered_json::array();
  for (const Note& note : document.notes)
    out["notes"].push_back({{"label", note.label},
                            {"text", note.text},
                            {"part", note.part},
                            {"at_mm", place_json(note.at_mm)},
                            {"normal", vector_json(note.normal)},
                            {"line_mm", path_json(note.line_mm)},
                            {"translation", note.translation},
                            {"created", note.created},
                            {"camera", camera_json(note.camera)}});
  return text_of(out);
}

std::string format_annotations(const Document& document) {
  const std::string source = file_uri(document.source.path);
  const TabletRecord& record = document.edition.record;
  // What an id begins with: of this surface, under whatever name.
  const std::string own = "urn:dubsar:" + (document.source.content.empty() ? bytes_checksum(document.source.path)
                                                                           : document.source.content);
  ordered_json items = ordered_json::array();
  for (const Note& note : document.notes) {
    const bool line = note.line_mm.size() > 1;
    ordered_json selector{{"type", "PointSelector"},
                          {"x", stored::rounded_mm(note.at_mm.x)},
                          {"y", stored::rounded_mm(note.at_mm.y)},
                          {"z", stored::rounded_mm(note.at_mm.z)}};
    if (line) selector = {{"type", "WktSelector"}, {"value", wkt_of(note.line_mm)}};
    selector["unit"] = "mm";
    selector["frame"] = "of the scan: voxel number times voxel size";
    const auto body_of = [&](const std::string& text, const std::string& language) {
      ordered_json body{{"type", "TextualBody"}, {"value", text}, {"format", "text/plain"}};
      if (!language.empty()) body["language"] = language;
      return body;
    };
    ordered_json item{{"id", own + ":note:" + note.id}, {"type", "Annotation"}};
    // The vocabulary of W3C has no transcription; the one of IIIF calls it supplementing.
    item["motivation"] = line ? ordered_json::array({"describing", "supplementing"}) : ordered_json("commenting");
    if (!note.label.empty()) item["label"] = note.label;
    if (!record.creator.empty()) item["creator"] = {{"type", "Person"}, {"name", record.creator}};
    if (!note.created.empty()) item["created"] = note.created + "T00:00:00Z";
    if (!record.rights.empty()) item["rights"] = record.rights;
    item["body"] = body_of(note.text, line ? record.language.empty() ? "akk-Latn" : record.language : std::string());
    if (!note.translation.empty())
      item["body"] = ordered_json::array(
          {item["body"], body_of(note.translation, record.translated.empty() ? "en" : record.translated)});
    item["target"] = {{"source", source}, {"selector", std::move(selector)}};
    items.push_back(std::move(item));
  }
  const std::size_t total = items.size();
  const ordered_json terms{{"PointSelector", "http://iiif.io/api/presentation/4#PointSelector"},
                           {"WktSelector", "http://iiif.io/api/presentation/4#WktSelector"},
                           {"x", "http://iiif.io/api/presentation/4#x"},
                           {"y", "http://iiif.io/api/presentation/4#y"},
                           {"z", "http://iiif.io/api/presentation/4#z"},
                           {"unit", "http://iiif.io/api/presentation/4#unit"},
                           {"frame", "urn:dubsar:frame"},
                           {"supplementing", "http://iiif.io/api/presentation/3#supplementing"},
                           {"label", "http://www.w3.org/2000/01/rdf-schema#label"}};
  const std::string name = name_of(record);
  ordered_json out;
  out["@context"] = ordered_json::array({kAnnotationContext, terms});
  out["id"] = own + ":notes";
  out["type"] = "AnnotationCollection";
  out["label"] = "notes on " + (name.empty() ? fs::path(document.source.path).filename().string() : name);
  if (!record.creator.empty()) out["creator"] = {{"type", "Person"}, {"name", record.creator}};
  if (!record.rights.empty()) out["rights"] = record.rights;
  out["generator"] = {{"type", "Software"}, {"name", "dubsar"}};
  out["total"] = total;
  out["first"] = {{"id", own + ":notes:1"}, {"type", "AnnotationPage"}, {"startIndex", 0}, {"items", items}};
  return text_of(out);
}

Result<void> write_marks(const std::string& path, std::string_view text) {
  const fs::path target(path);
  const std::string suffix = target.extension().string();
  if (suffix != ".json" && suffix != ".jsonld")
    return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .json or .jsonld", path);
  const auto other = [&] {
    return fail(ErrorKind::kUsage, "cannot write {}: something else is there; give another name", path);
  };
  KeptFile file(target);
  const auto before = file.read();
  const std::string format = format_of(text);
  if (!before || (*before && (format.empty() || format_of(**before) != format))) return other();
  DUBSAR_ASSIGN(const Kept done, file.write(text));
  if (done == Kept::kStranger) return other();
  return {};
}

}  // namespace dubsar::app
