#pragma once
// Tablet, envelope and air as labels of grid points, meshed once: the contact without patches (docs/manifold.md). A
// trial beside trace.h's way, which it could replace.

#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/clay_sides.h"
#include "core/contact/dips.h"
#include "core/contact/interface_shape.h"
#include "core/contact/pockets.h"
#include "core/extract/edge_index.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// What is known when the clay has been divided.
struct DividedClay {
  const ContactBand& band;
  const BandDensity& density;
  const Dips& dips;
  const EdgeIndex& index;
  const FaceGraph& graph;
  const std::vector<BandFace>& faces;
  const std::vector<ClayCavity>& pores;
  const std::vector<ClaySide>& side;
  ClayDivision* division = nullptr;  ///< asked once more which films are firm; null: all are
  ShapeOptions shape;
};

struct LabelledContactReport {
  std::int64_t pockets = 0, film_vertices = 0, inferred_vertices = 0;
  std::int64_t cells = 0;           ///< with clay of both
  std::int64_t relabelled = 0;      ///< points of clay that the sheet's place gave to the other
  int rounds = 0;                   ///< of taking back
  std::int64_t taken_back = 0;      ///< points
  std::int64_t crossing_pairs = 0;  ///< that are left, of all triangles of all parts
};

/// Puts the labelled mesh in place of the model's: its x-quads between clay and air with their triangles
/// (SurfaceModel::drawing), and the contact as one patch that shares vertices with them. Measures the partitions.
/// Errors of make_tri_mesh(), kCancelled.
Result<LabelledContactReport> lay_labelled_contact(SurfaceModel& model, const DividedClay& clay, Progress& progress);

}  // namespace dubsar
