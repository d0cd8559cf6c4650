// A grid in memory and one on the disk are the same to their readers; a disk that forgets is noticed.

#include "core/volume/grid_store.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace dubsar {
namespace {
namespace fs = std::filesystem;

const Dims kGridDims{37, 19, 23};

float value_at(std::int64_t i, int round) {
  return static_cast<float>(i * 7 % 1009) + 1000.0F * static_cast<float>(round);
}

Budget in_folder() {
  Budget budget;
  budget.scratch_folder = fs::temp_directory_path();
  return budget;
}

void fill(GridStore& grid, std::int64_t begin, std::int64_t end, int round) {
  const std::span<float> page = grid.page(begin, end);
  for (std::size_t i = 0; i < page.size(); ++i)
    page[i] = value_at(begin * kGridDims.slice() + static_cast<std::int64_t>(i), round);
  ASSERT_TRUE(grid.store(begin, end));
}

TEST(GridStore, MemoryAndDiskGiveBackWhatWasWrittenLast) {
  for (const GridPlace place : {GridPlace::kMemory, GridPlace::kScratch}) {
    auto grid = GridStore::create(kGridDims, {}, place, in_folder());
    ASSERT_TRUE(grid) << grid.error().message;
    EXPECT_EQ(grid->in_memory(), place == GridPlace::kMemory);
    EXPECT_EQ(grid->scratch_bytes(), place == GridPlace::kMemory ? 0 : kGridDims.count() * 4);
    fill(*grid, 11, 23, 0);
    fill(*grid, 0, 11, 0);
    fill(*grid, 5, 9, 1);
    std::vector<float> all(static_cast<std::size_t>(kGridDims.count()));
    for (const std::int64_t height : {1, 3, 23})
      for (std::int64_t z = 0; z < kGridDims.z; z += height) {
        const std::int64_t end = std::min(kGridDims.z, z + height);
        ASSERT_TRUE(grid->read(z, end, std::span(all).subspan(static_cast<std::size_t>(z * kGridDims.slice()))));
        for (std::int64_t i = z * kGridDims.slice(); i < end * kGridDims.slice(); ++i) {
          const std::int64_t slice = i / kGridDims.slice();
          ASSERT_EQ(all[static_cast<std::size_t>(i)], value_at(i, slice >= 5 && slice < 9 ? 1 : 0));
        }
      }
  }
}

/// The open file of this process that lies in `folder` and has no name any more.
int nameless_file(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    const std::string to = fs::read_symlink(entry.path(), error).string();
    if (to.rfind(folder.string(), 0) == 0 && to.find("(deleted)") != std::string::npos)
      return std::stoi(entry.path().filename().string());
  }
  return -1;
}

TEST(GridStore, ABitThatTheDiskChangedIsAnErrorAndNoSurface) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_store_{}", ::getpid());
  fs::create_directories(folder);
  Budget budget;
  budget.scratch_folder = folder;
  auto grid = GridStore::create(kGridDims, {}, GridPlace::kScratch, budget);
  ASSERT_TRUE(grid);
  fill(*grid, 0, kGridDims.z, 0);
  const int file = nameless_file(folder);
  ASSERT_GE(file, 0);
  const ::off_t at = 4 * (9 * kGridDims.slice() + 5);
  char byte = 0;
  ASSERT_EQ(::pread(file, &byte, 1, at), 1);
  byte ^= 4;
  ASSERT_EQ(::pwrite(file, &byte, 1, at), 1);
  std::vector<float> slab(static_cast<std::size_t>(3 * kGridDims.slice()));
  EXPECT_TRUE(grid->read(6, 9, slab));
  const auto damaged = grid->read(8, 11, slab);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().kind, ErrorKind::kIo);
  EXPECT_NE(damaged.error().message.find("slice 9"), std::string::npos) << damaged.error().message;
  grid->release();
  fs::remove_all(folder);
}

TEST(GridStore, ADiskWithoutRoomIsRefusedBeforeAnythingIsWritten) {
  const auto grid = GridStore::create({60000, 60000, 60000}, {}, GridPlace::kScratch, in_folder());
  ASSERT_FALSE(grid);
  EXPECT_EQ(grid.error().kind, ErrorKind::kTryAgain);
  EXPECT_NE(grid.error().message.find("another disk"), std::string::npos) << grid.error().message;
}

TEST(GridStore, AGridGoesToTheDiskWhereItWouldTakeMostOfTheBudget) {
  Budget budget;
  budget.memory_bytes = static_cast<std::uint64_t>(kGridDims.count()) * 4 * 2;
  EXPECT_EQ(place_for(kGridDims, budget), GridPlace::kMemory);
  budget.memory_bytes = static_cast<std::uint64_t>(kGridDims.count()) * 4 + 1000;
  EXPECT_EQ(place_for(kGridDims, budget), GridPlace::kScratch);
}

}  // namespace
}  // namespace dubsar
