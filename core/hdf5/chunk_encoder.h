#pragma once
// Chunks as HDF5's own shuffle and deflate write them, made by any thread: the library filters one chunk at a time, and
// under its lock.

#include <cstddef>
#include <span>
#include <vector>

namespace dubsar {

struct ChunkCoding {
  std::size_t element_bytes = 4;  ///< of a number, for shuffle
  bool shuffle = false;           ///< filter 2, before deflate
  int deflate = 1;                ///< filter 1: 1 (quick) .. 9
};

/// The bytes that are stored for one chunk of numbers. The same bytes for the same numbers.
std::vector<std::byte> encode_chunk(std::span<const std::byte> numbers, const ChunkCoding& coding);

}  // namespace dubsar
