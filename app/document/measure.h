#pragma once
// What was measured on a surface, and what came of it. Plain values; core/mesh/surface_measure.h finds the figures.

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dubsar::app {

enum class MeasureKind {
  kDistance,  ///< two places: straight, and along the surface
  kAngle,     ///< three places: at the second one
  kDepth,     ///< one place in a wedge: below the surface around it
  kProfile,   ///< two places: the section between them
};
inline constexpr std::array<std::string_view, 4> kMeasureKindNames{"distance", "angle", "depth", "profile"};
inline std::string_view measure_kind_name(MeasureKind kind) {
  return kMeasureKindNames[static_cast<std::size_t>(kind)];
}
std::optional<MeasureKind> measure_kind(std::string_view name);
/// How many places it is made of.
std::size_t points_of(MeasureKind kind);

/// What came of it; figures that its kind does not have are 0.
struct MeasureFigures {
  double straight_mm = 0.0;
  double surface_mm = 0.0;  ///< 0: the surface does not lead from one place to the other
  double angle_deg = 0.0;
  double depth_mm = 0.0;  ///< of a profile: below the straight line between its ends
  std::optional<double>
      uncertainty_mm{};             ///< of the depth of a wedge, one standard deviation; files of before have none
  std::vector<glm::dvec3> path_mm;  ///< along the surface; of a depth: from the plane down to the deepest place
  friend bool operator==(const MeasureFigures&, const MeasureFigures&) = default;
};

/// mm2 of the surface that the scan shows, and of that which was inferred.
struct EvidenceShares {
  double measured_mm2 = 0.0, inferred_mm2 = 0.0;
  friend bool operator==(const EvidenceShares&, const EvidenceShares&) = default;
};

struct Measure {
  MeasureKind kind = MeasureKind::kDistance;
  std::string name;                   ///< "wedge head"; may be empty
  std::string part;                   ///< that the first place lies on; empty: none
  std::vector<glm::dvec3> points_mm;  ///< on the surface, in the frame of the scan
  MeasureFigures figures;
  std::string id{};  ///< that it has for life, in all copies of the work
  friend bool operator==(const Measure&, const Measure&) = default;
};

/// "12.35 mm, 12.61 mm along the surface", "37.2\u00b0", "0.412 mm deep \u00b1 0.021 mm".
std::string figures_text(const Measure& measure);

/// 12.3456 is "12.35" and 0.01234 is "0.0123": four digits, three behind the point at most from 0.1 on.
std::string length_text(double mm);

}  // namespace dubsar::app
