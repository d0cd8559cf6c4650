#include "input/people/pose_history.h"

#include <algorithm>

namespace dubsar {
namespace {
constexpr std::size_t kSteps = 7;
constexpr TimestampNs kLongestWindow = 300'000'000;
}  // namespace

bool PositionHistory::add(const PositionSample& sample) noexcept {
  if (count_ > 0 && sample.time <= newest().time) {
    ++dropped_;
    return false;
  }
  samples_[next_] = sample;
  next_ = (next_ + 1) % kCapacity;
  count_ = std::min(count_ + 1, kCapacity);
  return true;
}

/// As long as it was asked for, longer where samples come slowly.
TimestampNs PositionHistory::window() const noexcept {
  std::array<TimestampNs, kSteps> steps{};
  const std::size_t count = std::min(count_ - 1, kSteps);
  for (std::size_t i = 0; i < count; ++i) steps[i] = ago(i).time - ago(i + 1).time;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(steps.begin(), middle, steps.begin() + static_cast<std::ptrdiff_t>(count));
  return std::max(window_ns_, std::min(kLongestWindow, *middle * 7 / 2));
}

std::optional<PositionHistory::Line> PositionHistory::fit() const noexcept {
  if (count_ < 3) return std::nullopt;
  const TimestampNs end = newest().time, longest = window();
  double n = 0.0, sum_t = 0.0, sum_tt = 0.0, oldest = 0.0;
  glm::dvec3 sum_p(0.0), sum_tp(0.0);
  for (std::size_t i = 0; i < count_; ++i) {
    const PositionSample& s = ago(i);
    if (end - s.time > longest) break;
    const double t = 1e-9 * static_cast<double>(s.time - end);
    oldest = t;
    n += 1.0;
    sum_t += t;
    sum_tt += t * t;
    sum_p += s.position_m;
    sum_tp += t * s.position_m;
  }
  const double determinant = n * sum_tt - sum_t * sum_t;
  if (n < 3.0 || oldest > -0.010 || determinant <= 0.0) return std::nullopt;
  const glm::dvec3 slope = (n * sum_tp - sum_t * sum_p) / determinant;
  return Line{(sum_p - slope * sum_t) / n, slope};
}

glm::dvec3 PositionHistory::velocity_mps() const noexcept {
  const auto line = fit();
  return line ? line->velocity_mps : glm::dvec3(0.0);
}

std::optional<glm::dvec3> PositionHistory::predict(TimestampNs time, TimestampNs max_ahead_ns) const noexcept {
  if (count_ == 0) return std::nullopt;
  const auto line = fit();
  if (!line) return newest().position_m;
  const double ahead = 1e-9 * static_cast<double>(std::clamp<TimestampNs>(time - newest().time, 0, max_ahead_ns));
  return line->at_newest_m + ahead * line->velocity_mps;
}

}  // namespace dubsar
