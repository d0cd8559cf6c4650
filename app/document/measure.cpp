#include "app/document/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  return fmt::format("{:.{}f} mm", mm, digits);
}

std::string figures_text(const Measure& measure) {
  const MeasureFigures& f = measure.figures;
  const std::string along = f.surface_mm > 0 ? fmt::format(", {} along the surface", length_text(f.surface_mm)) : "";
  switch (measure.kind) {
    case MeasureKind::kAngle:
      return fmt::format("{:.2f}\u00b0", f.angle_deg);
    case MeasureKind::kDepth:
      return f.uncertainty_mm
                 ? fmt::format("{} deep \u00b1 {}", length_text(f.depth_mm), length_text(*f.uncertainty_mm))
                 : fmt::format("{} deep", length_text(f.depth_mm));
    case MeasureKind::kProfile:
      return fmt::format("{}{}, {} deep", length_text(f.straight_mm), along, length_text(f.depth_mm));
    case MeasureKind::kDistance:
      break;
  }
  return length_text(f.straight_mm) + along;
}

}  // namespace dubsar::app
