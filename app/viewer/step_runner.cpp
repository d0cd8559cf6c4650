#include "app/viewer/step_runner.h"

namespace dubsar::app {

void StepRunner::update(TimestampNs now, const std::function<bool()>& opening, const Obey& obey) {
  if (began_ < 0) began_ = now;
  const bool waits = opening() && (over() || steps_[at_].text != "stop_opening");
  if (waits && looked_ >= 0) began_ += now - looked_;
  looked_ = now;
  if (waits) return;
  for (; !over() && !failed_; ++at_) {
    const TimedCommand& step = steps_[at_];
    if (opening() && step.text != "stop_opening") return;
    if (1e-9 * static_cast<double>(now - began_) < step.time_s) return;
    if (const auto done = obey(step.text); !done)
      failed_ = Error{done.error().kind, fmt::format("at {} s: {}", step.time_s, done.error().message)};
  }
}

}  // namespace dubsar::app
