#pragma once
// The signs of a volume as bytes (docs/exa.md, "Signs"). In bricks of 128 cells, which can be read alone or with those
// beside them, and in levels: every eighth point first, then spacing 4, 2 and 1.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/bit_volume.h"

namespace dubsar {

inline constexpr int kBrickCells = 128;

inline std::size_t count_of(const Dims& d) { return static_cast<std::size_t>(d.count()); }
/// Bricks along each axis of a volume; 1 for a volume of one point.
Dims brick_grid(const Dims& dims);
/// The volume of every eighth point, the last slices repeated so that every cell has its corners.
Dims coarse_dims(const Dims& dims);

/// Chunks in file order.
struct SignCode {
  std::vector<std::string> coarse;  ///< raw bits of every 64th point; bricks of every 8th, level by level
  std::array<std::vector<std::string>, 3> bricks;  ///< of spacing 1, 2, 4; one chunk a brick, empty: no surface inside
};

/// The same chunks, borrowed. A level that is not wanted may be empty.
struct SignChunks {
  bool late_bricks = true;  ///< ExaFeature::kLateBricks
  std::vector<std::string_view> coarse;
  std::array<std::vector<std::string_view>, 3> bricks;
  /// 1 for each brick whose chunks are damaged; empty: none. Bricks that know its points are lost with it.
  std::vector<std::uint8_t> lost;
};

/// The bricks that are lost with those: late ones (sign_surroundings.h) beside them, if the file has these.
std::vector<std::uint8_t> lost_with(const Dims& dims, std::vector<std::uint8_t> lost, bool late_bricks);

/// How many chunks a volume has.
std::size_t coarse_chunk_count(const Dims& dims);

/// Lossless. All threads; the same bytes for any number of them. kCancelled.
Result<SignCode> encode_signs(const BitVolume& signs, Progress& progress);

/// A box of grid points, ends included.
struct GridBox {
  std::array<std::int64_t, 3> low{}, high{};
};

/// The bricks that decode_signs() needs for a box, 1 for each: those that touch it, and with late ones those
/// beside them that they know.
std::vector<std::uint8_t> bricks_of_box(const Dims& dims, const GridBox& box, bool late_bricks);

/// `dims` must have passed check_dims. `level` 0..3: only the points of spacing 2^level, whose volume has
/// level_dims(dims, level) points. `box`: only bricks_of_box(), with the points of all their sides; elsewhere
/// the signs are 0. kBadData when the number of chunks is wrong or more than `most_points` signs are coded, which
/// bounds the time that damaged bytes can take; kTryAgain when the volume does not fit in memory. Bytes that are no
/// sign code give other signs. All threads.
Result<BitVolume> decode_signs(const SignChunks& chunks, const Dims& dims, int level, const std::optional<GridBox>& box,
                               std::uint64_t most_points, Progress& progress);

/// No volume with so many active edges has more coded signs.
constexpr std::uint64_t most_coded_signs(std::uint64_t edges) { return 64 * edges + (1 << 16); }

/// Points of spacing 2^level that lie in the volume.
Dims level_dims(const Dims& dims, int level);

}  // namespace dubsar
