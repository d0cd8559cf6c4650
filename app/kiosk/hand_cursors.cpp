#include "app/kiosk/hand_cursors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace dubsar::app {
namespace {

constexpr double kAcross = 0.45;                  // of the panel's width and height, to each side
constexpr double kBefore = 0.12, kBehind = 0.05;  // of its height
constexpr double kOpenRadius = 0.055, kClosedRadius = 0.026, kRestRadius = 0.072;
constexpr double kWithin = 0.72;  // of the object's extent: there is object, whatever its shape
constexpr double kGlowRadius = 0.2, kNear = 0.8, kFar = 0.4, kGlowEaseS = 0.35;
constexpr double kArrow = 0.12, kArrowRise = 0.06, kArrowPeriodS = 1.6, kArrowEaseS = 0.4, kRingStays = 0.8;
constexpr int kSegments = 40;
constexpr Rgb8 kAmber{217, 164, 65}, kGrey{150, 150, 150}, kPale{235, 230, 215}, kDark{25, 22, 18};

LinesItem arc(const glm::dvec3& centre, double radius, double share, double width_px, Rgb8 color) {
  LinesItem out;
  out.width_px = width_px;
  out.color = color;
  out.hidden_opacity = 0.45;  // a hand behind the object is still seen
  const int count = std::max(1, static_cast<int>(std::lround(share * kSegments)));
  const auto at = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * share * i / count;  // from the top, clockwise
    return centre + radius * glm::dvec3(std::sin(angle), std::cos(angle), 0.0);
  };
  for (int i = 0; i < count; ++i) {
    out.points_mm.push_back(at(i));
    out.points_mm.push_back(at(i + 1));
  }
  return out;
}

}  // namespace

glm::dvec3 cursor_place_mm(const CursorScene& scene, const glm::dvec3& place_m) noexcept {
  const glm::dvec3 middle = 0.5 * (scene.zone.min_m + scene.zone.max_m);
  const glm::dvec3 half = glm::max(0.5 * (scene.zone.max_m - scene.zone.min_m), glm::dvec3(1e-3));
  const glm::dvec3 at = glm::clamp((place_m - middle) / half, glm::dvec3(-1.0), glm::dvec3(1.0));
  const double height = scene.window_mm.y;
  const double depth = 0.5 * (at.z + 1.0);  // 0 nearest to the panel's back, 1 nearest to the person
  return {scene.middle_mm.x + kAcross * scene.window_mm.x * at.x, scene.middle_mm.y + kAcross * height * at.y,
          height * (depth * (kBefore + kBehind) - kBehind)};
}

std::vector<LinesItem> hand_cursors(const CursorScene& scene, std::span<const HandMark> hands) {
  std::vector<LinesItem> out;
  for (const HandMark& hand : hands) {
    const bool good = hand.state == HandState::kHolding || hand.state == HandState::kReady;
    const double height = scene.window_mm.y, closing = std::clamp(hand.closing, 0.0, 1.0);
    const glm::dvec3 at = cursor_place_mm(scene, hand.place_m);
    LinesItem ring = arc(at, height * std::lerp(kOpenRadius, kClosedRadius, closing), 1.0,
                         hand.state == HandState::kHolding ? 5.0 : 3.0, good ? kAmber : kGrey);
    ring.opacity = good ? 0.95 : 0.6;
    out.push_back(std::move(ring));
    if (hand.resting > 0.0) out.push_back(arc(at, height * kRestRadius, std::min(hand.resting, 1.0), 6.0, kAmber));
  }
  return out;
}

std::vector<LinesItem> higher_arrow(const CursorScene& scene, const glm::dvec3& place_m, double seconds) {
  const double height = scene.window_mm.y;
  const glm::dvec3 at = cursor_place_mm(scene, place_m);
  const double shown = std::clamp(seconds / kArrowEaseS, 0.0, 1.0);
  LinesItem ring = arc(at, height * kOpenRadius, 1.0, 3.0, kPale);
  ring.opacity = ring.hidden_opacity = kRingStays * shown;
  LinesItem arrow;
  arrow.width_px = 6.0;
  arrow.color = kAmber;
  arrow.opacity = arrow.hidden_opacity = 0.95 * shown;  // before clay of nearly its colour, too, hence its edge
  const double rises = std::fmod(seconds, kArrowPeriodS) / kArrowPeriodS, eased = rises * rises * (3.0 - 2.0 * rises);
  const glm::dvec3 foot = at + height * glm::dvec3(0.0, kOpenRadius + 0.02 + kArrowRise * eased, 0.0);
  const glm::dvec3 tip = foot + glm::dvec3(0.0, height * kArrow, 0.0);
  const double barb = 0.45 * kArrow * height;
  arrow.points_mm = {foot, tip, tip, tip + glm::dvec3(-barb, -barb, 0.0), tip, tip + glm::dvec3(barb, -barb, 0.0)};
  LinesItem edge = arrow;
  edge.width_px = 12.0;
  edge.color = kDark;
  edge.opacity = edge.hidden_opacity = 0.6 * shown;
  return {std::move(ring), std::move(edge), std::move(arrow)};
}

Glow object_glow(const CursorScene& scene, std::span<const HandMark> hands, std::span<const ScreenRect> objects) {
  Glow out;
  double nearest = std::numeric_limits<double>::max();
  const double height = scene.window_mm.y;
  for (const HandMark& hand : hands) {
    const bool holds = hand.state == HandState::kHolding;
    if (!holds && hand.state != HandState::kReady) continue;
    const glm::dvec2 ring(cursor_place_mm(scene, hand.place_m));
    for (const ScreenRect& rect : objects) {
      const glm::dvec2 middle = 0.5 * (rect.min_mm + rect.max_mm);
      const glm::dvec2 half = glm::max(kWithin * 0.5 * (rect.max_mm - rect.min_mm), glm::dvec2(1e-3));
      const double out_by = glm::length((ring - middle) / half);
      const glm::dvec2 at = out_by > 1.0 ? middle + (ring - middle) / out_by : ring;
      const double apart = glm::distance(ring, at);
      const double rank = apart - (holds ? 10.0 * height : 0.0);
      if (rank >= nearest) continue;
      nearest = rank;
      out.at_mm = glm::dvec3(at, 0.0);
      out.radius_mm = kGlowRadius * height;
      out.strength = holds ? 1.0 : std::lerp(kNear, kFar, std::min(1.0, apart / (0.5 * height)));
    }
  }
  return out;
}

const Glow& EasedGlow::update(const Glow& wanted, double dt_s) {
  const double step = dt_s / kGlowEaseS, left = std::exp(-3.0 * step);
  if (wanted.strength > 0) {
    const bool was = shown_.strength > 0;
    shown_.at_mm = was ? glm::mix(wanted.at_mm, shown_.at_mm, left) : wanted.at_mm;
    shown_.radius_mm = wanted.radius_mm;
  }
  const double apart = wanted.strength - shown_.strength;
  shown_.strength = std::clamp(shown_.strength + std::clamp(apart, -step, step), 0.0, 1.0);
  return shown_;
}

}  // namespace dubsar::app
