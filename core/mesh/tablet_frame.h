#pragma once
// Which way a tablet lies in a scan, from its own writing: where its broad sides are, which of them is the obverse, and
// which way is up.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// The tablet's directions in the mesh's mm frame: unit, right-handed (right x up = front). `front` points out of the
/// obverse, `right` along its lines, `up` to its first line. The scribe turns the tablet about `right`: from the
/// obverse over the lower edge to the reverse, whose text is upright then.
struct TabletFrame {
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, front{0, 0, 1};
  /// 0 (a guess) to 1: how much of the evidence of the writing speaks for this way up and not for the next best; and
  /// how much speaks for this obverse. Below .05 that is in doubt: obverse and reverse may be exchanged, each upright.
  double up_share = 0.0, obverse_share = 0.0;

  /// Rows right, up, front: a point in mm to the tablet's own axes.
  glm::dmat3 tablet_from_model() const;
};

/// The box: axes from the areas of the faces that look along them (eigenvectors of the sum of n n^T by area, without
/// inferred ones, whose normals are noise), the broad sides first, the others turned to where the edges look. The way
/// up: an impression of the stylus is steep at its head and rises slowly along its tail, horizontal wedges have their
/// head at the left, vertical ones at the top; so the third moments of the slopes of each side's relief say which way
/// its lines run. The obverse: it is the flatter broad side; where one of them has room left below its text, that is
/// the reverse; lines run on over the right edge, and the left edge is read downwards. Without writing (shares of 0)
/// the broad side and the way up are arbitrary but always the same. Deterministic. kBadData: no triangles, no area.
/// Cost: about .3 s a million triangles.
Result<TabletFrame> find_tablet_frame(const TriMesh& mesh);

enum class FrameTurn { kNone, kHalf, kLeft, kRight, kOver };

/// What is left to people: half a turn in the picture, a quarter to the left or right, or over to the other side (about
/// the horizontal axis, so that the obverse becomes the reverse).
TabletFrame turned(const TabletFrame& frame, FrameTurn turn);

/// The mesh in the tablet's own axes: mm, x right, y up, z out of the obverse.
TriMesh in_tablet_frame(const TriMesh& mesh, const TabletFrame& frame);

}  // namespace dubsar
