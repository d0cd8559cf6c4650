#include "core/extract/piece_lanes.h"

#include <algorithm>

namespace dubsar {
namespace {

PieceLanes lanes_of(const CellPiece& piece) {
  PieceLanes lanes;
  const auto edges = std::span(piece.edges).first(piece.count);
  if (edges.size() > lanes.stream.size() || std::ranges::any_of(edges, &PieceEdge::is_second)) return lanes;
  lanes.count = piece.count;
  std::copy_n(piece.high.begin(), 3, lanes.high_side.begin());
  for (std::size_t n = 0; n < lanes.stream.size(); ++n) {
    const PieceEdge& edge = edges[n < edges.size() ? n : 0];
    const std::uint8_t low = kLowInStream[edge.edge];
    lanes.stream[n] = kStreamOfEdge[edge.edge];
    lanes.place[n] = static_cast<std::int8_t>(edge.corner - 4 * low);
    if (n >= edges.size()) continue;
    lanes.crossings[lanes.stream[n]] |= low ? 0xFFFFu : 0xFFFF0000u;
    ++lanes.on_axis[edge.axis];
  }
  return lanes;
}

PieceTable make_table() {
  const CellTable& cells = CellTable::instance();
  PieceTable table;
  for (std::size_t id = 0; id < table.configs.size(); ++id) {
    const CellConfig& config = cells.config(static_cast<int>(id));
    ConfigLanes& lanes = table.configs[id];
    lanes.first_piece = static_cast<std::uint16_t>(table.pieces.size());
    lanes.vertices = config.vertices;
    lanes.incidences = config.incidences;
    for (std::size_t e = 0; e < 12; ++e)
      if ((config.active_edges >> e & 1u) && !kLowInStream[e]) lanes.steps[kStreamOfEdge[e]] = 1;
    for (unsigned p = 0; p < config.vertices; ++p) table.pieces.push_back(lanes_of(config.pieces[p]));
  }
  for (std::size_t bits = 1; bits < table.inverse.size(); ++bits)
    for (std::size_t n = 1; n <= 12; ++n) table.inverse[bits][n] = 1.0 / (static_cast<double>(n) * (2 << bits));
  return table;
}

}  // namespace

const PieceTable& PieceTable::instance() {
  static const PieceTable table = make_table();
  return table;
}

}  // namespace dubsar
