// Many scans in one run, damaged ones among them, killed and gone on with.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/app/cli/run_program.h"
#include "tests/core/volume/written_scan.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class Batch : public testing::Test {
 protected:
  Batch() { fs::create_directories(folder_ / "scans"); }
  ~Batch() override { fs::remove_all(folder_); }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }

  void write_ball(const std::string& path, double radius) const {
    constexpr std::size_t kEdge = 40;
    std::vector<float> values(kEdge * kEdge * kEdge);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = static_cast<double>(i % kEdge) - 19.5, y = static_cast<double>(i / kEdge % kEdge) - 19.5,
                   z = static_cast<double>(i / kEdge / kEdge) - 19.5;
      values[i] = x * x + y * y + z * z < radius * radius ? 100.0F : 10.0F;
    }
    Hdf5Storage storage;
    storage.dims = {kEdge, kEdge, kEdge};
    write_scan(path, "scan", storage, values);
  }
  /// Surfaces by name, with their bytes.
  std::map<std::string, std::string> surfaces(const std::string& folder) const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(in(folder)))
      if (entry.path().extension() == ".exa") {
        std::ifstream file(entry.path(), std::ios::binary);
        out[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
      }
    return out;
  }
  ProgramRun run(std::vector<std::string> words, const RunOptions& options = {}) const {
    words.insert(words.begin(), "process");
    words.insert(words.end(), {"--no-resample", "--iterations", "0", "--threshold", "50", "--no-ao"});
    return run_dubsar(words, options);
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_batch_{}", ::getpid());
};

TEST_F(Batch, AFolderIsProcessedAndADamagedScanCostsTheOthersNothing) {
  write_ball(in("scans/a.h5"), 9);
  write_ball(in("scans/c.h5"), 12);
  std::ofstream(in("scans/b.h5")) << "this is no HDF5";
  const ProgramRun done = run({in("scans"), "-o", in("out"), "--json", in("all.json")});
  EXPECT_EQ(done.exit_code, 65) << done.err;
  EXPECT_NE(done.out.find("2 made, 0 kept, 1 failed"), std::string::npos) << done.out;
  EXPECT_EQ(surfaces("out").size(), 2u);
  std::ifstream file(in("all.json"));
  const json all = json::parse(file);
  ASSERT_EQ(all["scans"].size(), 3u);
  EXPECT_EQ(all["scans"][1]["error"]["exit_code"], 65);
  EXPECT_EQ(all["scans"][2]["report"]["output"], in("out/c.exa"));
  EXPECT_TRUE(fs::exists(in("out/a.run.json")));
}

TEST_F(Batch, WhatIsMadeIsKeptUntilTheScanOrTheOptionsChange) {
  write_ball(in("scans/a.h5"), 9);
  write_ball(in("scans/b.h5"), 10);
  const std::vector<std::string> words{in("scans/a.h5"), in("scans/b.h5"), "-o", in("out"), "--resume"};
  const auto says = [&](const std::vector<std::string>& what) {
    const ProgramRun done = run(what);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return done.out.substr(done.out.rfind("\n\n") + 2);
  };
  EXPECT_EQ(says(words), "2 made, 0 kept, 0 failed\n");
  const auto first = surfaces("out");
  EXPECT_EQ(says(words), "0 made, 2 kept, 0 failed\n");
  write_ball(in("scans/b.h5"), 11);
  EXPECT_EQ(says(words), "1 made, 1 kept, 0 failed\n");
  auto other = words;
  other.insert(other.end(), {"--smooth", "1"});
  EXPECT_EQ(says(other), "2 made, 0 kept, 0 failed\n");
  EXPECT_EQ(says({in("scans/a.h5"), in("scans/b.h5"), "-o", in("out")}), "2 made, 0 kept, 0 failed\n");
  std::ofstream(in("out/a.exa"), std::ios::app) << "x";  // a surface that somebody spoilt
  EXPECT_EQ(says(words), "1 made, 1 kept, 0 failed\n");
  EXPECT_EQ(surfaces("out").at("a.exa"), first.at("a.exa"));
}

TEST_F(Batch, KilledAtAnyMomentItGoesOnToTheSameBytes) {
  for (int i = 0; i < 4; ++i) write_ball(in(fmt::format("scans/s{}.h5", i)), 8.0 + i);
  const ProgramRun whole = run({in("scans"), "-o", in("whole")});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  std::mt19937 random(20251);
  for (int round = 0; round < 8; ++round) {
    const int patience =
        std::uniform_int_distribution<int>(1, std::max(2, static_cast<int>(whole.seconds * 100)))(random);
    int waited = 0;
    RunOptions killed;
    killed.watch = [&](const std::string&) { return ++waited == patience ? SIGKILL : 0; };
    run({in("scans"), "-o", in("out"), "--resume"}, killed);
  }
  const ProgramRun rest = run({in("scans"), "-o", in("out"), "--resume"});
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(surfaces("out"), surfaces("whole"));
}

TEST_F(Batch, AskedToStopItSaysHowToGoOn) {
  for (int i = 0; i < 3; ++i) write_ball(in(fmt::format("scans/s{}.h5", i)), 8.0 + i);
  RunOptions stop;
  stop.watch = [this](const std::string&) { return fs::exists(in("out/s0.run.json")) ? SIGTERM : 0; };
  const ProgramRun done = run({in("scans"), "-o", in("out"), "--resume"}, stop);
  EXPECT_EQ(done.exit_code, 75) << done.out << done.err;
  EXPECT_NE(done.err.find("--resume goes on with the rest"), std::string::npos) << done.err;
}

TEST_F(Batch, TwoSurfacesOfOneNameAndAFileForAFolderAreRefused) {
  fs::create_directories(in("more"));
  write_ball(in("scans/a.h5"), 9);
  write_ball(in("more/a.h5"), 9);
  const ProgramRun twice = run({in("scans/a.h5"), in("more/a.h5"), "-o", in("out")});
  EXPECT_EQ(twice.exit_code, 64);
  EXPECT_NE(twice.err.find("would both be written"), std::string::npos) << twice.err;
  const ProgramRun file = run({in("scans/a.h5"), in("more/a.h5"), "-o", in("scans/a.h5")});
  EXPECT_EQ(file.exit_code, 73) << file.err;
  EXPECT_TRUE(fs::file_size(in("scans/a.h5")) > 1000);
}

}  // namespace
}  // namespace dubsar::test
