#include "core/extract/edge_index.h"

#include <limits>

#include "core/base/system/parallel.h"
#include "core/extract/row_kernels.h"

namespace dubsar {
namespace {

constexpr std::int64_t kMaxItems = std::int64_t{std::numeric_limits<std::uint32_t>::max()} - 1;

}  // namespace

const std::uint64_t* EdgeIndex::virtual_row(int axis, std::int64_t y, std::int64_t z) const noexcept {
  if (axis == 1 && z >= 0 && z < dims_.z && (y == -1 || y == dims_.y - 1))
    return samples_->signs.row(y == -1 ? 0 : y, z);
  if (axis == 2 && y >= 0 && y < dims_.y && (z == -1 || z == dims_.z - 1))
    return samples_->signs.row(y, z == -1 ? 0 : z);
  return nullptr;
}

std::array<std::uint32_t, 3> EdgeIndex::count_virtual(std::int64_t y, std::int64_t z) const noexcept {
  std::array<std::uint32_t, 3> counts{};
  if (y >= 0 && z >= 0) {
    counts[0] = std::uint32_t{samples_->signs.get(0, y, z)} + std::uint32_t{samples_->signs.get(dims_.x - 1, y, z)};
  }
  for (const int axis : {1, 2}) {
    const std::uint64_t* row = virtual_row(axis, y, z);
    if (row != nullptr) counts[static_cast<std::size_t>(axis)] = count_ones(row, dims_.x);
  }
  return counts;
}

Result<EdgeIndex> EdgeIndex::create(const SurfaceSamples& samples) {
  EdgeIndex index(samples);
  const Dims& dims = samples.dims;
  const std::int64_t rows = dims.y * dims.z;
  index.starts_.resize(static_cast<std::size_t>(rows));
  parallel_for(rows, rows_per_chunk(dims.x), [&](std::int64_t r) {
    const std::int64_t y = r % dims.y, z = r / dims.y;
    const bool has_y = y + 1 < dims.y, has_z = z + 1 < dims.z;
    const BitVolume& signs = samples.signs;
    const RowItems items =
        count_row({signs.row(y, z), has_y ? signs.row(y + 1, z) : nullptr, has_z ? signs.row(y, z + 1) : nullptr,
                   has_y && has_z ? signs.row(y + 1, z + 1) : nullptr},
                  dims.x);
    index.starts_[static_cast<std::size_t>(r)] = {items.edges, items.faces};
  });
  std::int64_t edges = 0, faces = 0;
  for (RowStarts& row : index.starts_) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t row_edges = row.edges[a], row_faces = row.faces[a];
      row.edges[a] = static_cast<std::uint32_t>(edges);
      row.faces[a] = static_cast<std::uint32_t>(faces);
      edges += row_edges;
      faces += row_faces;
    }
  }
  index.counts_ = {edges, faces};

  // Rows of the extended grid; most have virtual edges at their ends only.
  std::vector<std::uint32_t>& virtual_starts = index.virtual_starts_;
  virtual_starts.resize(static_cast<std::size_t>((dims.y + 1) * (dims.z + 1)));
  parallel_for(dims.z + 1, 1, [&](std::int64_t layer) {
    for (std::int64_t y = -1; y < dims.y; ++y) {
      const auto counts = index.count_virtual(y, layer - 1);
      virtual_starts[static_cast<std::size_t>(layer * (dims.y + 1) + y + 1)] = counts[0] + counts[1] + counts[2];
    }
  });
  std::int64_t virtual_edges = 0;
  for (std::uint32_t& row : virtual_starts) {
    const std::uint32_t row_edges = row;
    row = static_cast<std::uint32_t>(edges + virtual_edges);
    virtual_edges += row_edges;
  }
  index.virtual_edges_ = virtual_edges;
  if (edges + virtual_edges > kMaxItems || faces > kMaxItems) {
    return fail(ErrorKind::kTryAgain,
                "extract: the surface has {} x-quads, at most {} can be numbered: choose another isovalue, denoise or "
                "crop the volume",
                edges + virtual_edges, kMaxItems);
  }
  return index;
}

bool EdgeIndex::is_virtual(int axis, std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
  if (x < 0 || y < 0 || z < 0) return true;
  return axis == 0 ? x == dims_.x - 1 : axis == 1 ? y == dims_.y - 1 : z == dims_.z - 1;
}

std::uint32_t EdgeIndex::first_along(int axis, std::int64_t y, std::int64_t z) const noexcept {
  if (axis == 0) return has_row(y, z) ? starts(y, z).edges[0] : 0;
  const bool at_layer = axis == 1 ? y == -1 || y == dims_.y - 1 : z == -1 || z == dims_.z - 1;
  if (!at_layer) return has_row(y, z) ? starts(y, z).edges[static_cast<std::size_t>(axis)] : 0;
  if (virtual_row(axis, y, z) == nullptr) return 0;
  const auto counts = count_virtual(y, z);
  return virtual_start(y, z) + counts[0] + (axis == 2 ? counts[1] : 0);
}

std::uint32_t EdgeIndex::end_of_row(std::int64_t y, std::int64_t z, bool high) const noexcept {
  if (!has_row(y, z)) return 0;
  return virtual_start(y, z) + (high ? std::uint32_t{samples_->signs.get(0, y, z)} : 0u);
}

std::uint32_t EdgeIndex::quad_of(int axis, std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
  const BitVolume& signs = samples_->signs;
  if (!is_virtual(axis, x, y, z)) {
    const std::uint32_t start = starts(y, z).edges[static_cast<std::size_t>(axis)];
    if (axis == 0) return start + count_changes(signs.row(y, z), x);
    return start + count_differences(signs.row(y, z), axis == 1 ? signs.row(y + 1, z) : signs.row(y, z + 1), x);
  }
  if (axis == 0) return end_of_row(y, z, x >= 0);
  return first_along(axis, y, z) + count_ones(virtual_row(axis, y, z), x);
}

}  // namespace dubsar
