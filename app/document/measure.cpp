#include "app/document/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/words/text.h"

namespace dubsar::app {

std::optional<MeasureKind> measure_kind(std::string_view name) {
  const auto* const at = std::find(kMeasureKindNames.begin(), kMeasureKindNames.end(), name);
  if (at == kMeasureKindNames.end()) return std::nullopt;
  return static_cast<MeasureKind>(at - kMeasureKindNames.begin());
}

std::size_t points_of(MeasureKind kind) {
  switch (kind) {
    case MeasureKind::kAngle:
      return 3;
    case MeasureKind::kDepth:
      return 1;
    case MeasureKind::kDistance:
    case MeasureKind::kProfile:
      break;
  }
  return 2;
}

std::string length_text(double mm) {
  const double size = std::abs(mm);
  const int digits = size >= 100 ? 1 : size >= 10 ? 2 : size >= 0.1 || size == 0 ? 3 : 4;
  return local_figures(fmt::format("{:.{}f} mm", mm, digits));
}

namespace {

/// With two digits of what is uncertain, and as many of the length.
std::string uncertain_text(double mm, double uncertainty_mm) {
  const int digits =
      uncertainty_mm > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty_mm))), 0, 4) : 3;
  return local_figures(fmt::format("{:.{}f} \u00b1 {:.{}f} mm", mm, digits, uncertainty_mm, digits));
}

}  // namespace

std::string figures_text(const Measure& measure) {
  const MeasureFigures& f = measure.figures;
  const std::string straight = length_text(f.straight_mm);
  const std::string along = f.surface_mm > 0 ? tr("measure.along", straight, length_text(f.surface_mm)) : straight;
  switch (measure.kind) {
    case MeasureKind::kAngle:
      return local_figures(fmt::format("{:.2f}\u00b0", f.angle_deg));
    case MeasureKind::kDepth:
      return tr("measure.deep",
                f.uncertainty_mm ? uncertain_text(f.depth_mm, *f.uncertainty_mm) : length_text(f.depth_mm));
    case MeasureKind::kProfile:
      return along + ", " + tr("measure.deep", length_text(f.depth_mm));
    case MeasureKind::kDistance:
      break;
  }
  return along;
}

}  // namespace dubsar::app
