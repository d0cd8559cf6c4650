#pragma once
// Offsets of the active edges and decisions of the ambiguous faces as chunks, one a brick (docs/exa.md, "Offsets",
// "Face decisions"). The signs are known to both sides.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/exa/signs/brick_items.h"
#include "core/extract/edge_index.h"
#include "core/extract/surface_samples.h"

namespace dubsar {

struct SampleCode {
  std::vector<std::string> offsets, faces;
};

/// `samples` must have passed check_samples. All threads; the same bytes for any number of them.
Result<SampleCode> encode_samples(const SurfaceSamples& samples, Progress& progress);

/// Fills samples.offsets and samples.joined; dims, signs and offset_bits are set. Bricks whose chunks are empty keep
/// offset 0 and faces that are not joined. kBadData when the number of chunks is wrong or a brick names a model that is
/// not known; kTryAgain beyond 2^32 - 2 edges or out of memory. `far_sides`: BrickItems.
Result<void> decode_samples(std::span<const std::string_view> offsets, std::span<const std::string_view> faces,
                            SurfaceSamples& samples, Progress& progress, FarSides far_sides = kAllFarSides);
/// The same for who has the index of these signs.
Result<void> decode_samples(std::span<const std::string_view> offsets, std::span<const std::string_view> faces,
                            const EdgeIndex& index, SurfaceSamples& samples, Progress& progress,
                            FarSides far_sides = kAllFarSides);

/// Offsets half way of all edges of a brick whose chunk is lost.
void put_crossings_half_way(SurfaceSamples& samples, const EdgeIndex& index, std::size_t brick);

}  // namespace dubsar
