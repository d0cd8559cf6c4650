#pragma once
// From sides of the clay near the contact to labels of all grid points.

#include <vector>

#include "core/contact/band.h"
#include "core/extract/labelled/envelope_bits.h"

namespace dubsar {

/// Clay beyond the band, as runs along x, and which of it hangs together. Borrows both. Cost: a pass over the bits and
/// 20 ns a node; 12 bytes a run.
class ClayBeyond {
 public:
  /// The nodes are in the order of ContactBand.
  ClayBeyond(const BitVolume& inside, const ContactBand& band);

  /// Clay of the band has its side; clay that hangs together beyond it that of most of the band beside it, and the
  /// tablet's where it touches none: nobody asks. Islands of few nodes in clay of the other get its label. Cost: 30 ns
  /// a node.
  EnvelopeBits labels(const std::vector<ClaySide>& side) const;
  /// Is a point of clay in the band, or does it hang together with some beside it?
  bool touches(const glm::ivec3& p) const;

  struct Run {
    std::int32_t begin, end;
    std::uint32_t piece;  ///< the first run of those that hang together
  };

 private:
  struct Beside {
    std::uint32_t node, piece;
  };
  void find_runs();
  void find_pieces();
  std::size_t row(std::int64_t y, std::int64_t z) const { return static_cast<std::size_t>(z * inside_.dims().y + y); }
  std::uint32_t run_at(const glm::ivec3& p) const;

  const BitVolume& inside_;
  const ContactBand& band_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> first_;  ///< of each row, and behind the last
  std::vector<Beside> beside_;        ///< nodes, and pieces that they touch
  std::vector<bool> touched_;         ///< pieces
};

}  // namespace dubsar
