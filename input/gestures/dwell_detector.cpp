#include "input/gestures/dwell_detector.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace dubsar {

bool DwellDetector::update(TimestampNs now, const glm::dvec3& cursor_m, bool may_begin, const GestureOptions& options) {
  const bool still = since_ && glm::length(cursor_m - at_m_) <= options.dwell.radius_m;
  if (!may_begin || !still) {
    since_ = now;
    at_m_ = cursor_m;
    progress_ = 0.0;
    done_ = false;
    return false;
  }
  const double filled =
      static_cast<double>(now - *since_ - options.dwell.start_ns) / static_cast<double>(options.dwell.fill_ns);
  progress_ = done_ ? 0.0 : std::clamp(filled, 0.0, 1.0);
  if (filled < 1.0 || done_) return false;
  done_ = true;
  return true;
}

}  // namespace dubsar
