#include "app/publish/report_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/publish/page_files.h"
#include "core/base/text/json_text.h"
#include "core/base/text/markup_text.h"

namespace dubsar::app {
namespace {

std::string_view page_file(std::string_view name) {
  for (const auto& [file, text] : page_files())
    if (file == name) return text;
  return {};
}

/// What many small hollows and crumbs span and hold is nothing that anybody could measure.
std::string size_cells(const PartFacts& part) {
  if (part.kind == PartitionKind::kPores) return fmt::format("<td></td><td>{:.0f}</td><td></td>", part.area);
  return fmt::format("<td>{:.1f} × {:.1f} × {:.1f}</td><td>{:.0f}</td><td>{:.0f}</td>", part.size.x, part.size.y,
                     part.size.z, part.area, part.volume);
}

/// As a person writes it: six digits of a number are enough, sizes have their crosses.
std::string value_text(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (!value.is_array()) return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  for (const nlohmann::json& each : value) out += (out.empty() ? "" : " × ") + value_text(each);
  return out;
}

std::string parts_table(const SurfaceFacts& facts) {
  const char* const unit = facts.millimetres ? "mm" : "voxels";
  std::string out = fmt::format(
      "<div class=\"scroll\"><table><tr><th>part</th><th>{}</th><th>surface, {}²</th><th>volume, {}³</th>"
      "<th>not in the scan</th><th></th></tr>\n",
      facts.upright() ? fmt::format("width × height × thickness, {}", unit) : fmt::format("size, {}", unit), unit,
      unit);
  for (const PartFacts& part : facts.parts)
    out += fmt::format("<tr><td>{}</td>{}<td>{:.0f} {}² ({:.1f} %)</td><td>{}</td></tr>\n", markup_text(part.name),
                       size_cells(part), part.inferred_area, unit, 100.0 * part.inferred_share(),
                       part.watertight ? "watertight" : "open");
  return out + "</table></div>\n";
}

std::string evidence(const SurfaceFacts& facts) {
  std::string out;
  for (const PartFacts& part : facts.parts) {
    if (part.inferred_area <= 0.0) continue;
    out += fmt::format(
        "<p>{}: {:.1f} % of the surface is measured, {:.1f} % is not in the scan: there it was closed smoothly, and is "
        "brown in the picture above and hatched in those below.</p><div class=\"bar\"><i "
        "style=\"width:{:.2f}%\"></i></div>\n",
        markup_text(part.name), 100.0 * (1.0 - part.inferred_share()), 100.0 * part.inferred_share(),
        100.0 * part.inferred_share());
  }
  if (out.empty()) return "<p>All of the surface is in the scan.</p>\n";
  const char* const unit = facts.millimetres ? "mm²" : "voxel faces";
  for (const PartFacts& part : facts.parts) {
    if (part.area - part.evidence_area(Evidence::kMeasured) <= 0.0) continue;
    out += fmt::format("<div class=\"scroll\"><table><tr><th>{}, {}</th>", markup_text(part.name), unit);
    for (const auto& [evidence, name, short_name] : kEvidences) out += fmt::format("<th>{}</th>", name);
    out += "</tr>\n";
    for (std::size_t side = 0; side < kEvidenceSides.size(); ++side) {
      out += fmt::format("<tr><td>{}</td>", kEvidenceSides[side]);
      for (const double area : part.sides[side]) out += fmt::format("<td>{:.1f}</td>", area);
      out += "</tr>\n";
    }
    out += "</table></div>\n";
  }
  return out;
}

/// What a reader wants to know of how it was made, and all of it below.
std::string provenance(const ReportContent& content) {
  if (content.provenance.empty()) return "<p class=\"dim\">The file does not say how it was made.</p>\n";
  const auto facts = nlohmann::json::parse(content.provenance, nullptr, false);
  if (facts.is_discarded()) return "<pre>" + markup_text(content.provenance) + "</pre>\n";
  std::string rows;
  const auto row = [&](const char* name, const nlohmann::json::json_pointer& at) {
    if (!facts.contains(at) || facts.at(at).is_null()) return;
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", name, markup_text(value_text(facts.at(at))));
  };
  using Pointer = nlohmann::json::json_pointer;
  row("scan", Pointer("/input/path"));
  row("data set", Pointer("/input/dataset"));
  row("voxels", Pointer("/input/file_dims"));
  row("voxel size, mm", Pointer("/input/voxel_size_mm"));
  row("voxel size from", Pointer("/input/provenance"));
  row("signal to noise, dB", Pointer("/estimates/snr_db"));
  row("threshold", Pointer("/estimates/threshold"));
  return "<div class=\"scroll\"><table>" + rows + "</table></div>\n<details><summary>all parameters</summary><pre>" +
         markup_text(dump_json_lines(facts)) + "</pre></details>\n";
}

/// JSON in which nothing ends the element that it stands in.
std::string pins_json(const std::vector<ReportPin>& pins) {
  nlohmann::json out = nlohmann::json::array();
  for (const ReportPin& pin : pins)
    out.push_back({{"label", pin.label},
                   {"text", pin.text},
                   {"at", {pin.at.x, pin.at.y, pin.at.z}},
                   {"normal", {pin.normal.x, pin.normal.y, pin.normal.z}},
                   {"envelope", pin.envelope}});
  std::string text = out.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

/// A table of what somebody kept; nothing where they kept none.
std::string work_table(const char* heading, const std::vector<ReportRow>& rows) {
  if (rows.empty()) return {};
  std::string out = fmt::format("<h2>{}</h2>\n<div class=\"scroll\"><table>\n", heading);
  for (const ReportRow& row : rows)
    out += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"dim\">{}</td></tr>\n", markup_text(row.label),
                       markup_text(row.text), markup_text(row.more));
  return out + "</table></div>\n";
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kLetters[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string report_page(const ReportContent& content) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"generator\" content=\"dubsar\">\n<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<title>{0}</title>\n<style>\n{1}</style>\n"
      "</head>\n<body>\n<h1>{0}</h1>\n<p class=\"dim\">{2}{3}</p>\n",
      markup_text(content.title), page_file("page.css"), markup_text(what_it_is(content.facts)),
      content.institution.empty() ? "" : ", " + markup_text(content.institution));
  out +=
      "<div id=\"stage\"><canvas></canvas><p>This page shows the surface with JavaScript.</p></div>\n<div "
      "class=\"desk\"></div>\n";
  if (content.simplified)
    out +=
        "<p class=\"dim\">Here the surface has fewer triangles where it is flat; the pictures below show all of "
        "it.</p>\n";
  out += work_table("Tablet", content.work.record);
  out += "<h2>Parts</h2>\n" + parts_table(content.facts);
  if (!content.facts.way.sure())
    out += fmt::format("<p>Of the sides below: {}.</p>\n", markup_text(content.facts.way.doubt()));
  out += "<h2>Evidence</h2>\n" + evidence(content.facts);
  out += "<h2>Six sides</h2>\n<div class=\"sides\">\n";
  for (const ReportPicture& picture : content.pictures)
    out += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/jpeg;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        markup_text(picture.caption), base64(picture.jpeg));
  out += "</div>\n" + work_table("Text", content.work.lines) + work_table("Notes", content.work.notes) +
         work_table("Measures", content.work.measures);
  out += "<h2>How it was made</h2>\n" + provenance(content);
  out += fmt::format("<p class=\"dim\">Made by {}.{}</p>\n", markup_text(content.made_by),
                     content.rights.empty() ? "" : " " + markup_text(content.rights));
  out += "<script type=\"application/json\" id=\"pins\">" + pins_json(content.work.pins) + "</script>\n";
  out += "<script type=\"application/octet-stream\" id=\"surface\">" + base64(content.glb) + "</script>\n<script>\n";
  out += page_file("viewer.js");
  return out + "</script>\n</body>\n</html>\n";
}

}  // namespace dubsar::app
