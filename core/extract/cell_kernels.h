#pragma once
// Bit-plane work on one row of cells: counting and writing of dual vertices and of their corners in the x-quads.

#include <array>
#include <cstdint>

#include "core/extract/cell_table.h"
#include "core/extract/edge_index.h"
#include "core/extract/quad_mesh.h"
#include "core/extract/surface_samples.h"

namespace dubsar {

/// A row of cells of the grid extended by the virtual layer: cell i lies between the points i - 1 and i, i = 0 .. nx,
/// y = j - 1 and j, z = k - 1 and k.
struct CellRow {
  std::int64_t j = 0, k = 0;
};

struct CellRowCounts {
  std::uint32_t vertices = 0;
  std::uint32_t incidences = 0;
};

/// Where the row writes. Every element of every array is written by exactly one cell, in any order.
struct CellRowOutput {
  QuadMesh* mesh = nullptr;
  std::uint32_t first_vertex = 0;
  std::uint32_t first_incidence = 0;
  std::vector<DoubledCorner>* doubled = nullptr;  ///< appended to, unsorted
  std::vector<std::uint8_t>* in_layer = nullptr;  ///< per vertex, 1: of a cell that touches the layer; may be null
};

CellRowCounts count_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row);
void write_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row,
                 const CellRowOutput& output);

}  // namespace dubsar
