// What a run takes is said before it within 30 %, as far as a test can know it: surface, bytes; seconds only roughly,
// since tests share their machine with others.

#include "core/pipeline/forecast.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/system/clock.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class ForecastOfPhantoms : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_forecast_{}", ::getpid());
    fs::create_directories(folder_);
    SilentProgress progress;
    phantom::PhantomOptions wanted;
    wanted.dims = {224, 128, 208};
    wanted.seed = 23;
    ASSERT_TRUE(phantom::write_phantom(folder_ / "scan.h5", std::nullopt, wanted, progress));
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static Result<Forecast> foretell(Detail detail, const Budget& budget = {}) {
    SilentProgress progress;
    ImportOptions import;
    import.path = folder_ / "scan.h5";
    DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> scan, open_volume(import));
    RunShape run;
    run.contact = false;
    run.rays = 0.0;
    return forecast(*scan, run, detail, budget, std::nullopt, false, progress);
  }
  static inline fs::path folder_;
};

TEST_F(ForecastOfPhantoms, TheSurfaceAndItsFileAreThoseOfTheRun) {
  for (const Detail detail : {Detail::kScan, Detail::kHalf}) {
    const auto expected = foretell(detail);
    ASSERT_TRUE(expected) << expected.error().message;
    PipelineOptions options;
    options.import.path = folder_ / "scan.h5";
    options.detail = detail;
    options.contact.reset();
    options.occlusion.reset();
    SilentProgress progress;
    auto made = run_pipeline(options, progress);
    ASSERT_TRUE(made) << made.error().message;
    ASSERT_TRUE(write_product(folder_ / "a.exa", *made, progress));
    const auto vertices = static_cast<double>(made->report.surface.vertices);
    EXPECT_NEAR(expected->run.vertices, vertices, 0.3 * vertices);
    const auto bytes = static_cast<double>(fs::file_size(folder_ / "a.exa"));
    EXPECT_NEAR(product_bytes(expected->run), bytes, 0.3 * bytes);
    EXPECT_EQ(grid_of(expected->run.scan, expected->run.half), made->report.scan.grid);
    EXPECT_EQ(expected->cost.scratch_bytes, 0.0);
    double core_s = 0.0;
    for (const StageRecord& stage : made->report.stages) core_s += stage.cpu_s;
    EXPECT_GT(expected->cost.core_s, 0.1 * core_s);
    EXPECT_LT(expected->cost.core_s, 10.0 * core_s);
  }
}

TEST_F(ForecastOfPhantoms, WhatDoesNotFitIntoMemoryIsCountedOnTheDisk) {
  Budget budget;
  budget.memory_bytes = 1 << 20;
  budget.scratch_folder = folder_;
  const auto expected = foretell(Detail::kHalf, budget);
  ASSERT_TRUE(expected) << expected.error().message;
  EXPECT_EQ(expected->cost.scratch_bytes, 4.0 * static_cast<double>(grid_of(expected->run.scan, true).count()));
  const auto in_memory = foretell(Detail::kHalf);
  ASSERT_TRUE(in_memory);
  EXPECT_GE(in_memory->cost.bytes, expected->cost.bytes);
  EXPECT_EQ(in_memory->run.vertices, expected->run.vertices);
}

}  // namespace
}  // namespace dubsar
