#include "core/exa/exa_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>

#include "core/base/atomic_file.h"
#include "core/base/budget.h"
#include "core/base/input_file.h"
#include "core/exa/attributes.h"
#include "core/exa/chunks.h"
#include "core/exa/exa_reader.h"
#include "core/exa/exact.h"
#include "core/exa/offsets.h"
#include "core/exa/patches.h"
#include "core/exa/settle.h"
#include "core/exa/sign_brick.h"
#include "core/extract/extract.h"

namespace dubsar {
namespace {
constexpr std::uint16_t kCodec = 0;
constexpr std::size_t kWriteStep = std::size_t{4} << 20;
constexpr std::array<const char*, 3> kSignBlocks{"SIG0", "SIG1", "SIG2"};

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

/// The arrays of a model must fit its mesh, and its mesh must be the one that its samples give.
Result<void> check_model(const SurfaceModel& model, const QuadMesh& rebuilt) {
  const auto vertices = static_cast<std::size_t>(model.mesh.vertex_count());
  const auto quads = static_cast<std::size_t>(model.mesh.quad_count());
  const auto fits = [](std::size_t size, std::size_t count) { return size == 0 || size == count; };
  const VertexAttributes& a = model.attributes;
  if (!fits(a.normals.size(), vertices) || !fits(a.k_min.size(), vertices) || a.k_min.size() != a.k_max.size() ||
      !fits(a.shape.size(), vertices) || !fits(a.ao.size(), vertices) || !fits(model.quad_partition.size(), quads))
    return fail(ErrorKind::kInternal, "exa: arrays do not fit the mesh of {} vertices and {} x-quads", vertices, quads);
  if (model.mesh.quads != rebuilt.quads || model.mesh.doubled != rebuilt.doubled ||
      model.mesh.positions.size() != rebuilt.positions.size())
    return fail(ErrorKind::kInternal, "exa: the mesh of {} vertices is not the one that the samples give ({} vertices)",
                vertices, rebuilt.positions.size());
  const auto finite = [](float v) { return std::isfinite(v); };
  const auto all_finite = [&](const std::vector<glm::vec3>& items) {
    return std::all_of(items.begin(), items.end(),
                       [&](const glm::vec3& p) { return finite(p.x) && finite(p.y) && finite(p.z); });
  };
  if (!all_finite(model.mesh.positions) || !all_finite(a.normals) ||
      !std::all_of(a.k_min.begin(), a.k_min.end(), finite) || !std::all_of(a.k_max.begin(), a.k_max.end(), finite))
    return fail(ErrorKind::kBadData,
                "exa: a position, normal or curvature is not finite, so the surface is not stored");
  const auto largest = [](const std::vector<std::uint8_t>& v) {
    return v.empty() ? 0 : int{*std::max_element(v.begin(), v.end())};
  };
  if (largest(a.shape) > highest_label(ExaLabel::kShape) || largest(a.ao) > highest_label(ExaLabel::kLight) ||
      largest(model.quad_partition) > highest_label(ExaLabel::kPartition))
    return fail(ErrorKind::kInternal, "exa: a shape class, ambient light or partition is out of range");
  return check_patches(model.patches, model.mesh.vertex_count());
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

/// Can a reader compute the normals and curvatures itself?
Result<void> find_normals(const SurfaceModel& model, ExaHeader& header, Progress& progress) {
  const VertexAttributes& a = model.attributes;
  header.normals = a.normals.empty() && a.k_min.empty() ? ExaNormals::kNone : ExaNormals::kExact;
  header.curvatures = !a.k_min.empty();
  if (a.normals.empty()) return {};
  DUBSAR_ASSIGN(const std::vector<glm::vec3> normals, recomputed_normals(model.mesh, progress));
  if (!same_bytes(normals, a.normals)) return {};
  for (const CurvatureMethod method : {CurvatureMethod::kFit, CurvatureMethod::kPairs}) {
    header.curvature = method;
    if (a.k_min.empty()) {
      header.normals = ExaNormals::kRecomputed;
      return {};
    }
    DUBSAR_ASSIGN(const Curvatures k, principal_curvatures(model.mesh, normals, method, progress));
    if (!same_bytes(k.k_min, a.k_min) || !same_bytes(k.k_max, a.k_max)) continue;
    header.normals = ExaNormals::kRecomputed;
    return {};
  }
  header.curvature = CurvatureMethod::kFit;
  return {};
}

std::span<const float> floats_of(const std::vector<glm::vec3>& items) {
  return {reinterpret_cast<const float*>(items.data()), items.size() * 3};
}
std::span<float> floats_of(std::vector<glm::vec3>& items) {
  return {reinterpret_cast<float*>(items.data()), items.size() * 3};
}

class BlockList {
 public:
  void add(const char* type, bool required, const std::vector<std::string>& chunks) {
    blocks_.push_back({type, kCodec, required ? kExaRequired : std::uint16_t{0},
                       static_cast<std::uint32_t>(chunks.size()), join_chunks(chunks)});
  }
  std::vector<ExaBlock> take() { return std::move(blocks_); }

 private:
  std::vector<ExaBlock> blocks_;
};

Result<void> add_positions(const SurfaceModel& model, const QuadMesh& base, BlockList& blocks, Progress& progress) {
  if (same_bytes(base.positions, model.mesh.positions)) return {};
  if (const auto escapes = encode_escapes(base, model.mesh.positions, progress)) {
    blocks.add("ESCP", true, *escapes);
  } else {
    blocks.add("POSN", true, encode_floats(floats_of(model.mesh.positions), 3, progress));
  }
  return {};
}

Result<void> decode_positions(const ExaReader& reader, SurfaceModel& model, Progress& progress) {
  if (reader.has("ESCP")) {
    DUBSAR_ASSIGN(const ExaChunks escapes, reader.chunks("ESCP", kCodec));
    DUBSAR_TRY(decode_escapes(escapes.chunks, model.mesh, progress));
  }
  if (reader.has("POSN")) {
    DUBSAR_ASSIGN(const ExaChunks exact, reader.chunks("POSN", kCodec));
    DUBSAR_TRY(decode_floats(exact.chunks, 3, "positions", floats_of(model.mesh.positions), progress));
  }
  return {};
}

Result<void> decode_normals(const ExaReader& reader, const ExaHeader& header, SurfaceModel& model, Progress& progress) {
  VertexAttributes& a = model.attributes;
  const std::size_t vertices = model.mesh.positions.size();
  if (header.normals == ExaNormals::kRecomputed) {
    DUBSAR_ASSIGN(a.normals, recomputed_normals(model.mesh, progress));
    if (!header.curvatures) return {};
    DUBSAR_ASSIGN(Curvatures k, principal_curvatures(model.mesh, a.normals, header.curvature, progress));
    a.k_min = std::move(k.k_min);
    a.k_max = std::move(k.k_max);
    return {};
  }
  if (reader.has("NORM")) {
    DUBSAR_ASSIGN(const ExaChunks normals, reader.chunks("NORM", kCodec));
    a.normals.resize(vertices);
    DUBSAR_TRY(decode_floats(normals.chunks, 3, "normals", floats_of(a.normals), progress));
  }
  if (reader.has("CURV")) {
    DUBSAR_ASSIGN(const ExaChunks curvatures, reader.chunks("CURV", kCodec));
    std::vector<float> pairs(2 * vertices);
    DUBSAR_TRY(decode_floats(curvatures.chunks, 2, "curvatures", pairs, progress));
    a.k_min.resize(vertices);
    a.k_max.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      a.k_min[v] = pairs[2 * v];
      a.k_max[v] = pairs[2 * v + 1];
    }
  }
  return {};
}

Result<void> decode_attributes(const ExaReader& reader, SurfaceModel& model, Progress& progress) {
  const auto labels = [&](const char* type, ExaLabel label, std::vector<std::uint8_t>& out) -> Result<void> {
    if (!reader.has(type)) return {};
    DUBSAR_ASSIGN(const ExaChunks chunks, reader.chunks(type, kCodec));
    DUBSAR_ASSIGN(out, decode_labels(label, model.mesh, chunks.chunks, progress));
    return {};
  };
  DUBSAR_TRY(labels("SHAP", ExaLabel::kShape, model.attributes.shape));
  DUBSAR_TRY(labels("AMBO", ExaLabel::kLight, model.attributes.ao));
  DUBSAR_TRY(labels("QPAR", ExaLabel::kPartition, model.quad_partition));
  if (reader.has("PART")) {
    DUBSAR_ASSIGN(const std::string text, reader.text("PART"));
    DUBSAR_ASSIGN(model.partitions, parse_exa_partitions(text));
  }
  if (reader.has("FILL")) {
    DUBSAR_ASSIGN(const ExaChunks patches, reader.chunks("FILL", kCodec));
    DUBSAR_ASSIGN(model.patches, decode_patches(patches.chunks, model.mesh.vertex_count()));
  }
  if (reader.has("PROV")) {
    DUBSAR_ASSIGN(model.provenance, reader.text("PROV"));
  }
  return {};
}

struct LoadedSigns {
  std::vector<ExaChunks> blocks;
  SignChunks chunks;
};

Result<LoadedSigns> load_signs(const ExaReader& reader, int level, const std::function<bool(std::size_t)>& wanted) {
  LoadedSigns loaded;
  DUBSAR_ASSIGN(ExaChunks coarse, reader.chunks("SIGC", kCodec));
  loaded.chunks.coarse = coarse.chunks;
  loaded.blocks.push_back(std::move(coarse));
  for (int l = kBrickLevels - 1; l >= level; --l) {
    DUBSAR_ASSIGN(ExaChunks block, reader.chunks(kSignBlocks[static_cast<std::size_t>(l)], kCodec, wanted));
    loaded.chunks.bricks[static_cast<std::size_t>(l)] = block.chunks;
    loaded.blocks.push_back(std::move(block));
  }
  return loaded;
}

SurfaceSamples empty_samples(const ExaHeader& header) {
  SurfaceSamples samples;
  samples.dims = header.dims;
  samples.isovalue = header.isovalue;
  samples.offset_bits = header.offset_bits;
  samples.closed = header.closed;
  return samples;
}

Result<SurfaceModel> decode_model(const ExaReader& reader, Progress& progress) {
  DUBSAR_TRY(reader.check_sums());  // before anything is decoded: a damaged file costs next to nothing
  DUBSAR_ASSIGN(const ExaHeader header, reader.header());
  DUBSAR_TRY(check_memory("exa", exa_memory_bound(header)));
  SurfaceModel model;
  model.frame = header.frame;
  model.samples = empty_samples(header);
  SurfaceSamples& samples = model.samples;
  {
    DUBSAR_ASSIGN(const LoadedSigns loaded, load_signs(reader, 0, {}));
    DUBSAR_ASSIGN(samples.signs, decode_signs(loaded.chunks, header.dims, 0, std::nullopt,
                                              most_coded_signs(static_cast<std::uint64_t>(header.edges)), progress));
  }
  const SampleCounts counts = count_samples(samples.signs);
  if (counts.edges != header.edges || counts.faces != header.faces)
    return fail(ErrorKind::kBadData, "exa: {} active edges and {} ambiguous faces found, the header says {} and {}",
                counts.edges, counts.faces, header.edges, header.faces);
  {
    DUBSAR_ASSIGN(const ExaChunks offsets, reader.chunks("OFFS", kCodec));
    DUBSAR_ASSIGN(const ExaChunks faces, reader.chunks("FACE", kCodec));
    DUBSAR_TRY(decode_samples(offsets.chunks, faces.chunks, samples, progress));
  }
  DUBSAR_ASSIGN(model.mesh, build_quad_mesh(samples, progress));
  if (model.mesh.vertex_count() != header.vertices || model.mesh.quad_count() != header.quads)
    return fail(ErrorKind::kBadData, "exa: {} vertices and {} x-quads found, the header says {} and {}",
                model.mesh.vertex_count(), model.mesh.quad_count(), header.vertices, header.quads);
  DUBSAR_TRY(decode_positions(reader, model, progress));
  if (position_sum_of(model) != header.position_sum || quad_sum_of(model.mesh) != header.quad_sum)
    return fail(ErrorKind::kBadData, "exa: the mesh built from this file is not the one that was written");
  DUBSAR_TRY(decode_normals(reader, header, model, progress));
  DUBSAR_TRY(decode_attributes(reader, model, progress));
  return model;
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

/// A mesh of samples without attributes, its frame moved and scaled.
Result<SurfaceModel> bare_model(SurfaceSamples samples, const GridFrame& frame, const glm::dvec3& low, double scale,
                                Progress& progress) {
  SurfaceModel model;
  model.frame = frame;
  model.frame.origin_vox = frame.input_vox_from_grid(low);
  model.frame.scale = frame.scale * scale;
  model.samples = std::move(samples);
  DUBSAR_ASSIGN(model.mesh, build_quad_mesh(model.samples, progress));
  return model;
}

Result<SurfaceModel> decode_level(const ExaReader& reader, int level, Progress& progress) {
  DUBSAR_ASSIGN(const ExaHeader header, reader.header());
  DUBSAR_TRY(check_memory("exa", exa_memory_bound(header)));
  DUBSAR_ASSIGN(const LoadedSigns loaded, load_signs(reader, level, {}));
  SurfaceSamples samples = empty_samples(header);
  samples.dims = level_dims(header.dims, level);
  samples.closed = true;
  samples.offset_bits = 16;
  DUBSAR_ASSIGN(samples.signs, decode_signs(loaded.chunks, header.dims, level, std::nullopt,
                                            most_coded_signs(static_cast<std::uint64_t>(header.edges)), progress));
  const SampleCounts counts = count_samples(samples.signs);
  if (static_cast<std::uint64_t>(counts.edges) > most_coded_signs(static_cast<std::uint64_t>(header.edges)))
    return fail(ErrorKind::kBadData, "exa: {} active edges found on level {}, the whole surface has {}", counts.edges,
                level, header.edges);
  samples.offsets.assign(static_cast<std::size_t>(counts.edges), 1 << 15);
  samples.joined.assign(static_cast<std::size_t>(counts.faces), 0);
  return bare_model(std::move(samples), header.frame, glm::dvec3(0.0), std::exp2(level), progress);
}

Result<SurfaceModel> decode_box(const ExaReader& reader, const GridBox& box, Progress& progress) {
  DUBSAR_ASSIGN(const ExaHeader header, reader.header());
  const Dims& dims = header.dims;
  const std::array<std::int64_t, 3> size{dims.x, dims.y, dims.z};
  std::array<std::int64_t, 3> first{}, last{}, low{}, points{};  // bricks, points
  const Dims grid = brick_grid(dims);
  const std::array<std::int64_t, 3> bricks{grid.x, grid.y, grid.z};
  for (std::size_t a = 0; a < 3; ++a) {
    if (box.low[a] > box.high[a] || box.high[a] < 0 || box.low[a] >= size[a])
      return fail(ErrorKind::kUsage, "exa: the box {}..{} along axis {} lies outside of the grid of {} points",
                  box.low[a], box.high[a], a, size[a]);
    first[a] = std::min(std::max<std::int64_t>(box.low[a], 0) / kBrickCells, bricks[a] - 1);
    last[a] = std::min(box.high[a] / kBrickCells, bricks[a] - 1);
    low[a] = first[a] * kBrickCells;
    points[a] = std::min((last[a] + 1) * kBrickCells + 1, size[a]) - low[a];
  }
  DUBSAR_TRY(check_memory("exa", exa_memory_bound(header)));
  const auto wanted = [&](std::size_t index) {
    const auto i = static_cast<std::int64_t>(index);
    const std::array<std::int64_t, 3> at{i % grid.x, i / grid.x % grid.y, i / grid.slice()};
    return at[0] >= first[0] && at[0] <= last[0] && at[1] >= first[1] && at[1] <= last[1] && at[2] >= first[2] &&
           at[2] <= last[2];
  };
  DUBSAR_ASSIGN(const LoadedSigns loaded, load_signs(reader, 0, wanted));
  GridBox closed;
  for (std::size_t a = 0; a < 3; ++a) {
    closed.low[a] = low[a] + 1;  // inside, so that bricks that only touch a side stay out
    closed.high[a] = low[a] + points[a] - 2;
  }
  DUBSAR_ASSIGN(const BitVolume whole,
                decode_signs(loaded.chunks, dims, 0, closed, most_coded_signs(static_cast<std::uint64_t>(header.edges)),
                             progress));
  SurfaceSamples samples = empty_samples(header);
  samples.dims = {points[0], points[1], points[2]};
  samples.closed = false;
  samples.signs = BitVolume(samples.dims);
  for (std::int64_t z = 0; z < points[2]; ++z)
    for (std::int64_t y = 0; y < points[1]; ++y)
      for (std::int64_t x = 0; x < points[0]; ++x)
        samples.signs.set(x, y, z, whole.get(low[0] + x, low[1] + y, low[2] + z));
  DUBSAR_ASSIGN(const ExaChunks offsets, reader.chunks("OFFS", kCodec, wanted));
  DUBSAR_ASSIGN(const ExaChunks faces, reader.chunks("FACE", kCodec, wanted));
  std::vector<std::string_view> own_offsets, own_faces;
  for (std::size_t i = 0; i < offsets.chunks.size() && i < faces.chunks.size(); ++i) {
    if (!wanted(i)) continue;
    own_offsets.push_back(offsets.chunks[i]);
    own_faces.push_back(faces.chunks[i]);
  }
  DUBSAR_TRY(decode_samples(own_offsets, own_faces, samples, progress));
  return bare_model(std::move(samples), header.frame, glm::dvec3(low[0], low[1], low[2]), 1.0, progress);
}
}  // namespace

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
  header.edges = static_cast<std::int64_t>(model.samples.offsets.size());
  header.faces = static_cast<std::int64_t>(model.samples.joined.size());
  header.position_sum = position_sum_of(model);
  header.quad_sum = quad_sum_of(model.mesh);
  header.tool = "dubsar " DUBSAR_VERSION;
  DUBSAR_TRY(find_normals(model, header, progress));

  BlockList blocks;
  DUBSAR_ASSIGN(std::string text, exa_header_json(header));
  blocks.add("HEAD", true, {std::move(text)});
  if (!model.partitions.empty()) {
    DUBSAR_ASSIGN(std::string table, exa_partitions_json(model.partitions));
    blocks.add("PART", false, {std::move(table)});
  }
  if (!model.provenance.empty()) blocks.add("PROV", false, {model.provenance});
  DUBSAR_ASSIGN(const SignCode signs, encode_signs(model.samples.signs, progress));
  blocks.add("SIGC", true, signs.coarse);
  for (std::size_t level = kBrickLevels; level-- > 0;) blocks.add(kSignBlocks[level], true, signs.bricks[level]);
  DUBSAR_ASSIGN(const SampleCode samples, encode_samples(model.samples, progress));
  blocks.add("FACE", true, samples.faces);
  blocks.add("OFFS", true, samples.offsets);
  DUBSAR_TRY(add_positions(model, base, blocks, progress));
  const VertexAttributes& a = model.attributes;
  if (header.normals == ExaNormals::kExact) {
    if (!a.normals.empty()) blocks.add("NORM", false, encode_floats(floats_of(a.normals), 3, progress));
    if (header.curvatures) {
      std::vector<float> pairs(2 * a.k_min.size());
      for (std::size_t v = 0; v < a.k_min.size(); ++v) {
        pairs[2 * v] = a.k_min[v];
        pairs[2 * v + 1] = a.k_max[v];
      }
      blocks.add("CURV", false, encode_floats(pairs, 2, progress));
    }
  }
  const auto labels = [&](const char* type, ExaLabel label, const std::vector<std::uint8_t>& values) {
    if (!values.empty()) blocks.add(type, false, encode_labels(label, model.mesh, values, progress));
  };
  labels("SHAP", ExaLabel::kShape, a.shape);
  labels("AMBO", ExaLabel::kLight, a.ao);
  labels("QPAR", ExaLabel::kPartition, model.quad_partition);
  if (!model.patches.empty()) blocks.add("FILL", false, encode_patches(model.patches, model.mesh.vertex_count()));
  if (progress.cancelled()) return cancelled_error();
  return blocks.take();
}

Result<SurfaceModel> decode_exa(std::string_view file, Progress& progress) {
  DUBSAR_ASSIGN(const ExaReader reader, ExaReader::open(file));
  return decode_model(reader, progress);
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
  return with_file<SurfaceModel>(path, [&](const ExaReader& reader) { return decode_model(reader, progress); });
}

Result<SurfaceModel> read_exa_level(const std::filesystem::path& path, int level, Progress& progress) {
  if (level < 1 || level > kBrickLevels)
    return fail(ErrorKind::kUsage, "exa: level {} asked for, 1 to {} expected", level, kBrickLevels);
  return with_file<SurfaceModel>(path, [&](const ExaReader& reader) { return decode_level(reader, level, progress); });
}

Result<SurfaceModel> read_exa_box(const std::filesystem::path& path, const GridBox& box, Progress& progress) {
  return with_file<SurfaceModel>(path, [&](const ExaReader& reader) { return decode_box(reader, box, progress); });
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
