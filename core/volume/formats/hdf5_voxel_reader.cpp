#include "core/volume/formats/hdf5_voxel_reader.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <utility>

#include "core/base/system/parallel.h"
#include "core/hdf5/chunk_filters.h"

namespace dubsar {
namespace {

constexpr std::int64_t kRowsAtOnce = 256;  // where there are no chunks

std::vector<std::uint64_t> shape(std::size_t rank) { return std::vector<std::uint64_t>(rank, 1); }

class LibraryReader : public VoxelReader {
 public:
  /// `type`: what plain numbers are read as, of their own size.
  LibraryReader(std::shared_ptr<Hdf5File> file, Hdf5Dataset dataset, ScalarType type,
                const std::array<std::size_t, 3>& axes, const ScalarMap& map)
      : file_(std::move(file)), dataset_(std::move(dataset)), axes_(axes) {
    const Hdf5DatasetInfo& info = dataset_.info();
    format_ =
        info.plain_scalar ? NumberFormat{type, info.order, map} : NumberFormat{ScalarType::kF64, kNativeOrder, map};
  }

  const NumberFormat& format() const noexcept override { return format_; }

  Dims dims() const noexcept override {
    const auto& dims = dataset_.info().dims;
    return {static_cast<std::int64_t>(dims[axes_[2]]), static_cast<std::int64_t>(dims[axes_[1]]),
            static_cast<std::int64_t>(dims[axes_[0]])};
  }

  Dims chunk() const noexcept override {
    const auto& info = dataset_.info();
    if (info.layout != Hdf5Layout::kChunked) return {1, 1, 1};
    return {static_cast<std::int64_t>(info.chunk[axes_[2]]), static_cast<std::int64_t>(info.chunk[axes_[1]]),
            static_cast<std::int64_t>(info.chunk[axes_[0]])};
  }

  // Layer by layer of chunks, and rows of chunks where not all voxels are wanted: the library decodes a chunk once for
  // every call that touches it.
  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    const Dims size = box.dims();
    const std::int64_t element = scalar_bytes(format_.type);
    const bool all = box.x.step == 1 && box.y.step == 1 && box.z.step == 1;
    for (std::int64_t k = 0; k < size.z;) {
      const std::int64_t layer_end = all ? box.z.end : std::min(box.z.end, layer_of(box.z.at(k)).end);
      const AxisRange z{box.z.at(k), layer_end, box.z.step};
      const auto target = out.subspan(static_cast<std::size_t>(k * size.x * size.y * element));
      DUBSAR_TRY(all ? load({box.x, box.y, z}, target) : pick({box.x, box.y, z}, target));
      k += z.count();
    }
    return {};
  }

 protected:
  std::shared_ptr<Hdf5File> file_;
  Hdf5Dataset dataset_;
  std::array<std::size_t, 3> axes_;
  NumberFormat format_;

 private:
  // All voxels between the ends of the ranges.
  Result<void> load(const VoxelBox& box, std::span<std::byte> out) const {
    const auto& info = dataset_.info();
    auto offset = std::vector<std::uint64_t>(info.dims.size(), 0), count = shape(info.dims.size());
    const AxisRange ranges[3] = {box.z, box.y, box.x};
    std::uint64_t numbers = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      offset[axes_[i]] = static_cast<std::uint64_t>(ranges[i].begin);
      count[axes_[i]] = static_cast<std::uint64_t>(ranges[i].end - ranges[i].begin);
      numbers *= count[axes_[i]];
    }
    out = out.first(numbers * static_cast<std::uint64_t>(scalar_bytes(format_.type)));
    if (info.plain_scalar) return dataset_.read_stored(offset, count, out);
    std::vector<double> values(numbers);
    DUBSAR_TRY(dataset_.read_doubles(offset, count, values));
    std::memcpy(out.data(), values.data(), out.size());
    return {};
  }

  Result<void> pick(const VoxelBox& box, std::span<std::byte> out) {
    const Dims size = box.dims();
    const std::int64_t element = scalar_bytes(format_.type);
    const std::int64_t depth = chunk().y > 1 ? chunk().y : kRowsAtOnce;
    for (std::int64_t j = 0; j < size.y;) {
      const std::int64_t begin = box.y.at(j), end = std::min(box.y.end, (begin / depth + 1) * depth);
      const AxisRange y{begin, end, box.y.step};
      const std::int64_t row = box.x.end - box.x.begin;
      stored_.resize(static_cast<std::size_t>((box.z.end - box.z.begin) * (end - begin) * row * element));
      DUBSAR_TRY(load({{box.x.begin, box.x.end, 1}, {begin, end, 1}, {box.z.begin, box.z.end, 1}}, stored_));
      for (std::int64_t k = 0; k < size.z; ++k)
        for (std::int64_t r = 0; r < y.count(); ++r)
          copy_row(stored_.data() + (k * box.z.step * (end - begin) + r * y.step) * row * element, element,
                   {0, row, box.x.step}, out.data() + ((k * size.y + j + r) * size.x) * element);
      j += y.count();
    }
    return {};
  }

  std::vector<std::byte> stored_;
};

class ChunkReader final : public LibraryReader {
 public:
  ChunkReader(std::shared_ptr<Hdf5File> file, Hdf5Dataset dataset, ScalarType type,
              const std::array<std::size_t, 3>& axes, const ScalarMap& map)
      : LibraryReader(std::move(file), std::move(dataset), type, axes, map) {
    const auto& info = dataset_.info();
    for (std::size_t i = 0; i < 3; ++i) chunk_[i] = static_cast<std::int64_t>(info.chunk[axes_[i]]);
    for (const Hdf5Filter& filter : info.filters) filters_.push_back(filter.id);
    chunk_bytes_ = static_cast<std::size_t>(chunk_[0] * chunk_[1] * chunk_[2] * scalar_bytes(*info.scalar));
  }

  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    const std::vector<Origin> chunks = chunks_in(box);
    std::mutex mutex;
    Result<void> result;
    const std::int64_t grain = std::max<std::int64_t>(1, (1 << 17) / static_cast<std::int64_t>(chunk_bytes_ + 1));
    parallel_chunks(static_cast<std::int64_t>(chunks.size()), grain, [&](std::int64_t begin, std::int64_t end) {
      ChunkScratch scratch;
      for (std::int64_t i = begin; i < end; ++i)
        if (auto done = decode(chunks[static_cast<std::size_t>(i)], box, out, scratch); !done) {
          const std::lock_guard lock(mutex);
          result = std::move(done);
        }
    });
    return result;
  }

 private:
  using Origin = std::array<std::int64_t, 3>;  ///< of a chunk: z, y, x

  std::vector<Origin> chunks_in(const VoxelBox& box) const {
    const AxisRange ranges[3] = {box.z, box.y, box.x};
    std::array<std::int64_t, 3> first{}, last{};
    for (std::size_t i = 0; i < 3; ++i) {
      first[i] = ranges[i].begin / chunk_[i];
      last[i] = ranges[i].at(ranges[i].count() - 1) / chunk_[i];
    }
    std::vector<Origin> chunks;
    for (std::int64_t z = first[0]; z <= last[0]; ++z)
      for (std::int64_t y = first[1]; y <= last[1]; ++y)
        for (std::int64_t x = first[2]; x <= last[2]; ++x)
          chunks.push_back({z * chunk_[0], y * chunk_[1], x * chunk_[2]});
    return chunks;
  }

  // The plain numbers of a chunk; empty when it was never written.
  Result<std::span<const std::byte>> unpack(const Origin& at, ChunkScratch& scratch) const {
    const auto& info = dataset_.info();
    std::vector<std::uint64_t> origin(info.dims.size(), 0);
    for (std::size_t i = 0; i < 3; ++i) origin[axes_[i]] = static_cast<std::uint64_t>(at[i]);
    // A chunk that could not be shrunk is a little larger than its numbers.
    DUBSAR_ASSIGN(const auto mask, dataset_.read_chunk(origin, 2 * chunk_bytes_ + 1024, scratch.packed));
    if (!mask) return std::span<const std::byte>();
    const auto numbers =
        undo_filters(filters_, *mask, static_cast<std::size_t>(scalar_bytes(*info.scalar)), chunk_bytes_, scratch);
    if (!numbers)
      return fail(
          ErrorKind::kBadData,
          "import_hdf5: the chunk of \"{}\" at {}, {}, {} cannot be decoded; the file is damaged, copy it again",
          info.path, at[0], at[1], at[2]);
    return *numbers;
  }

  Result<void> decode(const Origin& origin, const VoxelBox& box, std::span<std::byte> out,
                      ChunkScratch& scratch) const {
    DUBSAR_ASSIGN(const std::span<const std::byte> bytes, unpack(origin, scratch));
    const std::int64_t element = scalar_bytes(format_.type);
    const Dims size = box.dims();
    const AxisRange ranges[3] = {box.z, box.y, box.x};
    std::array<std::int64_t, 3> first{}, last{};  // indices into the box that lie in the chunk
    for (std::size_t i = 0; i < 3; ++i) {
      const AxisRange& range = ranges[i];
      const auto steps_to = [&](std::int64_t index) {
        return index <= range.begin ? 0 : (index - range.begin - 1) / range.step + 1;
      };
      first[i] = steps_to(origin[i]);
      last[i] = std::min(range.count(), steps_to(origin[i] + chunk_[i]));
    }
    if (first[2] >= last[2]) return {};
    const AxisRange x{box.x.at(first[2]), box.x.at(last[2] - 1) + 1, box.x.step};
    for (std::int64_t k = first[0]; k < last[0]; ++k)
      for (std::int64_t j = first[1]; j < last[1]; ++j) {
        std::byte* const row = out.data() + ((k * size.y + j) * size.x + first[2]) * element;
        if (bytes.empty()) {
          for (std::int64_t i = 0; i < x.count(); ++i)
            std::memcpy(row + i * element, dataset_.info().fill.stored.data(), static_cast<std::size_t>(element));
          continue;
        }
        const std::int64_t at =
            ((box.z.at(k) - origin[0]) * chunk_[1] + (box.y.at(j) - origin[1])) * chunk_[2] + x.begin - origin[2];
        copy_row(bytes.data() + at * element, element, x, row);
      }
    return {};
  }

  std::array<std::int64_t, 3> chunk_{};  ///< z, y, x
  std::vector<int> filters_;
  std::size_t chunk_bytes_ = 0;
};

}  // namespace

bool decodes_chunks(const Hdf5DatasetInfo& info, const std::array<std::size_t, 3>& axes) {
  if (info.layout != Hdf5Layout::kChunked || !info.plain_scalar) return false;
  for (std::size_t axis = 0; axis < info.chunk.size(); ++axis)
    if (std::find(axes.begin(), axes.end(), axis) == axes.end() && info.chunk[axis] != 1) return false;
  return std::all_of(info.filters.begin(), info.filters.end(),
                     [](const Hdf5Filter& filter) { return can_undo_filter(filter.id); });
}

Result<std::unique_ptr<VoxelReader>> make_hdf5_reader(std::shared_ptr<Hdf5File> file, const Hdf5DatasetInfo& info,
                                                      const std::array<std::size_t, 3>& axes, const ScalarMap& map) {
  const bool direct = decodes_chunks(info, axes);
  DUBSAR_ASSIGN(Hdf5Dataset dataset, file->open_dataset(info.path, info.layout == Hdf5Layout::kVirtual));
  if (!direct) return std::make_unique<LibraryReader>(std::move(file), std::move(dataset), *info.scalar, axes, map);
  return std::make_unique<ChunkReader>(std::move(file), std::move(dataset), *info.scalar, axes, map);
}

}  // namespace dubsar
