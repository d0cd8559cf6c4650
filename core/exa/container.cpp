#include "core/exa/container.h"

#include <algorithm>

#include "core/base/numbers/bytes.h"
#include "core/exa/chunks.h"

namespace dubsar {
namespace {
constexpr std::size_t kSumBytes = 4;

std::uint64_t head_bytes(std::uint64_t blocks) { return kExaPreludeBytes + blocks * kExaRowBytes + kSumBytes; }

/// For error texts: a damaged type may hold anything.
std::string shown(std::string_view type) {
  std::string text(type);
  for (char& c : text)
    if (c < 32 || c > 126) c = '?';
  return text;
}
}  // namespace

const ExaRow* ExaTable::find(std::string_view type) const noexcept {
  for (const ExaRow& row : rows)
    if (row.type == type) return &row;
  return nullptr;
}

std::uint16_t exa_major_of(std::span<const ExaBlock> blocks) {
  std::uint16_t major = kExaMajorBefore;
  for (const ExaBlock& block : blocks) major = std::max(major, block.needs);
  return major;
}

std::string exa_head(std::span<const ExaBlock> blocks, std::uint16_t major, std::uint16_t minor) {
  DUBSAR_CHECK(blocks.size() <= kExaMaxBlocks);
  std::uint64_t offset = head_bytes(blocks.size()), total = offset + kExaEnd.size();
  for (const ExaBlock& block : blocks) total += block.bytes.size();
  std::string head(kExaMagic);
  append_little(head, major);
  append_little(head, minor);
  append_little(head, static_cast<std::uint32_t>(blocks.size()));
  append_little(head, total);
  for (const ExaBlock& block : blocks) {
    DUBSAR_CHECK(block.type.size() == 4);
    head += block.type;
    append_little(head, block.codec);
    append_little(head, block.flags);
    append_little(head, offset);
    append_little(head, static_cast<std::uint64_t>(block.bytes.size()));
    append_little(head, block.chunks);
    offset += block.bytes.size();
  }
  append_little(head, crc32_of(head));
  return head;
}

Result<std::uint64_t> exa_head_bytes(std::string_view prelude, std::uint64_t file_bytes) {
  if (file_bytes == 0) return fail(ErrorKind::kBadData, "exa: the file is empty, expected a file that dubsar wrote");
  if (!prelude.starts_with(kExaMagic))
    return fail(ErrorKind::kBadData,
                "exa: the file does not start with the EXA mark, expected a file that dubsar wrote");
  ByteReader reader(prelude.substr(kExaMagic.size()));
  const auto major = reader.little<std::uint16_t>();
  reader.little<std::uint16_t>();
  const auto blocks = reader.little<std::uint32_t>();
  const auto announced = reader.little<std::uint64_t>();
  if (!reader.ok())
    return fail(ErrorKind::kBadData, "exa: {} bytes found, the head alone needs {}", prelude.size(), kExaPreludeBytes);
  if (major < kExaOldest)
    return fail(ErrorKind::kBadData,
                "exa: format version {} found, expected {} to {}; that format was never kept: process the scan "
                "again",
                major, kExaOldest, kExaMajor);
  if (major > kExaMajor)
    return fail(ErrorKind::kBadData, "exa: format version {} found, expected {} to {}; it needs a later dubsar", major,
                kExaOldest, kExaMajor);
  if (blocks > kExaMaxBlocks)
    return fail(ErrorKind::kBadData, "exa: {} blocks announced, expected at most {}", blocks, kExaMaxBlocks);
  if (announced != file_bytes)
    return fail(ErrorKind::kBadData, "exa: {} bytes found, {} expected: the file is {}", file_bytes, announced,
                file_bytes < announced ? "truncated" : "damaged");
  if (head_bytes(blocks) + kExaEnd.size() > file_bytes)
    return fail(ErrorKind::kBadData, "exa: {} blocks announced in a file of {} bytes", blocks, file_bytes);
  return head_bytes(blocks);
}

Result<ExaTable> parse_exa_head(std::string_view head, std::uint64_t file_bytes) {
  DUBSAR_ASSIGN(const std::uint64_t expected, exa_head_bytes(head.substr(0, kExaPreludeBytes), file_bytes));
  if (head.size() < expected) return fail(ErrorKind::kBadData, "exa: the block table is truncated");
  head = head.substr(0, expected);
  ByteReader stored(head.substr(head.size() - kSumBytes));
  if (stored.little<std::uint32_t>() != crc32_of(head.substr(0, head.size() - kSumBytes)))
    return fail(ErrorKind::kBadData, "exa: the sum of the block table is wrong: the file is damaged");
  ByteReader reader(head.substr(kExaMagic.size()));
  ExaTable table;
  table.major = reader.little<std::uint16_t>();
  table.minor = reader.little<std::uint16_t>();
  table.rows.resize(reader.little<std::uint32_t>());
  table.file_bytes = reader.little<std::uint64_t>();
  std::uint64_t offset = expected;
  for (ExaRow& row : table.rows) {
    row.type = reader.take(4);
    row.codec = reader.little<std::uint16_t>();
    row.flags = reader.little<std::uint16_t>();
    row.offset = reader.little<std::uint64_t>();
    row.length = reader.little<std::uint64_t>();
    row.chunks = reader.little<std::uint32_t>();
    if (row.offset != offset || row.length > file_bytes - kExaEnd.size() - offset)
      return fail(ErrorKind::kBadData, "exa: block \"{}\" lies outside the file or over another", shown(row.type));
    offset += row.length;
  }
  if (offset + kExaEnd.size() != file_bytes)
    return fail(ErrorKind::kBadData, "exa: {} bytes between the blocks and the end belong to no block",
                file_bytes - kExaEnd.size() - offset);
  return table;
}

}  // namespace dubsar
