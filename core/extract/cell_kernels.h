#pragma once
// Bit-plane work on one row of cells: listing, and writing of dual vertices and of their corners in the x-quads.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

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

/// The cells of rows that have vertices, one after the other.
struct CellList {
  std::vector<std::uint32_t> cell;
  std::vector<std::uint16_t> config;  ///< CellTable::id
};

struct CellRowCounts {
  std::uint32_t cells = 0;  ///< in the list
  std::uint32_t vertices = 0;
  std::uint32_t incidences = 0;
};

/// The part of a list that is one row.
struct ListedRow {
  std::span<const std::uint32_t> cell;
  std::span<const std::uint16_t> config;
};

/// Where the row writes. Every element of every array is written by exactly one cell, in any order.
struct CellRowOutput {
  QuadMesh* mesh = nullptr;
  std::uint32_t first_vertex = 0;
  std::uint32_t first_incidence = 0;
  std::uint32_t end_incidence = 0;                ///< where those of the next row begin
  std::vector<DoubledCorner>* doubled = nullptr;  ///< appended to, unsorted
  std::vector<std::uint8_t>* in_layer =
      nullptr;  ///< per vertex, 0 before; 1: of a cell that touches the layer; may be null
};

/// Appends the cells of the row to the list.
CellRowCounts list_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row, CellList& list);
void write_cells(const SurfaceSamples& samples, const EdgeIndex& index, const CellRow& row, const ListedRow& cells,
                 const CellRowOutput& output);

}  // namespace dubsar
