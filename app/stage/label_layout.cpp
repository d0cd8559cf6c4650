#include "app/stage/label_layout.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "display/render/images/label_font.h"

namespace dubsar::app {
namespace {

constexpr double kAboveEm = 0.8, kBelowEm = 0.25;  // of the letters, from their base line
constexpr double kLineEm = 1.15;                   // from one line of text to the next
constexpr int kPlaces = 6;
constexpr double kLeastFacing = 0.12;  // cosine: 7 degrees above the surface
constexpr double kLeastAcross = 0.6;   // of the length of a line, what is seen of it: 37 degrees from its end

struct Projected {
  glm::dvec2 px{0.0};
  double depth = 0.0;
};
std::optional<Projected> project(const glm::dvec3& at_mm, const View& view, const PixelSize& size) {
  const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(at_mm, 1.0);
  if (!(clip.w > 0)) return std::nullopt;
  return Projected{(glm::dvec2(clip) / clip.w + 1.0) * 0.5 * glm::dvec2(size.width, size.height), clip.z / clip.w};
}

/// The label as it came, below its place, to the left of it above and below, and a line farther away.
LabelItem placed(const LabelItem& label, int place) {
  LabelItem out = label;
  const double below = -label.shift_px.y - (kAboveEm - kBelowEm) * label.height_px;
  if (place == 1 || place == 3) out.shift_px.y = below;
  if (place == 2 || place == 3) {
    out.shift_px.x = -label.shift_px.x;
    out.anchor = 1.0 - label.anchor;
  }
  if (place == 4) out.shift_px.y += kLineEm * label.height_px;
  if (place == 5) out.shift_px.y = below - kLineEm * label.height_px;
  return out;
}

}  // namespace

bool turn_to_reader(LabelItem& label, const View& view) {
  const glm::dmat3 turn(view.view_from_world);
  const glm::dvec3 at(view.view_from_world * glm::dvec4(label.at_mm, 1.0));
  const glm::dvec3 to_eye = view.orthographic() ? glm::dvec3(0, 0, 1) : -at / std::max(glm::length(at), 1e-9);
  const glm::dvec3 normal = turn * label.normal, along = turn * label.along_mm;
  const double size = glm::length(normal), length = glm::length(along);
  if (size > 0 && glm::dot(normal, to_eye) < kLeastFacing * size) return false;
  if (!(length > 0)) return true;
  if (glm::length(glm::cross(along, to_eye)) < kLeastAcross * length) return false;
  if (along.x < 0) {
    label.at_mm += label.along_mm;
    label.along_mm = -label.along_mm;
  }
  return true;
}

std::vector<LabelRect> label_rects(const LabelItem& label, const View& view, const PixelSize& size) {
  const auto at = project(label.at_mm, view, size);
  if (!at) return {};
  glm::dvec2 right(1.0, 0.0);
  if (glm::length(label.along_mm) > 0)
    if (const auto there = project(label.at_mm + label.along_mm, view, size))
      if (const glm::dvec2 way = there->px - at->px; glm::length(way) > 1.0) right = glm::normalize(way);
  const glm::dvec2 up(-right.y, right.x);
  const double width = label.font->width_em(label.text) * label.height_px, low = -kBelowEm * label.height_px;
  const int pieces = right.y == 0.0 ? 1 : std::max(1, static_cast<int>(std::ceil(width / label.height_px)));
  const double begin = label.shift_px.x - label.anchor * width, step = width / pieces;
  std::vector<LabelRect> out;
  for (int piece = 0; piece < pieces; ++piece) {
    LabelRect rect{at->px + 1e9, at->px - 1e9};
    for (const double x : {begin + piece * step, begin + (piece + 1) * step})
      for (const double y : {low, kAboveEm * label.height_px}) {
        const glm::dvec2 corner = at->px + x * right + (label.shift_px.y + y) * up;
        rect.min = glm::min(rect.min, corner);
        rect.max = glm::max(rect.max, corner);
      }
    out.push_back(rect);
  }
  return out;
}

bool cover(std::span<const LabelRect> some, std::span<const LabelRect> others) {
  return std::any_of(some.begin(), some.end(), [&](const LabelRect& one) {
    return std::any_of(others.begin(), others.end(), [&](const LabelRect& other) { return one.covers(other); });
  });
}

void LabelLayout::arrange(std::vector<LabelItem>& labels, const glm::dvec3& middle_mm, const View& view,
                          const PixelSize& size) {
  struct Candidate {
    std::size_t index;
    std::pair<std::string, int> name;
    int before;  // where it stood; -1: nowhere
    int rank;    // who chooses first
  };
  const auto middle = project(middle_mm, view, size);
  std::map<std::string, int> same;
  std::vector<Candidate> order;
  std::vector<LabelRect> taken;
  std::vector<bool> stays(labels.size(), true);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LabelItem& label = labels[i];
    if (label.text.empty() || label.font == nullptr) continue;
    const auto at = project(label.at_mm, view, size);
    if (!at) continue;
    const std::pair<std::string, int> name{label.text, same[label.text]++};
    const auto found = chosen_.find(name);
    const int before = found == chosen_.end() ? -1 : found->second;
    const bool wanted = label.hidden_opacity > 0, along = glm::length(label.along_mm) > 0;
    const bool near = !middle || at->depth <= middle->depth;
    order.push_back({i, name, before, along || wanted ? 0 : (near ? 1 : 3) + (before < 0 ? 1 : 0)});
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.rank < b.rank; });
  chosen_.clear();
  for (const Candidate& each : order) {
    LabelItem& label = labels[each.index];
    const bool along = glm::length(label.along_mm) > 0;
    std::vector<int> places;
    if (each.before >= 0) places.push_back(each.before);
    for (int place = 0; place < (along ? 1 : kPlaces); ++place) places.push_back(place);
    const auto free = std::find_if(places.begin(), places.end(), [&](int place) {
      return !cover(taken, label_rects(placed(label, place), view, size));
    });
    if (free == places.end() && each.rank > 0) {
      stays[each.index] = false;
      continue;
    }
    const int place = free == places.end() ? places.front() : *free;
    chosen_[each.name] = place;
    label = placed(label, place);
    for (const LabelRect& rect : label_rects(label, view, size)) taken.push_back(rect);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (stays[i]) {
      if (kept != i) labels[kept] = std::move(labels[i]);
      ++kept;
    }
  labels.resize(kept);
}

View middle_view(std::span<const View> views) {
  const View &a = views[(views.size() - 1) / 2], &b = views[views.size() / 2];
  return {0.5 * (a.view_from_world + b.view_from_world), 0.5 * (a.clip_from_view + b.clip_from_view)};
}

}  // namespace dubsar::app
