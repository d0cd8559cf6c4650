#include "display/panels/crosstalk_curve.h"

#include <map>

#include "display/optics/optics.h"

namespace dubsar {
namespace {

constexpr int kSidewaysSteps = 6;  // to either side

EyePair eyes_at(const glm::dvec3& head, double eye_distance_mm) {
  const glm::dvec3 half(0.5 * eye_distance_mm, 0.0, 0.0);
  return {head - half, head + half};
}

std::vector<glm::dvec3> usual_places(double z) {
  return {{0, 0, z}, {63, 0, z}, {0, 0, 0.75 * z}, {0, 0, 1.33 * z}, {120, 60, 500}, {200, 0, z}, {300, 100, z}};
}

}  // namespace

Result<CrosstalkCurve> crosstalk_curve(const PanelProfile& profile, const CrosstalkQuestion& question) {
  if (profile.kind != PanelKind::kTracked)
    return fail(ErrorKind::kConfig,
                "panel {}: many views, expected a tracked panel with two; render --see-from tells what an "
                "eye sees of it",
                profile.name);
  DUBSAR_ASSIGN(const TrackedPanel panel, panel_optics(profile, profile.zone.design_distance_mm));
  CrosstalkCurve out;
  out.eye_distance_mm = profile.zone.ipd_mm;
  out.design_distance_mm = profile.zone.design_distance_mm;
  const auto wrong = [&](const glm::dvec3& woven_for, const glm::dvec3& head, bool exact) {
    return wrong_eye_light(panel, eyes_at(woven_for, profile.zone.ipd_mm), eyes_at(head, profile.zone.ipd_mm), exact,
                           question.step_px)
        .worst();
  };
  const glm::dvec3 front(0.0, 0.0, profile.zone.design_distance_mm);
  out.nominal = wrong(front, front, true);
  for (int i = -kSidewaysSteps; i <= kSidewaysSteps; ++i) {
    const glm::dvec3 head = front + glm::dvec3(profile.zone.ipd_mm * i / kSidewaysSteps, 0.0, 0.0);
    out.worst_sideways = std::max(out.worst_sideways, wrong(head, head, true));
  }
  std::map<double, double> of_move;
  for (const double speed : question.head_mm_s)
    for (const double latency : question.latency_ms) {
      const double moved = speed * latency / 1000.0;
      const auto [known, is_new] = of_move.try_emplace(moved, 0.0);
      if (is_new) known->second = wrong(front, front + glm::dvec3(moved, 0.0, 0.0), true);
      out.lags.push_back({speed, latency, moved, known->second});
    }
  for (const glm::dvec3& head :
       question.places_mm.empty() ? usual_places(profile.zone.design_distance_mm) : question.places_mm)
    out.places.push_back({head, wrong(head, head, true), wrong(head, head, false)});
  return out;
}

}  // namespace dubsar
