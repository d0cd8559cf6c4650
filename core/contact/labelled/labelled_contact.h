#pragma once
// Tablet, envelope and air as labels of grid points, meshed once: the contact without patches (docs/manifold.md).

#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/clay_sides.h"
#include "core/contact/dips.h"
#include "core/contact/interface_shape.h"
#include "core/contact/labelled/clay_labels.h"
#include "core/contact/labelled/contact_sheet.h"
#include "core/contact/pockets.h"
#include "core/extract/edge_index.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// What is known when the clay has been divided.
struct DividedClay {
  const ContactBand& band;
  const ClayBeyond& beyond;
  const Dips& dips;
  const EdgeIndex& index;
  const std::vector<BandFace>& faces;
  const RestPieces& rest;
  const std::vector<ClayCavity>& pores;
  const std::vector<ClaySide>& side;
};

/// The contact as the cut has it, moved to where the scan shows it. Errors of build_contact_quads(), kCancelled.
Result<ContactSheet> sheet_of_cut(const SurfaceModel& model, const DividedClay& clay, const BandDensity& density,
                                  const ShapeOptions& shape, Progress& progress);

struct LabelledContact {
  LabelledMesh mesh;  ///< with the model's places where no cell is mixed
  std::int64_t pockets = 0, film_vertices = 0, inferred_vertices = 0;
  std::int64_t relabelled = 0;  ///< points of clay that the sheet's place gave to the other
};

/// Gives the model labels (SurfaceModel::labelled) on both sides of the sheet, and its faces to the parts that they
/// say. The mesh goes out of the model: put_labelled_mesh() (labelled_model.h) puts it back. Its vertices must lie in
/// their cells. Errors of build_labelled_mesh(), kCancelled.
Result<LabelledContact> lay_labelled_contact(SurfaceModel& model, const DividedClay& clay, const ContactSheet& sheet,
                                             Progress& progress);

}  // namespace dubsar
