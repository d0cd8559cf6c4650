#pragma once
// What a surface is, in figures that a person wants to read: its parts, how large they are, how much of them the scan
// shows.

#include <array>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/evidence.h"
#include "core/mesh/tablet_frame.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar::app {

/// Sides of a body as the reader holds the tablet; a guess where SurfaceFacts::upright() is false.
inline constexpr std::array<const char*, 6> kEvidenceSides{"obverse",    "reverse",   "upper edge",
                                                           "lower edge", "left edge", "right edge"};
using EvidenceAreas = std::array<double, kEvidenceCount>;  ///< by Evidence

/// A body: the tablet, its envelope (outside and inside together), a fragment. Lengths in mm, or in voxels where the
/// file does not say how large a voxel is.
struct PartFacts {
  std::string name;
  PartitionKind kind = PartitionKind::kOther;
  glm::dvec3 size{0.0};  ///< width, height, thickness as a reader holds the tablet; the axes of the whole surface
  double area = 0.0, volume = 0.0;
  double inferred_area = 0.0;                                ///< of surface that the scan does not show
  std::array<EvidenceAreas, kEvidenceSides.size()> sides{};  ///< by what a face looks to, and how it is known
  bool watertight = false;
  double evidence_area(Evidence evidence) const;
  double inferred_share() const { return area > 0.0 ? inferred_area / area : 0.0; }
};

struct SurfaceFacts {
  bool millimetres = true;
  TabletFrame way;               ///< how the body lies, by its writing; what probabilities are worth: tablet_frame.h
  glm::dvec3 box{0.0};           ///< of all of it, along the axes of the scan
  std::vector<PartFacts> parts;  ///< large ones first; "pores and crumbs" last
  /// The writing says which way is up, so that sizes are width, height, thickness.
  bool upright() const { return way.up_probability >= kSureOfTheWay; }
};

/// Facts of a whole surface: all of its parts, each closed by its patches. A mesh without parts is one, "object".
/// `closed`: the whole mesh is known to be watertight (mesh_check.h), so that its bodies, where they share no vertices,
/// are, too. kBadData: no triangles. Cost: about .2 s a million triangles.
Result<SurfaceFacts> surface_facts(const TriMesh& mesh, bool closed = false);

/// {"unit": "mm", "upright", "up_probability", "obverse_probability", "mirrored_probability", "box": [..], "parts":
/// [{"name", "size", "area", "volume", "watertight", "inferred_area", "inferred_share", "evidence": {"measured",
/// "pocket", "film", "inferred"}, "sides": {"obverse": the same, ...}}], "evidence": {"area", "measured_area",
/// "pocket_area", "film_area", "inferred_area", "inferred_share"}}. Areas.
nlohmann::json facts_json(const SurfaceFacts& facts);

/// Lines of at most 60 characters: the parts with their sizes, whether their sides are sure, what of them is inferred,
/// and how each side of the written body is known.
std::string facts_text(const SurfaceFacts& facts);

/// "a tablet inside its envelope", "one object", ...
std::string what_it_is(const SurfaceFacts& facts);

/// "25.37 mm": as many digits as a calliper gives.
std::string size_text(const glm::dvec3& size, bool millimetres);

}  // namespace dubsar::app
