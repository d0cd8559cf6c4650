#include "input/gestures/touch_pointer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace dubsar {
namespace {

constexpr double kSlop = 0.008;  // heights of the window: 2.7 mm of a panel of 27 inches, as a resting finger rolls
constexpr TimestampNs kRestNs = 150'000'000;  // the fingers of one hand land within 100 ms
constexpr double kTogether = 0.01;            // heights of the window, of fingers from their middle

InputEvent event_of(EventKind kind, TimestampNs time, std::optional<glm::dvec2> at) {
  InputEvent out;
  out.kind = kind;
  out.time = time;
  out.at = at;
  out.touched = true;
  return out;
}

bool has(std::span<const std::uint32_t> ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

glm::dvec2 middle_of(std::span<const glm::dvec2> points) {
  glm::dvec2 sum{0.0};
  for (const glm::dvec2& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

PinchStep pinch_between(std::span<const glm::dvec2> before, std::span<const glm::dvec2> after) {
  if (before.empty()) return {};
  const glm::dvec2 from = middle_of(before), to = middle_of(after);
  PinchStep out;
  out.by = to - from;
  // Umeyama 1991 in the plane: with points as complex numbers, the factor with its turn is sum(conj p q) / sum |p|^2.
  double along = 0.0, across = 0.0, size = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const glm::dvec2 p = before[i] - from, q = after[i] - to;
    along += glm::dot(p, q);
    across += p.x * q.y - p.y * q.x;
    size += glm::dot(p, p);
  }
  const double length = std::hypot(along, across), least = kTogether * kTogether * static_cast<double>(before.size());
  if (size < least || length < least) return out;
  out.factor = length / size;
  out.roll_rad = std::atan2(across, along);
  return out;
}

void TouchPointer::press(TimestampNs time, const glm::dvec2& at, std::vector<InputEvent>& out) {
  InputEvent event = event_of(EventKind::kButton, time, at);
  event.down = true;
  out.push_back(event);
  at_ = at;
  phase_ = Phase::kHolds;
}

void TouchPointer::release(TimestampNs time, std::optional<glm::dvec2> at, std::vector<InputEvent>& out) {
  out.push_back(event_of(EventKind::kButton, time, at));
  phase_ = Phase::kNone;
}

void TouchPointer::move(TimestampNs time, const glm::dvec2& to, std::vector<InputEvent>& out) {
  if (to == at_) return;
  InputEvent event = event_of(EventKind::kMotion, time, to);
  event.motion = kPixelsPerWindow * glm::dvec2(to.x - at_.x, at_.y - to.y);
  out.push_back(event);
  at_ = to;
}

void TouchPointer::none(TimestampNs time, bool cancelled, std::vector<InputEvent>& out) {
  if (phase_ == Phase::kRests && !cancelled) press(time, from_, out);
  if (phase_ == Phase::kHolds) release(time, cancelled ? std::nullopt : std::optional(at_), out);
  if (phase_ == Phase::kPinches) out.push_back(event_of(EventKind::kPinch, time, std::nullopt));
  phase_ = Phase::kNone;
}

void TouchPointer::one(TimestampNs time, const PlacedTouch& finger, bool cancelled, std::vector<InputEvent>& out) {
  if (phase_ == Phase::kPinches) {
    out.push_back(event_of(EventKind::kPinch, time, std::nullopt));
    phase_ = Phase::kStays;
    from_ = finger.at;
    return;
  }
  if (phase_ != Phase::kNone && fingers_.front().id != finger.id) none(time, cancelled, out);
  if (phase_ == Phase::kNone) {
    phase_ = Phase::kRests;
    since_ = time;
    from_ = finger.at;
  }
  const bool moved = glm::distance(finger.at, from_) > kSlop;
  if (phase_ == Phase::kRests && (moved || time - since_ >= kRestNs)) press(time, from_, out);
  if (phase_ == Phase::kStays && moved) press(time, finger.at, out);
  if (phase_ == Phase::kHolds) move(time, finger.at, out);
}

void TouchPointer::pinch(TimestampNs time, std::span<const PlacedTouch> fingers, std::vector<InputEvent>& out) {
  if (phase_ == Phase::kHolds) release(time, std::nullopt, out);
  const bool begins = phase_ != Phase::kPinches;
  phase_ = Phase::kPinches;
  std::vector<glm::dvec2> before, after;
  for (const PlacedTouch& finger : fingers)
    for (const PlacedTouch& was : fingers_)
      if (was.id == finger.id) {
        before.push_back(was.at);
        after.push_back(finger.at);
      }
  InputEvent event = event_of(EventKind::kPinch, time, std::nullopt);
  event.down = true;
  if (begins || before.size() < 2) {
    after.clear();
    for (const PlacedTouch& finger : fingers) after.push_back(finger.at);
  } else {
    event.pinch = pinch_between(before, after);
  }
  event.at = middle_of(after);
  out.push_back(event);
}

void TouchPointer::update(TimestampNs time, std::span<const PlacedTouch> fingers, bool cancelled,
                          std::vector<InputEvent>& out) {
  std::vector<PlacedTouch> counted;
  std::vector<std::uint32_t> beside;
  for (const PlacedTouch& finger : fingers) {
    const bool known =
        std::any_of(fingers_.begin(), fingers_.end(), [&](const PlacedTouch& was) { return was.id == finger.id; });
    if (!known && (!finger.inside || has(beside_, finger.id)))
      beside.push_back(finger.id);
    else
      counted.push_back(finger);
  }
  beside_ = std::move(beside);
  if (counted.empty())
    none(time, cancelled, out);
  else if (counted.size() == 1)
    one(time, counted.front(), cancelled, out);
  else
    pinch(time, counted, out);
  fingers_ = std::move(counted);
}

void TouchPointer::advance(TimestampNs now, std::vector<InputEvent>& out) {
  if (phase_ == Phase::kRests && now - since_ >= kRestNs) press(now, from_, out);
}

}  // namespace dubsar
