#include "input/people/other_bodies.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {
constexpr double kSameM = 0.15, kFollows = 0.05;  // of the way at each sample
constexpr TimestampNs kTold = 300'000'000, kForgotten = 20'000'000'000, kLongestStep = 100'000'000;
}  // namespace

void OtherBodies::see(TimestampNs now, double x_m) {
  std::erase_if(bodies_, [now](const Body& body) { return now < body.seen || now - body.seen > kForgotten; });
  const auto nearest = std::min_element(bodies_.begin(), bodies_.end(), [x_m](const Body& a, const Body& b) {
    return std::abs(a.x_m - x_m) < std::abs(b.x_m - x_m);
  });
  if (nearest == bodies_.end() || std::abs(nearest->x_m - x_m) > kSameM) {
    bodies_.push_back({x_m, now, 0});
    return;
  }
  nearest->x_m = std::lerp(nearest->x_m, x_m, kFollows);
  nearest->for_ns += std::min(kLongestStep, now - nearest->seen);
  nearest->seen = now;
}

bool OtherBodies::near(TimestampNs now, double x_m, double within_m) const {
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    return body.for_ns >= kTold && now - body.seen <= kForgotten && std::abs(body.x_m - x_m) <= within_m;
  });
}

}  // namespace dubsar
