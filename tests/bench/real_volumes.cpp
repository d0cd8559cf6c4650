#include "tests/bench/real_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "core/pipeline/pipeline.h"

namespace dubsar {

int print_real_volumes(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  fmt::print("{:<34}{:>16}{:>7}{:>10}{:>7}{:>7}{:>7}  {}\n", "volume", "voxels", "detail", "vertices", "blur", "cpu s",
             "MiB", "parts");
  int failed = files.empty();
  for (const auto& file : files) {
    SilentProgress progress;
    PipelineOptions options;
    options.import.path = file;
    const auto result = run_pipeline(options, progress);
    if (!result) {
      fmt::print("{:<34}  {}\n", file.filename().string(), result.error().message);
      ++failed;
      continue;
    }
    const PipelineReport& report = result->report;
    double cpu_s = 0.0, peak_mib = 0.0;
    for (const StageRecord& stage : report.stages) {
      cpu_s += stage.cpu_s;
      peak_mib = std::max(peak_mib, stage.peak_rss_mib);
    }
    std::string parts;
    bool tablet = false;
    for (const Partition& part : report.partitions) {
      parts += (parts.empty() ? "" : ", ") + part.name;
      tablet = tablet || part.kind == PartitionKind::kTablet;
    }
    const Dims& d = report.scan.info.box.dims();
    fmt::print("{:<34}{:>16}{:>7}{:>10}{:>7}{:>7.1f}{:>7.0f}  {}{}\n", file.filename().string(),
               fmt::format("{}x{}x{}", d.x, d.y, d.z), name_in(kDetails, report.detail.detail), report.surface.vertices,
               report.scan.blur ? fmt::format("{:.2f}", std::sqrt(report.scan.blur->variance)) : "-", cpu_s, peak_mib,
               parts, tablet ? "  A TABLET" : "");
    std::fflush(stdout);
    failed += tablet;
  }
  return failed;
}

}  // namespace dubsar
