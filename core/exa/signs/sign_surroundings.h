#pragma once
// The bricks beside a brick, as far as they are known when it is coded (docs/exa.md, "Signs"): those at an even sum of
// brick numbers are coded alone, and give their points to those at an odd one, which have them on all six sides.

#include <array>
#include <cstdint>

#include "core/exa/signs/sign_lattice.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

class SignSurroundings {
 public:
  /// `points`: those of spacing 2^level of a volume of `dims` points; must outlive this. `low`: first point of the
  /// brick, `cells`: its finest cells. `padded`: cells of the volume, by which it is seen where it ends.
  SignSurroundings(const BitVolume& points, int level, const Dims& dims, const std::array<std::int64_t, 3>& low,
                   const std::array<int, 3>& cells, const std::array<std::int64_t, 3>& padded);

  /// For SignLattice: the sides on which there is another brick.
  unsigned open() const noexcept { return open_; }
  /// Sets the points of open sides and those behind them, on a lattice of spacing 2^level.
  void fill(SignLattice& lattice, int level) const;
  /// Does a row of the lattice lie in the volume? If not, nothing of it is known.
  bool inside(int y, int z, int level) const noexcept {
    return low_[1] + (std::int64_t{y} << level) < dims_.y && low_[2] + (std::int64_t{z} << level) < dims_.z;
  }
  /// The last point of a row that lies in the volume, or a later one.
  int last_x(int level) const noexcept {
    const std::int64_t last = (dims_.x - 1 - low_[0]) >> level;
    return last > 255 ? 255 : static_cast<int>(last);
  }

 private:
  std::uint64_t bits(const std::uint64_t* row, std::int64_t at) const noexcept;
  const std::uint64_t* row(int y, int z, int level) const noexcept;
  std::array<std::uint64_t, 3> signs(const std::uint64_t* row, int level) const noexcept;
  void fill_row(SignLattice& lattice, int y, int z, int level) const;

  const BitVolume& points_;
  int level_ = 0;
  Dims dims_;
  std::array<std::int64_t, 3> low_{};
  std::array<int, 3> cells_{};
  unsigned open_ = 0;
};

}  // namespace dubsar
