#pragma once
// Whose clay each point of clay is, as bytes (docs/exa.md, "Labels"): one chunk a brick. The signs are known to both
// sides. Tiles of 4 x 4 x 4 points whose clay is all of one take next to nothing; in the others each point of clay has
// a bit, guessed from the labels around it.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/labelled/envelope_bits.h"

namespace dubsar {

/// Empty chunks are bricks whose clay is all the tablet's. All threads; the same bytes for any number of them.
/// kCancelled.
Result<std::vector<std::string>> encode_label_plane(const BitVolume& signs, const EnvelopeBits& envelope,
                                                    Progress& progress);

/// compact(). kBadData when the number of chunks is wrong or more than `most_points` labels are coded, which bounds the
/// time that damaged bytes can take. Bytes that are no code give other labels. kCancelled.
Result<EnvelopeBits> decode_label_plane(std::span<const std::string_view> chunks, const BitVolume& signs,
                                        std::uint64_t most_points, Progress& progress);

/// No surface with so many active edges and edges of the contact has more coded labels: each mixed tile has one of
/// them, and 64 points.
constexpr std::uint64_t most_coded_labels(std::uint64_t edges, std::uint64_t contact) { return 64 * (edges + contact); }

}  // namespace dubsar
