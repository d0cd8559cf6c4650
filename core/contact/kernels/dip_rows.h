#pragma once
// The dips of the nodes of one row of a brick at a time, by vector instructions.

#include <array>
#include <cstdint>
#include <span>

namespace dubsar {

inline constexpr std::size_t kDipArms = 3;
inline constexpr std::int32_t kDipRow = 8;  ///< points of a row
inline constexpr float kNoDip = -1e30f;     ///< strength where no direction had clay on both sides

/// A direction across the contact.
struct DipDirection {
  std::array<float, 3> unit;
  float least_cosine;                       ///< to the normal of nodes that it is meant for
  std::array<std::int32_t, kDipArms> arms;  ///< to the disks on one side, values; on the other side minus that
};

/// Points of a row; those that are no nodes have no normal.
struct DipRow {
  std::int32_t place = 0;                              ///< of the first, in blocks of clay and means
  std::array<std::array<float, kDipRow>, 3> normal{};  ///< by axis
  std::array<float, kDipRow> strength{}, density{};    ///< of the strongest dip so far
};

/// Lists the rows with nodes that `direction` is meant for and that have clay at both ends of its first arm. `clay` is
/// 1 where there is clay, else 0. `found` has room for all rows. Returns how many there are.
std::size_t rows_across(std::span<const DipRow> rows, const DipDirection& direction, const std::int32_t* clay,
                        std::uint32_t* found);

/// Raises the dips of such nodes in `some` of the rows to those of the direction: the mean of `means` at the ends of
/// its arms, which have clay at both ends (the first has), less that at the node. The same on every processor.
void raise_dips(std::span<DipRow> rows, std::span<const std::uint32_t> some, const DipDirection& direction,
                const std::int32_t* clay, const float* means);

}  // namespace dubsar
