#pragma once
// From input to what shall be seen: the sources, the person who is kept, navigation and the eyes. Where time is real it
// runs in a thread of its own, so that gestures work however long a picture takes. It publishes values.

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/base/system/clock.h"
#include "input/mixer.h"
#include "input/navigation/navigation.h"
#include "input/navigation/seen_view.h"
#include "input/people/hand_marks.h"
#include "input/people/head_follower.h"
#include "input/window_events.h"

namespace dubsar::app {

/// How things stand, for one picture.
struct Steered {
  ViewState view{};
  Control control = Control::kNone;
  FollowedEyes eyes{};                     ///< at the time when the picture will be seen
  std::vector<HandMark> hands{};           ///< everybody's
  bool swiped = false;                     ///< a hand did since the last one
  std::optional<TimestampNs> input_age{};  ///< of the newest measurement; none: nothing new since the last one
};

/// Any thread, but run() and stop() from one.
class InputController {
 public:
  InputController(const Mapping& mapping, const ViewState& home, const HeadFollowOptions& head);
  ~InputController() { stop(); }
  InputController(const InputController&) = delete;
  InputController& operator=(const InputController&) = delete;

  InputMixer& input() noexcept { return mixer_; }
  /// Told all input, in the thread and at the time of its poll. Set it before there are sources.
  void on_input(std::function<void(TimestampNs, const InputFrame&)> told);
  /// What simulated visitors look at: the view of the last look().
  std::shared_ptr<const SeenView> seen() const noexcept { return seen_; }

  /// Polls the input at `now` and moves the view on. Cheap.
  void steer(TimestampNs now);
  /// steer() each 8 ms by this clock, which outlives it, in a thread until stop(), or until that throws, which is
  /// logged.
  void run(const Clock& clock);
  void stop();

  /// Keys of scripts, recordings and SpaceMice that went down since the last call; those of a window do not come this
  /// way.
  std::vector<InputEvent> take_keys();
  /// What fingers on touch panels did since the last call; whoever knows where the window is places them, and puts what
  /// comes of it back.
  std::vector<TouchFrame> take_touches();
  /// With the next steer(), as if a source had told it.
  void put(const InputEvent& event) { fingers_.placed.push(event); }
  /// What a picture shall show whose light reaches the eye at `display_time`.
  Steered look(TimestampNs now, TimestampNs display_time);

  /// Where the view will be when nobody does anything more, and the number of the movement that led there.
  std::pair<ViewState, std::uint64_t> goal() const;
  /// Whether a key may change the view now; then it is the keys' for a while.
  bool claim_for_keys(TimestampNs now);
  void go_to(const ViewState& view, TimestampNs now, bool glide);
  void set_home(const ViewState& home);
  /// What whoever leads the session knows of it.
  void set_scene(const GestureScene& scene);
  void set_room(const WornRoom& room);
  void let_go_of_mouse();
  /// Where the eyes go when nobody is seen.
  void set_rest(const glm::dvec3& rest_m);

 private:
  struct Fingers {
    std::vector<TouchFrame> told;  // by a source
    WindowEvents placed;           // by the window; has its own mutex
  };
  InputMixer mixer_;
  std::shared_ptr<SeenView> seen_ = std::make_shared<SeenView>();
  mutable std::mutex mutex_;  // for all below but the thread
  std::function<void(TimestampNs, const InputFrame&)> told_;
  HandZone zone_;
  PersonKeeper people_;
  Navigator navigator_;
  HeadFollower head_;
  TimestampNs steered_ = 0, newest_input_ = 0, used_input_ = 0;
  Steered since_{};  // what happened since the last look()
  std::vector<InputEvent> keys_;
  Fingers fingers_;
  std::jthread thread_;
};

}  // namespace dubsar::app
