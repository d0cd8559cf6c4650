#include "core/exa/packed.h"

#include <zstd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/parallel.h"

namespace dubsar {
namespace {
constexpr int kEffort = 5;  // byte planes of noise: higher levels gain less than 1 %

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

std::int64_t chunk_count(std::size_t items) {
  return (static_cast<std::int64_t>(items) + kPackedChunk - 1) / kPackedChunk;
}
}  // namespace

Result<std::string> pack_items(std::span<const std::byte> data, std::size_t item_bytes, Progress& progress) {
  DUBSAR_CHECK(item_bytes >= 1 && item_bytes <= 64 && data.size() % item_bytes == 0);
  const std::size_t items = data.size() / item_bytes;
  std::vector<std::string> chunks(static_cast<std::size_t>(chunk_count(items)));
  parallel_for(static_cast<std::int64_t>(chunks.size()), 1, [&](std::int64_t c) {
    if (progress.cancelled()) return;
    const std::size_t first = static_cast<std::size_t>(c * kPackedChunk);
    const std::size_t count = std::min<std::size_t>(items - first, kPackedChunk);
    std::string planes(count * item_bytes, '\0');
    for (std::size_t p = 0; p < item_bytes; ++p)
      for (std::size_t i = 0; i < count; ++i)
        planes[p * count + i] = static_cast<char>(data[(first + i) * item_bytes + p]);
    const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
    if (!context) throw std::bad_alloc();
    std::string& chunk = chunks[static_cast<std::size_t>(c)];
    chunk.resize(ZSTD_compressBound(planes.size()));
    const std::size_t length =
        ZSTD_compressCCtx(context.get(), chunk.data(), chunk.size(), planes.data(), planes.size(), kEffort);
    DUBSAR_CHECK(!ZSTD_isError(length));
    chunk.resize(length);
  });
  if (progress.cancelled()) return cancelled_error();
  std::string bytes;
  for (const std::string& chunk : chunks) append_little(bytes, static_cast<std::uint32_t>(chunk.size()));
  for (const std::string& chunk : chunks) bytes += chunk;
  return bytes;
}

Result<void> unpack_items(std::string_view bytes, std::size_t item_bytes, std::span<std::byte> out,
                          Progress& progress) {
  DUBSAR_CHECK(item_bytes >= 1 && item_bytes <= 64 && out.size() % item_bytes == 0);
  const std::size_t items = out.size() / item_bytes;
  const auto chunks = static_cast<std::size_t>(chunk_count(items));
  ByteReader reader(bytes);
  std::vector<std::uint64_t> starts(chunks + 1, chunks * 4);
  for (std::size_t c = 0; c < chunks; ++c) starts[c + 1] = starts[c] + reader.little<std::uint32_t>();
  if (!reader.ok() || starts.back() != bytes.size())
    return fail(ErrorKind::kBadData, "exa: packed chunks of {} bytes found, expected {}", bytes.size(), starts.back());
  std::atomic<bool> broken{false};
  parallel_for(static_cast<std::int64_t>(chunks), 1, [&](std::int64_t index) {
    if (progress.cancelled()) return;
    const auto c = static_cast<std::size_t>(index);
    const std::size_t first = c * static_cast<std::size_t>(kPackedChunk);
    const std::size_t count = std::min<std::size_t>(items - first, kPackedChunk);
    std::string planes(count * item_bytes, '\0');
    const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
    if (!context) throw std::bad_alloc();
    const std::string_view chunk = bytes.substr(starts[c], starts[c + 1] - starts[c]);
    const std::size_t length =
        ZSTD_decompressDCtx(context.get(), planes.data(), planes.size(), chunk.data(), chunk.size());
    if (ZSTD_isError(length) || length != planes.size()) {
      broken = true;
      return;
    }
    for (std::size_t p = 0; p < item_bytes; ++p)
      for (std::size_t i = 0; i < count; ++i)
        out[(first + i) * item_bytes + p] = static_cast<std::byte>(planes[p * count + i]);
  });
  if (progress.cancelled()) return cancelled_error();
  if (broken) return fail(ErrorKind::kBadData, "exa: a packed chunk is broken");
  return {};
}

}  // namespace dubsar
