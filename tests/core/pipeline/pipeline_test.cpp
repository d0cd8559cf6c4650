// The whole chain on a small phantom: what it reports, that threads do not change it, that it can be stopped.

#include "core/pipeline/pipeline.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/files/input_file.h"
#include "core/base/system/parallel.h"
#include "core/phantom/write_phantom.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class Pipeline : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_pipeline_{}", ::getpid());
    fs::create_directories(folder_);
    SilentProgress progress;
    phantom::PhantomOptions wanted;
    wanted.dims = {96, 64, 96};
    wanted.seed = 11;
    wanted.snr_db = 30.0;
    ASSERT_TRUE(phantom::write_phantom(folder_ / "scan.h5", std::nullopt, wanted, progress));
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static PipelineOptions options() {
    PipelineOptions options;
    options.import.path = folder_ / "scan.h5";
    options.detail = Detail::kScan;
    options.denoise.iterations = 1;
    options.occlusion->rays = 8;
    return options;
  }
  static Result<PipelineResult> process(const fs::path& out, Progress& progress, bool contact = true) {
    PipelineOptions wanted = options();
    if (!contact) wanted.contact.reset();
    DUBSAR_ASSIGN(PipelineResult result, run_pipeline(wanted, progress));
    DUBSAR_TRY(write_product(out, result, progress));
    return result;
  }
  static void expect_only_the_scan(const std::string& after) {
    std::vector<std::string> left;
    for (const auto& entry : fs::directory_iterator(folder_)) left.push_back(entry.path().filename().string());
    EXPECT_EQ(std::count_if(left.begin(), left.end(), [](const std::string& name) { return name[0] == 's'; }), 1)
        << "only scan.h5, after " << after;
  }
  static inline fs::path folder_;
};

TEST_F(Pipeline, NothingThatAStageFoundIsMissingInTheReport) {
  SilentProgress progress;
  const auto result = process(folder_ / "a.exa", progress);
  ASSERT_TRUE(result) << result.error().message;
  const PipelineReport& report = result->report;
  std::vector<std::string> stages;
  for (const StageRecord& stage : report.stages) stages.push_back(stage.name);
  EXPECT_EQ(stages,
            (std::vector<std::string>{"estimate_raw", "import",     "resample", "blur",      "rays",      "rings",
                                      "axis",         "holder",     "estimate", "denoise",   "estimate",  "sample",
                                      "band",         "extract",    "mesh",     "smooth",    "curvature", "settle",
                                      "segment",      "fill_holes", "contact",  "occlusion", "check",     "write"}));
  for (const StageRecord& stage : report.stages) {
    EXPECT_GE(stage.work, stage.name == "fill_holes" || stage.name == "blur" ? 0 : 1) << stage.name;
  }

  const nlohmann::json json = report_json(report, options());
  EXPECT_EQ(json["input"]["dims"], nlohmann::json({96, 64, 96}));
  EXPECT_EQ(json["input"]["grid"], nlohmann::json({96, 64, 96}));
  EXPECT_EQ(json["input"]["nonfinite_voxels"], 0);
  EXPECT_EQ(json["estimates"]["filters"].size(), 5u);
  EXPECT_GT(json["estimates"]["threshold"], 0.0);
  EXPECT_FALSE(json["estimates"]["path"].get<std::string>().empty());
  EXPECT_GT(json["mesh"]["smooth"]["max_displacement_vox"], 0.0);
  EXPECT_GT(json["mesh"]["settle"]["p95_error_vox"], 0.0);
  EXPECT_LE(json["mesh"]["settle"]["p95_error_vox"], 1.0 / 32.0);
  EXPECT_EQ(json["mesh"]["vertices"], result->model.mesh.vertex_count());
  EXPECT_EQ(json["mesh"]["xquads"], result->model.mesh.quad_count());
  EXPECT_EQ(json["mesh"]["nonmanifold_edges"], 0);
  EXPECT_EQ(json["partitions"].size(), result->model.partitions.size());
  EXPECT_EQ(json["exa"]["bytes"], fs::file_size(folder_ / "a.exa"));
  EXPECT_EQ(json["segment"]["components"], report.segment.components);
  EXPECT_GE(json["segment"]["components"], 1);
  for (const char* key : {"nested", "enclosure_refused", "crack_radius_vox", "small_pieces", "cut_length_vox"})
    EXPECT_TRUE(json["segment"].contains(key)) << key;
  std::int64_t patch_triangles = 0;
  for (const FillPatch& patch : result->model.patches)
    patch_triangles += static_cast<std::int64_t>(patch.triangles.size());
  EXPECT_EQ(json["segment"]["holes"]["triangles"], patch_triangles);
  for (const char* key : {"loops", "unshared", "longest_loop", "area_vox2"})
    EXPECT_TRUE(json["segment"]["holes"].contains(key)) << key;
  EXPECT_NE(report_text(report).find("surfaces, "), std::string::npos);
}

/// The stages that began.
class Begun final : public Progress {
 public:
  std::vector<std::string> names;

 private:
  void on_begin(std::string_view stage, std::int64_t, std::string_view) override { names.emplace_back(stage); }
};

TEST_F(Pipeline, ThePlansPhasesAreThoseThatProgressIsToldOf) {
  Begun progress;
  const auto made = process(folder_ / "p.exa", progress);
  ASSERT_TRUE(made) << made.error().message;
  RunShape run;
  run.half = false;
  auto at = progress.names.begin();
  int passes = 0;
  for (const StagePlan& stage : kRunPlan)
    for (const StagePhase& phase : stage.phases) {
      const std::string name = phase.name == nullptr ? "" : phase.name;
      passes = name == "denoise" ? passes + 1 : passes;
      // One pass of two was asked for, and no ray is bent.
      if (name.empty() || name == "straighten" || (name == "denoise" && passes % 2 == 0)) continue;
      const auto found = std::find(at, progress.names.end(), name);
      EXPECT_NE(found, progress.names.end()) << name << ", " << stage.when;
      if (found != progress.names.end() && name != "estimate") at = found + 1;
    }
  fs::remove(folder_ / "p.exa");
}

TEST_F(Pipeline, OneTwoAndSevenThreadsGiveTheSameBytes) {
  std::vector<std::string> bytes;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    SilentProgress progress;
    ASSERT_TRUE(process(folder_ / "b.exa", progress));
    bytes.push_back(read_file_bytes(folder_ / "b.exa").value());
  }
  set_thread_count(0);
  EXPECT_TRUE(bytes[0] == bytes[1]);
  EXPECT_TRUE(bytes[0] == bytes[2]);
}

TEST_F(Pipeline, EveryInstructionSetGivesTheSameBytes) {
  const auto choose = [](std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  };
  std::string first;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    choose(target);
    SilentProgress progress;
    ASSERT_TRUE(process(folder_ / "t.exa", progress, false));
    const std::string bytes = read_file_bytes(folder_ / "t.exa").value();
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << hwy::TargetName(target);
  }
  choose(0);
}

TEST_F(Pipeline, AGridOnTheDiskGivesTheSameBytes) {
  std::vector<std::string> bytes;
  for (const Detail detail : {Detail::kScan, Detail::kHalf})
    for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 15}) {
      PipelineOptions wanted = options();
      wanted.detail = detail;
      wanted.denoise.iterations = 2;
      wanted.occlusion.reset();
      wanted.import.budget.memory_bytes = memory;  // 32 KiB: the grid and layers of chunks go to the disk
      wanted.import.budget.scratch_folder = folder_;
      SilentProgress progress;
      auto result = run_pipeline(wanted, progress);
      ASSERT_TRUE(result) << result.error().message;
      ASSERT_TRUE(write_product(folder_ / "d.exa", *result, progress));
      bytes.push_back(read_file_bytes(folder_ / "d.exa").value());
    }
  EXPECT_TRUE(bytes[0] == bytes[1]);
  EXPECT_TRUE(bytes[2] == bytes[3]);
  EXPECT_FALSE(bytes[0] == bytes[2]);
}

/// Stops when the n-th stage begins, or that of a name.
class StopAt final : public Progress {
 public:
  explicit StopAt(int stage) : left_(stage) {}
  explicit StopAt(std::string name) : name_(std::move(name)) {}
  const std::string& stage() const noexcept { return stage_; }

 private:
  void on_begin(std::string_view stage, std::int64_t, std::string_view) override {
    if (name_.empty() ? --left_ != 0 : stage != name_) return;
    stage_ = stage;
    cancel();
  }
  int left_ = 0;
  std::string name_, stage_;
};

TEST_F(Pipeline, StoppedInAnyStageItLeavesNothing) {
  int stages = 0;
  for (int stage = 1;; ++stage) {
    StopAt progress(stage);
    const auto result = process(folder_ / "stopped.exa", progress, false);  // tracing takes most of the time, see below
    if (progress.stage().empty()) {
      EXPECT_TRUE(result) << result.error().message;
      break;
    }
    ++stages;
    ASSERT_FALSE(result) << progress.stage();
    EXPECT_EQ(result.error().kind, ErrorKind::kCancelled) << progress.stage();
    expect_only_the_scan(progress.stage());
    ASSERT_LT(stages, 60);
  }
  EXPECT_GE(stages, 12);
  fs::remove(folder_ / "stopped.exa");  // of the run that nobody stopped
  StopAt contact("contact");
  const auto result = process(folder_ / "stopped.exa", contact);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
  expect_only_the_scan("contact");
}

TEST(SmallestPhantom, HoldsATabletAtEitherResolution) {
  for (const std::uint64_t seed : {3u, 77u}) {
    phantom::PhantomOptions wanted = phantom::parse_preset("tiny").value();
    wanted.seed = seed;
    SilentProgress progress;
    PipelineOptions options;
    options.import.path = fs::temp_directory_path() / fmt::format("dubsar_smallest_{}.h5", ::getpid());
    ASSERT_TRUE(phantom::write_phantom(options.import.path, std::nullopt, wanted, progress));
    options.occlusion.reset();
    for (const Detail detail : {Detail::kScan, Detail::kHalf}) {
      options.detail = detail;
      const auto result = run_pipeline(options, progress);
      ASSERT_TRUE(result) << result.error().message;
      EXPECT_TRUE(result->report.segment.nested) << "seed " << seed << ", " << name_in(kDetails, detail);
    }
    fs::remove(options.import.path);
  }
}

}  // namespace
}  // namespace dubsar
