#include "core/exa/chunks.h"

#include <array>
#include <atomic>
#include <cstring>

#include "core/base/numbers/bytes.h"
#include "core/base/system/budget.h"
#include "core/base/system/parallel.h"
#include "core/exa/coding/crc_fold.h"

namespace dubsar {
namespace {
using Tables = std::array<std::array<std::uint32_t, 256>, 16>;
constexpr Tables kTables = [] {
  Tables tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = c & 1 ? 0xEDB88320u ^ c >> 1 : c >> 1;
    tables[0][i] = c;
  }
  for (std::size_t t = 1; t < 16; ++t)
    for (std::size_t i = 0; i < 256; ++i) tables[t][i] = tables[t - 1][i] >> 8 ^ tables[0][tables[t - 1][i] & 255];
  return tables;
}();

/// The register after `bytes`.
std::uint32_t table_crc(std::string_view bytes, std::uint32_t crc) noexcept {
  std::size_t at = 0;
  for (; at + 16 <= bytes.size(); at += 16) {
    std::array<std::uint64_t, 2> words;
    std::memcpy(words.data(), bytes.data() + at, sizeof words);
    words[0] ^= crc;
    std::uint32_t first = 0, second = 0;
#pragma GCC unroll 8
    for (std::size_t b = 0; b < 8; ++b) {
      first ^= kTables[15 - b][words[0] >> (8 * b) & 255];
      second ^= kTables[7 - b][words[1] >> (8 * b) & 255];
    }
    crc = first ^ second;
  }
  for (; at < bytes.size(); ++at) crc = crc >> 8 ^ kTables[0][(crc ^ static_cast<unsigned char>(bytes[at])) & 255];
  return crc;
}
}  // namespace

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before) noexcept {
  constexpr std::size_t kFoldStep = 64, kLeastFolded = 256;
  const std::size_t head = bytes.size() < kLeastFolded ? 0 : bytes.size() / kFoldStep * kFoldStep;
  FoldedCrc folded;
  if (head == 0 || !fold_crc(reinterpret_cast<const std::uint8_t*>(bytes.data()), head, ~before, folded))
    return ~table_crc(bytes, ~before);
  const std::string_view rest(reinterpret_cast<const char*>(folded.bytes), sizeof folded.bytes);
  return ~table_crc(bytes.substr(head), table_crc(rest, 0));
}

std::string join_chunks(std::span<const std::string> chunks) {
  std::string index;
  for (const std::string& chunk : chunks) {
    std::size_t length = chunk.size();
    for (; length >= 128; length >>= 7) index.push_back(static_cast<char>((length & 127) | 128));
    index.push_back(static_cast<char>(length));
  }
  for (const std::string& chunk : chunks)
    if (!chunk.empty()) append_little(index, crc32_of(chunk));
  std::string block;
  append_little(block, crc32_of(index));
  block += index;
  for (const std::string& chunk : chunks) block += chunk;
  return block;
}

Result<ChunkIndex> ChunkIndex::parse(std::string_view head, std::uint64_t block_bytes, std::uint64_t count,
                                     std::string_view name) {
  const auto damaged = [&](std::string_view what) {
    return fail(ErrorKind::kBadData, "exa: the index of block \"{}\" {}: the file is damaged", name, what);
  };
  DUBSAR_TRY(check_count("exa: chunks", count, 1, head.size()));
  ByteReader reader(head);
  const auto sum = reader.little<std::uint32_t>();
  ChunkIndex index;
  index.name_ = name;
  index.offsets_.assign(count + 1, 0);
  index.sums_.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t length = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = reader.little<std::uint8_t>();
      length |= std::uint64_t{byte & 127u} << shift;
      if (byte < 128) break;
      if (shift == 63) return damaged("is broken");
    }
    if (length > block_bytes || index.offsets_[i] + length > block_bytes) return damaged("is broken");
    index.offsets_[i + 1] = index.offsets_[i] + length;
  }
  for (std::size_t i = 0; i < count; ++i)
    if (index.length(i) > 0) index.sums_[i] = reader.little<std::uint32_t>();
  if (!reader.ok()) return damaged("is cut off");
  const std::uint64_t bytes = reader.position();
  if (crc32_of(head.substr(4, bytes - 4)) != sum) return damaged("has a wrong sum");
  for (std::uint64_t& offset : index.offsets_) offset += bytes;
  if (index.offsets_.back() != block_bytes) return damaged("does not fit its length");
  return index;
}

Result<void> ChunkIndex::check(std::size_t i, std::string_view chunk) const {
  if (chunk.size() == length(i) && (chunk.empty() || crc32_of(chunk) == sums_[i])) return {};
  return fail(ErrorKind::kBadData, "exa: the sum of chunk {} of block \"{}\" is wrong: the file is damaged", i, name_);
}

Result<std::vector<std::string_view>> split_chunks(std::string_view block, std::uint64_t count, std::string_view name) {
  DUBSAR_ASSIGN(const ChunkIndex index, ChunkIndex::parse(block, block.size(), count, name));
  std::vector<std::string_view> chunks(index.size());
  std::atomic<std::int64_t> broken{-1};
  parallel_for(static_cast<std::int64_t>(chunks.size()), 64, [&](std::int64_t i) {
    const auto c = static_cast<std::size_t>(i);
    chunks[c] = block.substr(index.offset(c), index.length(c));
    if (!index.check(c, chunks[c])) broken = i;
  });
  if (broken >= 0) {
    const auto c = static_cast<std::size_t>(broken.load());
    DUBSAR_TRY(index.check(c, chunks[c]));
  }
  return chunks;
}

}  // namespace dubsar
