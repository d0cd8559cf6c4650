#include "core/volume/grid_source.h"

#include <algorithm>
#include <utility>

namespace dubsar {
namespace {
constexpr std::int64_t kMostLayerBytes = std::int64_t{512} << 20;
}

GridSource::GridSource(std::unique_ptr<VoxelReader> reader, const VoxelBox& box, VoxelSize voxel)
    : reader_(std::move(reader)), box_(box), dims_(box.dims()) {
  frame_.scale = {box.x.step, box.y.step, box.z.step};
  frame_.origin_vox = {box.x.begin, box.y.begin, box.z.begin};
  frame_.input_voxel = std::move(voxel);
}

Result<void> GridSource::fetch(std::int64_t k_begin, std::int64_t k_end, std::span<float> out) {
  VoxelBox box = box_;
  box.z.begin = box_.z.at(k_begin);
  box.z.end = box_.z.at(k_end - 1) + 1;
  return reader_->read(box, out);
}

Result<void> GridSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= dims_.z);
  DUBSAR_CHECK(static_cast<std::int64_t>(out.size()) >= (z_end - z_begin) * dims_.slice());
  const std::int64_t slice = dims_.slice();
  const auto slices = [&](std::int64_t count) { return static_cast<std::size_t>(count * slice); };
  const auto first_at = [&](std::int64_t z) {
    return z <= box_.z.begin ? 0 : std::min(dims_.z, (z - box_.z.begin - 1) / box_.z.step + 1);
  };
  for (std::int64_t k = z_begin; k < z_end;) {
    // The slices of the grid that share a layer of chunks with slice k.
    const AxisRange layer = reader_->layer_of(box_.z.at(k));
    if (layer.count() <= 1 && reader_->chunk().z <= 1) return fetch(k, z_end, out.subspan(slices(k - z_begin)));
    const std::int64_t begin = first_at(layer.begin), end = first_at(layer.end);
    const std::int64_t stop = std::min(end, z_end);
    const std::span<float> target = out.subspan(slices(k - z_begin), slices(stop - k));
    const bool whole = k == begin && stop == end;
    const bool cached = layer_begin_ == begin && layer_end_ == end;
    if (!cached && (whole || slices(end - begin) * sizeof(float) > static_cast<std::size_t>(kMostLayerBytes))) {
      DUBSAR_TRY(fetch(k, stop, target));
    } else {
      if (!cached) {
        layer_begin_ = layer_end_ = 0;
        layer_.resize(slices(end - begin));
        DUBSAR_TRY(fetch(begin, end, layer_));
        layer_begin_ = begin;
        layer_end_ = end;
      }
      std::copy_n(layer_.begin() + static_cast<std::ptrdiff_t>(slices(k - begin)), target.size(), target.begin());
    }
    k = stop;
  }
  return {};
}

}  // namespace dubsar
