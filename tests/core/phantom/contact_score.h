#pragma once
// How much of the contact between tablet and envelope a tablet shows, and how much of it is invention.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "tests/core/phantom/truth_compare.h"

namespace dubsar::phantom {

struct CaseScore {
  int wedges = 0, kept = 0, shown = 0;  ///< depth within 20 %; at least half of the depth
  double kept_fraction() const { return wedges ? static_cast<double>(kept) / wedges : 0.0; }
  double shown_fraction() const { return wedges ? static_cast<double>(shown) / wedges : 0.0; }
};

/// A dent of the contact that is said to be known and that nobody wrote.
struct FalseWedge {
  glm::dvec3 place{0.0};  ///< middle, input voxels
  double deepest = 0.0;   ///< below the true surface, voxels
  int vertices = 0;
  int of_pockets = 0, of_pores = 0;  ///< of those, on walls of pockets of air; where the truth has a pore
};

struct ContactScore {
  std::array<CaseScore, std::size(kWedgeCases)> cases;  ///< of the tablet's wedges, by WedgeCase
  std::int64_t contact_vertices = 0;                    ///< of the tablet where it touches the envelope
  std::int64_t near_truth = 0;                          ///< of those within one input voxel of the true interface
  std::array<std::int64_t, 4> evidence{};               ///< of those, by Evidence
  std::vector<FalseWedge> invented;  ///< at least 6 vertices in a cube of 8 voxels, 2.5 voxels below the true surface
  int false_wedges() const { return static_cast<int>(invented.size()); }
  double near_fraction() const {
    return contact_vertices ? static_cast<double>(near_truth) / static_cast<double>(contact_vertices) : 0.0;
  }
};

/// `tablet` is the whole tablet with its patches, in input voxels; `evidence` of its vertices. Free wedges count where
/// the gap is at least 1.5 processed voxels.
ContactScore judge_contact(const Phantom& phantom, const JudgedMesh& tablet, std::span<const std::uint8_t> evidence);

}  // namespace dubsar::phantom
