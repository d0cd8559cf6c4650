#pragma once
// The EXA container: a fixed head, a table of blocks, the blocks one after the other, an end marker. Every byte is
// either checked against its only legal value or covered by a checksum.
//
//   magic      8  89 45 58 41 0D 0A 1A 0A ("EXA"; shows damage by text-mode transfers)
//   major      2  readers refuse a major version that they do not know
//   minor      2  readers skip blocks that they do not know
//   blocks     4
//   file bytes 8
//   table     32 per block: type 4, codec 2, flags 2 (bit 0: a reader that does not know the block must refuse),
//                offset 8, length 8, XXH3-64 of the block 8
//   checksum   8  XXH3-64 of all of the above
//   blocks        without gaps
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
inline constexpr std::uint16_t kExaMajor = 1, kExaMinor = 0;
inline constexpr std::size_t kExaPreludeBytes = 24, kExaRowBytes = 32, kExaMaxBlocks = 256;
inline constexpr std::uint16_t kExaRequired = 1;

struct ExaBlock {
  std::string type;  ///< four characters
  std::uint16_t codec = 0, flags = 0;
  std::string bytes;
};

struct ExaRow {
  std::string type;
  std::uint16_t codec = 0, flags = 0;
  std::uint64_t offset = 0, length = 0, checksum = 0;
};

struct ExaTable {
  std::uint16_t major = 0, minor = 0;
  std::uint64_t file_bytes = 0;
  std::vector<ExaRow> rows;
  /// The first row of this type, or nullptr.
  const ExaRow* find(std::string_view type) const noexcept;
};

/// XXH3-64, any thread.
std::uint64_t exa_checksum(std::string_view bytes) noexcept;

/// Head, table and its checksum for these blocks.
std::string exa_head(std::span<const ExaBlock> blocks, std::uint16_t major = kExaMajor,
                     std::uint16_t minor = kExaMinor);

/// Bytes of the head of a file that starts with `prelude` (kExaPreludeBytes of it). kBadData: not an EXA file, a later
/// major version, too many blocks, a file of another size (truncated, appended to).
Result<std::uint64_t> exa_head_bytes(std::string_view prelude, std::uint64_t file_bytes);

/// Parses a whole head. kBadData when any field is not what a writer can have written.
Result<ExaTable> parse_exa_head(std::string_view head, std::uint64_t file_bytes);

/// The bytes of a block of a whole file in memory. kBadData when the checksum differs.
Result<std::string_view> exa_block(std::string_view file, const ExaRow& row);

}  // namespace dubsar
