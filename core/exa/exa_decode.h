#pragma once
// From the blocks of a file to a model: all of it, a coarser level, or a box.

#include <functional>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/exa/exa_file.h"
#include "core/exa/exa_reader.h"
#include "core/exa/exa_text.h"
#include "core/exa/signs/topology.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// What of a file is known to be damaged, so that it is read without (exa_salvage.h).
struct ExaDamage {
  std::vector<std::uint8_t> signs, offsets, faces;  ///< 1 for each brick that has lost these; empty: none has
};

/// As read_exa(), read_exa_level() and read_exa_box() (exa_file.h). With `damage`, signs of a lost brick are those of
/// the nearest of every eighth point, and crossings lie half way; where that gives other vertices than were written,
/// all that is stored in their order is left out. Then sums are not compared.
Result<SurfaceModel> decode_model(const ExaReader& reader, const ExaReadOptions& options, Progress& progress,
                                  const ExaDamage* damage = nullptr);
Result<SurfaceModel> decode_level(const ExaReader& reader, int level, Progress& progress);
Result<SurfaceModel> decode_box(const ExaReader& reader, const GridBox& box, Progress& progress);

/// Blocks of signs and the chunks that borrow from them.
struct LoadedSigns {
  std::vector<ExaChunks> blocks;
  SignChunks chunks;
};
/// The signs down to spacing 2^level; with `wanted`, only of the bricks i with wanted(i).
Result<LoadedSigns> load_signs(const ExaReader& reader, int level, const std::function<bool(std::size_t)>& wanted);

/// All points of spacing 2^level.
Result<BitVolume> decode_level_signs(const ExaReader& reader, const ExaHeader& header, int level, Progress& progress,
                                     const std::vector<std::uint8_t>& lost = {});

/// What the header says of the samples; signs, offsets and face decisions are empty.
SurfaceSamples empty_samples(const ExaHeader& header);

}  // namespace dubsar
