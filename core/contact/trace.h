#pragma once
// Contact between tablet and envelope, traced through the scan: pockets of air join the relief of both, films of air
// are followed, and only where neither is there does the smooth patch stay (docs/evidence.md).

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/text/enum_names.h"
#include "core/contact/rules.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/parts/surface_model.h"
#include "core/parts/untangle.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// How the parts are closed where they touch.
enum class ContactMesh {
  kPatches,  ///< a patch between the surfaces, which is got apart from them
  kLabels,   ///< one mesh of labelled grid points (labelled_contact.h), which crosses itself nowhere
};
inline constexpr EnumName<ContactMesh> kContactMeshes[] = {{ContactMesh::kPatches, "patches"},
                                                           {ContactMesh::kLabels, "labels"}};
static_assert(names_all(kContactMeshes, static_cast<std::size_t>(ContactMesh::kLabels) + 1));

struct ContactOptions {
  ContactMesh mesh = ContactMesh::kPatches;
  /// Whether what the smooth patch has missed by more than the reach is looked for at half the density's resolution:
  /// at the scan's own.
  bool halve_first = true;
  float reach = 12.0f;       ///< of the search from the smooth patch, grid steps: the deepest wedge
  float out_reach = 8.0f;    ///< the same into the envelope, where the two clays are not seen to differ
  double step = 1.0 / 64.0;  ///< positions are multiples of it, as in files
  /// Mean strength of dips around a vertex (dips.h) above that of plain clay from which on a film is believed.
  float film_margin = 0.3f;
  /// Variance of the scan's edges, voxels squared (core/filter/edge_spread.h); this is that of a good scan.
  float blur_variance = 0.42f;
  /// Smaller differences of the two clays, grey values, say nothing: so uneven is what should be one density where rays
  /// were straightened.
  float least_clay_step = 0.0f;
  ContactRules rules{};  ///< all but those that a bench switches off
};

struct ContactReport {
  bool traced = false;  ///< false: the patches stay as they were, `why` says the reason
  std::string why;
  std::int64_t points = 0;    ///< of clay that was looked at
  std::int64_t pockets = 0;   ///< closed surfaces that joined tablet and envelope
  UntangleReport patches;     ///< whether the contact runs through anything
  bool clays_differ = false;  ///< in density, and the contact follows that
  std::int64_t film_vertices = 0, inferred_vertices = 0;
  /// kLabels: the mesh of all parts, which has gone out of the model; settle_labelled() (settle_labelled.h), or
  /// put_labelled_mesh() (labelled_model.h), puts it back.
  std::optional<LabelledMesh> labelled{};
};

/// Replaces the fill patches between tablet and envelope (fill_holes() must have run) by the traced contact, moves the
/// labels of faces beside it, and measures the partitions. `density` is the scan on the model's grid, unfiltered. The
/// model stays as it was where tablet or envelope would not be closed. Deterministic for any thread count. Errors of
/// `density`, kCancelled. About 5 us a point of the band.
Result<ContactReport> trace_contact(SurfaceModel& model, SlabSource& density, const ContactOptions& options,
                                    Progress& progress);

}  // namespace dubsar
