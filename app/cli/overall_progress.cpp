#include "app/cli/overall_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dubsar::app {
namespace {
constexpr double kTooEarlyS = 3.0, kTooLittle = 0.02;
}

void OverallProgress::begin(std::string_view stage, double now_s) {
  if (!started_) started_ = now_s;
  end(now_s);
  stage_fraction_ = 0.0;
  stage_started_s_ = now_s;
  const auto found = std::find_if(plan_.begin() + static_cast<std::ptrdiff_t>(next_), plan_.end(),
                                  [&](const PlannedStage& planned) { return planned.name == stage; });
  if (found == plan_.end()) return;
  stage_ = static_cast<std::size_t>(found - plan_.begin());
  for (std::size_t k = next_; k < stage_; ++k) passed_ += plan_[k].share;
  next_ = stage_ + 1;
}

void OverallProgress::advance(double fraction, double now_s) {
  if (!started_) started_ = now_s;
  stage_fraction_ = std::clamp(fraction, 0.0, 1.0);
  double all = 0.0;
  for (const PlannedStage& planned : plan_) all += planned.share;
  if (all > 0.0) shown_ = std::max(shown_, std::min(1.0, (passed_ + in_stage()) / all));
}

void OverallProgress::end(double now_s) {
  if (stage_ >= plan_.size()) return;
  advance(1.0, now_s);
  Kind& kind = kinds_[plan_[stage_].surface ? 1 : 0];
  kind.seconds += now_s - stage_started_s_;
  kind.share += plan_[stage_].share;
  passed_ += plan_[stage_].share;
  stage_ = plan_.size();
}

double OverallProgress::pace(bool surface, double now_s) const {
  Kind kind = kinds_[surface ? 1 : 0];
  if (stage_ < plan_.size() && plan_[stage_].surface == surface && stage_fraction_ > kTooLittle) {
    kind.seconds += now_s - stage_started_s_;
    kind.share += in_stage();
  }
  return kind.share > 0.0 ? kind.seconds / kind.share : 0.0;
}

std::optional<double> OverallProgress::remaining_s(double now_s) const {
  if (!planned() || elapsed_s(now_s) < kTooEarlyS) return std::nullopt;
  double seconds = 0.0;
  const auto add = [&](const PlannedStage& planned, double share) {
    const double one = pace(planned.surface, now_s);
    seconds += share * one;
    return share <= 0.0 || one > 0.0;
  };
  bool known = true;
  if (stage_ < plan_.size()) known = add(plan_[stage_], plan_[stage_].share - in_stage());
  for (std::size_t k = next_; k < plan_.size(); ++k) known = add(plan_[k], plan_[k].share) && known;
  return known ? std::optional(seconds) : std::nullopt;
}

std::string rough_duration(double seconds) {
  const auto to = [](double value, double step) {
    return static_cast<int>(std::lround(value / step) * std::lround(step));
  };
  if (seconds < 10) return "a few seconds";
  if (seconds < 50) return fmt::format("about {} s", to(seconds, 5));
  if (seconds < 570) return fmt::format("about {} min", std::max(1, to(seconds / 60, 1)));
  if (seconds < 3300) return fmt::format("about {} min", to(seconds / 60, 5));
  const int minutes = to(seconds / 60, 10);
  return fmt::format("about {} h{}", minutes / 60, minutes % 60 == 0 ? "" : fmt::format(" {} min", minutes % 60));
}

}  // namespace dubsar::app
