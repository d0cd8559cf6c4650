#pragma once
// What makes a surface of parts of a surface, as chunks: labels, crossings of the contact, how its vertices are known,
// and the places of all vertices (docs/exa.md, "Labels").

#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/exa/exa_reader.h"
#include "core/exa/exa_text.h"
#include "core/extract/edge_index.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct LabelledCode {
  std::vector<std::string> labels, offsets, evidence;
  /// Of all vertices, in the order of LabelledMesh: as escapes or exact; both empty: none escapes.
  std::vector<std::string> escapes, exact;
  ExaContact counts;
};

/// kInternal: a model whose mesh or patch is not what its labels give; kTryAgain; kCancelled.
Result<LabelledCode> encode_labelled(const SurfaceModel& model, Progress& progress);

/// Fills model.labelled, mesh and contact; model.samples are there, `index` is theirs. The mesh is returned for
/// draw_labelled_mesh(), when normals are known. `exact_sums`: false where the file is damaged. kBadData: other labels
/// than the header counts, a block that is missing or broken, no tablet in an envelope.
Result<LabelledMesh> decode_labelled(const ExaReader& reader, const ExaHeader& header, const EdgeIndex& index,
                                     bool exact_sums, SurfaceModel& model, Progress& progress);

/// The labelled mesh of a model's samples and labels: every vertex at the mean of its crossings.
Result<LabelledMesh> labelled_base(const SurfaceModel& model, const EdgeIndex& index, Progress& progress);

}  // namespace dubsar
