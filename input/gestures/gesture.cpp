#include "input/gestures/gesture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace dubsar {
namespace {
// A palm at rest is steadied to a few tenths of a millimetre, one at 200 mm/s lags 20 ms. Tuned on 1 mm of noise at 90
// Hz.
constexpr OneEuroOptions kPalmFilter{2.0, 30.0, 3.0};
constexpr TimestampNs kVelocityWindow = 60'000'000;
constexpr TimestampNs kSetBack = 1'000'000'000;  // no sample is so late: its device's clock was set back
constexpr TimestampNs kReachedIn = 1'200'000'000;
}  // namespace

GestureRecognizer::GestureRecognizer(const GestureOptions& options)
    : options_(options), filter_(kPalmFilter), history_(kVelocityWindow) {}

void GestureRecognizer::lose(TimestampNs now) {
  grip_.lose(now, events_);
  swipe_.lose();
  dwell_.lose();
  fingers_.lose();
  stillness_.lose();
  seen_.came.reset();
  velocity_mps_ = glm::dvec3(0.0);
  filter_.reset();
  history_.clear();
}

void GestureRecognizer::update(TimestampNs now, const HandFrame* hand, const HandStanding& standing) {
  events_.clear();
  if (hand != nullptr && hand->time < seen_.sample - kSetBack) {
    lose(now);
    seen_.sample = -1;
  }
  seen_.now = hand != nullptr && hand->valid && hand->tracked && hand->time > seen_.sample;
  // A gap of hands that are polled rarely shows only when they are back.
  if (seen_.came && now - seen_.last > options_.hold_ns) lose(now);
  if (!seen_.now) return;
  const TimestampNs since_ns = seen_.sample < 0 ? 0 : hand->time - seen_.sample;
  seen_.sample = hand->time;
  seen_.last = now;
  if (!seen_.came) seen_.came = now;
  if (hand->id != seen_.id) swipe_.let_go();  // it was lost and found: what one hand began another one may not end
  seen_.id = hand->id;
  position_m_ = filter_.filter(hand->time, hand->palm.position_m);
  cursor_m_ = cursor_point_m(*hand);
  history_.add({hand->time, hand->palm.position_m});
  velocity_mps_ = history_.velocity_mps();
  const bool may_begin = now - *seen_.came >= options_.cooldown_ns;
  fingers_.update(now, hand->grab_strength, hand->pinch_distance_m);
  closing_ = fingers_.closing(now);
  stillness_.update(now, position_m_, closing_);
  const TimestampNs still_ns = stillness_.still_for(now);
  const bool at_signs = scene_.signs_above && position_m_.x >= options_.place.signs_from_x_m &&
                        position_m_.y >= options_.place.signs_from_y_m;
  const bool acts = may_begin && !standing.at_face && !at_signs && position_m_.z <= options_.place.acts_to_z_m;
  const bool within = std::max(std::abs(position_m_.x), std::abs(position_m_.y)) <= options_.swipe.within_m;
  // What has just reached in and moves on may be somebody else's, whatever its fingers tell; who has turned nothing yet
  // is not made to wait.
  const bool sure = standing.sure && (scene_.beginner || !standing.doubtful);
  const bool known_long = scene_.beginner || now - *seen_.came >= kReachedIn;
  grip_.update(
      {now, since_ns, glm::length(velocity_mps_), still_ns, closing_, acts, sure && known_long, scene_.beginner}, *hand,
      options_, events_);
  const bool free = may_begin && !grip_.holds();
  const bool known = now - *seen_.came >= (sure ? options_.swipe.sure_ns : options_.swipe.known_ns);
  if (const auto swiped = swipe_.update({now, still_ns, history_.newest().position_m, velocity_mps_,
                                         hand->grab_strength, since_ns, free && acts && within, known},
                                        options_))
    events_.push_back({now, GestureKind::kSwipe, GesturePhase::kDone, *swiped});
  if (dwell_.update(now, cursor_m_, free, options_)) events_.push_back({now, GestureKind::kDwell, GesturePhase::kDone});
}

}  // namespace dubsar
