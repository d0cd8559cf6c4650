#include "core/exa/exa_file.h"

#include <algorithm>
#include <memory>
#include <new>

#include "core/base/files/atomic_file.h"
#include "core/base/files/input_file.h"
#include "core/exa/exa_decode.h"
#include "core/exa/exa_reader.h"
#include "core/exa/exa_salvage.h"
#include "core/exa/exa_text.h"
#include "core/exa/signs/sign_brick.h"

namespace dubsar {
namespace {
constexpr std::size_t kWriteStep = std::size_t{4} << 20;

ExaStats stats_of(const ExaTable& table, std::int64_t vertices) {
  ExaStats stats;
  stats.bytes = static_cast<std::int64_t>(table.file_bytes);
  stats.vertices = vertices;
  const auto bits = [&](std::int64_t bytes) {
    return vertices > 0 ? 8.0 * static_cast<double>(bytes) / static_cast<double>(vertices) : 0.0;
  };
  std::int64_t container = stats.bytes;
  stats.blocks.push_back({"container", 0, 0.0, 0});
  for (const ExaRow& row : table.rows) {
    const auto bytes = static_cast<std::int64_t>(row.length);
    container -= bytes;
    stats.blocks.push_back({exa_block_name(row.type), bytes, bits(bytes), row.chunks});
  }
  stats.blocks[0].bytes = container;
  stats.blocks[0].bits_per_vertex = bits(container);
  stats.bits_per_vertex = bits(stats.bytes);
  return stats;
}

tl::unexpected<Error> named(const std::filesystem::path& path, Error error) {
  if (error.kind == ErrorKind::kBadData || error.kind == ErrorKind::kTryAgain)
    error.message = path.string() + ": " + error.message;
  return tl::unexpected<Error>(std::move(error));
}

/// Opens a file, does something with it, and names the file in what went wrong.
template <class T, class Use>
Result<T> with_file(const std::filesystem::path& path, const Use& use) {
  DUBSAR_ASSIGN(InputFile input, InputFile::open(path));
  const auto read = [&]() -> Result<T> {
    try {
      DUBSAR_ASSIGN(const ExaReader reader, ExaReader::open(std::make_shared<InputFile>(std::move(input))));
      return use(reader);
    } catch (const std::bad_alloc&) {
      return fail(ErrorKind::kTryAgain, "exa: out of memory");
    }
  };
  Result<T> result = read();
  if (!result) return named(path, result.error());
  return result;
}
}  // namespace

Result<SurfaceModel> decode_exa(std::string_view file, Progress& progress, const ExaReadOptions& options) {
  DUBSAR_ASSIGN(const ExaReader reader, ExaReader::open(file));
  return decode_model(reader, options, progress);
}

Result<ExaStats> write_exa(const std::filesystem::path& path, const SurfaceModel& model, Progress& progress) {
  DUBSAR_ASSIGN(const std::vector<ExaBlock> blocks, encode_exa(model, progress));
  const std::string head = exa_head(blocks);
  std::uint64_t total = head.size() + kExaEnd.size();
  for (const ExaBlock& block : blocks) total += block.bytes.size();
  DUBSAR_TRY(check_exa_size(model.samples.dims, total));  // what no reader takes is not written
  progress.begin("write exa", static_cast<std::int64_t>(total), "byte");
  DUBSAR_ASSIGN(AtomicFile file, AtomicFile::create(path, static_cast<std::int64_t>(total)));
  const auto put = [&](std::string_view bytes) -> Result<void> {
    for (std::size_t at = 0; at < bytes.size(); at += kWriteStep) {
      if (progress.cancelled()) return cancelled_error();
      const std::string_view piece = bytes.substr(at, kWriteStep);
      DUBSAR_TRY(file.write(piece));
      progress.advance(static_cast<std::int64_t>(piece.size()));
    }
    return {};
  };
  DUBSAR_TRY(put(head));
  for (const ExaBlock& block : blocks) DUBSAR_TRY(put(block.bytes));
  DUBSAR_TRY(put(kExaEnd));
  if (progress.cancelled()) return cancelled_error();
  DUBSAR_TRY(file.commit());
  progress.end();
  DUBSAR_ASSIGN(const ExaTable table, parse_exa_head(head, total));
  return stats_of(table, model.mesh.vertex_count());
}

Result<SurfaceModel> read_exa(const std::filesystem::path& path, Progress& progress, const ExaReadOptions& options) {
  return with_file<SurfaceModel>(path,
                                 [&](const ExaReader& reader) { return decode_model(reader, options, progress); });
}

Result<SurfaceModel> read_exa_level(const std::filesystem::path& path, int level, Progress& progress) {
  if (level < 1 || level > kBrickLevels)
    return fail(ErrorKind::kUsage, "exa: level {} asked for, 1 to {} expected", level, kBrickLevels);
  return with_file<SurfaceModel>(path, [&](const ExaReader& reader) { return decode_level(reader, level, progress); });
}

Result<SurfaceModel> read_exa_box(const std::filesystem::path& path, const GridBox& box, Progress& progress) {
  return with_file<SurfaceModel>(path, [&](const ExaReader& reader) { return decode_box(reader, box, progress); });
}

Result<SalvagedExa> salvage_exa(const std::filesystem::path& path, Progress& progress) {
  return with_file<SalvagedExa>(path, [&](const ExaReader& reader) { return decode_salvaged(reader, progress); });
}

Result<void> check_exa_sums(const std::filesystem::path& path) {
  return with_file<void>(path, [](const ExaReader& reader) { return reader.check_sums(); });
}

Result<ExaInfo> read_exa_info(const std::filesystem::path& path) {
  return with_file<ExaInfo>(path, [](const ExaReader& reader) -> Result<ExaInfo> {
    ExaInfo info;
    DUBSAR_ASSIGN(info.header, reader.header());
    info.major = reader.table().major;
    info.minor = reader.table().minor;
    info.stats = stats_of(reader.table(), info.header.vertices);
    if (reader.has("PART")) {
      DUBSAR_ASSIGN(const std::string partitions, reader.text("PART"));
      DUBSAR_ASSIGN(info.partitions, parse_exa_partitions(partitions));
    }
    if (reader.has("PROV")) {
      DUBSAR_ASSIGN(info.provenance, reader.text("PROV"));
    }
    return info;
  });
}

}  // namespace dubsar
