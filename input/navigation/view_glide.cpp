#include "input/navigation/view_glide.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {
constexpr double kShortestS = 0.25;
}  // namespace

void ViewGlide::start(const ViewState& from, const ViewState& to, TimestampNs now, const HandMapping& limits) {
  const double angle = turn_between_deg(from.rotation, to.rotation);
  const double zoom = std::abs(std::log(to.zoom / from.zoom));
  const double pan = glm::length(to.pan - from.pan);
  // A smooth step is 1.5 times as fast in its middle as on average.
  const double longest = std::max(
      {1.5 * angle / limits.fastest_turn_deg_per_s, 1.5 * zoom / std::log(limits.fastest_zoom_per_s), pan, kShortestS});
  step_ = Step{from, to, now, static_cast<TimestampNs>(1e9 * longest)};
}

void ViewGlide::advance(TimestampNs now, ViewState& view) {
  if (!step_) return;
  const double t = std::clamp(static_cast<double>(now - step_->start) / static_cast<double>(step_->duration), 0.0, 1.0);
  const double s = t * t * (3.0 - 2.0 * t);
  const ViewState &a = step_->from, &b = step_->to;
  view.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, s));
  view.zoom = a.zoom * std::pow(b.zoom / a.zoom, s);
  view.pan = glm::mix(a.pan, b.pan, s);
  view.nearer = glm::mix(a.nearer, b.nearer, s);
  view.light_azimuth_deg = glm::mix(a.light_azimuth_deg, b.light_azimuth_deg, s);
  view.light_elevation_deg = glm::mix(a.light_elevation_deg, b.light_elevation_deg, s);
  if (t < 1.0) return;
  view = b;
  step_.reset();
}

}  // namespace dubsar
