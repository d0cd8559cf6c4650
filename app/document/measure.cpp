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

namespace {

/// With two digits of what is uncertain, and as many of the length.
std::string uncertain_text(double mm, double uncertainty_mm) {
  const int digits =
      uncertainty_mm > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty_mm))), 0, 4) : 3;
  return fmt::format("{:.{}f} \u00b1 {:.{}f} mm", mm, digits, uncertainty_mm, digits);
}

}  // namespace

std::string figures_text(const Measure& measure) {
  const MeasureFigures& f = measure.figures;
  const std::string along = f.surface_mm > 0 ? fmt::format(", {} along the surface", length_text(f.surface_mm)) : "";
  switch (measure.kind) {
    case MeasureKind::kAngle:
      return fmt::format("{:.2f}\u00b0", f.angle_deg);
    case MeasureKind::kDepth:
      return (f.uncertainty_mm ? uncertain_text(f.depth_mm, *f.uncertainty_mm) : length_text(f.depth_mm)) + " deep";
    case MeasureKind::kProfile:
      return fmt::format("{}{}, {} deep", length_text(f.straight_mm), along, length_text(f.depth_mm));
    case MeasureKind::kDistance:
      break;
  }
  return length_text(f.straight_mm) + along;
}

}  // namespace dubsar::app
