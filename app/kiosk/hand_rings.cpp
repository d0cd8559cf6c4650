#include "app/kiosk/hand_rings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dubsar::app {
namespace {

constexpr double kAcross = 0.45;                  // of the panel's width and height, to each side
constexpr double kBefore = 0.12, kBehind = 0.05;  // of its height
constexpr double kOpenRadius = 0.055, kClosedRadius = 0.026, kRestRadius = 0.072;
constexpr int kSegments = 40;
constexpr Rgb8 kAmber{217, 164, 65}, kGrey{150, 150, 150};

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

glm::dvec3 ring_place_mm(const RingStage& stage, const glm::dvec3& place_m) noexcept {
  const glm::dvec3 middle = 0.5 * (stage.zone.min_m + stage.zone.max_m);
  const glm::dvec3 half = glm::max(0.5 * (stage.zone.max_m - stage.zone.min_m), glm::dvec3(1e-3));
  const glm::dvec3 at = glm::clamp((place_m - middle) / half, glm::dvec3(-1.0), glm::dvec3(1.0));
  const double height = stage.window_mm.y;
  const double depth = 0.5 * (at.z + 1.0);  // 0 nearest to the panel's back, 1 nearest to the person
  return {stage.middle_mm.x + kAcross * stage.window_mm.x * at.x, stage.middle_mm.y + kAcross * height * at.y,
          height * (depth * (kBefore + kBehind) - kBehind)};
}

std::vector<LinesItem> hand_rings(const RingStage& stage, std::span<const HandMark> hands) {
  std::vector<LinesItem> out;
  for (const HandMark& hand : hands) {
    const bool good = hand.state == HandState::kHolding || hand.state == HandState::kReady;
    const double height = stage.window_mm.y, closing = std::clamp(hand.closing, 0.0, 1.0);
    const glm::dvec3 at = ring_place_mm(stage, hand.place_m);
    LinesItem ring = arc(at, height * std::lerp(kOpenRadius, kClosedRadius, closing), 1.0,
                         hand.state == HandState::kHolding ? 5.0 : 3.0, good ? kAmber : kGrey);
    ring.opacity = good ? 0.95 : 0.6;
    out.push_back(std::move(ring));
    if (hand.resting > 0.0) out.push_back(arc(at, height * kRestRadius, std::min(hand.resting, 1.0), 6.0, kAmber));
  }
  return out;
}

}  // namespace dubsar::app
