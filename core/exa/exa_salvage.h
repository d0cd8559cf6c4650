#pragma once
// What can be read of a damaged EXA file (docs/exa.md, "Damage").

#include <string>
#include <vector>

#include "core/exa/exa_reader.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct SalvagedExa {
  SurfaceModel model;
  std::vector<std::string> lost;  ///< a sentence for each block or brick that is left out; empty: the file is whole
};

/// Leaves out blocks that are not needed and damaged, with those that hang on them, and what is damaged of bricks:
/// their crossings lie half way, or their signs are those of every eighth point. Where vertices are others than were
/// written nothing that is stored in their order is left, and those near lost bricks are marked as inferred. kBadData:
/// the table, the header or the signs of every eighth point are damaged, or a needed block of the paper's profile.
Result<SalvagedExa> decode_salvaged(const ExaReader& reader, Progress& progress);

}  // namespace dubsar
