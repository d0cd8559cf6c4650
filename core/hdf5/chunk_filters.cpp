#include "core/hdf5/chunk_filters.h"

#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace dubsar {
namespace {

constexpr int kDeflate = 1, kShuffle = 2, kFletcher32 = 3, kLzf = 32000;

std::optional<std::size_t> inflate(std::span<const std::byte> from, std::span<std::byte> to) {
  thread_local const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  std::size_t written = 0;
  if (inflater == nullptr || libdeflate_zlib_decompress(inflater.get(), from.data(), from.size(), to.data(), to.size(),
                                                        &written) != LIBDEFLATE_SUCCESS)
    return std::nullopt;
  return written;
}

// Byte planes back to numbers; bytes behind the last whole number were left alone.
template <std::size_t kElement>
void unshuffle(const std::byte* from, std::size_t count, std::byte* to) {
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t byte = 0; byte < kElement; ++byte) to[i * kElement + byte] = from[byte * count + i];
}

void unshuffle(std::span<const std::byte> from, std::size_t element, std::byte* to) {
  const std::size_t count = from.size() / element;
  if (element == 2)
    unshuffle<2>(from.data(), count, to);
  else if (element == 4)
    unshuffle<4>(from.data(), count, to);
  else if (element == 8)
    unshuffle<8>(from.data(), count, to);
  else
    std::memcpy(to, from.data(), count * element);
  std::copy(from.begin() + static_cast<std::ptrdiff_t>(count * element), from.end(), to + count * element);
}

}  // namespace

bool can_undo_filter(int id) noexcept { return id == kDeflate || id == kShuffle || id == kFletcher32 || id == kLzf; }

std::optional<std::size_t> lzf_decode(std::span<const std::byte> from, std::span<std::byte> to) noexcept {
  std::size_t in = 0, out = 0;
  while (in < from.size()) {
    const auto control = static_cast<std::size_t>(from[in++]);
    if (control < 32) {  // control + 1 bytes as they are
      const std::size_t length = control + 1;
      if (length > from.size() - in || length > to.size() - out) return std::nullopt;
      std::memcpy(to.data() + out, from.data() + in, length);
      in += length;
      out += length;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    if (length == 9) {
      if (in == from.size()) return std::nullopt;
      length += static_cast<std::size_t>(from[in++]);
    }
    if (in == from.size()) return std::nullopt;
    const std::size_t back = ((control & 31) << 8) + static_cast<std::size_t>(from[in++]) + 1;
    if (back > out || length > to.size() - out) return std::nullopt;
    for (std::size_t i = 0; i < length; ++i, ++out) to[out] = to[out - back];  // the two may overlap
  }
  return out;
}

std::uint32_t hdf5_fletcher32(std::span<const std::byte> bytes) noexcept {
  std::uint32_t sum1 = 0, sum2 = 0;
  const auto fold = [](std::uint32_t sum) { return (sum & 0xffffU) + (sum >> 16); };
  std::size_t at = 0;
  while (at + 1 < bytes.size()) {
    const std::size_t stop = std::min(bytes.size() - 1, at + 720);  // 360 words cannot overflow 32 bits
    for (; at < stop; at += 2) {
      sum1 += static_cast<std::uint32_t>(bytes[at]) << 8 | static_cast<std::uint32_t>(bytes[at + 1]);
      sum2 += sum1;
    }
    sum1 = fold(sum1);
    sum2 = fold(sum2);
  }
  if (bytes.size() % 2 != 0) {
    sum1 += static_cast<std::uint32_t>(bytes.back()) << 8;
    sum2 += sum1;
    sum1 = fold(sum1);
    sum2 = fold(sum2);
  }
  return fold(sum2) << 16 | fold(sum1);
}

std::optional<std::span<const std::byte>> undo_filters(std::span<const int> ids, std::uint32_t skipped,
                                                       std::size_t element_bytes, std::size_t chunk_bytes,
                                                       ChunkScratch& scratch) {
  std::span<const std::byte> bytes = scratch.packed;
  std::vector<std::byte>*next = &scratch.a, *other = &scratch.b;
  for (std::size_t i = ids.size(); i-- > 0;) {
    if (i < 32 && (skipped >> i & 1U) != 0) continue;
    if (ids[i] == kFletcher32) {
      if (bytes.size() < 4) return std::nullopt;
      const auto stored = bytes.last(4);
      bytes = bytes.first(bytes.size() - 4);
      std::uint32_t sum = 0;  // little endian
      for (std::size_t k = 4; k-- > 0;) sum = sum << 8 | static_cast<std::uint32_t>(stored[k]);
      if (sum != hdf5_fletcher32(bytes)) return std::nullopt;
      continue;
    }
    if (ids[i] == kShuffle) {
      next->resize(bytes.size());
      unshuffle(bytes, element_bytes, next->data());
    } else {
      next->resize(chunk_bytes + 4);  // a checksum may lie inside
      const auto size = ids[i] == kDeflate ? inflate(bytes, *next) : lzf_decode(bytes, *next);
      if (!size) return std::nullopt;
      next->resize(*size);
    }
    bytes = *next;
    std::swap(next, other);
  }
  if (bytes.size() != chunk_bytes) return std::nullopt;
  return bytes;
}

}  // namespace dubsar
