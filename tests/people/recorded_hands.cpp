#include "tests/people/recorded_hands.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace dubsar {

RecordedFingers::State RecordedFingers::at(double part) const {
  const double t_s = std::max(0.0, part) * there_s;
  const auto after = std::find_if(moments.begin(), moments.end(), [&](const RecordedMoment& m) { return m.t_s > t_s; });
  const RecordedMoment& b = after == moments.end() ? moments.back() : *after;
  const RecordedMoment& a = after == moments.begin() ? b : *(after - 1);
  const double share = b.t_s > a.t_s ? std::clamp((t_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0) : 1.0;
  const RecordedMoment &first = moments.front(), &last = moments.back();
  const auto between = [](double value, double from, double to) { return (value - from) / (to - from); };
  State out{between(std::lerp(a.grab, b.grab, share), first.grab, last.grab),
            between(std::lerp(a.pinch_mm, b.pinch_mm, share), first.pinch_mm, last.pinch_mm),
            1e-3 * glm::mix(a.went_mm, b.went_mm, share)};
  if (kind == kOpens) {  // what the arm did meanwhile is the arm's: the way there and back is the fingers'
    const double done = std::clamp(t_s / last.t_s, 0.0, 1.0);
    out.went_m -= 1e-3 * done * last.went_mm;
  }
  return out;
}

std::span<const RecordedFingers> recorded_fingers() {
  static const std::vector<RecordedFingers> all{
#include "tests/people/recorded_hands.inc"
  };
  return all;
}

}  // namespace dubsar
