#include "core/script/hand_copy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <type_traits>

#include "core/base/numbers/median.h"
#include "core/mesh/writing/measured_places.h"
#include "core/script/copy_mask.h"

namespace dubsar {
namespace {

// mm on paper; weights of lines as hand copies have them (docs/edition.md).
constexpr double kCopyMargin = 8.0, kCopyBetween = 6.0, kCopyTitle = 8.0, kCopyFoot = 16.0;
constexpr double kCopyOutline = 0.18, kCopyStroke = 0.13, kCopyHatch = 0.08, kCopyHatchSpacing = 0.8;
constexpr double kCopyMark = 0.1;  // rulings, cracks, seals: thinner than wedges
constexpr double kCopyCell = 0.1, kCopyTolerance = 0.07;
constexpr double kCopyLeastHead = 0.3;
constexpr double kCopyDepthStroke = 0.1, kCopyDepthMore = 0.25, kCopyMostStroke = 0.5;
constexpr int kCopyCurve = 8;  // pieces of a flank

/// One side before it has its place on the sheet: mm along right and up of its view.
struct SideDrawing {
  TextSide side = TextSide::kObverse;
  CopyView view;
  glm::dvec2 low{0.0}, high{0.0};
  glm::dvec2 corner{0.0};  ///< on the sheet, of (low.x, high.y)
  glm::dvec2 size() const { return high - low; }
  glm::dvec2 flat(const glm::dvec3& p) const { return {glm::dot(p, view.right), glm::dot(p, view.up)}; }
  glm::dvec2 paper(const glm::dvec2& q) const { return {corner.x + q.x - low.x, corner.y + high.y - q.y}; }
  glm::dvec2 paper(const glm::dvec3& p) const { return paper(flat(p)); }
};

std::vector<SideDrawing> measured_sides(const std::vector<glm::dvec3>& points, const TriMesh& mesh,
                                        const TabletFrame& frame) {
  std::vector<SideDrawing> out(kTextSideCount);
  for (std::size_t s = 0; s < kTextSideCount; ++s) {
    SideDrawing& d = out[s];
    d.side = static_cast<TextSide>(s);
    d.view = copy_view(frame, d.side);
    d.low = glm::dvec2(1e30), d.high = glm::dvec2(-1e30);
    for (const Triangle& t : mesh.triangles) {
      const glm::dvec2 q = d.flat(points[t[0]]);
      d.low = {std::min(d.low.x, q.x), std::min(d.low.y, q.y)};
      d.high = {std::max(d.high.x, q.x), std::max(d.high.y, q.y)};
    }
  }
  return out;
}

/// A cross: upper edge, obverse, lower edge and reverse from above, the other edges beside the obverse.
glm::dvec2 lay_out(std::vector<SideDrawing>& sides, double top) {
  const auto of = [&](TextSide side) -> SideDrawing& { return sides[static_cast<std::size_t>(side)]; };
  const double left = of(TextSide::kLeftEdge).size().x, middle = of(TextSide::kObverse).size().x,
               right = of(TextSide::kRightEdge).size().x;
  const double x = kCopyMargin + left + kCopyBetween;
  double y = top;
  for (const TextSide side : {TextSide::kUpperEdge, TextSide::kObverse, TextSide::kLowerEdge, TextSide::kReverse}) {
    of(side).corner = {x, y};
    if (side == TextSide::kObverse) {
      of(TextSide::kLeftEdge).corner = {kCopyMargin, y};
      of(TextSide::kRightEdge).corner = {x + middle + kCopyBetween, y};
    }
    y += of(side).size().y + kCopyBetween;
  }
  return {x + middle + kCopyBetween + right + kCopyMargin, y};
}

CopyPath path_of(std::string name, std::vector<glm::dvec2> points, double stroke, bool closed = false) {
  CopyPath path;
  path.name = std::move(name);
  path.points = std::move(points);
  path.stroke_mm = stroke;
  path.closed = closed;
  return path;
}

/// From a corner of the head to the end, bent towards the middle of the tail: points of a quadratic Bezier curve.
std::vector<glm::dvec2> flank_of(const glm::dvec2& corner, const glm::dvec2& bend, const glm::dvec2& end) {
  std::vector<glm::dvec2> out;
  for (int k = 0; k <= kCopyCurve; ++k) {
    const double t = static_cast<double>(k) / kCopyCurve, u = 1.0 - t;
    out.push_back(u * u * corner + 2.0 * u * t * bend + t * t * end);
  }
  return out;
}

CopyGroup wedge_group(const ScriptWedge& w, const SideDrawing& side, const HandCopyOptions& options,
                      double median_depth) {
  CopyGroup group;
  const std::string kind(name_in(kWedgeKinds, w.kind));
  group.id = fmt::format("w{}", w.order);
  group.classes = fmt::format("wedge {} {}", kind, name_in(kWedgeBys, w.by));
  group.data = {{"line", fmt::format("{} {}", name_in(kTextSides, w.side), w.line)},
                {"depth", fmt::format("{:.3f}", w.depth_mm)},
                {"confidence", fmt::format("{:.2f}", w.confidence)},
                {"evidence", std::string(name_in(kEvidences, w.evidence))}};
  const double wider = std::max(1.0, kCopyLeastHead / std::max(w.width_mm, 1e-6));
  const glm::dvec3 half = 0.5 * wider * (w.corner_mm[0] - w.corner_mm[1]);
  const glm::dvec2 a = side.paper(w.head_mm + half), b = side.paper(w.head_mm - half), end = side.paper(w.tail_mm);
  const bool tailed = w.length_mm > 1.3 * w.width_mm;
  const glm::dvec2 middle = 0.5 * (a + b);
  // A head is as long as it is broad, about; its flanks meet there and the tail goes on.
  const double head = tailed ? std::min(0.75 * w.width_mm / std::max(w.length_mm, 1e-6), 0.8) : 0.5;
  const glm::dvec2 bend = middle + head * (end - middle);
  double stroke = kCopyStroke;
  if (options.style == CopyStyle::kWeighted && median_depth > 0.0)
    stroke = std::min(kCopyMostStroke, kCopyDepthStroke + kCopyDepthMore * w.depth_mm / median_depth);
  const std::vector<glm::dvec2> left = tailed ? flank_of(a, bend, end) : std::vector<glm::dvec2>{a, end};
  const std::vector<glm::dvec2> right = tailed ? flank_of(b, bend, end) : std::vector<glm::dvec2>{b, end};
  if (options.style == CopyStyle::kFilled) {
    std::vector<glm::dvec2> whole = left;
    whole.insert(whole.end(), right.rbegin(), right.rend());
    CopyPath body = path_of("body", whole, 0.05, true);
    body.filled = true;
    group.paths.push_back(body);
  }
  group.paths.push_back(path_of("head", {a, b}, stroke));
  group.paths.push_back(path_of("left", left, stroke));
  group.paths.push_back(path_of("right", right, stroke));
  return group;
}

/// Silhouette and hatch of a side.
void draw_ground(const std::vector<glm::dvec3>& points, const TriMesh& mesh, const SideDrawing& side,
                 CopyLayer& outline, CopyLayer& inferred) {
  CopyMask shape(side.low, side.high, kCopyCell), unknown(side.low, side.high, kCopyCell);
  const auto is_inferred = [&](std::size_t t) {
    if (!mesh.triangle_inferred.empty() && mesh.triangle_inferred[t]) return true;
    return !mesh.evidence.empty() &&
           std::any_of(mesh.triangles[t].begin(), mesh.triangles[t].end(),
                       [&](std::uint32_t v) { return mesh.evidence[v] == evidence_byte(Evidence::kInferred); });
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& f = mesh.triangles[t];
    const glm::dvec3 n = glm::cross(points[f[1]] - points[f[0]], points[f[2]] - points[f[0]]);
    const double facing = glm::dot(n, side.view.front);
    if (!(facing > 0.0)) continue;
    shape.add_triangle(side.flat(points[f[0]]), side.flat(points[f[1]]), side.flat(points[f[2]]));
    if (facing > 0.6 * glm::length(n) && is_inferred(t))
      unknown.add_triangle(side.flat(points[f[0]]), side.flat(points[f[1]]), side.flat(points[f[2]]));
  }
  const auto on_paper = [&](const std::vector<glm::dvec2>& line) {
    std::vector<glm::dvec2> out;
    for (const glm::dvec2& q : line) out.push_back(side.paper(q));
    return out;
  };
  const auto loops = shape.outlines(kCopyTolerance, 40);
  if (!loops.empty()) outline.paths.push_back(path_of("outline", on_paper(loops.front()), kCopyOutline, true));
  for (const auto& loop : unknown.outlines(kCopyTolerance, 40))
    inferred.paths.push_back(path_of("border", on_paper(loop), kCopyHatch, true));
  for (const bool rising : {false, true})
    for (const auto& line : unknown.hatch(kCopyHatchSpacing, rising))
      inferred.paths.push_back(path_of("hatch", on_paper(line), kCopyHatch));
}

/// What is found of a kind of marks on a side: one group each, a line or an outline.
template <class Mark>
CopyLayer marks_layer(const std::vector<Mark>& marks, const SideDrawing& side, const std::string& kind,
                      std::vector<glm::dvec3> Mark::*places, double Mark::*size, const char* size_name) {
  const std::string name(name_in(kTextSides, side.side));
  CopyLayer layer{name + "-" + kind + "s", name + " " + kind + "s", name + " " + kind + "s", {}, {}, {}};
  for (const Mark& mark : marks) {
    if (mark.side != side.side) continue;
    CopyGroup group;
    group.id = fmt::format("{}-{}", layer.id, layer.groups.size() + 1);
    group.classes = kind + " machine";
    group.data = {{size_name, fmt::format("{:.3f}", mark.*size)}};
    std::vector<glm::dvec2> line;
    for (const glm::dvec3& p : mark.*places) line.push_back(side.paper(p));
    group.paths.push_back(path_of(kind, line, kCopyMark, std::is_same_v<Mark, ScriptSealing>));
    layer.groups.push_back(std::move(group));
  }
  return layer;
}

void number_lines_of(const SideDrawing& side, const std::vector<ScriptWedge>& wedges, CopyLayer& numbers) {
  std::map<int, std::pair<double, int>> heights;
  double leftmost = 1e30;
  for (const ScriptWedge& w : wedges) {
    if (w.side != side.side || w.line < 1) continue;
    const glm::dvec2 at = side.paper(0.5 * (w.head_mm + w.tail_mm));
    heights[w.line].first += at.y;
    ++heights[w.line].second;
    leftmost = std::min(leftmost, at.x);
  }
  // Edges that are read across have their lines across, too: no numbers beside them.
  if (side.side == TextSide::kLeftEdge || heights.empty()) return;
  for (const auto& [line, sum] : heights)
    numbers.texts.push_back(
        {{side.corner.x - 1.0, sum.first / sum.second + 0.8}, std::to_string(line), 2.2, CopyText::Anchor::kEnd});
}

void add_foot(CopySheet& sheet, double top, bool inferred, const HandCopyOptions& options) {
  CopyLayer foot{"scale", "scale and legend", "scale", {}, {}, {}};
  const int whole_cm = std::max(1, std::min(5, static_cast<int>((sheet.width_mm - 2.0 * kCopyMargin) / 10.0)));
  const double y = top + 2.0, x = kCopyMargin;
  foot.paths.push_back(path_of("ruler", {{x, y}, {x + 10.0 * whole_cm, y}}, kCopyOutline));
  for (int cm = 0; cm <= whole_cm; ++cm) {
    foot.paths.push_back(path_of("tick", {{x + 10.0 * cm, y - 1.5}, {x + 10.0 * cm, y}}, kCopyOutline));
    foot.texts.push_back({{x + 10.0 * cm, y + 2.8}, std::to_string(cm), 2.2, CopyText::Anchor::kMiddle});
  }
  foot.texts.push_back({{x + 10.0 * whole_cm + 3.0, y + 2.8}, "cm", 2.2, CopyText::Anchor::kStart});
  foot.texts.push_back(
      {{x, y + 7.0}, fmt::format("scale 1:1; drawn by {}", options.made_by), 2.2, CopyText::Anchor::kStart});
  if (inferred) {
    CopyMask box({0.0, 0.0}, {6.0, 2.6}, kCopyCell);
    box.add_triangle({0.0, 0.0}, {6.0, 0.0}, {6.0, 2.6});
    box.add_triangle({0.0, 0.0}, {6.0, 2.6}, {0.0, 2.6});
    for (const bool rising : {false, true})
      for (auto line : box.hatch(kCopyHatchSpacing, rising)) {
        for (glm::dvec2& q : line) q = {x + q.x, y + 11.5 - q.y};
        foot.paths.push_back(path_of("hatch", line, kCopyHatch));
      }
    foot.texts.push_back(
        {{x + 8.0, y + 11.2}, "clay is there, its surface is not in the scan", 2.2, CopyText::Anchor::kStart});
  }
  sheet.layers.push_back(std::move(foot));
}

}  // namespace

CopyView copy_view(const TabletFrame& f, TextSide side) {
  switch (side) {
    case TextSide::kObverse:
      return {f.right, f.up, f.front};
    case TextSide::kLowerEdge:
      return {f.right, f.front, -f.up};
    case TextSide::kReverse:
      return {f.right, -f.up, -f.front};
    case TextSide::kUpperEdge:
      return {f.right, -f.front, f.up};
    case TextSide::kLeftEdge:
      return {f.front, f.up, -f.right};
    case TextSide::kRightEdge:
      break;
  }
  return {-f.front, f.up, f.right};
}

Result<CopySheet> hand_copy(const TriMesh& mesh, const WedgesFound& found, const HandCopyOptions& options) {
  if (mesh.triangles.empty())
    return fail(ErrorKind::kBadData, "hand copy: a surface without triangles found, expected a tablet");
  const std::vector<glm::dvec3> points = places_mm(mesh);
  std::vector<SideDrawing> sides = measured_sides(points, mesh, found.sides.frame());
  CopySheet sheet;
  sheet.title = options.title.empty() ? "hand copy" : options.title;
  sheet.description = fmt::format("hand copy at true scale, one unit is one mm; drawn by {}", options.made_by);
  const double top = kCopyMargin + kCopyTitle;
  if (!options.whole_plate) {
    SideDrawing one = sides[static_cast<std::size_t>(options.side)];
    one.corner = {kCopyMargin + 4.0, top};
    const double wide = std::max(one.size().x, 50.0);
    sheet.width_mm = wide + 2.0 * kCopyMargin + 4.0;
    sheet.height_mm = top + one.size().y + kCopyBetween;
    sides = {one};
  } else {
    const glm::dvec2 size = lay_out(sides, top);
    sheet.width_mm = std::max(size.x, 60.0 + 2.0 * kCopyMargin);
    sheet.height_mm = size.y;
  }
  std::vector<double> depths;
  for (const ScriptWedge& w : found.wedges) depths.push_back(w.depth_mm);
  const double usual = median(depths);
  bool any_inferred = false;
  for (const SideDrawing& side : sides) {
    const std::string name(name_in(kTextSides, side.side));
    CopyLayer outline{name + "-outline", name + " outline", name + " outline", {}, {}, {}};
    CopyLayer inferred{name + "-inferred", name + " inferred", name + " inferred", {}, {}, {}};
    CopyLayer numbers{name + "-numbers", name + " line numbers", name + " numbers", {}, {}, {}};
    draw_ground(points, mesh, side, outline, inferred);
    outline.texts.push_back(
        {{side.corner.x + 0.5 * side.size().x, side.corner.y - 1.2}, name, 2.2, CopyText::Anchor::kMiddle});
    any_inferred = any_inferred || !inferred.paths.empty();
    sheet.layers.push_back(std::move(outline));
    if (!inferred.paths.empty()) sheet.layers.push_back(std::move(inferred));
    const ScriptMarks& marks = options.marks;
    for (CopyLayer& layer : std::array{
             marks_layer(marks.sealings, side, "seal", &ScriptSealing::outline_mm, &ScriptSealing::relief_mm, "relief"),
             marks_layer(marks.cracks, side, "crack", &ScriptCrack::line_mm, &ScriptCrack::width_mm, "width"),
             marks_layer(marks.rulings, side, "ruling", &ScriptRuling::line_mm, &ScriptRuling::depth_mm, "depth")})
      if (!layer.groups.empty()) sheet.layers.push_back(std::move(layer));
    for (std::size_t k = 0; k < kWedgeKindCount; ++k) {
      const std::string kind(name_in(kWedgeKinds, static_cast<WedgeKind>(k)));
      CopyLayer layer{name + "-" + kind, name + " " + kind, name + " " + kind, {}, {}, {}};
      for (const ScriptWedge& w : found.wedges)
        if (w.side == side.side && w.kind == static_cast<WedgeKind>(k))
          layer.groups.push_back(wedge_group(w, side, options, usual));
      if (!layer.groups.empty()) sheet.layers.push_back(std::move(layer));
    }
    if (options.line_numbers) number_lines_of(side, found.wedges, numbers);
    if (!numbers.texts.empty()) sheet.layers.push_back(std::move(numbers));
  }
  CopyLayer title{"title", "title", "title", {}, {}, {}};
  title.texts.push_back({{kCopyMargin, kCopyMargin + 2.0}, sheet.title, 4.0, CopyText::Anchor::kStart});
  sheet.layers.push_back(std::move(title));
  const double foot = sheet.height_mm;
  sheet.height_mm += kCopyFoot;
  add_foot(sheet, foot, any_inferred, options);
  return sheet;
}

}  // namespace dubsar
