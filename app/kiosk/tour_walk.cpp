#include "app/kiosk/tour_walk.h"

#include <algorithm>
#include <utility>

namespace dubsar::app {
namespace {

constexpr double kSettleS = 1.2, kReturnS = 3.5, kLongestStepS = 0.2;

/// What a keyframe does not name is as before.
Keyframe completed(Keyframe key, const Keyframe& before) {
  if (key.style.empty()) key.style = before.style;
  for (const KeyedPart& part : before.parts)
    if (std::none_of(key.parts.begin(), key.parts.end(), [&](const KeyedPart& p) { return p.name == part.name; }))
      key.parts.push_back(part);
  return key;
}

/// The envelope is away, or not there.
bool is_open(const Keyframe& frame) {
  return frame.unpack > 0.5 || std::any_of(frame.parts.begin(), frame.parts.end(), [](const KeyedPart& part) {
           return part.name == "envelope" && part.opacity < 0.5;
         });
}

}  // namespace

void TourWalk::begin(Tour tour, Keyframe home) {
  *this = {};
  tour_ = std::move(tour);
  home_ = std::move(home);
}

void TourWalk::start(Way way, const Keyframe& from, const std::vector<Keyframe>& keys) {
  way_ = way;
  since_s_ = 0.0;
  path_ = {from};
  path_.front().time_s = 0.0;
  for (const Keyframe& key : keys) path_.push_back(completed(key, path_.back()));
  now_ = path_.front();
}

void TourWalk::go(const Keyframe& from) {
  if (!any()) return;
  last_ = -1;
  start(Way::kWalks, from, tour_.steps[step_].keyframes);
}

void TourWalk::next() {
  if (!walks()) return;
  if (step_ + 1 == tour_.steps.size()) {
    start(Way::kReturns, now_, {rest(kReturnS)});
    return forget();
  }
  ++step_;
  start(Way::kWalks, now_, tour_.steps[step_].keyframes);
}

Keyframe TourWalk::rest(double after_s) const {
  Keyframe out = home_;
  out.time_s = after_s;
  out.unpack = is_open(now_) ? 1.0 : 0.0;
  return out;
}

void TourWalk::leave() {
  if (way_ != Way::kWalks && way_ != Way::kReturns) return;
  Keyframe to = rest(kSettleS);
  to.camera = now_.camera;
  to.light = now_.light;
  start(Way::kSettles, now_, {to});
  left_ = true;
}

std::optional<TourMoment> TourWalk::update(TimestampNs now) {
  if (way_ == Way::kRests) return std::nullopt;
  const double dt = last_ < 0 ? 0.0 : std::clamp(1e-9 * static_cast<double>(now - last_), 0.0, kLongestStepS);
  last_ = now;
  if (std::exchange(left_, false)) return TourMoment{now_, true, true};
  since_s_ += dt;
  if (walks() && since_s_ >= step_length_s(tour_.steps[step_])) next();
  now_ = moment_at(path_, since_s_);
  const bool camera = way_ != Way::kSettles, over = settling() && since_s_ >= path_.back().time_s;
  if (over) way_ = Way::kRests;
  return TourMoment{now_, camera, over};
}

}  // namespace dubsar::app
