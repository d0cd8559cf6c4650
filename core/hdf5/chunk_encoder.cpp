#include "core/hdf5/chunk_encoder.h"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/result.h"

namespace dubsar {
namespace {

using Compressor = std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)>;

libdeflate_compressor* compressor_of_thread(int level) {
  thread_local std::pair<int, Compressor> kept{0, Compressor(nullptr, libdeflate_free_compressor)};
  if (kept.first != level) kept = {level, Compressor(libdeflate_alloc_compressor(level), libdeflate_free_compressor)};
  DUBSAR_CHECK(kept.second != nullptr);
  return kept.second.get();
}

/// Numbers to byte planes; bytes behind the last whole number stay as they are.
void shuffle(std::span<const std::byte> from, std::size_t element, std::byte* to) {
  const std::size_t count = from.size() / element;
  for (std::size_t byte = 0; byte < element; ++byte)
    for (std::size_t i = 0; i < count; ++i) to[byte * count + i] = from[i * element + byte];
  std::copy(from.begin() + static_cast<std::ptrdiff_t>(count * element), from.end(), to + count * element);
}

}  // namespace

std::vector<std::byte> encode_chunk(std::span<const std::byte> numbers, const ChunkCoding& coding) {
  DUBSAR_CHECK(coding.deflate >= 1 && coding.deflate <= 9 && coding.element_bytes > 0);
  thread_local std::vector<std::byte> planes;
  std::span<const std::byte> plain = numbers;
  if (coding.shuffle && coding.element_bytes > 1) {
    planes.resize(numbers.size());
    shuffle(numbers, coding.element_bytes, planes.data());
    plain = planes;
  }
  libdeflate_compressor* const compressor = compressor_of_thread(coding.deflate);
  std::vector<std::byte> out(libdeflate_zlib_compress_bound(compressor, plain.size()));
  const std::size_t size = libdeflate_zlib_compress(compressor, plain.data(), plain.size(), out.data(), out.size());
  DUBSAR_CHECK(size > 0);  // the bound is enough for any bytes
  out.resize(size);
  return out;
}

}  // namespace dubsar
