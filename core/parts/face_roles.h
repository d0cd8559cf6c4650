#pragma once
// Roles of faces: every face gets one from where its air lies and where it looks, and the roles make the partitions.

#include <cstdint>
#include <vector>

#include "core/parts/air_space.h"
#include "core/parts/face_graph.h"
#include "core/parts/segment.h"

namespace dubsar {

enum class FaceRole : std::uint8_t {
  kOutside,  ///< borders exterior air
  kInside,   ///< borders enclosed air and looks inwards: inner wall of an envelope, wall of a pore
  kCore,     ///< borders enclosed air and looks outwards: the hidden body
};

struct FaceScene {
  static constexpr std::uint32_t kExterior = 0xfffffffeu;
  const FaceGraph& graph;  ///< borrowed
  int crack_radius = 0;
  std::vector<std::uint32_t>
      air{};                    ///< per face: kExterior, a component of enclosed air, or EnclosedAir::kNone (unknown)
  std::vector<float> inward{};  ///< per face: cosine between its normal and the way inwards
  std::vector<float> depth{};   ///< per face: below the sealed outside, grid steps

  /// False when only the graph is there: enough for components of closed bodies.
  bool observed() const noexcept { return air.size() == graph.faces(); }
};

/// The expensive half: finds the exterior (find_exterior) and measures depths. Borrows the graph.
Result<FaceScene> observe_faces(const SurfaceModel& model, const FaceGraph& graph, const SegmentOptions& options,
                                Progress& progress);

/// Faces of one label that hang together.
struct FaceComponents {
  struct Info {
    double area = 0.0;
    double volume = 0.0;                       ///< signed; cones from the centre of area close what is open
    double exterior_area = 0.0;                ///< of faces at exterior air
    double inward_area = 0.0;                  ///< sum of area times cosine over the other faces
    double border = 0.0;                       ///< length of sides towards other labels and of open sides
    glm::vec3 lowest{1e30f}, highest{-1e30f};  ///< bounding box
    std::uint32_t first_face = 0;
  };
  std::vector<std::uint32_t> of_face;  ///< component ids rise with their first face
  std::vector<Info> info;
};
FaceComponents find_components(const SurfaceModel& model, const FaceScene& scene,
                               const std::vector<std::uint8_t>& label);

/// Minimum cut along concave creases, nested: outside | rest, then inside | core. `whole`: the components of all faces,
/// whatever their label. kCancelled.
Result<std::vector<FaceRole>> roles_by_cut(const SurfaceModel& model, const FaceScene& scene,
                                           const FaceComponents& whole, const SegmentOptions& options,
                                           Progress& progress);

/// Components of what the concavity threshold leaves; each gets the role that most of its area votes for.
Result<std::vector<FaceRole>> roles_by_concavity(const SurfaceModel& model, const FaceScene& scene,
                                                 const SegmentOptions& options, Progress& progress);

/// Faces of one role that hang together.
FaceComponents role_components(const SurfaceModel& model, const FaceScene& scene, const std::vector<FaceRole>& roles);

/// The second half: sets quad_partition and partitions of the model from the roles of its faces and their `components`,
/// and small_pieces and cut_length of the report. False, and closed bodies as they are, when the core pieces are no
/// hidden body.
bool partition_by_roles(SurfaceModel& model, const FaceScene& scene, const SegmentOptions& options,
                        std::vector<FaceRole> roles, FaceComponents components, SegmentReport& report);

/// Length of side i of a face.
float side_length(const QuadMesh& mesh, std::uint32_t face, std::uint32_t side);

}  // namespace dubsar
