#pragma once
// The values of the paper's profile beside its signs: places and normals as small numbers in words of constant codes,
// shape class, light and partition in 16 bits a vertex (paper_code.md).

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/exa/offsets/settle.h"
#include "core/parts/surface_model.h"

namespace dubsar {

inline constexpr double kPaperStep = 1.0 / 512.0;  ///< of places, in grid steps
inline constexpr int kPaperNormalSteps = 255;      ///< of an octahedron's coordinate from 0 to 1

/// Moves positions to whole steps from those that the samples give and normals to the steps of the octahedron;
/// curvatures and shape classes follow from them. Everything else stays. Twice is the same as once. With
/// options.exact_normals normals, curvatures and shapes stay, too; options.max_error is not looked at, the steps are
/// finer than any bound that makes sense.
Result<SettleStats> settle_for_paper(SurfaceModel& model, const SettleOptions& options, Progress& progress);

/// Nothing when a position is not a whole number of steps from its base.
std::optional<std::vector<std::string>> encode_paper_positions(std::span<const glm::vec3> base,
                                                               std::span<const glm::vec3> moved, Progress& progress);
/// Moves `positions` from base. kBadData: not what was written.
Result<void> decode_paper_positions(std::span<const std::string_view> chunks, std::vector<glm::vec3>& positions,
                                    Progress& progress);

/// Nothing when a normal is not on a step.
std::optional<std::vector<std::string>> encode_paper_normals(std::span<const glm::vec3> normals, Progress& progress);
Result<std::vector<glm::vec3>> decode_paper_normals(std::span<const std::string_view> chunks, std::size_t vertices,
                                                    Progress& progress);

/// Numbers of `bits` bits, in chunks of 65,536.
std::vector<std::string> encode_paper_bits(std::span<const std::uint16_t> numbers, int bits, Progress& progress);
Result<void> decode_paper_bits(std::span<const std::string_view> chunks, int bits, std::string_view what,
                               std::span<std::uint16_t> numbers);

/// Shape classes, light and partitions of a model; those that it has not got stay empty.
struct PaperWords {
  std::vector<std::string> words;       ///< one byte: which there are; then 16 bits a vertex
  std::vector<std::string> exceptions;  ///< x-quads whose partition is not that of their first vertex; may be empty
};
PaperWords encode_paper_words(const SurfaceModel& model, bool shapes, Progress& progress);
Result<void> decode_paper_words(std::span<const std::string_view> words, std::span<const std::string_view> exceptions,
                                SurfaceModel& model);

}  // namespace dubsar
