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
  static Result<Forecast> foretell(const ForecastOptions& options) {
    SilentProgress progress;
    ImportOptions import;
    import.path = folder_ / "scan.h5";
    DUBSAR_ASSIGN(const std::unique_ptr<ImportedVolume> scan, open_volume(import));
    return forecast(*scan, options, progress);
  }
  static inline fs::path folder_;
};

TEST_F(ForecastOfPhantoms, TheSurfaceAndItsFileAreThoseOfTheRun) {
  for (const Detail detail : {Detail::kScan, Detail::kHalf}) {
    const auto expected = foretell({.detail = detail, .contact = false, .occlusion_rays = 0});
    ASSERT_TRUE(expected) << expected.error().message;
    PipelineOptions options;
    options.import.path = folder_ / "scan.h5";
    options.detail = detail;
    options.trace_contact = false;
    options.occlusion.reset();
    SilentProgress progress;
    auto made = run_pipeline(options, progress);
    ASSERT_TRUE(made) << made.error().message;
    ASSERT_TRUE(write_product(folder_ / "a.exa", *made, options.exa_profile, progress));
    const auto vertices = static_cast<double>(made->report.surface.vertices);
    EXPECT_NEAR(static_cast<double>(expected->vertices), vertices, 0.3 * vertices);
    const auto bytes = static_cast<double>(fs::file_size(folder_ / "a.exa"));
    EXPECT_NEAR(static_cast<double>(expected->product_bytes), bytes, 0.3 * bytes);
    EXPECT_EQ(expected->grid, made->report.scan.grid);
    EXPECT_EQ(expected->scratch_bytes, 0U);
    double core_s = 0.0;
    for (const StageRecord& stage : made->report.stages) core_s += stage.cpu_s;
    EXPECT_GT(expected->core_s, 0.1 * core_s);
    EXPECT_LT(expected->core_s, 10.0 * core_s);
  }
}

TEST_F(ForecastOfPhantoms, WhatDoesNotFitIntoMemoryIsCountedOnTheDisk) {
  Budget budget;
  budget.memory_bytes = 1 << 20;
  budget.scratch_folder = folder_;
  const auto expected = foretell({.detail = Detail::kHalf, .occlusion_rays = 0, .budget = budget});
  ASSERT_TRUE(expected) << expected.error().message;
  EXPECT_EQ(expected->scratch_bytes, static_cast<std::uint64_t>(expected->grid.count()) * 4);
  const auto in_memory = foretell({.detail = Detail::kHalf, .occlusion_rays = 0});
  ASSERT_TRUE(in_memory);
  EXPECT_GE(in_memory->memory_bytes, expected->memory_bytes);
  EXPECT_EQ(in_memory->vertices, expected->vertices);
}

}  // namespace
}  // namespace dubsar
