#pragma once
// The nodes of a glTF file: which are shown, where what hangs on them stands, how far it is morphed.

#include <glm/mat4x4.hpp>
#include <vector>

#include "core/mesh_io/glb/glb_data.h"

namespace dubsar {

/// The nodes that stand in the shown scene: of the scene that is named, else of the first one; all that are no node's
/// child in a file without scenes. kBadData: none, or a scene that does not exist.
Result<nlohmann::json> glb_roots(const nlohmann::json& root);
/// From a node to its parent: its matrix, or translation, rotation (brought to length 1) and scale.
Result<glm::dmat4> glb_node_matrix(const nlohmann::json& node);
/// Where a node's mesh stands: once, at `transform`, or as often as EXT_mesh_gpu_instancing says.
Result<std::vector<glm::dmat4>> glb_instances(GlbData& data, const nlohmann::json& node, const glm::dmat4& transform);
/// Shares of the morph targets of the mesh of a node: the node's, else those of the mesh; missing ones are 0.
std::vector<double> glb_weights(const nlohmann::json& node, const nlohmann::json& mesh);

}  // namespace dubsar
