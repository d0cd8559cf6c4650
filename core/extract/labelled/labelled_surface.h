#pragma once
// What a surface of parts is made of, beside the samples of clay and air: whose clay each point is, and where the two
// clays touch along the grid. Mesh and triangles follow from it.
//
// What determines what, so that writer and reader agree:
//  1. Connectivity (LabelledMesh: vertices and their order, x-quads, doubled corners, mixed cells) follows from the
//  signs,
//     the face decisions of clay and air (SurfaceSamples::joined) and `envelope` alone, by the table
//     (labelled_cell_table.h); no geometry. Of `envelope` only the clay of mixed cells matters: any other clay may have
//     either bit as long as no cell comes to hold both.
//  2. Places: those of build_labelled_mesh(), means of crossings (SurfaceSamples::offsets, `contact`), to the last bit;
//  but
//     for vertices that escape, whose place is given. All lie inside their cells.
//  3. Triangles: triangulate() of the mesh with these places (QuadMesh::embedded), as of any surface without labels.
//  Which
//     diagonals the envelope allows, fans, points on edges and on faces follow from places rounded to 2^-10 step, in
//     integers; where both diagonals are allowed normals choose, of x-quads between clay and air; the contact's take
//     none. Nothing is taken back and nothing of it is stored.
// So a file needs `envelope` where cells are mixed, `contact` and `evidence`, and the places that escape, as it has
// those of surfaces without labels.

#include <cstdint>
#include <vector>

#include "core/extract/labelled/envelope_bits.h"

namespace dubsar {

struct LabelledSurface {
  EnvelopeBits envelope;               ///< compact()
  std::vector<std::uint16_t> contact;  ///< of each edge of ContactEdges, in its order; as SurfaceSamples::offsets
  /// Of the vertices of LabelledMesh that have no x-quad at the air, in their order: evidence_byte() (evidence.h).
  std::vector<std::uint8_t> evidence;
  friend bool operator==(const LabelledSurface&, const LabelledSurface&) = default;
};

}  // namespace dubsar
