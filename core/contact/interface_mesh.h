#pragma once
// The surface between the two clays as part of the dual mesh: one polygon for each grid edge from a tablet point to an
// envelope point, with vertices in the cells around it. Where such a cell also has a vertex of the surface of the air,
// that one is used, so that tablet, envelope and contact meet along its edges, and each of the two is closed.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/contact/band.h"
#include "core/contact/dips.h"
#include "core/extract/edge_index.h"
#include "core/parts/surface_model.h"

namespace dubsar {

struct InterfaceMesh {
  std::vector<Triangle> triangles;  ///< out of the tablet; id < vertex_count(): dual vertex, else added[id - count]
  std::vector<glm::vec3> added;     ///< where the density dips, half-way along the edges where nothing is known
  std::vector<float> strength;      ///< of the dip, of each added vertex
  /// Triangle t of each quadrilateral: it was divided into (a, b, c) and, in t + 1, (a, c, d). Which of both diagonals
  /// that is says nothing about the contact. Where either triangle was changed since, it is none any more.
  std::vector<std::uint32_t> quads;
  std::int64_t doubled_corners = 0;  ///< cells in which the contact runs from one surface of the air to another
};

/// `side`: of each node of the band.
InterfaceMesh make_interface(const SurfaceModel& model, const EdgeIndex& index, const ContactBand& band,
                             const std::vector<ClaySide>& side, const Dips& dips);

}  // namespace dubsar
