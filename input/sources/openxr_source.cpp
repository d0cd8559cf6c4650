#include "input/sources/openxr_source.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace dubsar {
namespace {

constexpr TimestampNs kSessionSilentNs = 500'000'000;
constexpr double kSqueezed = 0.6, kLetGo = 0.4;          // of a trigger's way
constexpr double kWholePush_m = 0.1;                     // for a deflection of 1
constexpr double kWholeTwist = std::numbers::pi / 4;     // the same
constexpr double kOpenBend = 30.0, kClosedBend = 180.0;  // degrees between palm and finger tip
constexpr double kLongestStep_s = 0.1;                   // between samples that a velocity is made of

/// How far a finger is bent: directions of its metacarpal and of its end.
double bend_deg(const HandFrame& hand, HandJoint metacarpal, HandJoint proximal, HandJoint distal, HandJoint tip) {
  const auto way = [&](HandJoint from, HandJoint to) {
    return glm::normalize(hand.joint(to).pose.position_m - hand.joint(from).pose.position_m);
  };
  // A fist bends a finger by more than half a turn: the two halves are added.
  const glm::dvec3 base = way(metacarpal, proximal), middle = way(proximal, distal), end = way(distal, tip);
  const auto angle = [](const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * 180.0 / std::numbers::pi;
  };
  return angle(base, middle) + angle(middle, end);
}

class OpenXrSource final : public InputSource {
 public:
  OpenXrSource(std::shared_ptr<WornFeed> feed, bool simulated_time)
      : feed_(std::move(feed)), simulated_time_(simulated_time) {}

  std::string_view name() const noexcept override { return "openxr"; }
  Result<void> start() override { return {}; }
  std::string note() const override {
    const std::string reason = feed_->reason();
    return !reason.empty() || heard_ ? reason : "openxr: no picture was made for a headset yet";
  }

  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    newest.events.clear();
    const WornSample sample = feed_->newest();
    const bool fresh = sample.time != 0 && sample.time != last_.time;
    if (fresh) heard_ = now;
    if (!heard_ || now - *heard_ > kSessionSilentNs || !feed_->reason().empty()) {
      newest.hands.clear();
      newest.puck.reset();
      held_.reset();
      return Freshness::kLost;
    }
    if (!fresh) return Freshness::kUnchanged;
    newest.time = simulated_time_ ? now : sample.time;
    newest.hands.clear();
    for (std::size_t side = 0; side < 2; ++side) add_hand(sample, side, newest);
    steer(sample, newest);
    last_ = sample;
    return Freshness::kNew;
  }

 private:
  void add_hand(const WornSample& sample, std::size_t side, InputFrame& newest) {
    const std::optional<HandFrame>& before = last_.hands[side];
    if (!sample.hands[side]) return;
    HandFrame hand = *sample.hands[side];
    if (!before) ids_[side] = ++next_id_;
    hand.id = ids_[side];
    hand.time = newest.time;
    hand.chirality = side == 0 ? Chirality::kLeft : Chirality::kRight;
    complete_hand(hand);
    const double step_s = 1e-9 * static_cast<double>(sample.time - last_.time);
    if (before && step_s > 0 && step_s < kLongestStep_s)
      hand.velocity_mps = (hand.palm.position_m - before->joint(HandJoint::kPalm).pose.position_m) / step_s;
    if (newest.hands.size() < kMaxHands) newest.hands.push_back(hand);
  }

  /// The controller that is squeezed, as a puck.
  void steer(const WornSample& sample, InputFrame& newest) {
    if (held_) {
      const auto& controller = sample.controllers[*held_];
      if (!controller.active || controller.squeeze < kLetGo) held_.reset();
    }
    for (std::size_t side = 0; side < 2 && !held_; ++side) {
      const auto& controller = sample.controllers[side];
      if (!controller.active || controller.squeeze < kSqueezed) continue;
      held_ = side;
      from_ = controller.grip;
    }
    const bool any = sample.controllers[0].active || sample.controllers[1].active;
    newest.puck.reset();
    if (any) newest.puck = PuckMotion{newest.time, glm::dvec3(0.0), glm::dvec3(0.0)};
    if (held_) {
      const Pose& grip = sample.controllers[*held_].grip;
      glm::dquat turn = grip.rotation * glm::conjugate(from_.rotation);
      if (turn.w < 0) turn = -turn;
      const double angle = 2.0 * std::acos(std::min(1.0, turn.w));
      const glm::dvec3 axis(turn.x, turn.y, turn.z);
      const double length = glm::length(axis);
      newest.puck->push = bounded((grip.position_m - from_.position_m) / kWholePush_m);
      if (length > 1e-9) newest.puck->twist = bounded(angle / length / kWholeTwist * axis);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      const bool down = sample.controllers[side].active && sample.controllers[side].select;
      if (down == pressed_[side]) continue;
      pressed_[side] = down;
      InputEvent event;
      event.kind = EventKind::kKey;
      event.time = newest.time;
      event.down = down;
      event.key = "puck1";
      newest.events.push_back(event);
    }
  }
  static glm::dvec3 bounded(const glm::dvec3& way) { return way / std::max(1.0, glm::length(way)); }

  std::shared_ptr<WornFeed> feed_;
  const bool simulated_time_;
  WornSample last_;
  std::optional<TimestampNs> heard_;
  std::optional<std::size_t> held_;  // the controller that steers
  Pose from_;                        // where it was squeezed
  std::array<bool, 2> pressed_{};
  std::array<std::uint32_t, 2> ids_{};
  std::uint32_t next_id_ = 0;
};

}  // namespace

void complete_hand(HandFrame& hand) {
  using enum HandJoint;
  const auto good = [&](std::initializer_list<HandJoint> joints) {
    return std::all_of(joints.begin(), joints.end(), [&](HandJoint joint) { return hand.joint(joint).valid; });
  };
  hand.palm = hand.joint(kPalm).pose;
  const std::array<std::array<HandJoint, 4>, 4> fingers{
      {{kIndexMetacarpal, kIndexProximal, kIndexDistal, kIndexTip},
       {kMiddleMetacarpal, kMiddleProximal, kMiddleDistal, kMiddleTip},
       {kRingMetacarpal, kRingProximal, kRingDistal, kRingTip},
       {kLittleMetacarpal, kLittleProximal, kLittleDistal, kLittleTip}}};
  double sum = 0.0;
  int seen = 0;
  for (const auto& [metacarpal, proximal, distal, tip] : fingers) {
    if (!good({metacarpal, proximal, distal, tip})) continue;
    sum += std::clamp((bend_deg(hand, metacarpal, proximal, distal, tip) - kOpenBend) / (kClosedBend - kOpenBend), 0.0,
                      1.0);
    ++seen;
  }
  hand.valid = good({kPalm, kThumbTip, kIndexTip}) && seen > 0;
  hand.tracked = hand.valid && hand.joint(kPalm).tracked;
  hand.confidence = hand.tracked ? 1.0 : hand.valid ? 0.5 : 0.0;
  if (!hand.valid) return;
  hand.grab_strength = sum / seen;
  hand.pinch_distance_m = glm::distance(hand.joint(kThumbTip).pose.position_m, hand.joint(kIndexTip).pose.position_m);
}

Result<std::unique_ptr<InputSource>> make_openxr_source(const InputConfig& config) {
  if (!config.options.empty())
    return fail(ErrorKind::kUsage, "input openxr: option \"{}\" found, expected none", config.options[0].key);
  if (!config.worn)
    return fail(ErrorKind::kUnavailable,
                "input openxr: hands come with a headset that pictures are made for, expected --display openxr too");
  return std::make_unique<OpenXrSource>(config.worn, config.simulated_time);
}

}  // namespace dubsar
