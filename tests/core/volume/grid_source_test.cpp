// A chunk is decoded once, whatever its shape, the slices asked for and the memory allowed.

#include "core/volume/grid_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numeric>
#include <vector>

#include "core/volume/oriented_reader.h"

namespace dubsar {
namespace {

constexpr Dims kScanner{3072, 3072, 512};

std::uint8_t voxel(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<std::uint8_t>(x * 7 + y * 31 + z * 101 + x / 64 * y / 64);
}

std::int64_t chunks(std::int64_t length, std::int64_t chunk) { return (length + chunk - 1) / chunk; }

/// Chunks along an axis that hold voxels of a range.
std::vector<std::int64_t> touched(const AxisRange& range, std::int64_t chunk) {
  std::vector<std::int64_t> all;
  for (std::int64_t i = 0; i < range.count(); ++i)
    if (all.empty() || all.back() != range.at(i) / chunk) all.push_back(range.at(i) / chunk);
  return all;
}

struct Decoded {
  std::vector<int> times;  ///< of each chunk, x fastest
  std::int64_t most_bytes = 0;
  /// How many chunks a box touches at all.
  static int touched_by(const VoxelBox& box, const Dims& chunk) {
    return static_cast<int>(touched(box.x, chunk.x).size() * touched(box.y, chunk.y).size() *
                            touched(box.z, chunk.z).size());
  }
};

/// Boxes of a scanner's volume in chunks: says what they hold, and keeps count of the chunks they touch.
class CountingReader final : public VoxelReader {
 public:
  CountingReader(Dims chunk, Decoded* decoded) : chunk_(chunk), decoded_(decoded) {
    decoded_->times.assign(static_cast<std::size_t>(chunks(kScanner.x, chunk.x) * chunks(kScanner.y, chunk.y) *
                                                    chunks(kScanner.z, chunk.z)),
                           0);
  }
  Dims dims() const noexcept override { return kScanner; }
  Dims chunk() const noexcept override { return chunk_; }
  const NumberFormat& format() const noexcept override { return format_; }

  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    const auto xs = touched(box.x, chunk_.x), ys = touched(box.y, chunk_.y), zs = touched(box.z, chunk_.z);
    for (const std::int64_t z : zs)
      for (const std::int64_t y : ys)
        for (const std::int64_t x : xs)
          ++decoded_->times[static_cast<std::size_t>(
              (z * chunks(kScanner.y, chunk_.y) + y) * chunks(kScanner.x, chunk_.x) + x)];
    const Dims size = box.dims();
    decoded_->most_bytes = std::max(decoded_->most_bytes, size.count());
    std::size_t i = 0;
    for (std::int64_t z = 0; z < size.z; ++z)
      for (std::int64_t y = 0; y < size.y; ++y)
        for (std::int64_t x = 0; x < size.x; ++x)
          out[i++] = static_cast<std::byte>(voxel(box.x.at(x), box.y.at(y), box.z.at(z)));
    return {};
  }

 private:
  Dims chunk_;
  Decoded* decoded_;
  NumberFormat format_{ScalarType::kU8, kNativeOrder, {}};
};

/// Every 48th voxel of every 48th row of all slices: all chunks, and little to write down.
constexpr VoxelBox kThinned{{5, 3072, 48}, {11, 3072, 48}, {0, 512, 1}};

/// New slices only, as filters with a ring of slices ask for them.
void read_in_slabs(GridSource& source, std::int64_t first, std::int64_t then, const AxisOrder& order,
                   const VoxelBox& box) {
  const Dims dims = source.dims();
  for (std::int64_t z = 0; z < dims.z;) {
    const std::int64_t end = std::min(dims.z, z + (z == 0 ? first : then));
    std::vector<float> out(static_cast<std::size_t>((end - z) * dims.slice()));
    const auto read = source.read(z, end, out);
    ASSERT_TRUE(read) << read.error().message;
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(out.size()); i += 5) {
      const std::array<std::int64_t, 3> at{box.x.at(i % dims.x), box.y.at(i / dims.x % dims.y),
                                           box.z.at(z + i / dims.slice())};
      std::array<std::int64_t, 3> stored{};
      const std::array<std::int64_t, 3> lengths{kScanner.x, kScanner.y, kScanner.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto to = static_cast<std::size_t>(order.stored[axis]);
        stored[to] = order.backwards[axis] ? lengths[to] - 1 - at[axis] : at[axis];
      }
      ASSERT_EQ(out[static_cast<std::size_t>(i)], voxel(stored[0], stored[1], stored[2])) << z << " " << i;
    }
    z = end;
  }
}

Budget budget_of(std::uint64_t bytes) {
  Budget budget;
  budget.memory_bytes = bytes;
  budget.scratch_folder = std::filesystem::temp_directory_path();
  return budget;
}

TEST(GridSource, EveryChunkIsDecodedOnce) {
  for (const Dims chunk :
       {Dims{64, 64, 64}, Dims{256, 256, 256}, Dims{3072, 3072, 1}, Dims{3072, 8, 64}, Dims{100, 90, 70}})
    for (const std::uint64_t memory : {std::uint64_t{1} << 30, std::uint64_t{200000}})
      for (const auto& [first, then] : {std::pair<std::int64_t, std::int64_t>{3, 2}, {1, 1}, {64, 64}, {500, 12}}) {
        Decoded decoded;
        GridSource source(std::make_unique<CountingReader>(chunk, &decoded), kThinned, {}, budget_of(memory));
        read_in_slabs(source, first, then, {}, kThinned);
        EXPECT_EQ(std::accumulate(decoded.times.begin(), decoded.times.end(), 0), decoded.touched_by(kThinned, chunk))
            << chunk.z << " " << then;
        EXPECT_EQ(*std::max_element(decoded.times.begin(), decoded.times.end()), 1) << chunk.z << " " << then;
        EXPECT_LE(source.kept_bytes(), static_cast<std::int64_t>(memory / 4));
      }
}

TEST(GridSource, ALayerBeyondTheBudgetIsNeverInMemoryWhole) {
  Decoded decoded;
  constexpr std::int64_t kLayer = 64 * 64 * 256;
  GridSource source(std::make_unique<CountingReader>(Dims{256, 256, 256}, &decoded), kThinned, {},
                    budget_of(static_cast<std::uint64_t>(kLayer)));
  EXPECT_EQ(source.preferred_height(), 256);
  read_in_slabs(source, 3, 2, {}, kThinned);
  EXPECT_EQ(source.kept_bytes(), 0);
  EXPECT_LE(decoded.most_bytes, kLayer / 8) << "rows of chunks";
  EXPECT_EQ(*std::max_element(decoded.times.begin(), decoded.times.end()), 1);
}

TEST(GridSource, ChunksAreDecodedOnceInEveryOrderOfTheAxes) {
  for (const char* letters : {"zyx", "xyz", "yxz", "xzy", "-zyx", "z-yx", "zy-x", "y-zx", "-x-y-z"}) {
    const AxisOrder order = *parse_axis_order(letters);
    Decoded decoded;
    auto reader = std::make_unique<OrientedReader>(std::make_unique<CountingReader>(Dims{128, 256, 64}, &decoded),
                                                   order, std::uint64_t{1} << 20);
    // thinned along the stored x and y, where these lie now
    const std::array<std::int64_t, 3> lengths{3072, 3072, 512};
    std::array<AxisRange, 3> ranges{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto to = static_cast<std::size_t>(order.stored[axis]);
      ranges[axis] = {0, lengths[to], to == 2 ? 16 : 48};
    }
    const VoxelBox box{ranges[0], ranges[1], ranges[2]};
    GridSource source(std::move(reader), box, {}, budget_of(std::uint64_t{1} << 26));
    read_in_slabs(source, 3, 2, order, box);
    EXPECT_EQ(*std::min_element(decoded.times.begin(), decoded.times.end()), 1) << letters;
    EXPECT_EQ(*std::max_element(decoded.times.begin(), decoded.times.end()), 1) << letters;
  }
}

TEST(GridSource, AScratchFileThatCannotBeMadeIsAnError) {
  Decoded decoded;
  Budget budget = budget_of(1000);
  budget.scratch_folder = "/proc/no/such/folder";
  GridSource source(std::make_unique<CountingReader>(Dims{64, 64, 64}, &decoded), kThinned, {}, budget);
  std::vector<float> out(static_cast<std::size_t>(2 * source.dims().slice()));
  const auto read = source.read(0, 2, out);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("scratch file"), std::string::npos);
}

}  // namespace
}  // namespace dubsar
