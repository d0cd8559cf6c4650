#pragma once
// What tools find on the surface of a session: places, figures, how far it reaches, what of it was measured.

#include <array>
#include <map>

#include "app/commands/editor.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// What is known of the bodies of a surface. Pores and crumbs are none of them.
class SurfaceEvidence {
 public:
  SurfaceEvidence() = default;
  explicit SurfaceEvidence(const TriMesh& mesh);
  /// Of the partitions whose bit is set: a patch that closes two of them counts once. Of one body these are the figures
  /// of surface_facts().
  EvidenceShares of(std::uint8_t partitions) const;

 private:
  std::array<double, PartitionTable::kMost> measured_mm2_{};
  std::map<std::uint8_t, double> inferred_mm2_;  ///< by the partitions that a place closes
};

/// The nearest place of the surface, with the part of `parts` that it lies on; its side is left empty.
Result<SurfacePin> pin_on(const TriMesh& mesh, const std::vector<Part>& parts, const glm::dvec3& at_mm);

/// What comes of a measure's points, each taken to the surface first. kUsage: too few or too many points, and the
/// errors of impression_depth().
Result<MeasureFigures> figures_of(const TriMesh& mesh, const Measure& measure);

/// From where to where the surface reaches along a direction (unit), mm from the scan's origin.
Workplace::Reach reach_along(const TriMesh& mesh, const glm::dvec3& direction);

/// The turn that shows the tablet's obverse upright, found from its writing: of the tablet where there is one, else of
/// everything; and what of it is not sure (TabletFrame::doubt()). `first` turns the scan as an unturned view shows it.
struct UprightTurn {
  glm::dquat turn{1.0, 0.0, 0.0, 0.0};
  std::string doubt{};
};
Result<UprightTurn> upright_turn(const TriMesh& mesh, const glm::dmat3& first);

/// Which of the six sides looks the way of a normal; `home` turns the scan to its obverse.
std::string side_of(const glm::dvec3& normal, const glm::dmat3& home);

}  // namespace dubsar::app
