#include "input/plugins/plugin_frame.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace dubsar {
namespace {

constexpr double kFarthest_m = 100.0;

/// As much of the structure as the plug-in knows; false: less than the members that every version has.
template <class T>
bool take(const T* given, T& out) noexcept {
  if (given == nullptr || given->size < sizeof(T)) return false;
  std::memcpy(&out, given, sizeof(T));  // members of later versions stand behind
  return true;
}

double share(double value, double low, double high) noexcept {
  return std::isfinite(value) ? std::clamp(value, low, high) : low;
}

}  // namespace

dubsar_source_sink PluginFrame::sink() noexcept {
  return {sizeof(dubsar_source_sink),
          0,
          this,
          [](void* self, const dubsar_source_head* head) { static_cast<PluginFrame*>(self)->add_head(head); },
          [](void* self, const dubsar_source_hand* hand) { static_cast<PluginFrame*>(self)->add_hand(hand); },
          [](void* self, const dubsar_source_puck* space_mouse) {
            static_cast<PluginFrame*>(self)->add_space_mouse(space_mouse);
          },
          [](void* self, const dubsar_source_key* key) { static_cast<PluginFrame*>(self)->add_key(key); }};
}

void PluginFrame::begin(TimestampNs now) {
  now_ = now;
  newest_ = 0;
  heads_.clear();
  hands_.clear();
  space_mouse_.reset();
  keys_.clear();
}

void PluginFrame::finish(InputFrame& frame) {
  frame.time = newest_ > 0 ? newest_ : now_;
  frame.heads.swap(heads_);
  frame.hands.swap(hands_);
  if (space_mouse_) frame.space_mouse = space_mouse_;
  frame.events.insert(frame.events.end(), keys_.begin(), keys_.end());
}

TimestampNs PluginFrame::host_time(std::int64_t told) noexcept {
  const TimestampNs time = told <= 0 || told > now_ ? now_ : told;
  newest_ = std::max(newest_, time);
  return time;
}

bool PluginFrame::placed(const double* position_m, glm::dvec3& out) const noexcept {
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(position_m[i]) <= kFarthest_m)) return false;
  out = transform(place_, {position_m[0], position_m[1], position_m[2]});
  return true;
}

bool PluginFrame::placed(const dubsar_source_pose& given, Pose& out) const noexcept {
  glm::dquat turn(given.rotation_wxyz[0], given.rotation_wxyz[1], given.rotation_wxyz[2], given.rotation_wxyz[3]);
  const double length = glm::length(turn);
  if (!(std::abs(length - 1.0) <= 0.01) || !placed(given.position_m, out.position_m)) return false;
  out.rotation = place_.rotation * (turn / length);
  return true;
}

void PluginFrame::add_head(const dubsar_source_head* given) noexcept {
  dubsar_source_head told;
  HeadFrame head;
  glm::dvec3 left, right;
  if (!take(given, told) || ((told.flags & DUBSAR_SOURCE_LEFT_EYE) != 0 && !placed(told.left_eye_m, left)) ||
      ((told.flags & DUBSAR_SOURCE_RIGHT_EYE) != 0 && !placed(told.right_eye_m, right))) {
    ++refused_;
    return;
  }
  if (heads_.size() >= kMaxHeads) {
    ++dropped_;
    return;
  }
  head.time = host_time(told.time_ns);
  head.id = told.id;
  head.tracked = (told.flags & DUBSAR_SOURCE_TRACKED) != 0;
  head.confidence = share(told.confidence, 0.0, 1.0);
  if ((told.flags & DUBSAR_SOURCE_LEFT_EYE) != 0) head.left_eye_m = left;
  if ((told.flags & DUBSAR_SOURCE_RIGHT_EYE) != 0) head.right_eye_m = right;
  heads_.push_back(head);
}

void PluginFrame::add_hand(const dubsar_source_hand* given) noexcept {
  dubsar_source_hand told;
  HandFrame hand;
  if (!take(given, told) || told.chirality > 2 || !placed(told.palm, hand.palm)) {
    ++refused_;
    return;
  }
  if (hands_.size() >= kMaxHands) {
    ++dropped_;
    return;
  }
  hand.time = host_time(told.time_ns);
  hand.id = told.id;
  hand.chirality = static_cast<Chirality>(told.chirality);
  hand.valid = true;
  hand.tracked = (told.flags & DUBSAR_SOURCE_TRACKED) != 0;
  hand.confidence = share(told.confidence, 0.0, 1.0);
  hand.grab_strength = share(told.grab, 0.0, 1.0);
  hand.pinch_distance_m = share(told.pinch_m, 0.0, 1.0);
  static_assert(kHandJointCount == DUBSAR_SOURCE_JOINTS);
  for (std::size_t i = 0; i < kHandJointCount; ++i) {
    const dubsar_source_joint& joint = told.joints[i];
    HandJointPose& out = hand.joints[i];
    out.valid = joint.valid != 0 && placed(joint.pose, out.pose);
    out.tracked = out.valid && joint.tracked != 0;
    out.radius_m = out.valid ? share(joint.radius_m, 0.0, 0.1) : 0.0;
  }
  hands_.push_back(hand);
}

void PluginFrame::add_space_mouse(const dubsar_source_puck* given) noexcept {
  dubsar_source_puck told;
  if (!take(given, told)) {
    ++refused_;
    return;
  }
  SpaceMouseMotion space_mouse;
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(told.push[i]) || !std::isfinite(told.twist[i])) {
      ++refused_;
      return;
    }
    space_mouse.push[i] = std::clamp(told.push[i], -1.0, 1.0);
    space_mouse.twist[i] = std::clamp(told.twist[i], -1.0, 1.0);
  }
  space_mouse.time = host_time(told.time_ns);
  space_mouse_ = space_mouse;
}

void PluginFrame::add_key(const dubsar_source_key* given) noexcept {
  dubsar_source_key told;
  if (!take(given, told)) {
    ++refused_;
    return;
  }
  const std::size_t length = ::strnlen(told.name, sizeof told.name);
  const auto plain = [](char c) { return c > ' ' && c < '\x7f'; };
  if (length == 0 || length == sizeof told.name || !std::all_of(told.name, told.name + length, plain)) {
    ++refused_;
    return;
  }
  if (keys_.size() >= kMaxKeys) {
    ++dropped_;
    return;
  }
  InputEvent event;
  event.time = host_time(told.time_ns);
  event.kind = EventKind::kKey;
  event.down = told.down != 0;
  event.key.assign(told.name, length);
  keys_.push_back(std::move(event));
}

}  // namespace dubsar
