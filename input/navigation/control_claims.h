#pragma once
// Who steers the view, when several want to.

#include <vector>

#include "input/navigation/mapping.h"

namespace dubsar {

class ControlClaims {
 public:
  /// The first of `priority` wins; who is not in it never steers. A lower control gets the view `handover_ns` after a
  /// higher one was used last.
  ControlClaims(std::vector<Control> priority, TimestampNs handover_ns)
      : priority_(std::move(priority)), handover_ns_(handover_ns) {}

  /// True when `control` may steer now. A higher one takes the view away from a lower one; mouse and keyboard are one
  /// person's two hands.
  bool claim(Control control, TimestampNs now);
  /// The last claim that was granted changed who steers.
  bool fresh() const noexcept { return fresh_; }
  /// Time goes on; `held` means that who steers holds something still.
  void advance(TimestampNs now, bool held);
  Control control() const noexcept { return control_; }

 private:
  std::vector<Control> priority_;
  TimestampNs handover_ns_;
  Control control_ = Control::kNone;
  TimestampNs used_ = 0;
  bool fresh_ = false;
};

}  // namespace dubsar
