#pragma once
// Live figures of a head tracker before a tracked panel: how much light of the wrong eye gets through because the weave
// is as old as the way from the tracker to the panel is long.

#include <deque>
#include <functional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "display/panels/panel_profile.h"
#include "input/input_source.h"

namespace dubsar::app {

struct EyeCheckOptions {
  double seconds = 10.0;
  double delay_ms = 40.0;  ///< from a head's move to the light of the weave for it
  int step_px = 96;        ///< of the grid of panel points that are looked at
};

/// Remembers eyes for a while. One thread.
class EyeCheck {
 public:
  EyeCheck(const TrackedPanel& panel, const EyeCheckOptions& options) : panel_(panel), options_(options) {}

  /// Eyes as they were at `at`, millimetres in the screen frame; times go up.
  void add(TimestampNs at, const EyePair& eyes_mm);
  /// Light of the wrong eye, the worse one, at the newest eyes, of a weave for where they were delay_ms before. Nothing
  /// before that much is known.
  std::optional<double> wrong_light() const;
  /// The same for a weave without delay: what is left of the lenses' own.
  std::optional<double> own_light() const;
  const EyePair& newest() const { return known_.back().eyes; }
  /// Samples of the last second.
  int a_second() const;

 private:
  struct Known {
    TimestampNs at;
    EyePair eyes;
  };
  TrackedPanel panel_;
  EyeCheckOptions options_;
  std::deque<Known> known_;
};

/// What was seen, from the first eyes on.
struct EyeCheckFigures {
  int samples = 0, checks = 0;
  double rate_hz = 0.0;
  double median_percent = 0.0, worst_percent = 0.0, own_percent = 0.0;
  EyePair last_mm{};
  std::string note;  ///< the source's own; empty: none
};

/// Reads heads of `source` until options.seconds are over; `told` gets a line twice a second. kUnavailable with the
/// source's reason when no eyes were seen, kConfig for panels that are not tracked, kCancelled. Sleeps in between.
Result<EyeCheckFigures> check_eyes(InputSource& source, const PanelProfile& panel, const EyeCheckOptions& options,
                                   const std::function<void(const std::string&)>& told, Progress& progress);

}  // namespace dubsar::app
