#include "app/steering/input_controller.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <utility>

#include "core/base/system/guarded.h"
#include "core/base/system/log.h"
#include "input/event_limit.h"

namespace dubsar::app {
namespace {

constexpr auto kEvery = std::chrono::milliseconds(8);
constexpr std::size_t kMostKeys = 4096;

}  // namespace

InputController::InputController(const Mapping& mapping, const ViewState& home, const HeadFollowOptions& head)
    : zone_{1e-3 * mapping.hands.enter_min_mm(), 1e-3 * mapping.hands.enter_max_mm()},
      people_(zone_),
      navigator_(mapping, home),
      head_(head) {
  seen_->show(home);
}

void InputController::on_input(std::function<void(TimestampNs, const InputFrame&)> told) {
  const std::scoped_lock lock(mutex_);
  told_ = std::move(told);
}

void InputController::steer(TimestampNs now) {
  const std::scoped_lock lock(mutex_);
  steered_ = std::max(steered_, now);  // two threads may have read the clock in the other order
  InputFrame frame = mixer_.poll(steered_);
  for (TouchFrame& touch : std::exchange(frame.touches, {}))
    add_touch_frame(fingers_.told, std::move(touch), kMostTouchFrames);
  for (const bool keys : {false, true})
    for (InputEvent& event : fingers_.placed.take(keys)) {
      frame.time = std::max(frame.time, event.time);
      frame.events.push_back(std::move(event));
    }
  if (told_) told_(steered_, frame);
  const KeptPerson person = people_.update(steered_, frame);
  navigator_.update(steered_, frame, person.hands, person.standing);
  if (person.head) head_.add(*person.head, steered_);
  since_.hands = hand_marks(frame, person, navigator_.hands(), zone_);
  for (const GestureRecognizer& hand : navigator_.hands())
    for (const GestureEvent& event : hand.events()) since_.swiped = since_.swiped || event.kind == GestureKind::kSwipe;
  for (const InputEvent& event : frame.events)
    if (event.kind == EventKind::kKey && event.down && keys_.size() < kMostKeys) keys_.push_back(event);
  newest_input_ = std::max(newest_input_, frame.time);
}

void InputController::run(const Clock& clock) {
  thread_ = std::jthread([this, &clock](const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any waiting;
    std::unique_lock lock(mutex);
    const auto ended = guarded("the thread that steers", [&] {
      while (!stop.stop_requested()) {
        steer(clock.now());
        waiting.wait_for(lock, stop, kEvery, [] { return false; });
      }
    });
    if (!ended) log_warning("{}; whoever draws steers", ended.error().message);
  });
}

void InputController::stop() { thread_ = {}; }

std::vector<InputEvent> InputController::take_keys() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(keys_, {});
}

std::vector<TouchFrame> InputController::take_touches() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(fingers_.told, {});
}

Steered InputController::look(TimestampNs now, TimestampNs display_time) {
  const std::scoped_lock lock(mutex_);
  Steered out = since_;
  since_.swiped = false;
  out.view = navigator_.view();
  out.control = navigator_.control();
  out.eyes = head_.eyes(now, display_time);
  if (newest_input_ > used_input_) {
    out.input_age = now - newest_input_;
    used_input_ = newest_input_;
  }
  seen_->show(out.view);
  return out;
}

std::pair<ViewState, std::uint64_t> InputController::goal() const {
  const std::scoped_lock lock(mutex_);
  return {navigator_.goal(), navigator_.movement()};
}

bool InputController::claim_for_keys(TimestampNs now) {
  const std::scoped_lock lock(mutex_);
  return navigator_.claim_for_keys(now);
}

void InputController::go_to(const ViewState& view, TimestampNs now, bool glide) {
  const std::scoped_lock lock(mutex_);
  navigator_.go_to(view, now, glide);
}

void InputController::set_scene(const GestureScene& scene) {
  const std::scoped_lock lock(mutex_);
  navigator_.set_scene(scene);
}

void InputController::set_home(const ViewState& home) {
  const std::scoped_lock lock(mutex_);
  navigator_.set_home(home);
}

void InputController::set_room(const WornRoom& room) {
  const std::scoped_lock lock(mutex_);
  navigator_.set_room(room);
}

void InputController::let_go_of_mouse() {
  const std::scoped_lock lock(mutex_);
  navigator_.let_go_of_mouse();
}

void InputController::set_rest(const glm::dvec3& rest_m) {
  const std::scoped_lock lock(mutex_);
  head_.set_rest(rest_m);
}

}  // namespace dubsar::app
