// What does not fit is refused before the scan is read, and what fits is not looked at twice.

#include "core/pipeline/room_check.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/phantom/write_phantom.h"
#include "core/pipeline/forecast.h"
#include "core/pipeline/pipeline.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

std::uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// The stages that began.
class Stages final : public Progress {
 public:
  bool has(const std::string& name) const { return std::find(names_.begin(), names_.end(), name) != names_.end(); }

 private:
  void on_begin(std::string_view stage, std::int64_t, std::string_view) override { names_.emplace_back(stage); }
  std::vector<std::string> names_;
};

class Room : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_room_{}", ::getpid());
    fs::create_directories(folder_);
    SilentProgress progress;
    phantom::PhantomOptions wanted;
    wanted.dims = {96, 64, 96};
    wanted.seed = 5;
    ASSERT_TRUE(phantom::write_phantom(folder_ / "scan.h5", std::nullopt, wanted, progress));
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  void TearDown() override { set_memory_limit(0); }
  static PipelineOptions options() {
    PipelineOptions options;
    options.import.path = folder_ / "scan.h5";
    options.detail = Detail::kScan;
    options.trace_contact = false;
    options.occlusion->rays = 4;
    return options;
  }
  static inline fs::path folder_;
};

TEST_F(Room, WhatCannotFitIsRefusedBeforeTheScanIsRead) {
  Stages stages;
  set_memory_limit(resident_bytes() + 3'000'000);  // the surface has some 50,000 vertices
  const auto made = run_pipeline(options(), stages);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::kTryAgain);
  EXPECT_NE(made.error().message.find("memory"), std::string::npos) << made.error().message;
  EXPECT_FALSE(stages.has("import")) << "the scan was read";
}

TEST_F(Room, WhatSurelyFitsIsNotLookedAtTwice) {
  Stages stages;
  const auto made = run_pipeline(options(), stages);
  ASSERT_TRUE(made) << made.error().message;
  for (const StageRecord& stage : made->report.stages) EXPECT_NE(stage.name, "forecast");
  EXPECT_TRUE(stages.has("import"));
}

TEST_F(Room, AGridWhoseSignsAloneAreTooManyIsRefusedByItsSize) {
  const Dims scan{60000, 60000, 10};
  const auto points = static_cast<std::uint64_t>(scan.count());
  EXPECT_GT(bytes_of_run({scan, false, 0.0, GridPlace::kScratch, false}), points / 8);
  EXPECT_GT(bytes_of_run({scan, true, 0.0, GridPlace::kScratch, false}), points / 64);
  for (const bool half : {false, true}) {
    EXPECT_GE(bytes_of_run({scan, half, 0.0, GridPlace::kMemory, false}), points / 8 * 4) << "of the halved grid";
    EXPECT_GE(bytes_of_run({scan, half, 1e9, GridPlace::kScratch, false}),
              static_cast<std::uint64_t>(1e9 * kSurfaceBytesPerVertex));
  }
  EXPECT_GT(bytes_of_run({scan, false, 1e9, GridPlace::kScratch, true}),
            bytes_of_run({scan, false, 1e9, GridPlace::kScratch, false}));
}

}  // namespace
}  // namespace dubsar
