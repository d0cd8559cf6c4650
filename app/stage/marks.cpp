#include "app/stage/marks.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "app/stage/ground_color.h"

namespace dubsar::app {
namespace {

constexpr double kDotPx = 7.0, kDotBorderPx = 11.0, kLinePx = 2.2, kLineBorderPx = 5.0;
constexpr std::size_t kMostLetters = 48;

LinesItem lines(const std::vector<glm::dvec3>& pairs, double width_px, const Rgb8& color) {
  LinesItem out;
  out.points_mm = pairs;
  out.width_px = width_px;
  out.color = color;
  return out;
}

std::vector<glm::dvec3> pairs_of(const std::vector<glm::dvec3>& path) {
  std::vector<glm::dvec3> out;
  for (std::size_t i = 1; i < path.size(); ++i) {
    out.push_back(path[i - 1]);
    out.push_back(path[i]);
  }
  return out;
}

/// The first line, not longer than one reads at a glance.
std::string beginning(const std::string& text) {
  std::string out = text.substr(0, text.find('\n'));
  if (out.size() <= kMostLetters) return out;
  std::size_t end = kMostLetters;
  while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xc0) == 0x80) --end;  // no half letters
  return out.substr(0, end) + " ...";
}

class Marker {
 public:
  Marker(const Document& document, const PartLooks& parts, LabelFont& font)
      : document_(document), looks_(parts), font_(font) {}

  /// Where a thing of this part stands beside its place in the scan; none: it is not shown.
  std::optional<glm::dvec3> offset(const std::string& name) const {
    for (const Part& part : document_.parts) {
      if (part.name != name) continue;
      for (std::size_t p = 0; p < looks_.size(); ++p)
        if ((part.partitions >> p & 1) != 0)
          return looks_[p].visible && looks_[p].opacity > 0 ? std::optional(looks_[p].offset_mm) : std::nullopt;
    }
    return glm::dvec3(0.0);
  }
  void path(const std::vector<glm::dvec3>& at, const Rgb8& color) {
    if (at.size() < 2) return;
    out_.lines.push_back(lines(pairs_of(at), kLineBorderPx, kGroundColor));
    out_.lines.push_back(lines(pairs_of(at), kLinePx, color));
  }
  void straight(const glm::dvec3& a, const glm::dvec3& b, const Rgb8& color) {
    LinesItem line = lines({a, b}, 1.2, color);
    line.opacity = 0.7;
    out_.lines.push_back(std::move(line));
  }
  void dot(const glm::dvec3& at, const Rgb8& color) {
    out_.lines.push_back(lines({at, at}, kDotBorderPx, kGroundColor));
    out_.lines.push_back(lines({at, at}, kDotPx, color));
    out_.lines.back().lift_mm = 0.1;  // before its border
  }
  LabelItem& label(std::string text, const glm::dvec3& at, const Rgb8& color) {
    LabelItem label;
    label.font = &font_;
    label.text = std::move(text);
    label.at_mm = at;
    label.shift_px = {9.0, 7.0};
    label.height_px = kMarkLettersPx;
    label.color = color;
    label.border = kGroundColor;
    label.plate = kMarkPlate;
    return out_.labels.emplace_back(std::move(label));
  }
  Marks take(double scale) {
    for (LinesItem& line : out_.lines) line.width_px *= scale;
    for (LabelItem& label : out_.labels) {
      label.height_px *= scale;
      label.shift_px *= scale;
    }
    return std::move(out_);
  }

 private:
  const Document& document_;
  const PartLooks& looks_;
  LabelFont& font_;
  Marks out_;
};

std::vector<glm::dvec3> moved(std::vector<glm::dvec3> points, const glm::dvec3& offset) {
  for (glm::dvec3& p : points) p += offset;
  return points;
}

void mark(Marker& marker, const Measure& measure, std::size_t number) {
  const auto offset = marker.offset(measure.part);
  if (!offset) return;
  const auto points = moved(measure.points_mm, *offset), way = moved(measure.figures.path_mm, *offset);
  const bool depth = measure.kind == MeasureKind::kDepth, angle = measure.kind == MeasureKind::kAngle;
  if (angle) marker.path(points, kMeasuredColor);
  if (!angle) marker.path(way, kMeasuredColor);
  if (!angle && !depth && points.size() > 1) marker.straight(points[0], points[1], kMeasuredColor);
  if (!depth)
    for (const glm::dvec3& p : points) marker.dot(p, kMeasuredColor);
  if (depth && !way.empty()) marker.dot(way.front(), kMeasuredColor);
  const glm::dvec3 at = angle ? points[1] : way.empty() ? points[0] : depth ? way.front() : middle_of(way);
  const std::string name = measure.name.empty() ? fmt::format("{}", number) : measure.name;
  marker.label(fmt::format("{}: {}", name, figures_text(measure)), at, kMeasuredColor);
}

void mark(Marker& marker, const Note& note) {
  const auto offset = marker.offset(note.part);
  if (!offset) return;
  if (note.line_mm.size() > 1) {
    const auto line = moved(note.line_mm, *offset);
    marker.path(line, kWrittenColor);
    LabelItem& text = marker.label(note.text.empty() ? note.label : beginning(note.text), line.front(), kWrittenColor);
    text.along_mm = line.back() - line.front();
    text.shift_px = {0.0, 8.0};
    text.normal = note.normal;
    if (!note.text.empty() && !note.label.empty()) {
      LabelItem& label = marker.label(note.label, line.front(), kMeasuredColor);
      label.anchor = 1.0;
      label.shift_px = {-8.0, -5.0};
      label.normal = note.normal;
    }
    return;
  }
  marker.dot(note.at_mm + *offset, kWrittenColor);
  const std::string between = note.label.empty() || note.text.empty() ? "" : "  ";
  LabelItem& text = marker.label(note.label + between + beginning(note.text), note.at_mm + *offset, kWrittenColor);
  text.normal = note.normal;
}

}  // namespace

glm::dvec3 middle_of(const std::vector<glm::dvec3>& path_mm) {
  if (path_mm.empty()) return glm::dvec3(0.0);
  double all = 0.0;
  for (std::size_t i = 1; i < path_mm.size(); ++i) all += glm::distance(path_mm[i - 1], path_mm[i]);
  double left = 0.5 * all;
  for (std::size_t i = 1; i < path_mm.size(); ++i) {
    const double step = glm::distance(path_mm[i - 1], path_mm[i]);
    if (step >= left && step > 0) return path_mm[i - 1] + (path_mm[i] - path_mm[i - 1]) * (left / step);
    left -= step;
  }
  return path_mm.back();
}

Marks marks_of(const Document& document, const UiState& ui, const PartLooks& parts, LabelFont& font, double scale) {
  Marker marker(document, parts, font);
  for (std::size_t i = 0; i < document.measures.size(); ++i) mark(marker, document.measures[i], i + 1);
  for (std::size_t i = 0; i < document.notes.size(); ++i) mark(marker, document.notes[i]);
  for (const SurfacePin& pin : ui.pending)
    if (const auto offset = marker.offset(pin.part)) marker.dot(pin.at_mm + *offset, kMeasuredColor);
  return marker.take(scale);
}

}  // namespace dubsar::app
