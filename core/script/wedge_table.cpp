#include "core/script/wedge_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "core/base/files/sealed_text.h"

namespace dubsar {

namespace {

std::vector<int> orders_before(const ScriptWedge& w) {
  std::vector<int> out;
  for (const WedgeBefore& before : w.pressed_after) out.push_back(before.order);
  return out;
}

}  // namespace

std::string wedges_csv(std::span<const ScriptWedge> wedges) {
  std::string out = fmt::format("{},{}\n", kWedgeColumns, kUnsealed);
  const auto point = [](const glm::dvec3& p) { return fmt::format("{:.4f},{:.4f},{:.4f}", p.x, p.y, p.z); };
  const auto before = [](const ScriptWedge& w) { return fmt::format("{}", fmt::join(orders_before(w), ";")); };
  for (const ScriptWedge& w : wedges)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.1f},{},{:.3f},{},{},\n", w.order,
                       name_in(kTextSides, w.side), w.column, w.line, w.order, name_in(kWedgeKinds, w.kind),
                       point(w.head_mm), point(w.tip_mm), point(w.tail_mm), point(w.normal), w.depth_mm, w.length_mm,
                       w.width_mm, w.opening_deg, before(w), w.confidence, name_in(kEvidences, w.evidence),
                       name_in(kWedgeBys, w.by));
  return sealed_text(std::move(out));
}

std::string wedges_json(const WedgesFound& found, const std::string& made_by, const ScriptMarks& marks) {
  const auto rounded = [](double v, double digits) { return std::round(v * digits) / digits; };
  const auto point = [&](const glm::dvec3& p) {
    return nlohmann::json::array({rounded(p.x, 1e4), rounded(p.y, 1e4), rounded(p.z, 1e4)});
  };
  nlohmann::ordered_json out{{"made_by", made_by},
                             {"checksum", kUnsealed},
                             {"unit", "mm"},
                             {"frame", "of the scan: voxel index times voxel size"},
                             {"usual_width_mm", rounded(found.scale.width_mm, 1e4)},
                             {"misfit", rounded(found.scale.misfit, 1e4)},
                             {"up_probability", found.sides.frame().up_probability},
                             {"obverse_probability", found.sides.frame().obverse_probability},
                             {"wedges", nlohmann::ordered_json::array()}};
  for (const ScriptWedge& w : found.wedges)
    out["wedges"].push_back({{"id", w.order},
                             {"side", name_in(kTextSides, w.side)},
                             {"column", w.column},
                             {"line", w.line},
                             {"order", w.order},
                             {"kind", name_in(kWedgeKinds, w.kind)},
                             {"head", point(w.head_mm)},
                             {"corners", {point(w.corner_mm[0]), point(w.corner_mm[1])}},
                             {"tip", point(w.tip_mm)},
                             {"tail", point(w.tail_mm)},
                             {"normal", point(w.normal)},
                             {"depth_mm", rounded(w.depth_mm, 1e4)},
                             {"length_mm", rounded(w.length_mm, 1e4)},
                             {"width_mm", rounded(w.width_mm, 1e4)},
                             {"opening_deg", rounded(w.opening_deg, 10)},
                             {"pressed_after", orders_before(w)},
                             {"confidence", rounded(w.confidence, 1e3)},
                             {"evidence", name_in(kEvidences, w.evidence)},
                             {"by", name_in(kWedgeBys, w.by)}});
  const auto add = [&](const char* list, TextSide side, const char* size, double mm, const char* line,
                       std::span<const glm::dvec3> points) {
    nlohmann::ordered_json places = nlohmann::ordered_json::array();
    for (const glm::dvec3& p : points) places.emplace_back(nlohmann::ordered_json(point(p)));
    out[list].push_back({{"side", name_in(kTextSides, side)},
                         {size, rounded(mm, 1e4)},
                         {line, std::move(places)},
                         {"by", name_in(kWedgeBys, WedgeBy::kMachine)}});
  };
  for (const char* list : {"rulings", "cracks", "seals"}) out[list] = nlohmann::ordered_json::array();
  for (const ScriptRuling& m : marks.rulings) add("rulings", m.side, "depth_mm", m.depth_mm, "line", m.line_mm);
  for (const ScriptCrack& m : marks.cracks) add("cracks", m.side, "width_mm", m.width_mm, "line", m.line_mm);
  for (const ScriptSealing& m : marks.sealings) add("seals", m.side, "relief_mm", m.relief_mm, "outline", m.outline_mm);
  return sealed_text(out.dump(1) + "\n");
}

}  // namespace dubsar
