#include "core/volume/oriented_reader.h"

#include <algorithm>
#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPieceVoxels = 8 << 20;
constexpr std::int64_t kTile = 32;  // voxels a side: both sides of a transposition stay in the first-level cache

std::array<std::int64_t, 3> as_array(const Dims& dims) { return {dims.x, dims.y, dims.z}; }

/// The same indices counted from the far end, rising.
AxisRange backwards(const AxisRange& range, std::int64_t length) {
  const std::int64_t begin = length - 1 - range.at(range.count() - 1);
  return {begin, length - range.begin, range.step};
}

/// Where the voxels of a stored box go: a step in `out` for each stored axis, fastest first.
struct Target {
  std::array<std::int64_t, 3> step{};
  std::int64_t begin = 0;  ///< of the first stored voxel
};

template <class Number>
void scatter(const Number* from, const std::array<std::int64_t, 3>& size, const Target& to, Number* out) {
  if (to.step[0] == 1 || to.step[0] == -1) {
    parallel_for(size[1] * size[2], std::max<std::int64_t>(1, (1 << 16) / size[0]), [&](std::int64_t row) {
      const Number* in = from + row * size[0];
      Number* target = out + to.begin + row % size[1] * to.step[1] + row / size[1] * to.step[2];
      for (std::int64_t i = 0; i < size[0]; ++i) target[i * to.step[0]] = in[i];
    });
    return;
  }
  // The stored axis whose voxels become neighbours, against the one whose voxels are neighbours.
  const std::size_t across = std::abs(to.step[1]) == 1 ? 1 : 2, other = 3 - across;
  const std::array<std::int64_t, 3> in_step{1, size[0], size[0] * size[1]};
  const std::int64_t tiles_fast = (size[0] + kTile - 1) / kTile, tiles_across = (size[across] + kTile - 1) / kTile;
  parallel_for(tiles_fast * tiles_across * size[other], 16, [&](std::int64_t tile) {
    const std::int64_t k = tile / (tiles_fast * tiles_across);
    const std::int64_t i0 = tile % tiles_fast * kTile, j0 = tile / tiles_fast % tiles_across * kTile;
    const std::int64_t i1 = std::min(i0 + kTile, size[0]), j1 = std::min(j0 + kTile, size[across]);
    for (std::int64_t i = i0; i < i1; ++i) {
      const Number* in = from + i + k * in_step[other];
      Number* target = out + to.begin + i * to.step[0] + k * to.step[other];
      for (std::int64_t j = j0; j < j1; ++j) target[j * to.step[across]] = in[j * in_step[across]];
    }
  });
}

template <class Number>
void scatter_bytes(const std::vector<std::byte>& from, const std::array<std::int64_t, 3>& size, const Target& to,
                   std::span<std::byte> out) {
  scatter(reinterpret_cast<const Number*>(from.data()), size, to, reinterpret_cast<Number*>(out.data()));
}

}  // namespace

OrientedReader::OrientedReader(std::unique_ptr<VoxelReader> stored, const AxisOrder& order, std::uint64_t layer_bytes)
    : stored_(std::move(stored)), order_(order) {
  const auto size = by_axis(order_, as_array(stored_->dims()));
  dims_ = {size[0], size[1], size[2]};
  const std::int64_t slice_bytes = dims_.slice() * scalar_bytes(stored_->format().type);
  layer_ = std::clamp<std::int64_t>(static_cast<std::int64_t>(layer_bytes) / slice_bytes, 1, dims_.z);
}

Dims OrientedReader::chunk() const noexcept {
  const auto size = by_axis(order_, as_array(stored_->chunk()));
  return {size[0], size[1], size[2]};
}

AxisRange OrientedReader::layer_of(std::int64_t z) const noexcept {
  const bool backward = order_.backwards[2];
  const auto here = [&](std::int64_t stored_begin, std::int64_t stored_end) {
    return backward ? AxisRange{dims_.z - stored_end, dims_.z - stored_begin, 1}
                    : AxisRange{stored_begin, stored_end, 1};
  };
  const std::int64_t at = backward ? dims_.z - 1 - z : z;
  if (order_.stored[2] == 2 && !(backward && stored_->sequential())) {
    const AxisRange layer = stored_->layer_of(at);
    return here(layer.begin, layer.end);
  }
  const std::int64_t depth = chunk().z > 1 ? chunk().z : layer_;
  const std::int64_t begin = at / depth * depth;
  return here(begin, std::min(begin + depth, dims_.z));
}

Result<void> OrientedReader::read(const VoxelBox& box, std::span<std::byte> out) {
  const std::int64_t element = scalar_bytes(stored_->format().type);
  const std::array<AxisRange, 3> ranges{box.x, box.y, box.z};
  const std::array<std::int64_t, 3> length = as_array(dims_), count = as_array(box.dims());
  const std::array<std::int64_t, 3> step{1, count[0], count[0] * count[1]};
  std::array<AxisRange, 3> stored{};
  Target target;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto to = static_cast<std::size_t>(order_.stored[axis]);
    const bool backward = order_.backwards[axis];
    stored[to] = backward ? backwards(ranges[axis], length[axis]) : ranges[axis];
    target.step[to] = backward ? -step[axis] : step[axis];
    if (backward) target.begin += (count[axis] - 1) * step[axis];
  }
  // Pieces end where chunks end, so that none is decoded for two of them.
  const std::int64_t depth = std::max<std::int64_t>(1, stored_->chunk().z);
  const std::int64_t plane = stored[0].count() * stored[1].count();
  const std::int64_t layers = std::max<std::int64_t>(1, kPieceVoxels / std::max<std::int64_t>(1, plane * depth));
  for (std::int64_t i = 0; i < stored[2].count();) {
    const std::int64_t stop = (stored[2].at(i) / depth + layers) * depth;
    AxisRange part{stored[2].at(i), std::min(stop, stored[2].end), stored[2].step};
    const std::array<std::int64_t, 3> size{stored[0].count(), stored[1].count(), part.count()};
    piece_.resize(static_cast<std::size_t>(size[0] * size[1] * size[2] * element));
    DUBSAR_TRY(stored_->read({stored[0], stored[1], part}, piece_));
    const auto place = element == 1   ? scatter_bytes<std::uint8_t>
                       : element == 2 ? scatter_bytes<std::uint16_t>
                       : element == 4 ? scatter_bytes<std::uint32_t>
                                      : scatter_bytes<std::uint64_t>;
    place(piece_, size, target, out);
    target.begin += size[2] * target.step[2];
    i += size[2];
  }
  return {};
}

}  // namespace dubsar
