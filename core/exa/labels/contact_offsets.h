#pragma once
// Where the contact crosses its grid edges, as chunks, one a brick (docs/exa.md, "Labels"): the code of the offsets
// between clay and air (offsets.h), walking over the surface of the tablet, of which those at the air are known.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/edge_index.h"
#include "core/extract/labelled/contact_edges.h"
#include "core/extract/labelled/point_labels.h"

namespace dubsar {

/// What both sides know of a contact. `index` is that of the samples; all must outlive this.
struct KnownContact {
  const SurfaceSamples& samples;
  const EdgeIndex& index;
  const PointLabels& labels;
  const ContactEdges& edges;
};

/// `offsets`: one for each edge of the contact, of samples.offset_bits. Bricks in which none begins have empty chunks.
/// All threads; the same bytes for any number of them. kTryAgain beyond 2^32 - 2 edges; kCancelled.
Result<std::vector<std::string>> encode_contact_offsets(const KnownContact& contact,
                                                        std::span<const std::uint16_t> offsets, Progress& progress);

/// Bricks whose chunks are empty keep offset 0. kBadData when the number of chunks is wrong or a brick names a model
/// that is not known.
Result<std::vector<std::uint16_t>> decode_contact_offsets(std::span<const std::string_view> chunks,
                                                          const KnownContact& contact, Progress& progress);

}  // namespace dubsar
