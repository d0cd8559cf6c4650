#pragma once
// The general entropy stage: arrays of fixed-size items, split into byte planes and compressed by Zstandard in chunks
// of 65,536 items, which are independent of each other (threads, later random access).
//
//   for each chunk: its compressed length, 4 bytes; then the chunks

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace dubsar {

inline constexpr std::int64_t kPackedChunk = 65536;

/// `data` holds whole items of `item_bytes` (1..64) bytes. All threads; the same bytes for any number of them.
Result<std::string> pack_items(std::span<const std::byte> data, std::size_t item_bytes, Progress& progress);

/// Fills `out`, whose size the caller knows from elsewhere. kBadData for anything but exactly that many items.
Result<void> unpack_items(std::string_view bytes, std::size_t item_bytes, std::span<std::byte> out, Progress& progress);

}  // namespace dubsar
