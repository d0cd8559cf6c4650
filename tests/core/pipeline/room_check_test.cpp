// What does not fit is refused before the scan is read, and what fits is not looked at twice.

#include "core/pipeline/room_check.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/system/clock.h"
#include "core/base/system/large_blocks.h"
#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
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
    options.contact.reset();
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

TEST_F(Room, TheScanIsOpenedOnce) {
  PipelineOptions wanted = options();
  wanted.contact.emplace();
  wanted.import.voxel_size_mm = glm::dvec3(5.0);  // every opening warns of that
  SilentProgress progress;
  int warnings = 0;
  set_log_handler([&](LogLevel, std::string_view text) { warnings += text.find("5 x 5 x 5 mm") != text.npos ? 1 : 0; });
  const auto made = run_pipeline(wanted, progress);
  set_log_handler({});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->report.contact) << "the contact was not looked at";
  EXPECT_EQ(warnings, 1);
}

/// Of one budget: nothing that was refused had begun, nothing that was made took more.
void expect_kept_or_refused(const PipelineOptions& options, std::uint64_t limit, const fs::path& out, int& made) {
  return_free_memory();
  set_memory_limit(limit);
  reset_peak_rss();
  Stages stages;
  auto result = run_pipeline(options, stages);
  if (!result) {
    EXPECT_EQ(result.error().kind, ErrorKind::kTryAgain) << result.error().message;
    EXPECT_NE(result.error().message.find("of memory"), std::string::npos) << result.error().message;
    EXPECT_FALSE(stages.has("rays")) << "the scan was read, then: " << result.error().message;
  } else {
    const auto written = write_product(out, *result, stages);
    EXPECT_TRUE(written) << written.error().message;
    ++made;
    std::string table;
    for (const StageRecord& stage : result->report.stages)
      table += fmt::format("{} {:.0f}, ", stage.name, stage.peak_rss_mib);
    for (const StageRecord& stage : result->report.stages)
      EXPECT_LE(stage.peak_rss_mib * 1048576.0, static_cast<double>(limit)) << stage.name << " of " << table;
    fs::remove(out);
  }
  set_memory_limit(0);
}

phantom::PhantomOptions glued(phantom::Contact kind, double share, std::uint64_t seed) {
  phantom::PhantomOptions wanted;
  wanted.dims = {256, 160, 240};
  wanted.seed = seed;
  wanted.contact = kind;
  wanted.film_vox = 0.3;
  wanted.contact_share = share;
  return wanted;
}

/// A suite of its own: minutes, and no sanitizer keeps a budget.
class RoomOfBudgets : public Room {};

TEST_F(RoomOfBudgets, ADozenAreKeptOrRefusedBeforeTheScanIsRead) {
  SilentProgress progress;
  share_heaps();
  PipelineOptions run = options();
  run.import.path = folder_ / "scan256.h5";
  run.import.budget.scratch_folder = folder_;
  run.contact.emplace();
  const auto try_budgets = [&](Detail detail, const std::vector<std::uint64_t>& mib) {
    run.detail = detail;
    int made = 0;
    for (const std::uint64_t m : mib)
      expect_kept_or_refused(run, resident_bytes() + (m << 20), folder_ / "k.exa", made);
    return made;
  };
  ASSERT_TRUE(
      phantom::write_phantom(run.import.path, std::nullopt, glued(phantom::Contact::kFilled, 0.1, 901), progress));
  const int made = try_budgets(Detail::kScan, {10, 30, 50, 65, 80, 100, 120, 150, 180, 220, 260, 400});
  EXPECT_GE(made, 3) << "more is refused than need be";
  EXPECT_LE(made, 6) << "a budget that cannot be kept was accepted";
  EXPECT_GE(try_budgets(Detail::kAuto, {30, 100, 120, 150}), 2) << "half of the scan's resolution fits";
  set_thread_count(16);
  EXPECT_GE(try_budgets(Detail::kScan, {180, 220, 260}), 1) << "of 16 threads";
  set_thread_count(0);
  // Of this one twice as much is contact as the plan takes for granted.
  ASSERT_TRUE(
      phantom::write_phantom(run.import.path, std::nullopt, glued(phantom::Contact::kFilm, 0.3, 902), progress));
  EXPECT_GE(try_budgets(Detail::kScan, {160, 190, 220, 260}), 1);
  // Noise moves the surface of this one, so that it is extracted twice.
  phantom::PhantomOptions noisy = glued(phantom::Contact::kFilled, 0.1, 903);
  noisy.snr_db = 14.0;
  ASSERT_TRUE(phantom::write_phantom(run.import.path, std::nullopt, noisy, progress));
  EXPECT_GE(try_budgets(Detail::kScan, {100, 150, 220}), 1);
}

}  // namespace
}  // namespace dubsar
