#pragma once
// How much light of the wrong eye a tracked panel lets through: against the head's speed and the system's
// latency, and off the axis, where exact refraction pays. Figures of the optical simulator, for people who
// choose trackers and cameras.

#include <vector>

#include "display/panels/panel_profile.h"

namespace dubsar {

struct CrosstalkCurve {
  struct Lag {
    double head_mm_s = 0.0, latency_ms = 0.0;
    double moved_mm = 0.0;  ///< sideways, between the weave and the light
    double wrong = 0.0;     ///< share of wrong-eye light of the worse eye, 0..1
  };
  struct Place {
    glm::dvec3 head_mm{0.0};  ///< between the eyes; woven for it
    double exact = 0.0, paraxial = 0.0;
  };
  double eye_distance_mm = 0.0, design_distance_mm = 0.0;
  double nominal = 0.0;         ///< in front at the design distance, woven for the true eyes
  double worst_sideways = 0.0;  ///< the same, anywhere within one eye distance to either side
  std::vector<Lag> lags;        ///< all pairs of the speeds and latencies, latencies fastest
  std::vector<Place> places;
};

struct CrosstalkQuestion {
  std::vector<double> head_mm_s{50, 100, 200, 400};
  std::vector<double> latency_ms{10, 20, 40, 60, 80, 100};
  std::vector<glm::dvec3> places_mm;  ///< empty: at the design distance and around it, and off the axis
  int step_px = 64;                   ///< of the grid of panel points that are looked at
};

/// kConfig when the profile is not one of a tracked panel. Uses all threads; some seconds for a 4K panel.
Result<CrosstalkCurve> crosstalk_curve(const PanelProfile& profile, const CrosstalkQuestion& question = {});

}  // namespace dubsar
