#pragma once
// What happens at a kiosk: nobody, an arrival, learning, free play, leaving. Time is an argument; the same moments give
// the same visit.

#include <array>
#include <cstdint>
#include <optional>

#include "app/document/gallery_picture.h"
#include "app/kiosk/words.h"
#include "core/base/system/clock.h"
#include "input/people/hand_marks.h"

namespace dubsar::app {

/// What a hand that is not told what to do finds out.
struct VisitChances {
  double held_deg = 0.0;  ///< the object's turn between the beginning of this hold and now; 0: nothing is held
  bool can_tour = false;  ///< there is a button that begins a tour
};

/// What is known at one moment.
struct VisitMoment : VisitChances {
  bool tracker = true;                 ///< there is a hand sensor
  bool touch = false;                  ///< there is a touch panel
  bool asleep = false;                 ///< quiet hours
  bool head = false;                   ///< somebody is seen, with or without hands
  int hands = 0;                       ///< that are seen
  HandState hand = HandState::kReady;  ///< of the leading one; meaningless without hands
  double hand_y_m = 0.0;               ///< above the panel's middle, of the leading one; meaningless without hands
  bool two_hold = false;               ///< both of a person's hands hold
  double turned_deg = 0.0;             ///< by hands, since the last moment
  double zoomed = 0.0;                 ///< |logarithm| of the zoom by hands, since the last moment
  bool swiped = false;
  bool toured = false;                        ///< a tour is shown: somebody looks on, and is not taught
  bool can_open = false, chose_open = false;  ///< there is an envelope; a hand rested on its button
};

enum class VisitPhase : std::uint8_t { kAsleep, kAttract, kArrived, kFree, kLeaving };

struct VisitPicture {
  VisitPhase phase = VisitPhase::kAttract;
  std::optional<Line> line;          ///< said now
  std::optional<Tutorial> tutorial;  ///< shown as a moving hand
  double tutorial_s = 0.0;           ///< since it is shown
  std::optional<double> higher_s;    ///< the hand that sank out of sight is wanted higher up, for so long already
  bool reset = false;                ///< now, once: all is to go back to the beginning
  bool arrived = false;              ///< now, once: a visit began
};

struct VisitFigures {
  double idle_reset_s = 90.0, attract_after_s = 8.0;
};

/// Who can do a thing is not taught it: a tutorial waits until its time has come, is shown for a while, rests, and is
/// over for this visit when it was done or was shown three times. One thread.
class Visit {
 public:
  explicit Visit(const VisitFigures& figures = {}) : figures_(figures) {}
  VisitPicture update(TimestampNs now, const VisitMoment& moment);

  struct Counts {
    std::int64_t visits = 0, resets = 0, openings = 0;  ///< of the envelope, and closings
    std::array<std::int64_t, kTutorialCount> done{};    ///< visits in which it was done
  };
  const Counts& counts() const noexcept { return counts_; }

 private:
  struct Course {
    std::array<bool, kTutorialCount> done{};
    std::array<int, kTutorialCount> shown{};
    std::optional<Tutorial> now;
    TimestampNs since = 0, rests_until = 0;
    double turned_deg = 0.0, zoomed = 0.0;
    TimestampNs followed = -1;  // a hand of this visitor was seen last; -1: there is none that sank
    // A hand that sank out of the sensor's sight.
    bool low = false;
    int sank = 0;                                              ///< how often
    TimestampNs seen_since = -1, lost_since = -1, asked = -1;  ///< -1: not now
  };
  void begin(TimestampNs now);
  void learn(const VisitMoment& moment);
  void done(Tutorial tutorial);
  std::optional<Tutorial> next(const VisitMoment& moment) const;
  void teach(TimestampNs now, const VisitMoment& moment);
  void ask_for_height(TimestampNs now, const VisitMoment& moment);
  std::optional<double> sunk_s(TimestampNs now, const VisitMoment& moment);
  bool never_closes(const VisitMoment& moment) const;
  std::optional<Line> line(const VisitMoment& moment) const;

  VisitFigures figures_;
  VisitPhase phase_ = VisitPhase::kAttract;
  TimestampNs last_hand_ = 0, last_somebody_ = 0, last_ = -1, trouble_since_ = -1;
  bool touched_ = false;  // somebody moved the object since it was reset
  Course course_;
  Counts counts_;
};

}  // namespace dubsar::app
