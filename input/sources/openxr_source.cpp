#include "input/sources/openxr_source.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace dubsar {
namespace {

constexpr TimestampNs kSessionSilentNs = 500'000'000;
constexpr double kSqueezed = 0.6, kLetGo = 0.4;          // of a trigger's way
constexpr double kPinched_m = 0.025, kParted_m = 0.04;   // between the tips of thumb and index
constexpr double kFist = 0.75, kOpened = 0.5;            // of the fingers' bend
constexpr TimestampNs kBounceNs = 60'000'000;            // joints of one headset part for 20 to 60 ms in a pinch
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
      newest.grips = {};
      return Freshness::kLost;
    }
    if (!fresh) return Freshness::kUnchanged;
    newest.time = simulated_time_ ? now : sample.time;
    newest.hands.clear();
    for (std::size_t side = 0; side < 2; ++side) add_hand(sample, side, newest);
    grip(sample, newest);
    press(sample, newest);
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

  /// Where hands are and whether they are closed. A side that has a controller has no bare hand.
  void grip(const WornSample& sample, InputFrame& newest) {
    for (std::size_t side = 0; side < 2; ++side) {
      const WornSample::Controller& controller = sample.controllers[side];
      HandGrip& grip = newest.grips[side];
      const bool was_closed = grip.closed && grip.active;
      grip = {};
      if (controller.active) {
        grip = {true, controller.squeeze >= (was_closed ? kLetGo : kSqueezed), true, controller.grip};
      } else if (const HandFrame* const hand = bare_hand(newest, side)) {
        grip = {true, closed_hand(*hand, was_closed, side), false, hand->palm};
      }
    }
  }
  static const HandFrame* bare_hand(const InputFrame& frame, std::size_t side) {
    for (const HandFrame& hand : frame.hands)
      if (hand.valid && hand.chirality == (side == 0 ? Chirality::kLeft : Chirality::kRight)) return &hand;
    return nullptr;
  }
  /// A pinch or a fist. Joints of cameras let fingers part for moments: a hand is open when it was for kBounceNs.
  bool closed_hand(const HandFrame& hand, bool was_closed, std::size_t side) {
    const bool closed = hand.pinch_distance_m < (was_closed ? kParted_m : kPinched_m) ||
                        hand.grab_strength > (was_closed ? kOpened : kFist);
    if (closed) closed_at_[side] = hand.time;
    return closed || (was_closed && hand.time - closed_at_[side] < kBounceNs);
  }

  /// A trigger is the key of a SpaceMouse: the next side.
  void press(const WornSample& sample, InputFrame& newest) {
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
  std::shared_ptr<WornFeed> feed_;
  const bool simulated_time_;
  WornSample last_;
  std::optional<TimestampNs> heard_;
  std::array<TimestampNs, 2> closed_at_{};  // when each hand was last seen closed
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
