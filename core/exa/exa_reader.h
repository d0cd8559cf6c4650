#pragma once
// The blocks of an EXA file, read as they are asked for.

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/files/input_file.h"
#include "core/base/result.h"
#include "core/exa/container.h"
#include "core/exa/exa_text.h"

namespace dubsar {

/// Chunks of a block and the bytes that they borrow from.
struct ExaChunks {
  std::vector<std::string> storage;
  std::vector<std::string_view> chunks;
};

class ExaReader {
 public:
  /// A whole file in memory, which must outlive the reader.
  static Result<ExaReader> open(std::string_view file);
  /// A file on disk; only what is asked for is read.
  static Result<ExaReader> open(std::shared_ptr<const InputFile> file);

  const ExaTable& table() const noexcept { return table_; }
  bool has(std::string_view type) const noexcept { return table_.find(type) != nullptr; }

  /// The chunks of a block that must be there with this codec. Their sums are checked. With `wanted`, only the chunks i
  /// with wanted(i) are read, the others are empty.
  Result<ExaChunks> chunks(std::string_view type, std::uint16_t codec,
                           const std::function<bool(std::size_t)>& wanted = {}) const;
  /// The one chunk of a text block.
  Result<std::string> text(std::string_view type) const;
  Result<ExaHeader> header() const;

  /// Blocks that are not known, whole.
  Result<std::vector<ForeignBlock>> foreign() const;

  /// What of a block is damaged: 1 for each chunk whose sum is wrong. kBadData where the index is damaged, so that all
  /// is.
  Result<std::vector<std::uint8_t>> damaged_chunks(const ExaRow& row) const;
  /// The same file as if these blocks were not there.
  ExaReader without(const std::set<std::string>& types) const;

  /// Checks every sum, of unknown blocks, too.
  Result<void> check_sums() const;

 private:
  ExaReader() = default;
  Result<void> read_table();
  Result<std::string> read(std::uint64_t offset, std::uint64_t count) const;
  Result<ExaChunks> chunks_of(const ExaRow& row, const std::function<bool(std::size_t)>& wanted) const;

  std::string_view memory_;
  std::shared_ptr<const InputFile> file_;
  std::uint64_t bytes_ = 0;
  ExaTable table_;
};

/// "signs_8" for "SIGC" and so on; the type itself, made printable, for blocks that are not known.
std::string exa_block_name(std::string_view type);
bool exa_block_known(std::string_view type);

}  // namespace dubsar
