#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/system/budget.h"
#include "core/exa/exa_blocks.h"
#include "core/exa/exa_decode.h"
#include "core/exa/offsets/offsets.h"
#include "core/extract/extract.h"

namespace dubsar {
namespace {
/// A mesh of samples without attributes, its frame moved and scaled.
Result<SurfaceModel> bare_model(SurfaceSamples samples, const ExaHeader& header, const glm::dvec3& low, double scale,
                                Progress& progress) {
  SurfaceModel model;
  const GridFrame& frame = header.frame;
  model.frame = frame;
  model.frame.origin_vox = frame.input_vox_from_grid(low);
  model.frame.scale = frame.scale * scale;
  model.samples = std::move(samples);
  DUBSAR_ASSIGN(model.mesh, build_quad_mesh(model.samples, progress));
  model.mesh.embedded = header.sums.embedded;
  return model;
}

}  // namespace

Result<SurfaceModel> decode_level(const ExaReader& reader, int level, Progress& progress) {
  DUBSAR_ASSIGN(const ExaHeader header, reader.header());
  DUBSAR_TRY(check_memory("exa", exa_memory_bound(header)));
  SurfaceSamples samples = empty_samples(header);
  samples.dims = level_dims(header.dims, level);
  samples.closed = true;
  samples.offset_bits = 16;
  DUBSAR_ASSIGN(samples.signs, decode_level_signs(reader, header, level, progress));
  const SampleCounts counts = count_samples(samples.signs);
  if (static_cast<std::uint64_t>(counts.edges) > most_coded_signs(static_cast<std::uint64_t>(header.samples.edges)))
    return fail(ErrorKind::kBadData, "exa: {} active edges found on level {}, the whole surface has {}", counts.edges,
                level, header.samples.edges);
  samples.offsets.assign(static_cast<std::size_t>(counts.edges), 1 << 15);
  samples.joined.assign(static_cast<std::size_t>(counts.faces), 0);
  return bare_model(std::move(samples), header, glm::dvec3(0.0), std::exp2(level), progress);
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
  GridBox closed;
  for (std::size_t a = 0; a < 3; ++a) {
    closed.low[a] = low[a] + 1;  // inside, so that bricks that only touch a side stay out
    closed.high[a] = std::max(low[a], low[a] + points[a] - 2);
  }
  const std::vector<std::uint8_t> needed = bricks_of_box(dims, closed, reader.table().has(ExaFeature::kLateBricks));
  DUBSAR_ASSIGN(const LoadedSigns loaded,
                load_signs(reader, 0, [&](std::size_t i) { return i < needed.size() && needed[i] != 0; }));
  DUBSAR_ASSIGN(const BitVolume whole,
                decode_signs(loaded.chunks, dims, 0, closed,
                             most_coded_signs(static_cast<std::uint64_t>(header.samples.edges)), progress));
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
  FarSides far_sides{};
  for (std::size_t a = 0; a < 3; ++a) far_sides[a] = header.sums.far_sides && low[a] + points[a] == size[a];
  DUBSAR_TRY(decode_samples(own_offsets, own_faces, samples, progress, far_sides));
  return bare_model(std::move(samples), header, glm::dvec3(low[0], low[1], low[2]), 1.0, progress);
}

}  // namespace dubsar
