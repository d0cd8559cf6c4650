#pragma once
// The points of a band in bricks of 4x4x4 (lattice_bricks.h), and what can be asked of all points of a brick at once.

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/band.h"
#include "core/contact/cut/lattice_bricks.h"

namespace dubsar {

/// A bit a point, a word a brick; that of brick 0 is 0.
using BrickBits = std::vector<std::uint64_t>;

class BandBricks {
 public:
  using Nodes = std::array<std::uint32_t, LatticeBricks::kPoints>;

  /// Borrows the band, whose nodes are in the order of ContactBand::make(). About 45 bytes a brick of 4x4x4 points.
  explicit BandBricks(const ContactBand& band);

  const LatticeBricks& lattice() const noexcept { return lattice_; }
  /// Bricks over the same piece of the patches follow each other: the first of each piece, and how many there are.
  const std::vector<std::uint32_t>& starts() const noexcept { return starts_; }
  const BrickBits& in_band() const noexcept { return in_band_; }

  /// Nodes of the points of a brick, ContactBand::kNone where there is none.
  Nodes nodes(std::uint32_t brick) const noexcept;
  std::uint32_t point(std::uint32_t node) const noexcept { return lattice_.at(band_.point(node)); }
  /// The nodes that `bits` has, rising.
  std::vector<std::uint32_t> nodes_of(const BrickBits& bits) const;

  /// The points of the tablet.
  BrickBits tablet(const std::vector<ClaySide>& side) const;
  /// Points of `within` that hang together with some of `seeds`, through its points.
  BrickBits reached(const BrickBits& within, const BrickBits& seeds) const;
  /// The points at the low corner of a face of the grid whose points are of tablet and envelope in turn.
  BrickBits pinched(const BrickBits& tablet) const;

 private:
  struct Found {
    glm::ivec3 place;
    std::uint32_t piece;
  };
  static std::vector<Found> find(const ContactBand& band);
  BandBricks(const ContactBand& band, const std::vector<Found>& found);

  const ContactBand& band_;
  LatticeBricks lattice_;
  std::vector<std::uint32_t> starts_;
  BrickBits in_band_;
};

inline bool has_bit(const BrickBits& bits, std::uint32_t point) noexcept {
  return (bits[point / LatticeBricks::kPoints] >> point % LatticeBricks::kPoints & 1) != 0;
}
inline void set_bit(BrickBits& bits, std::uint32_t point, bool value) noexcept {
  const std::uint64_t bit = std::uint64_t{1} << point % LatticeBricks::kPoints;
  std::uint64_t& word = bits[point / LatticeBricks::kPoints];
  word = value ? word | bit : word & ~bit;
}

}  // namespace dubsar
