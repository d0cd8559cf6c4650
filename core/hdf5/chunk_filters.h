#pragma once
// Our own inverse of the common HDF5 chunk filters: thread-safe, bounds-checked, no plug-in. Chunks from a file are
// untrusted: every function either fills what it says or reports damage, and never reads or writes outside.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace dubsar {

/// deflate 1, shuffle 2, fletcher32 3, lzf 32000. (The lzf plug-in of Debian 12 cannot even be loaded: it is not linked
/// with liblzf.)
bool can_undo_filter(int id) noexcept;

/// Memory of one thread.
struct ChunkScratch {
  std::vector<std::byte> packed, a, b;
};

/// Undoes the filters `ids` (in the order of writing; those with their bit set in `skipped` were not applied) on the
/// bytes in scratch.packed. Returns the numbers, which lie in scratch; nullopt when the data are damaged or are not
/// exactly `chunk_bytes` long. `element_bytes` is the size of a number, for shuffle.
std::optional<std::span<const std::byte>> undo_filters(std::span<const int> ids, std::uint32_t skipped,
                                                       std::size_t element_bytes, std::size_t chunk_bytes,
                                                       ChunkScratch& scratch);

/// LZF of liblzf. Bytes written; nullopt: damaged, or more than `to` holds.
std::optional<std::size_t> lzf_decode(std::span<const std::byte> from, std::span<std::byte> to) noexcept;

/// Checksum of HDF5's filter 3 (big-endian 16-bit words).
std::uint32_t hdf5_fletcher32(std::span<const std::byte> bytes) noexcept;

}  // namespace dubsar
