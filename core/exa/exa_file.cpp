#include "core/exa/exa_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "core/base/atomic_file.h"
#include "core/base/bytes.h"
#include "core/base/input_file.h"
#include "core/base/parallel.h"
#include "core/exa/exa_text.h"
#include "core/exa/geometry.h"
#include "core/exa/patches.h"
#include "core/exa/topology.h"
#include "core/extract/extract.h"

namespace dubsar {
namespace {
constexpr std::uint16_t kCodecPlain = 0, kCodecSigns = 1;
constexpr int kHighestShape = 126, kHighestAo = 63, kHighestPartition = PartitionTable::kHighest;
constexpr std::size_t kWriteStep = std::size_t{4} << 20;

struct BlockName {
  std::string_view type, name;
};
constexpr std::array<BlockName, 14> kBlockNames{{{"HEAD", "header"},
                                                 {"SIGN", "signs"},
                                                 {"FACE", "face_decisions"},
                                                 {"OFFS", "offsets"},
                                                 {"POSN", "positions"},
                                                 {"NORM", "normals"},
                                                 {"KMIN", "k_min"},
                                                 {"KMAX", "k_max"},
                                                 {"SHAP", "shape"},
                                                 {"AMBO", "ao"},
                                                 {"QPAR", "quad_partition"},
                                                 {"PART", "partitions"},
                                                 {"FILL", "fill_patches"},
                                                 {"PROV", "provenance"}}};

bool known(std::string_view type) {
  return std::any_of(kBlockNames.begin(), kBlockNames.end(), [&](const BlockName& b) { return b.type == type; });
}

ExaStats stats_of(const ExaTable& table, std::int64_t vertices) {
  ExaStats stats;
  stats.bytes = static_cast<std::int64_t>(table.file_bytes);
  stats.vertices = vertices;
  const auto bits = [&](std::int64_t bytes) {
    return vertices > 0 ? 8.0 * static_cast<double>(bytes) / static_cast<double>(vertices) : 0.0;
  };
  std::int64_t container = stats.bytes;
  stats.blocks.push_back({"container", 0, 0.0});
  for (const ExaRow& row : table.rows) {
    const auto bytes = static_cast<std::int64_t>(row.length);
    container -= bytes;
    stats.blocks.push_back({exa_block_name(row.type), bytes, bits(bytes)});
  }
  stats.blocks[0].bytes = container;
  stats.blocks[0].bits_per_vertex = bits(container);
  stats.bits_per_vertex = bits(stats.bytes);
  return stats;
}

/// The arrays of a model must fit its mesh, and its mesh must be the one that its samples give.
Result<void> check_model(const SurfaceModel& model, const QuadMesh& rebuilt) {
  const auto vertices = static_cast<std::size_t>(model.mesh.vertex_count());
  const auto quads = static_cast<std::size_t>(model.mesh.quad_count());
  const auto fits = [](std::size_t size, std::size_t count) { return size == 0 || size == count; };
  const VertexAttributes& a = model.attributes;
  if (!fits(a.normals.size(), vertices) || !fits(a.k_min.size(), vertices) || !fits(a.k_max.size(), vertices) ||
      !fits(a.shape.size(), vertices) || !fits(a.ao.size(), vertices) || !fits(model.quad_partition.size(), quads))
    return fail(ErrorKind::kInternal, "exa: arrays do not fit the mesh of {} vertices and {} x-quads", vertices, quads);
  if (model.mesh.quads != rebuilt.quads || model.mesh.doubled != rebuilt.doubled ||
      model.mesh.positions.size() != rebuilt.positions.size())
    return fail(ErrorKind::kInternal, "exa: the mesh of {} vertices is not the one that the samples give ({} vertices)",
                vertices, rebuilt.positions.size());
  for (const glm::vec3& p : model.mesh.positions)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return fail(ErrorKind::kBadData, "exa: a vertex position is not finite, so the surface is not stored");
  const auto largest = [](const std::vector<std::uint8_t>& v) {
    return v.empty() ? 0 : *std::max_element(v.begin(), v.end());
  };
  if (largest(a.shape) > kHighestShape || largest(a.ao) > kHighestAo ||
      largest(model.quad_partition) > kHighestPartition)
    return fail(ErrorKind::kInternal, "exa: a shape class, ambient light or partition is out of range");
  return check_patches(model.patches, model.mesh.vertex_count());
}

/// The blocks of a file in memory, checked and found by type.
class Blocks {
 public:
  static Result<Blocks> open(std::string_view file) {
    DUBSAR_ASSIGN(const std::uint64_t head, exa_head_bytes(file.substr(0, kExaPreludeBytes), file.size()));
    Blocks blocks;
    blocks.file_ = file;
    DUBSAR_ASSIGN(blocks.table_, parse_exa_head(file.substr(0, head), file.size()));
    if (!file.ends_with(kExaEnd)) return fail(ErrorKind::kBadData, "exa: the end mark is damaged");
    for (const ExaRow& row : blocks.table_.rows) {
      DUBSAR_TRY(exa_block(file, row));
      if (blocks.table_.find(row.type) != &row)
        return fail(ErrorKind::kBadData, "exa: two blocks \"{}\", expected one", exa_block_name(row.type));
      if (!known(row.type) && (row.flags & kExaRequired))
        return fail(ErrorKind::kBadData, "exa: block \"{}\" is needed and not known; a later dubsar wrote the file",
                    exa_block_name(row.type));
    }
    return blocks;
  }
  const ExaRow* row(std::string_view type) const { return table_.find(type); }
  std::string_view bytes(const ExaRow& row) const { return file_.substr(row.offset, row.length); }
  /// The bytes of a block that must be there with this codec.
  Result<std::string_view> required(std::string_view type, std::uint16_t codec) const {
    const ExaRow* found = row(type);
    if (!found) return fail(ErrorKind::kBadData, "exa: block \"{}\" is missing", exa_block_name(type));
    if (found->codec != codec)
      return fail(ErrorKind::kBadData, "exa: codec {} of block \"{}\" is not known; a later dubsar wrote the file",
                  found->codec, exa_block_name(type));
    return bytes(*found);
  }

 private:
  std::string_view file_;
  ExaTable table_;
};

Result<void> decode_attributes(const Blocks& blocks, SurfaceModel& model, Progress& progress) {
  const std::size_t vertices = model.mesh.positions.size();
  VertexAttributes& a = model.attributes;
  if (const ExaRow* row = blocks.row("NORM")) {
    DUBSAR_ASSIGN(a.normals, decode_normals(row->codec, blocks.bytes(*row), vertices, progress));
  }
  if (const ExaRow* row = blocks.row("KMIN")) {
    DUBSAR_ASSIGN(a.k_min, decode_curvatures(row->codec, blocks.bytes(*row), vertices, progress));
  }
  if (const ExaRow* row = blocks.row("KMAX")) {
    DUBSAR_ASSIGN(a.k_max, decode_curvatures(row->codec, blocks.bytes(*row), vertices, progress));
  }
  const auto labels = [&](const char* type, std::size_t count, int highest,
                          std::vector<std::uint8_t>& out) -> Result<void> {
    const ExaRow* row = blocks.row(type);
    if (!row) return {};
    DUBSAR_ASSIGN(out, decode_labels(row->codec, blocks.bytes(*row), count, highest, exa_block_name(type), progress));
    return {};
  };
  DUBSAR_TRY(labels("SHAP", vertices, kHighestShape, a.shape));
  DUBSAR_TRY(labels("AMBO", vertices, kHighestAo, a.ao));
  return labels("QPAR", model.mesh.quads.size(), kHighestPartition, model.quad_partition);
}

Result<void> decode_tables(const Blocks& blocks, SurfaceModel& model) {
  if (blocks.row("PART")) {
    DUBSAR_ASSIGN(const std::string_view text, blocks.required("PART", kCodecPlain));
    DUBSAR_ASSIGN(model.partitions, parse_exa_partitions(text));
  }
  if (blocks.row("FILL")) {
    DUBSAR_ASSIGN(const std::string_view bytes, blocks.required("FILL", kCodecPlain));
    DUBSAR_ASSIGN(model.patches, decode_patches(bytes, model.mesh.vertex_count()));
  }
  if (blocks.row("PROV")) {
    DUBSAR_ASSIGN(const std::string_view text, blocks.required("PROV", kCodecPlain));
    model.provenance = text;
  }
  return {};
}
}  // namespace

std::string exa_block_name(std::string_view type) {
  for (const BlockName& block : kBlockNames)
    if (block.type == type) return std::string(block.name);
  std::string text(type);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < 32 || c > 126; }, '?');
  return text;
}

void quantise_for_exa(SurfaceModel& model) {
  constexpr std::int64_t kGrain = 1 << 14;
  const auto each = [&](auto& items, auto rounded) {
    parallel_for(static_cast<std::int64_t>(items.size()), kGrain, [&](std::int64_t i) {
      auto& item = items[static_cast<std::size_t>(i)];
      item = rounded(item);
    });
  };
  each(model.mesh.positions, quantised_position);
  each(model.attributes.normals, quantised_normal);
  each(model.attributes.k_min, quantised_curvature);
  each(model.attributes.k_max, quantised_curvature);
  for (FillPatch& patch : model.patches) each(patch.extra_positions, quantised_position);
}

Result<std::vector<ExaBlock>> encode_exa(const SurfaceModel& model, Progress& progress) {
  DUBSAR_ASSIGN(const QuadMesh base, build_quad_mesh(model.samples, progress));
  DUBSAR_TRY(check_model(model, base));
  ExaHeader header;
  header.frame = model.frame;
  header.dims = model.samples.dims;
  header.isovalue = model.samples.isovalue;
  header.offset_bits = model.samples.offset_bits;
  header.closed = model.samples.closed;
  header.vertices = model.mesh.vertex_count();
  header.quads = model.mesh.quad_count();
  header.mesh_sum = mesh_checksum(model.mesh);

  std::vector<ExaBlock> blocks;
  const auto add = [&](const char* type, std::uint16_t flags, Encoded encoded) {
    blocks.push_back({type, encoded.codec, flags, std::move(encoded.bytes)});
  };
  DUBSAR_ASSIGN(std::string text, exa_header_json(header));
  add("HEAD", kExaRequired, {kCodecPlain, std::move(text)});
  DUBSAR_ASSIGN(std::string signs, encode_signs(model.samples.signs, progress));
  add("SIGN", kExaRequired, {kCodecSigns, std::move(signs)});
  add("FACE", kExaRequired, encode_bits<std::uint8_t>(model.samples.joined, 1));
  add("OFFS", kExaRequired, encode_bits<std::uint16_t>(model.samples.offsets, model.samples.offset_bits));
  const bool smoothed =
      exa_checksum({reinterpret_cast<const char*>(model.mesh.positions.data()),
                    model.mesh.positions.size() * sizeof(glm::vec3)}) !=
      exa_checksum({reinterpret_cast<const char*>(base.positions.data()), base.positions.size() * sizeof(glm::vec3)});
  if (smoothed) {
    DUBSAR_ASSIGN(Encoded positions, encode_positions(model.mesh.positions, base.positions, progress));
    add("POSN", kExaRequired, std::move(positions));
  }
  const VertexAttributes& a = model.attributes;
  if (!a.normals.empty()) {
    DUBSAR_ASSIGN(Encoded normals, encode_normals(a.normals, progress));
    add("NORM", 0, std::move(normals));
  }
  const auto curvatures = [&](const char* type, const std::vector<float>& k) -> Result<void> {
    if (k.empty()) return {};
    DUBSAR_ASSIGN(Encoded encoded, encode_curvatures(k, progress));
    add(type, 0, std::move(encoded));
    return {};
  };
  DUBSAR_TRY(curvatures("KMIN", a.k_min));
  DUBSAR_TRY(curvatures("KMAX", a.k_max));
  const auto labels = [&](const char* type, const std::vector<std::uint8_t>& values) -> Result<void> {
    if (values.empty()) return {};
    DUBSAR_ASSIGN(Encoded encoded, encode_labels(values, progress));
    add(type, 0, std::move(encoded));
    return {};
  };
  DUBSAR_TRY(labels("SHAP", a.shape));
  DUBSAR_TRY(labels("AMBO", a.ao));
  DUBSAR_TRY(labels("QPAR", model.quad_partition));
  if (!model.partitions.empty()) {
    DUBSAR_ASSIGN(std::string table, exa_partitions_json(model.partitions));
    add("PART", 0, {kCodecPlain, std::move(table)});
  }
  if (!model.patches.empty()) add("FILL", 0, {kCodecPlain, encode_patches(model.patches)});
  if (!model.provenance.empty()) add("PROV", 0, {kCodecPlain, model.provenance});
  return blocks;
}

Result<SurfaceModel> decode_exa(std::string_view file, Progress& progress) {
  DUBSAR_ASSIGN(const Blocks blocks, Blocks::open(file));
  DUBSAR_ASSIGN(const std::string_view text, blocks.required("HEAD", kCodecPlain));
  DUBSAR_ASSIGN(const ExaHeader header, parse_exa_header(text));
  SurfaceModel model;
  model.frame = header.frame;
  SurfaceSamples& samples = model.samples;
  samples.dims = header.dims;
  samples.isovalue = header.isovalue;
  samples.offset_bits = header.offset_bits;
  samples.closed = header.closed;
  DUBSAR_ASSIGN(const std::string_view signs, blocks.required("SIGN", kCodecSigns));
  DUBSAR_ASSIGN(samples.signs, decode_signs(signs, header.dims, progress));
  const SampleCounts counts = count_samples(samples.signs);
  DUBSAR_ASSIGN(const std::string_view faces, blocks.required("FACE", kCodecBits));
  DUBSAR_ASSIGN(samples.joined,
                decode_bits<std::uint8_t>(faces, static_cast<std::uint64_t>(counts.faces), 1, "face decisions"));
  DUBSAR_ASSIGN(const std::string_view offsets, blocks.required("OFFS", kCodecBits));
  DUBSAR_ASSIGN(samples.offsets, decode_bits<std::uint16_t>(offsets, static_cast<std::uint64_t>(counts.edges),
                                                            samples.offset_bits, "offsets"));
  DUBSAR_ASSIGN(model.mesh, build_quad_mesh(samples, progress));
  if (model.mesh.vertex_count() != header.vertices || model.mesh.quad_count() != header.quads)
    return fail(ErrorKind::kBadData, "exa: {} vertices and {} x-quads found, the header says {} and {}",
                model.mesh.vertex_count(), model.mesh.quad_count(), header.vertices, header.quads);
  if (const ExaRow* row = blocks.row("POSN")) {
    DUBSAR_ASSIGN(model.mesh.positions,
                  decode_positions(row->codec, blocks.bytes(*row), model.mesh.positions, progress));
  }
  if (mesh_checksum(model.mesh) != header.mesh_sum)
    return fail(ErrorKind::kBadData, "exa: the mesh built from this file is not the one that was written");
  DUBSAR_TRY(decode_attributes(blocks, model, progress));
  DUBSAR_TRY(decode_tables(blocks, model));
  return model;
}

Result<ExaStats> write_exa(const std::filesystem::path& path, const SurfaceModel& model, Progress& progress) {
  DUBSAR_ASSIGN(const std::vector<ExaBlock> blocks, encode_exa(model, progress));
  const std::string head = exa_head(blocks);
  std::uint64_t total = head.size() + kExaEnd.size();
  for (const ExaBlock& block : blocks) total += block.bytes.size();
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

Result<SurfaceModel> read_exa(const std::filesystem::path& path, Progress& progress) {
  const auto named = [&](Error error) {
    if (error.kind == ErrorKind::kBadData || error.kind == ErrorKind::kTryAgain)
      error.message = path.string() + ": " + error.message;
    return tl::unexpected<Error>(std::move(error));
  };
  DUBSAR_ASSIGN(const InputFile input, InputFile::open(path));
  const auto prelude = read_bytes(input, 0, std::min<std::int64_t>(input.size(), kExaPreludeBytes));
  if (!prelude) return named(prelude.error());
  // A huge file of another kind is refused before it is read.
  if (const auto head = exa_head_bytes(*prelude, static_cast<std::uint64_t>(input.size())); !head)
    return named(head.error());
  DUBSAR_ASSIGN(const std::string bytes, read_bytes(input, 0, input.size()));
  try {
    auto model = decode_exa(bytes, progress);
    if (!model) return named(std::move(model).error());
    return model;
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::kTryAgain, "{}: out of memory while reading {} bytes", path.string(), bytes.size());
  }
}

Result<ExaInfo> read_exa_info(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const InputFile input, InputFile::open(path));
  const auto read = [&]() -> Result<ExaInfo> {
    DUBSAR_ASSIGN(const std::string prelude,
                  read_bytes(input, 0, std::min<std::int64_t>(input.size(), kExaPreludeBytes)));
    const auto size = static_cast<std::uint64_t>(input.size());
    DUBSAR_ASSIGN(const std::uint64_t head_bytes, exa_head_bytes(prelude, size));
    DUBSAR_ASSIGN(const std::string head, read_bytes(input, 0, static_cast<std::int64_t>(head_bytes)));
    DUBSAR_ASSIGN(const ExaTable table, parse_exa_head(head, size));
    const auto text_of = [&](const ExaRow& row) -> Result<std::string> {
      DUBSAR_ASSIGN(std::string bytes,
                    read_bytes(input, static_cast<std::int64_t>(row.offset), static_cast<std::int64_t>(row.length)));
      DUBSAR_TRY(exa_block(bytes, {row.type, row.codec, row.flags, 0, row.length, row.checksum}));
      return bytes;
    };
    const ExaRow* row = table.find("HEAD");
    if (!row) return fail(ErrorKind::kBadData, "exa: block \"header\" is missing");
    DUBSAR_ASSIGN(const std::string text, text_of(*row));
    DUBSAR_ASSIGN(const ExaHeader header, parse_exa_header(text));
    ExaInfo info;
    info.major = table.major;
    info.minor = table.minor;
    info.frame = header.frame;
    info.dims = header.dims;
    info.isovalue = header.isovalue;
    info.offset_bits = header.offset_bits;
    info.closed = header.closed;
    info.vertices = header.vertices;
    info.quads = header.quads;
    info.stats = stats_of(table, header.vertices);
    if (row = table.find("PART"); row) {
      DUBSAR_ASSIGN(const std::string partitions, text_of(*row));
      DUBSAR_ASSIGN(info.partitions, parse_exa_partitions(partitions));
    }
    if (row = table.find("PROV"); row) {
      DUBSAR_ASSIGN(info.provenance, text_of(*row));
    }
    return info;
  };
  auto info = read();
  if (!info && info.error().kind == ErrorKind::kBadData)
    info.error().message = path.string() + ": " + info.error().message;
  return info;
}

}  // namespace dubsar
