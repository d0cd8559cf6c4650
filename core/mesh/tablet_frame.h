#pragma once
// Which way a tablet lies in a scan, from its own writing: where its broad sides are, which of them is the obverse, and
// which way is up.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// Below it the way up or the obverse is asked for.
inline constexpr double kSureOfTheWay = 0.9;

/// The tablet's directions in the mesh's mm frame: unit, right-handed (right x up = front). `front` points out of the
/// obverse, `right` along its lines, `up` to its first line. The scribe turns the tablet about `right`: from the
/// obverse over the lower edge to the reverse, whose text is upright then.
struct TabletFrame {
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, front{0, 0, 1};
  /// Of the lines running to `right`, with the writing as it should be; a quarter where nothing is written.
  double up_probability = 0.25;
  /// Of `front` being the obverse, if the lines run to `right`: else obverse and reverse are exchanged, each upright. A
  /// half where nothing tells them apart.
  double obverse_probability = 0.5;
  /// Of the surface being a mirror image, in which wedges run to the left.
  double mirrored_probability = 0.0;

  bool sure() const { return up_probability >= kSureOfTheWay && obverse_probability >= kSureOfTheWay; }
  /// What is to be looked at, in at most 56 letters; empty: sure().
  std::string doubt() const;
  /// Rows right, up, front: a point in mm to the tablet's own axes.
  glm::dmat3 tablet_from_model() const;
};

/// The axes are those of the body (writing/body_axes.h), the way up is that of the wedges (writing/impressions.h,
/// writing/script.h) on the six sides, for the two obverses and four ways up that a box has and for their mirror
/// images: obverse and lower edge, reverse and upper edge are written while the tablet is turned about `right`, lines
/// run on over the right edge, and the left edge is read downwards, each of these by a share of tablets. The size of
/// the wedges is not known: four, an octave apart, are averaged over. The obverse is also the flatter broad side, and
/// the one without room left below its text. Of a mesh with parts the
/// tablet is looked at, of others all of it; inferred triangles take no part.
///
/// The surface is sampled by area in the frame of the body, in steps of its size: the unit, the attitude and the
/// triangles do not matter. Without writing the broad side and the way up are arbitrary but always the same.
/// Deterministic. kBadData: no triangles, no area. Cost: about a second, and .3 s a million triangles.
Result<TabletFrame> find_tablet_frame(const TriMesh& mesh);

enum class FrameTurn { kNone, kHalf, kLeft, kRight, kOver };

/// What is left to people: half a turn in the picture, a quarter to the left or right, or over to the other side (about
/// the horizontal axis, so that the obverse becomes the reverse). Probabilities stay.
TabletFrame turned(const TabletFrame& frame, FrameTurn turn);

/// The mesh in the tablet's own axes: mm, x right, y up, z out of the obverse.
TriMesh in_tablet_frame(TriMesh mesh, const TabletFrame& frame);

}  // namespace dubsar
