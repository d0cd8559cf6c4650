#include "core/pipeline/stage_clock.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/pipeline/tapped_source.h"

namespace dubsar {
namespace {

TEST(StageClock, RecordsTimeMemoryAndWork) {
  ManualClock wall(7'000'000'000);
  StageClock clock(&wall);
  clock.start("fill", "byte");
  std::vector<char> memory(64 << 20);
  for (std::size_t i = 0; i < memory.size(); i += 4096) memory[i] = 1;
  wall.advance(2'500'000'000);
  clock.finish(static_cast<std::int64_t>(memory.size()));
  ASSERT_EQ(clock.records().size(), 1u);
  const StageRecord& record = clock.records()[0];
  EXPECT_EQ(record.work, 64 << 20);
  EXPECT_GT(record.peak_rss_mib, 64.0);
  EXPECT_DOUBLE_EQ(record.wall_s, 2.5);
}

TEST(StageClock, SplittingKeepsTheSum) {
  ManualClock wall;
  StageClock clock(&wall);
  clock.start("resample", "voxel");
  wall.advance(4'000'000'000);
  clock.finish(10);
  clock.split_before_last("import", 1.0, 0.0, 10, "voxel");
  ASSERT_EQ(clock.records().size(), 2u);
  EXPECT_EQ(clock.records()[0].name, "import");
  EXPECT_DOUBLE_EQ(clock.records()[0].wall_s, 1.0);
  EXPECT_DOUBLE_EQ(clock.records()[1].wall_s, 3.0);
}

Volume<float> ramp(Dims dims) {
  Volume<float> volume(dims);
  for (std::int64_t i = 0; i < dims.count(); ++i) volume.voxels[i] = static_cast<float>(i);
  return volume;
}

TEST(TappedSource, PassesSlabsOnAndCountsEachSliceOnce) {
  const Volume<float> volume = ramp({4, 3, 8});
  VolumeSource source(volume);
  SilentProgress progress;
  TappedSource tap(source, progress);
  std::vector<float> slab(4 * 3 * 5);
  ASSERT_TRUE(tap.read(0, 5, slab));
  ASSERT_TRUE(tap.read(3, 8, slab));
  EXPECT_EQ(slab.back(), 95.0f);
  progress.cancel();
  EXPECT_EQ(tap.read(0, 1, slab).error().kind, ErrorKind::kCancelled);
}

TEST(SampledSource, TakesGroupsOfSlicesFromTheWholeHeight) {
  const Volume<float> volume = ramp({1, 1, 100});
  VolumeSource source(volume);
  SampledSource sample(source, 12, 3);
  ASSERT_EQ(sample.dims().z, 12);
  std::vector<float> all(12), parts(12);
  ASSERT_TRUE(sample.read(0, 12, all));
  EXPECT_EQ(all, (std::vector<float>{0, 1, 2, 25, 26, 27, 50, 51, 52, 75, 76, 77}));
  for (std::int64_t z = 0; z < 12; z += 4)
    ASSERT_TRUE(sample.read(z, z + 4, std::span(parts).subspan(static_cast<std::size_t>(z))));
  EXPECT_EQ(parts, all);
  SampledSource whole(source, 1000, 3);
  EXPECT_EQ(whole.dims().z, 100);
}

/// A source whose slices come in layers, as chunks do; counts the layers that reads touch.
class LayeredSource final : public SlabSource {
 public:
  LayeredSource(const Volume<float>& volume, std::int64_t layer) : source_(volume), layer_(layer) {}
  Dims dims() const noexcept override { return source_.dims(); }
  const GridFrame& frame() const noexcept override { return source_.frame(); }
  std::int64_t preferred_height() const noexcept override { return layer_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    touched += (z_end - 1) / layer_ - z_begin / layer_ + 1;
    return source_.read(z_begin, z_end, out);
  }
  std::int64_t touched = 0;

 private:
  VolumeSource source_;
  std::int64_t layer_;
};

TEST(SampledSource, NoGroupLiesAcrossTwoLayersOfChunks) {
  const Volume<float> volume = ramp({1, 1, 400});
  for (const std::int64_t layer : {1, 4, 6, 7, 16, 64}) {
    LayeredSource source(volume, layer);
    SampledSource sample(source, 24, 3);
    std::vector<float> all(24);
    ASSERT_EQ(sample.dims().z, 24);
    ASSERT_TRUE(sample.read(0, 24, all));
    EXPECT_EQ(source.touched, layer == 1 ? 24 : 8) << layer;
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end())) << layer;
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end()) << "no slice twice, layer " << layer;
  }
}

}  // namespace
}  // namespace dubsar
