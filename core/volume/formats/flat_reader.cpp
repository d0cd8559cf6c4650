#include "core/volume/formats/flat_reader.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "core/base/system/clock.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kReadBytes = 4 << 20;   // large enough for disks and network shares, small enough for threads
constexpr std::int64_t kGrainBytes = 1 << 20;  // less is not worth waking a thread for
constexpr double kMemoryRate = 4e9;            // bytes a second, all threads: slower ones come from a disk

class FlatReader final : public VoxelReader {
 public:
  explicit FlatReader(FlatLayout layout) : layout_(std::move(layout)) {}

  Dims dims() const noexcept override { return layout_.dims; }
  const NumberFormat& format() const noexcept override { return layout_.format; }

  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    const Dims size = box.dims();
    const std::int64_t element = scalar_bytes(layout_.format.type);
    DUBSAR_CHECK(static_cast<std::int64_t>(out.size()) >= size.count() * element);
    const std::int64_t row = layout_.dims.x * element;
    // Whole rows, and of them whole runs, are cheaper than many small reads unless most bytes would be thrown away.
    const bool narrow = (box.x.end - box.x.begin) * 4 < layout_.dims.x;
    const bool runs = box.y.step == 1 && !narrow;
    const std::int64_t rows_at_once = runs ? std::clamp<std::int64_t>(kReadBytes / row, 1, size.y) : 1;
    const std::int64_t pieces_per_slice = (size.y + rows_at_once - 1) / rows_at_once;
    const bool in_place = runs && size.x == layout_.dims.x;
    std::mutex mutex;
    Result<void> result;
    const std::int64_t grain = std::max<std::int64_t>(1, kGrainBytes / (rows_at_once * row));
    const TimestampNs started = SteadyClock().now();
    parallel_chunks(size.z * pieces_per_slice, grain, [&](std::int64_t begin, std::int64_t end) {
      std::vector<std::byte> buffer;
      for (std::int64_t piece = begin; piece < end; ++piece) {
        const std::int64_t k = piece / pieces_per_slice;
        const std::int64_t j = piece % pieces_per_slice * rows_at_once;
        const std::int64_t rows = std::min(rows_at_once, size.y - j);
        const std::int64_t first_row = box.z.at(k) * layout_.dims.y + box.y.at(j);
        const std::span<std::byte> target = out.subspan(static_cast<std::size_t>((k * size.y + j) * size.x * element),
                                                        static_cast<std::size_t>(rows * size.x * element));
        const std::int64_t skip = narrow ? box.x.begin * element : 0;
        const std::int64_t bytes = narrow ? (box.x.end - box.x.begin) * element : rows * row;
        if (!in_place) buffer.resize(static_cast<std::size_t>(bytes));
        const auto read = fetch(first_row * row + skip, in_place ? target : std::span(buffer));
        if (!read) {
          const std::lock_guard lock(mutex);
          result = read;
          return;
        }
        if (in_place) continue;
        const std::byte* from = buffer.data() + (narrow ? 0 : box.x.begin * element);
        for (std::int64_t r = 0; r < rows; ++r)
          copy_row(from + r * row, element, box.x, target.data() + r * size.x * element);
      }
    });
    // What comes from the disk comes while the slices read so far are worked on; what lies in memory needs no such
    // call.
    const double seconds = 1e-9 * static_cast<double>(SteadyClock().now() - started);
    const std::int64_t slice = layout_.dims.y * row, next = box.z.at(size.z - 1) + 1;
    const std::int64_t ahead = std::min(box.z.end - box.z.begin, layout_.dims.z - next);
    if (result && runs && ahead > 0 && static_cast<double>(size.z * slice) < kMemoryRate * seconds)
      expect(next * slice, ahead * slice);
    return result;
  }

 private:
  /// Bytes of the array that will be asked for next.
  void expect(std::int64_t at, std::int64_t bytes) const {
    for (const FlatSegment& segment : layout_.segments) {
      if (const std::int64_t here = std::min(bytes, segment.bytes - at); here > 0) {
        segment.file.will_read(segment.offset + at, here);
        bytes -= here;
        at += here;
      }
      at -= segment.bytes;
      if (bytes == 0) return;
    }
  }

  Result<void> fetch(std::int64_t at, std::span<std::byte> out) const {
    for (const FlatSegment& segment : layout_.segments) {
      if (out.empty()) break;
      if (at >= segment.bytes) {
        at -= segment.bytes;
        continue;
      }
      const auto count = std::min(out.size(), static_cast<std::size_t>(segment.bytes - at));
      DUBSAR_TRY(segment.file.read_at(segment.offset + at, out.first(count)));
      out = out.subspan(count);
      at = 0;
    }
    DUBSAR_CHECK(out.empty());
    return {};
  }

  FlatLayout layout_;
};

}  // namespace

Result<std::unique_ptr<VoxelReader>> make_flat_reader(FlatLayout layout) {
  std::int64_t present = 0;
  for (FlatSegment& segment : layout.segments) {
    const std::int64_t left = segment.file.size() - segment.offset;
    if (segment.offset < 0 || segment.bytes < 0 || left < segment.bytes)
      return fail(ErrorKind::kBadData,
                  "{} has {} bytes, expected at least {} from byte {} on: it is truncated, or its size was given wrong",
                  segment.file.path().string(), segment.file.size(), segment.bytes, segment.offset);
    present += segment.bytes;
  }
  const std::int64_t needed = layout.dims.count() * scalar_bytes(layout.format.type);
  if (present < needed)
    return fail(ErrorKind::kBadData, "{} bytes of voxels found, expected {} ({} x {} x {} of {})", present, needed,
                layout.dims.x, layout.dims.y, layout.dims.z, scalar_name(layout.format.type));
  return std::make_unique<FlatReader>(std::move(layout));
}

}  // namespace dubsar
