#pragma once
// The EXA container: a fixed head, a table of blocks, the blocks one after the other, an end mark. Every byte is either
// checked against its only legal value or covered by a sum (docs/exa.md, "Container").
//
//   magic      8  89 45 58 41 0D 0A 1A 0A ("EXA"; shows damage by text-mode transfers)
//   major      2  6, or 7 where it holds what is new; readers refuse a major version that they do not know; 3 to 5 are
//                 read, too
//   minor      2  0; readers skip blocks that they do not know
//   blocks     4
//   file bytes 8
//   table     28 per block: type 4, codec 2, flags 2 (bit 0: a reader that does not know the block must refuse),
//                offset 8, length 8, chunks 4
//   sum        4  CRC-32 of all of the above
//   blocks        without gaps, each in chunks (chunks.h)
//   end        8  "EXA.END\n"
// All numbers little endian.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

inline constexpr std::string_view kExaMagic(
    "\x89"
    "EXA\r\n\x1a\n",
    8);
inline constexpr std::string_view kExaEnd = "EXA.END\n";
inline constexpr std::uint16_t kExaMajor = 7, kExaOldest = 3, kExaMinor = 0;
/// What a file has that holds nothing of version 7.
inline constexpr std::uint16_t kExaMajorBefore = 6;
inline constexpr std::size_t kExaPreludeBytes = 24, kExaRowBytes = 28, kExaMaxBlocks = 256;
inline constexpr std::uint16_t kExaRequired = 1;

/// What a version of the format brought that readers must ask for.
enum class ExaFeature : std::uint16_t {
  kLateBricks = 5,  ///< bricks of signs that know those beside them
  kLabels = 7,      ///< parts that touch, and far sides of grids that end where a brick does
};

struct ExaBlock {
  std::string type;  ///< four characters
  std::uint16_t codec = 0, flags = 0;
  std::uint32_t chunks = 0;
  std::string bytes;                      ///< join_chunks()
  std::uint16_t needs = kExaMajorBefore;  ///< the oldest version whose readers can use it
};

struct ExaRow {
  std::string type;
  std::uint16_t codec = 0, flags = 0;
  std::uint64_t offset = 0, length = 0;
  std::uint32_t chunks = 0;
};

struct ExaTable {
  std::uint16_t major = 0, minor = 0;
  std::uint64_t file_bytes = 0;
  std::vector<ExaRow> rows;
  bool has(ExaFeature feature) const noexcept { return major >= static_cast<std::uint16_t>(feature); }
  /// The first row of this type, or nullptr.
  const ExaRow* find(std::string_view type) const noexcept;
};

/// Head, table and its sum for these blocks.
std::string exa_head(std::span<const ExaBlock> blocks, std::uint16_t major, std::uint16_t minor = kExaMinor);
/// The version that a reader of these blocks needs: files without anything new stay readable for older programs.
std::uint16_t exa_major_of(std::span<const ExaBlock> blocks);
inline std::string exa_head(std::span<const ExaBlock> blocks) { return exa_head(blocks, exa_major_of(blocks)); }

/// Bytes of the head of a file that starts with `prelude` (kExaPreludeBytes of it). kBadData: not an EXA file, another
/// major version, too many blocks, a file of another size (truncated, appended to).
Result<std::uint64_t> exa_head_bytes(std::string_view prelude, std::uint64_t file_bytes);

/// Parses a whole head. kBadData when any field is not what a writer can have written.
Result<ExaTable> parse_exa_head(std::string_view head, std::uint64_t file_bytes);

}  // namespace dubsar
