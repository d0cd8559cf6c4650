#include "core/exa/exa_reader.h"

#include <algorithm>
#include <array>

#include "core/exa/chunks.h"

namespace dubsar {
namespace {
struct BlockName {
  std::string_view type, name;
};
constexpr std::array<BlockName, 22> kBlockNames{
    {{"HEAD", "header"},          {"PART", "partitions"},     {"PROV", "provenance"},
     {"SIGC", "signs_8"},         {"SIG2", "signs_4"},        {"SIG1", "signs_2"},
     {"SIG0", "signs_1"},         {"FACE", "face_decisions"}, {"OFFS", "offsets"},
     {"ESCP", "escapes"},         {"POSN", "positions"},      {"NORM", "normals"},
     {"CURV", "curvatures"},      {"SHAP", "shape"},          {"AMBO", "ao"},
     {"EVID", "evidence"},        {"QPAR", "quad_partition"}, {"FILL", "fill_patches"},
     {"FEVI", "fill_evidence"},   {"LABL", "labels"},         {"LOFS", "contact_offsets"},
     {"LEVI", "contact_evidence"}}};
}  // namespace

std::string exa_block_name(std::string_view type) {
  for (const BlockName& block : kBlockNames)
    if (block.type == type) return std::string(block.name);
  std::string text(type);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < 32 || c > 126; }, '?');
  return text;
}

bool exa_block_known(std::string_view type) {
  return std::any_of(kBlockNames.begin(), kBlockNames.end(), [&](const BlockName& b) { return b.type == type; });
}

Result<ExaReader> ExaReader::open(std::string_view file) {
  ExaReader reader;
  reader.memory_ = file;
  reader.bytes_ = file.size();
  DUBSAR_TRY(reader.read_table());
  return reader;
}

Result<ExaReader> ExaReader::open(std::shared_ptr<const InputFile> file) {
  ExaReader reader;
  reader.bytes_ = static_cast<std::uint64_t>(file->size());
  reader.file_ = std::move(file);
  DUBSAR_TRY(reader.read_table());
  return reader;
}

Result<std::string> ExaReader::read(std::uint64_t offset, std::uint64_t count) const {
  if (file_) return read_bytes(*file_, static_cast<std::int64_t>(offset), static_cast<std::int64_t>(count));
  return std::string(memory_.substr(offset, count));
}

Result<void> ExaReader::read_table() {
  DUBSAR_ASSIGN(const std::string prelude, read(0, std::min<std::uint64_t>(bytes_, kExaPreludeBytes)));
  DUBSAR_ASSIGN(const std::uint64_t head_bytes, exa_head_bytes(prelude, bytes_));
  DUBSAR_ASSIGN(const std::string head, read(0, head_bytes));
  DUBSAR_ASSIGN(table_, parse_exa_head(head, bytes_));
  DUBSAR_ASSIGN(const std::string end, read(bytes_ - kExaEnd.size(), kExaEnd.size()));
  if (end != kExaEnd) return fail(ErrorKind::kBadData, "exa: the end mark is missing: the file is damaged");
  for (const ExaRow& row : table_.rows) {
    if (table_.find(row.type) != &row)
      return fail(ErrorKind::kBadData, "exa: two blocks \"{}\", expected one", exa_block_name(row.type));
    if (!exa_block_known(row.type) && (row.flags & kExaRequired))
      return fail(ErrorKind::kBadData, "exa: block \"{}\" is needed and not known; a later dubsar wrote the file",
                  exa_block_name(row.type));
  }
  return {};
}

Result<ExaChunks> ExaReader::chunks_of(const ExaRow& row, const std::function<bool(std::size_t)>& wanted) const {
  const std::string name = exa_block_name(row.type);
  ExaChunks loaded;
  if (!wanted) {
    std::string_view block = memory_.substr(std::min<std::uint64_t>(row.offset, memory_.size()), row.length);
    if (file_) {
      DUBSAR_ASSIGN(std::string bytes, read(row.offset, row.length));
      loaded.storage.push_back(std::move(bytes));
      block = loaded.storage.back();
    }
    DUBSAR_ASSIGN(loaded.chunks, split_chunks(block, row.chunks, name));
    return loaded;
  }
  DUBSAR_ASSIGN(const std::string head, read(row.offset, std::min(row.length, ChunkIndex::most_bytes(row.chunks))));
  DUBSAR_ASSIGN(const ChunkIndex index, ChunkIndex::parse(head, row.length, row.chunks, name));
  loaded.storage.resize(index.size());
  loaded.chunks.resize(index.size());
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index.length(i) == 0 || !wanted(i)) continue;
    DUBSAR_ASSIGN(loaded.storage[i], read(row.offset + index.offset(i), index.length(i)));
    DUBSAR_TRY(index.check(i, loaded.storage[i]));
    loaded.chunks[i] = loaded.storage[i];
  }
  return loaded;
}

Result<ExaChunks> ExaReader::chunks(std::string_view type, std::uint16_t codec,
                                    const std::function<bool(std::size_t)>& wanted) const {
  const ExaRow* row = table_.find(type);
  if (!row) return fail(ErrorKind::kBadData, "exa: block \"{}\" is missing", exa_block_name(type));
  if (row->codec != codec)
    return fail(ErrorKind::kBadData, "exa: codec {} of block \"{}\" is not known; a later dubsar wrote the file",
                row->codec, exa_block_name(type));
  return chunks_of(*row, wanted);
}

Result<std::string> ExaReader::text(std::string_view type) const {
  DUBSAR_ASSIGN(const ExaChunks loaded, chunks(type, 0));
  if (loaded.chunks.size() != 1)
    return fail(ErrorKind::kBadData, "exa: {} chunks of block \"{}\" found, 1 expected", loaded.chunks.size(),
                exa_block_name(type));
  return std::string(loaded.chunks[0]);
}

Result<ExaHeader> ExaReader::header() const {
  DUBSAR_ASSIGN(const std::string json, text("HEAD"));
  return parse_exa_header(json, bytes_);
}

Result<std::vector<ForeignBlock>> ExaReader::foreign() const {
  std::vector<ForeignBlock> blocks;
  for (const ExaRow& row : table_.rows) {
    if (exa_block_known(row.type) && row.type != "FILL" && row.type != "FEVI") continue;
    DUBSAR_ASSIGN(std::string bytes, read(row.offset, row.length));
    blocks.push_back({row.type, row.codec, row.flags, row.chunks, std::move(bytes)});
  }
  return blocks;
}

Result<std::vector<std::uint8_t>> ExaReader::damaged_chunks(const ExaRow& row) const {
  DUBSAR_ASSIGN(const std::string block, read(row.offset, row.length));
  DUBSAR_ASSIGN(const ChunkIndex index, ChunkIndex::parse(block, row.length, row.chunks, exa_block_name(row.type)));
  std::vector<std::uint8_t> damaged(index.size());
  for (std::size_t i = 0; i < index.size(); ++i)
    damaged[i] = index.check(i, std::string_view(block).substr(index.offset(i), index.length(i))) ? 0 : 1;
  return damaged;
}

ExaReader ExaReader::without(const std::set<std::string>& types) const {
  ExaReader rest = *this;
  std::erase_if(rest.table_.rows, [&](const ExaRow& row) { return types.contains(row.type); });
  return rest;
}

Result<void> ExaReader::check_sums() const {
  for (const ExaRow& row : table_.rows) {
    DUBSAR_ASSIGN(const ExaChunks loaded, chunks_of(row, {}));
    static_cast<void>(loaded);
  }
  return {};
}

}  // namespace dubsar
