#include "input/people/head_follower.h"

#include <algorithm>
#include <numbers>

namespace dubsar {
namespace {

constexpr TimestampNs kShortestReturnNs = 100'000'000, kLongestReturnNs = 1'000'000'000;

}  // namespace

HeadFollower::HeadFollower(const HeadFollowOptions& options)
    : options_(options), filter_(options.filter), half_m_(0.5 * options.ipd_m, 0.0, 0.0) {}

void HeadFollower::add(const HeadFrame& head, TimestampNs now) {
  if (!history_.empty() && head.time <= history_.newest().time) return;
  const Eyes before = look(now, now);
  const auto eyes = pair_.update({head.time, head.left_eye_m, head.right_eye_m});
  std::optional<glm::dvec3> centre;
  if (eyes) {
    centre = 0.5 * (eyes->left_m + eyes->right_m);
    half_m_ = 0.5 * (eyes->right_m - eyes->left_m);
  } else if (head.left_eye_m) {
    centre = *head.left_eye_m + half_m_;
  } else if (head.right_eye_m) {
    centre = *head.right_eye_m - half_m_;
  }
  if (!centre) return;
  if (!history_.empty() && head.time - history_.newest().time > options_.presence.hold_ns) history_.clear();
  history_.add({head.time, filter_.filter(head.time, *centre)});
  const double cutoff_hz = options_.filter.min_cutoff_hz + options_.filter.beta * glm::length(filter_.velocity());
  filter_lag_s_ = 1.0 / (2.0 * std::numbers::pi * cutoff_hz);
  if (before.presence == Presence::kTracked) return;
  return_ = {};
  const Eyes after = look(now, now);
  return_ = {
      before.centre_m - after.centre_m, before.half_m - after.half_m, now,
      std::clamp(static_cast<TimestampNs>(1e9 * glm::length(before.centre_m - after.centre_m) / options_.return_mps),
                 kShortestReturnNs, kLongestReturnNs)};
}

HeadFollower::Eyes HeadFollower::look(TimestampNs now, TimestampNs display_time) const {
  const bool seen = !history_.empty();
  const TimestampNs measured = seen ? history_.newest().time : 0;
  glm::dvec3 last = options_.rest_m;
  if (seen) {
    const auto lag = static_cast<TimestampNs>(1e9 * filter_lag_s_);
    const TimestampNs target = std::min(display_time, now + options_.most_ahead_ns) + lag;
    last = history_.predict(target, options_.most_ahead_ns).value_or(history_.newest().position_m);
  }
  const PresentPosition at =
      present_position(last, options_.rest_m, seen ? std::max<TimestampNs>(0, now - measured) : -1, options_.presence);
  const glm::dvec3 half = glm::mix(half_m_, glm::dvec3(0.5 * options_.ipd_m, 0.0, 0.0), at.away);
  const double off =
      1.0 - std::clamp(static_cast<double>(now - return_.since) / static_cast<double>(return_.duration), 0.0, 1.0);
  const double left = (1.0 - at.away) * off;
  return {at.position_m + left * return_.centre_m, half + left * return_.half_m, at.presence};
}

FollowedEyes HeadFollower::eyes(TimestampNs now, TimestampNs display_time) const {
  const Eyes eyes = look(now, display_time);
  return {eyes.centre_m - eyes.half_m, eyes.centre_m + eyes.half_m, eyes.presence,
          history_.empty() ? 0 : history_.newest().time};
}

}  // namespace dubsar
