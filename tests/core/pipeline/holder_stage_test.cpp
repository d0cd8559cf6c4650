// A scan whose object stands in something gives the surface of the object alone.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

struct HeldAnswer {
  PipelineReport report;
  std::map<std::string, double> volumes;
};

HeldAnswer held_answer(double holder, Artefacts artefacts = Artefacts::kAuto) {
  const fs::path path = fs::temp_directory_path() / fmt::format("dubsar_holder_{}.h5", ::getpid());
  phantom::PhantomOptions wanted;
  wanted.dims = {128, 88, 128};
  wanted.seed = 7301;
  wanted.snr_db = 24.0;
  wanted.artefacts.holder = holder;
  SilentProgress progress;
  EXPECT_TRUE(phantom::write_phantom(path, std::nullopt, wanted, progress));
  PipelineOptions options;
  options.import.path = path;
  options.occlusion.reset();
  options.artefacts = artefacts;
  auto result = run_pipeline(options, progress);
  fs::remove(path);
  EXPECT_TRUE(result) << result.error().message;
  HeldAnswer found;
  if (!result) return found;
  found.report = result->report;
  for (const Partition& part : found.report.partitions) found.volumes[part.name] += part.volume_mm3;
  return found;
}

TEST(HolderStage, WhatTheObjectStandsInIsTakenOffAndSaid) {
  const HeldAnswer plain = held_answer(0.0), held = held_answer(0.6), as_it_is = held_answer(0.6, Artefacts::kOff);
  EXPECT_FALSE(plain.report.scan.holder.has_value());
  ASSERT_TRUE(held.report.scan.holder.has_value());
  EXPECT_EQ(held.report.scan.holder->fate, HolderFate::kTakenOff);
  EXPECT_NE(report_text(held.report).find("a holder of 0."), std::string::npos);
  EXPECT_NEAR(held.report.threshold.value, plain.report.threshold.value, 0.02f * plain.report.threshold.value);
  double largest = 0.0;
  for (const auto& [part, volume] : plain.volumes) {
    ASSERT_TRUE(held.volumes.contains(part)) << part << "\n" << report_text(held.report);
    EXPECT_NEAR(held.volumes.at(part), volume, 0.03 * std::abs(volume)) << part;
    largest = std::max(largest, as_it_is.volumes.at(part) / volume);
  }
  EXPECT_GT(largest, 1.1);  // else this test shows nothing
}

}  // namespace
}  // namespace dubsar
