#pragma once
// A smooth step from one view to another, never faster than hands may turn it.

#include <optional>

#include "input/navigation/mapping.h"
#include "input/navigation/view_state.h"

namespace dubsar {

class ViewGlide {
 public:
  void start(const ViewState& from, const ViewState& to, TimestampNs now, const HandMapping& limits);
  void stop() { step_.reset(); }
  /// Sets `view` to where the glide is at `now`; nothing when none goes on.
  void advance(TimestampNs now, ViewState& view);
  bool running() const noexcept { return step_.has_value(); }
  const ViewState& goal() const noexcept { return step_->to; }  ///< while running

 private:
  struct Step {
    ViewState from, to;
    TimestampNs start = 0, duration = 1;
  };
  std::optional<Step> step_;
};

}  // namespace dubsar
