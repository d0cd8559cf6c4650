#pragma once
// Somebody walks a tour: how the object stands at each moment, which step that is; left and taken up again at any time.

#include <optional>

#include "app/kiosk/tour.h"
#include "core/base/system/clock.h"

namespace dubsar::app {

/// What a tour wants shown now.
struct TourMoment {
  Keyframe frame;
  bool camera = true;    ///< camera and light as well; false: hands have those, the parts alone are brought to rest
  bool settles = false;  ///< this is how the object stays: whoever shows it takes it over, now, once
};

/// Nothing jumps: each step begins where things are, whoever left them there. One thread.
class TourWalk {
 public:
  /// Another object's, from its beginning; no steps: none. `home` is how the object is first shown, with every part.
  void begin(Tour tour, Keyframe home);
  bool any() const noexcept { return !tour_.steps.empty(); }
  bool walks() const noexcept { return way_ == Way::kWalks; }
  /// The parts go back to what a hand may open and close.
  bool settling() const noexcept { return way_ == Way::kSettles || way_ == Way::kReturns; }

  /// From things as they are, with every part: at the first step, or at the one that was left.
  void go(const Keyframe& from);
  /// The next step; after the last one the object goes back to its first view.
  void next();
  /// Hands have the object; its parts go where they were at first, with the envelope open if it is open now.
  void leave();
  /// The next go() begins at the first step.
  void forget() noexcept { step_ = 0; }

  /// How things stand at `now`; none: as they are. Rising times; a jump of the clock holds the tour still.
  std::optional<TourMoment> update(TimestampNs now);
  /// The step that is walked; none: none is.
  const TourStep* step() const noexcept { return walks() ? &tour_.steps[step_] : nullptr; }
  double in_step_s() const noexcept { return since_s_; }  ///< since its beginning
  std::size_t at() const noexcept { return step_; }
  std::size_t steps() const noexcept { return tour_.steps.size(); }

 private:
  enum class Way : std::uint8_t { kRests, kWalks, kReturns, kSettles };
  void start(Way way, const Keyframe& from, const std::vector<Keyframe>& keys);
  Keyframe rest(double after_s) const;

  Tour tour_;
  Way way_ = Way::kRests;
  std::size_t step_ = 0;
  std::vector<Keyframe> path_;
  Keyframe home_, now_;
  double since_s_ = 0.0;  // the path's beginning
  TimestampNs last_ = -1;
  bool left_ = false;  // now: hands take it over
};

}  // namespace dubsar::app
