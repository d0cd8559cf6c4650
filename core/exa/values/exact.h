#pragma once
// Numbers kept to the last bit, and the escapes of positions that the offsets do not reach (docs/exa.md, "Exact
// numbers", "Escapes").

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/quad_mesh.h"

namespace dubsar {

/// Floats, `columns` to an item, one chunk for 65,536 items: differences to the item before, byte by byte.
std::vector<std::string> encode_floats(std::span<const float> values, std::size_t columns, Progress& progress);
/// kBadData: wrong number of chunks, a number that is not finite. `what` names them.
Result<void> decode_floats(std::span<const std::string_view> chunks, std::size_t columns, std::string_view what,
                           std::span<float> values, Progress& progress);

inline constexpr double kEscapeStep = 1.0 / 64.0;  ///< grid steps

/// base + k / 64 along each axis, rounded to float.
glm::vec3 escaped(const glm::vec3& base, const glm::ivec3& k);
/// k of the place next to `wanted`; nothing when it is more than 511 steps away.
std::optional<glm::ivec3> escape_to(const glm::vec3& base, const glm::vec3& wanted);

/// For each vertex whether it has left mesh.positions, and by how many steps; nothing when some position of `moved` is
/// not base + k / 64.
std::optional<std::vector<std::string>> encode_escapes(const QuadMesh& mesh, std::span<const glm::vec3> moved,
                                                       Progress& progress);
/// Moves mesh.positions. kBadData: wrong number of chunks.
Result<void> decode_escapes(std::span<const std::string_view> chunks, QuadMesh& mesh, Progress& progress);

}  // namespace dubsar
