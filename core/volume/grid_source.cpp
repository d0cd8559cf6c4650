#include "core/volume/grid_source.h"

#include <algorithm>
#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kCopyBytes = 16 << 20;    // stored numbers on their way to floats
constexpr std::int64_t kConvertGrain = 1 << 16;  // voxels

std::span<std::byte> bytes_of(Buffer<std::byte>& buffer, std::int64_t count) {
  if (buffer.size() < count) buffer = Buffer<std::byte>(count);
  return buffer.span().first(static_cast<std::size_t>(count));
}

}  // namespace

GridSource::GridSource(std::unique_ptr<VoxelReader> reader, const VoxelBox& box, VoxelSize voxel, Budget budget)
    : reader_(std::move(reader)), box_(box), dims_(box.dims()), budget_(std::move(budget)) {
  budget_.memory_bytes = budget_.limit_bytes();  // the same for every layer
  frame_.scale = {box.x.step, box.y.step, box.z.step};
  frame_.origin_vox = {box.x.begin, box.y.begin, box.z.begin};
  frame_.input_voxel = std::move(voxel);
}

GridSource::Slices GridSource::layer_of(std::int64_t k) const noexcept {
  const AxisRange layer = reader_->layer_of(box_.z.at(k));
  const auto first_at = [&](std::int64_t z) {
    return z <= box_.z.begin ? 0 : std::min(dims_.z, (z - box_.z.begin - 1) / box_.z.step + 1);
  };
  return {first_at(layer.begin), first_at(layer.end)};
}

std::int64_t GridSource::preferred_height() const noexcept {
  const Slices layer = layer_of(std::min(dims_.z / 2, dims_.z - 1));
  return std::max<std::int64_t>(1, layer.end - layer.begin);
}

VoxelBox GridSource::box_of(const Slices& slices) const noexcept {
  VoxelBox box = box_;
  box.z.begin = box_.z.at(slices.begin);
  box.z.end = box_.z.at(slices.end - 1) + 1;
  return box;
}

void GridSource::convert(const std::byte* from, std::span<float> out) const {
  const NumberFormat format = reader_->format();
  const std::int64_t bytes = scalar_bytes(format.type);
  parallel_chunks(static_cast<std::int64_t>(out.size()), kConvertGrain, [&](std::int64_t begin, std::int64_t end) {
    scalars_to_float(from + begin * bytes, format.type, format.order, format.map,
                     out.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
  });
}

Result<void> GridSource::fetch(const Slices& slices, std::span<float> out) {
  const NumberFormat format = reader_->format();
  if (format.is_native_float()) return reader_->read(box_of(slices), std::as_writable_bytes(out));
  const std::int64_t slice_bytes = dims_.slice() * scalar_bytes(format.type);
  // A layer of chunks is not split: its chunks would be decoded for each part.
  const std::int64_t whole = layer_of(slices.begin).end - slices.begin;
  const std::int64_t step = std::max<std::int64_t>({1, whole, kCopyBytes / slice_bytes});
  for (std::int64_t k = slices.begin; k < slices.end; k += step) {
    const Slices part{k, std::min(k + step, slices.end)};
    const auto stored = bytes_of(piece_, (part.end - part.begin) * slice_bytes);
    DUBSAR_TRY(reader_->read(box_of(part), stored));
    convert(stored.data(), out.subspan(static_cast<std::size_t>((k - slices.begin) * dims_.slice()),
                                       static_cast<std::size_t>((part.end - part.begin) * dims_.slice())));
  }
  return {};
}

Result<void> GridSource::keep(const Slices& layer) {
  layer_ = {};
  const std::int64_t bytes = (layer.end - layer.begin) * dims_.slice() * scalar_bytes(reader_->format().type);
  if (bytes > static_cast<std::int64_t>(budget_.kept_bytes())) {
    kept_ = {};
    DUBSAR_TRY(spill(layer));
  } else {
    scratch_.reset();
    if (kept_.size() != bytes) {
      kept_ = {};  // never two layers at a time
      kept_ = Buffer<std::byte>(bytes);
    }
    DUBSAR_TRY(reader_->read(box_of(layer), kept_.span()));
  }
  layer_ = layer;
  return {};
}

// By rows of chunks: one that crosses the layer in x holds whole rows of every slice.
Result<void> GridSource::spill(const Slices& layer) {
  if (!scratch_) {
    DUBSAR_ASSIGN(scratch_, ScratchFile::create(budget_.scratch_folder));
  }
  const std::int64_t element = scalar_bytes(reader_->format().type), depth = reader_->chunk().y;
  const std::int64_t row = dims_.x * element, height = layer.end - layer.begin;
  for (std::int64_t j = 0; j < dims_.y;) {
    VoxelBox band = box_of(layer);
    band.y.begin = box_.y.at(j);
    band.y.end = std::min(box_.y.end, (band.y.begin / depth + 1) * depth);
    const std::int64_t rows = band.y.count();
    const auto stored = bytes_of(piece_, height * rows * row);
    DUBSAR_TRY(reader_->read(band, stored));
    for (std::int64_t k = 0; k < height; ++k)
      DUBSAR_TRY(scratch_->write_at((k * dims_.y + j) * row, stored.subspan(static_cast<std::size_t>(k * rows * row),
                                                                            static_cast<std::size_t>(rows * row))));
    j += rows;
  }
  return {};
}

Result<void> GridSource::from_kept(const Slices& slices, std::span<float> out) {
  const std::int64_t slice_bytes = dims_.slice() * scalar_bytes(reader_->format().type);
  if (!scratch_) {
    convert(kept_.data() + (slices.begin - layer_.begin) * slice_bytes, out);
    return {};
  }
  for (std::int64_t k = slices.begin; k < slices.end; ++k) {
    const auto stored = bytes_of(piece_, slice_bytes);
    DUBSAR_TRY(scratch_->read_at((k - layer_.begin) * slice_bytes, stored));
    convert(stored.data(), out.subspan(static_cast<std::size_t>((k - slices.begin) * dims_.slice()),
                                       static_cast<std::size_t>(dims_.slice())));
  }
  return {};
}

Result<void> GridSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= dims_.z);
  DUBSAR_CHECK(static_cast<std::int64_t>(out.size()) >= (z_end - z_begin) * dims_.slice());
  const auto target = [&](const Slices& slices) {
    return out.subspan(static_cast<std::size_t>((slices.begin - z_begin) * dims_.slice()),
                       static_cast<std::size_t>((slices.end - slices.begin) * dims_.slice()));
  };
  for (std::int64_t k = z_begin; k < z_end;) {
    const Slices layer = layer_of(k);
    if (reader_->layer_of(box_.z.at(k)).count() <= 1) {  // slices that stand alone: all that are asked for at once
      return fetch({k, z_end}, target({k, z_end}));
    }
    const Slices wanted{k, std::min(layer.end, z_end)};
    if (layer_ != layer && wanted == layer) {
      DUBSAR_TRY(fetch(wanted, target(wanted)));
    } else {
      if (layer_ != layer) DUBSAR_TRY(keep(layer));
      DUBSAR_TRY(from_kept(wanted, target(wanted)));
    }
    k = wanted.end;
  }
  return {};
}

}  // namespace dubsar
