#include "input/navigation/control_claims.h"

#include <algorithm>

namespace dubsar {

bool ControlClaims::claim(Control control, TimestampNs now) {
  const auto rank = [&](Control c) { return std::find(priority_.begin(), priority_.end(), c) - priority_.begin(); };
  const auto at_desk = [](Control c) { return c == Control::kMouse || c == Control::kKeyboard; };
  if (rank(control) == static_cast<std::ptrdiff_t>(priority_.size())) return false;
  if (control_ != Control::kNone && control_ != control && rank(control) > rank(control_) &&
      !(at_desk(control) && at_desk(control_)))
    return false;
  fresh_ = control_ != control;
  control_ = control;
  used_ = now;
  return true;
}

void ControlClaims::advance(TimestampNs now, bool held) {
  if (held) used_ = now;
  if (control_ != Control::kNone && now - used_ > handover_ns_) control_ = Control::kNone;
}

}  // namespace dubsar
