#include "core/volume/hdf5_voxel_reader.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "core/base/parallel.h"
#include "core/hdf5/chunk_filters.h"

namespace dubsar {
namespace {

std::vector<std::uint64_t> shape(std::size_t rank) { return std::vector<std::uint64_t>(rank, 1); }

class LibraryReader : public VoxelReader {
 public:
  LibraryReader(std::shared_ptr<Hdf5File> file, Hdf5Dataset dataset, const std::array<std::size_t, 3>& axes,
                const ScalarMap& map)
      : file_(std::move(file)), dataset_(std::move(dataset)), axes_(axes), map_(map) {}

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

  // Slice by slice through the library's chunk cache, which holds a layer of chunks.
  Result<void> read(const VoxelBox& box, std::span<float> out) override {
    const Dims size = box.dims();
    const auto& info = dataset_.info();
    auto offset = std::vector<std::uint64_t>(info.dims.size(), 0);
    auto count = shape(info.dims.size());
    const std::int64_t rows = box.y.end - box.y.begin, row = box.x.end - box.x.begin;
    offset[axes_[1]] = static_cast<std::uint64_t>(box.y.begin);
    offset[axes_[2]] = static_cast<std::uint64_t>(box.x.begin);
    count[axes_[1]] = static_cast<std::uint64_t>(rows);
    count[axes_[2]] = static_cast<std::uint64_t>(row);
    std::vector<std::byte> stored;
    std::vector<double> numbers;
    for (std::int64_t k = 0; k < size.z; ++k) {
      offset[axes_[0]] = static_cast<std::uint64_t>(box.z.at(k));
      ScalarType type = ScalarType::kF64;
      ByteOrder order = kNativeOrder;
      const std::byte* from = nullptr;
      if (info.plain_scalar) {
        type = *info.scalar;
        order = info.order;
        stored.resize(static_cast<std::size_t>(rows * row * scalar_bytes(type)));
        DUBSAR_TRY(dataset_.read_stored(offset, count, stored));
        from = stored.data();
      } else {
        numbers.resize(static_cast<std::size_t>(rows * row));
        DUBSAR_TRY(dataset_.read_doubles(offset, count, numbers));
        from = std::as_bytes(std::span(numbers)).data();
      }
      parallel_for(size.y, std::max<std::int64_t>(64, (1 << 18) / row), [&](std::int64_t j) {
        store_row(from + j * box.y.step * row * scalar_bytes(type), type, order, map_, box.x,
                  out.subspan(static_cast<std::size_t>((k * size.y + j) * size.x), static_cast<std::size_t>(size.x)));
      });
    }
    return {};
  }

 protected:
  std::shared_ptr<Hdf5File> file_;
  Hdf5Dataset dataset_;
  std::array<std::size_t, 3> axes_;
  ScalarMap map_;
};

class ChunkReader final : public LibraryReader {
 public:
  ChunkReader(std::shared_ptr<Hdf5File> file, Hdf5Dataset dataset, const std::array<std::size_t, 3>& axes,
              const ScalarMap& map)
      : LibraryReader(std::move(file), std::move(dataset), axes, map) {
    const auto& info = dataset_.info();
    for (std::size_t i = 0; i < 3; ++i) chunk_[i] = static_cast<std::int64_t>(info.chunk[axes_[i]]);
    for (const Hdf5Filter& filter : info.filters) filters_.push_back(filter.id);
    chunk_bytes_ = static_cast<std::size_t>(chunk_[0] * chunk_[1] * chunk_[2] * scalar_bytes(*info.scalar));
  }

  Result<void> read(const VoxelBox& box, std::span<float> out) override {
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

  Result<void> decode(const Origin& origin, const VoxelBox& box, std::span<float> out, ChunkScratch& scratch) const {
    DUBSAR_ASSIGN(const std::span<const std::byte> bytes, unpack(origin, scratch));
    const ScalarType type = *dataset_.info().scalar;
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
    const float fill = static_cast<float>(dataset_.info().fill_value * map_.scale + map_.offset);
    const AxisRange x{box.x.at(first[2]), box.x.at(last[2] - 1) + 1, box.x.step};
    for (std::int64_t k = first[0]; k < last[0]; ++k)
      for (std::int64_t j = first[1]; j < last[1]; ++j) {
        const std::span<float> row = out.subspan(static_cast<std::size_t>((k * size.y + j) * size.x + first[2]),
                                                 static_cast<std::size_t>(last[2] - first[2]));
        if (bytes.empty()) {
          std::fill(row.begin(), row.end(), fill);
          continue;
        }
        const std::int64_t at =
            ((box.z.at(k) - origin[0]) * chunk_[1] + (box.y.at(j) - origin[1])) * chunk_[2] + x.begin - origin[2];
        store_row(bytes.data() + at * scalar_bytes(type), type, dataset_.info().order, map_, x, row);
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
  // The library decodes a chunk again for every slice unless its cache holds a whole layer of chunks.
  constexpr std::uint64_t kMostCache = std::uint64_t{512} << 20;
  std::uint64_t layer = info.element_bytes();
  for (std::size_t axis = 0; axis < info.chunk.size(); ++axis)
    layer *= axis == axes[0] ? info.chunk[axis]
                             : (info.dims[axis] + info.chunk[axis] - 1) / info.chunk[axis] * info.chunk[axis];
  const std::uint64_t cache = direct ? 0 : std::min(layer, kMostCache);
  DUBSAR_ASSIGN(Hdf5Dataset dataset, file->open_dataset(info.path, cache, info.layout == Hdf5Layout::kVirtual));
  if (!direct) return std::make_unique<LibraryReader>(std::move(file), std::move(dataset), axes, map);
  return std::make_unique<ChunkReader>(std::move(file), std::move(dataset), axes, map);
}

}  // namespace dubsar
