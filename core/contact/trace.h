#pragma once
// Contact between tablet and envelope: pockets of air join the relief of both, films of air are followed through the
// scan, and only where neither is there is it as the smooth patch (docs/evidence.md). One mesh of labelled grid points
// closes both (labelled/labelled_contact.h).

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/rules.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/parts/surface_model.h"
#include "core/volume/slab_source.h"

namespace dubsar {

struct ContactOptions {
  /// Whether what the smooth patch has missed by more than the reach is looked for at half the density's resolution:
  /// at the scan's own.
  bool halve_first = true;
  float reach = 12.0f;     ///< of the search from the smooth patch, grid steps: the deepest wedge
  float out_reach = 8.0f;  ///< the same into the envelope, where the two clays are not seen to differ
  /// Variance of the scan's edges, voxels squared (core/filter/edge_spread.h); this is that of a good scan.
  float blur_variance = 0.42f;
  /// Deviation of dips that is taken for at least, grey values: however little noise there is, reconstructions make
  /// dips that hang together.
  float least_deviation = 0.0f;
  /// Smaller differences of the two clays, grey values, say nothing: so uneven is what should be one density where rays
  /// were straightened.
  float least_clay_step = 0.0f;
  ContactRules rules{};  ///< all but those that a bench switches off
};

struct ContactReport {
  bool traced = false;  ///< false: the scan was not asked, `why` says the reason
  std::string why;
  std::int64_t points = 0;    ///< of clay that was looked at
  std::int64_t pockets = 0;   ///< closed surfaces that joined tablet and envelope
  bool clays_differ = false;  ///< in density, and the contact follows that
  std::int64_t film_vertices = 0, inferred_vertices = 0;
  std::int64_t touching = 0;  ///< polygons of the final mesh that touch others: none but where nothing could part them
  /// The mesh of all parts, which has gone out of the model; settle_labelled() (settle_labelled.h), or
  /// put_labelled_mesh() (labelled_model.h), puts it back. None: tablet and envelope do not touch.
  std::optional<LabelledMesh> labelled{};
};

/// Gives the model labels where fill patches lie between tablet and envelope (fill_holes() must have run), and its
/// faces to the parts that they say. `density` is the scan on the model's grid, unfiltered. Deterministic for any
/// thread count. Errors of `density` and of lay_labelled_contact(), kCancelled. About 5 us a point of the band.
Result<ContactReport> trace_contact(SurfaceModel& model, SlabSource& density, const ContactOptions& options,
                                    Progress& progress);

/// The same where the scan is not asked: the contact is where the patches are, and all of it is inferred. A quarter
/// of the time; the peak of the whole run is 40 to 65 % lower.
Result<ContactReport> follow_patches(SurfaceModel& model, Progress& progress);

}  // namespace dubsar
