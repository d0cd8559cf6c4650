#pragma once
// How good are found wedges? Beside those that were pressed into a phantom. Shares no constant with the finder.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/phantom/phantom.h"
#include "core/script/wedge.h"

namespace dubsar {

struct WedgeJudging {
  phantom::Owner owner = phantom::Owner::kTablet;
  double grid_step = 1.0;        ///< voxels of the scan in one of the surface's grid
  double least_depth_vox = 0.0;  ///< shallower ones need not be found
};

/// A wedge that was found, beside what was pressed.
struct JudgedWedge {
  int truth = -1;           ///< the wedge of the phantom whose head and direction it has; -1: none
  int near = -1;            ///< of the phantom's wedges, that with the nearest head, whatever its direction
  double head_off = 1e9;    ///< of `near`, in half widths of it
  double turned_deg = 0.0;  ///< of `near`
};

/// Numbers of wedges by phantom::StrokeKind and phantom::Side.
struct WedgeCounts {
  std::vector<int> wanted_of_kind, found_of_kind, wanted_of_side, found_of_side;
};

/// Pairs of wedges that overlap and were both found.
struct PairCounts {
  int pairs = 0, pairs_told = 0, pairs_right = 0;  ///< of those, whose order of pressing is told, and rightly
  std::vector<std::array<double, 2>> pair_clear;   ///< of pairs_told: how clear, and 1 if right
};

struct WedgeScore : WedgeCounts, PairCounts {
  int wanted = 0, found = 0;  ///< with air and deep enough; of those, found
  int drawn = 0, real = 0;    ///< found wedges; of those, with the head and direction of any wedge of the phantom
  int placed = 0;             ///< of those drawn, with the head of one whatever its direction
  int kind_right = 0;         ///< of `found`
  int line_right = 0;  ///< of `found`: in the line that was found for its own; each line that was found is one of
                       ///< those pressed, no two the same
  std::vector<double> depth_ratios, direction_deg, head_off_vox;  ///< of `found`: measured over true, and errors
  /// Of `found`: measured over what the stylus left, head to end and between the corners.
  std::vector<double> length_ratios, width_ratios;
  double corner_squares = 0.0;  ///< of `found`: mean square of how far the corners of the head are off, voxels, summed
  std::vector<JudgedWedge> judged;  ///< one for each found wedge
  std::vector<int> missed;          ///< wedges of the phantom that were wanted and not found
  double recall() const { return wanted ? static_cast<double>(found) / wanted : 0.0; }
  double precision() const { return drawn ? static_cast<double>(real) / drawn : 1.0; }
  double kind_share() const { return found ? static_cast<double>(kind_right) / found : 0.0; }
  /// Adds the figures of another tablet.
  void add(const WedgeScore& other);
  std::string text() const;
};

/// A wedge is found when a drawn one has its head within half a width of its own and its direction within 15 degrees;
/// each counts once, nearest first. Wedges of the phantom that the envelope filled, or that lie under a gap narrower
/// than 1.5 voxels of the surface's grid, need not be found, but whoever finds them is right.
WedgeScore judge_wedges(const phantom::Phantom& truth, std::span<const ScriptWedge> found, const WedgeJudging& how);

}  // namespace dubsar
