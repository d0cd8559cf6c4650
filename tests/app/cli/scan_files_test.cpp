// Scans with odd names, odd axes and full disks, through the program.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/exa/exa_file.h"
#include "tests/app/cli/run_program.h"
#include "tests/core/volume/written_scan.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class ScanFiles : public testing::Test {
 protected:
  ScanFiles() { fs::create_directories(folder_); }
  ~ScanFiles() override { fs::remove_all(folder_); }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  bool empty() const { return fs::is_empty(folder_); }

  // A box with a smaller one upon its corner: no plane or axis mirrors it into itself. Slowest axis z, or x.
  void write_box(const std::string& path, const std::string& dataset, bool x_first, const std::string& attribute) {
    constexpr std::size_t kX = 26, kY = 22, kZ = 30;
    std::vector<float> values(kX * kY * kZ);
    for (std::size_t z = 0; z < kZ; ++z)
      for (std::size_t y = 0; y < kY; ++y)
        for (std::size_t x = 0; x < kX; ++x) {
          const bool large = x >= 3 && x < 22 && y >= 3 && y < 17 && z >= 3 && z < 15;
          const bool small = x >= 3 && x < 8 && y >= 3 && y < 13 && z >= 3 && z < 26;
          values[x_first ? (x * kY + y) * kZ + z : (z * kY + y) * kX + x] = large || small ? 100.0F : 10.0F;
        }
    Hdf5Storage storage;
    storage.dims = x_first ? std::vector<std::uint64_t>{kX, kY, kZ} : std::vector<std::uint64_t>{kZ, kY, kX};
    write_scan(path, dataset, storage, values, attribute);
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_scans_{}", ::getpid());
};

const std::vector<std::string> kQuick{"--no-resample", "--iterations", "0", "--threshold", "50", "--no-ao", "--quiet"};

std::vector<std::string> process(const std::string& scan, const std::string& out) {
  std::vector<std::string> arguments{"process", scan, "-o", out};
  arguments.insert(arguments.end(), kQuick.begin(), kQuick.end());
  return arguments;
}

TEST_F(ScanFiles, ALatin1NameReachesTheEnd) {
  const std::string scan =
                        in("T\xe4"
                           "felchen.h5"),
                    out = in("a.exa"), report = in("report.json");
  write_box(scan, "/v\xe4", false, "zyx");
  auto arguments = process(scan, out);
  arguments.insert(arguments.end(), {"--json", report});
  const ProgramRun run = run_dubsar(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(*read_text_file(report))["input"]["dataset"], "/v\xef\xbf\xbd");
  for (const std::string& file : {scan, out}) {
    const ProgramRun info = run_dubsar({"info", file, "--json", "-"});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_TRUE(json::accept(info.out)) << info.out;
    EXPECT_EQ(run_dubsar({"info", file}).exit_code, 0);
  }
}

TEST_F(ScanFiles, NamesFromFilesDoNotReachTheTerminalRaw) {
  const std::string scan = in("a.h5");
  write_box(scan, "/v\x1b]0;owned\x07", false, "\x1b[2J");
  const ProgramRun run = run_dubsar({"info", scan});
  EXPECT_EQ(run.exit_code, 0);
  for (const std::string& stream : {run.out, run.err}) {
    EXPECT_EQ(stream.find('\x1b'), std::string::npos) << stream;
    EXPECT_EQ(stream.find('\x07'), std::string::npos) << stream;
  }
  EXPECT_NE(run.out.find("/v\\x1b]0;owned\\x07"), std::string::npos) << run.out;
  EXPECT_NE(run.err.find("says \"\\x1b[2J\""), std::string::npos) << run.err;
  const ProgramRun wrong = run_dubsar({"info", scan, "--dataset", "/none"});
  EXPECT_EQ(wrong.exit_code, 65);
  EXPECT_EQ(wrong.err.find('\x1b'), std::string::npos) << wrong.err;
}

TEST_F(ScanFiles, AxesAreTurnedAndTheDecisionIsPrintedAndKept) {
  write_box(in("zyx.h5"), "/v", false, "");
  write_box(in("xyz.h5"), "/v", true, "xyz");
  write_box(in("silent.h5"), "/v", true, "");
  const auto surface = [&](const std::string& name, const std::vector<std::string>& more) {
    auto arguments = process(in(name + ".h5"), in(name + ".exa"));
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    SilentProgress progress;
    auto model = read_exa(in(name + ".exa"), progress);
    EXPECT_TRUE(model) << model.error().message;
    return *std::move(model);
  };
  const SurfaceModel plain = surface("zyx", {});
  ASSERT_GT(plain.mesh.vertex_count(), 100);
  const SurfaceModel turned = surface("xyz", {});
  EXPECT_EQ(turned.mesh.positions, plain.mesh.positions);
  const json provenance = json::parse(turned.provenance);
  EXPECT_EQ(provenance["input"]["axes"],
            json({{"order", "xyz"}, {"stated_by", "/v@axis_order"}, {"mirrored_as_stored", true}}));
  EXPECT_EQ(json::parse(plain.provenance)["input"]["axes"]["stated_by"], nullptr);
  const SurfaceModel mirrored = surface("silent", {});
  EXPECT_NE(mirrored.mesh.positions, plain.mesh.positions);
  EXPECT_EQ(surface("silent", {"--axis-order", "xyz"}).mesh.positions, plain.mesh.positions);

  EXPECT_NE(run_dubsar({"info", in("xyz.h5")}).out.find("xyz, slowest first (/v@axis_order): turned"),
            std::string::npos);
  EXPECT_NE(run_dubsar({"info", in("silent.h5")}).out.find("the file does not say"), std::string::npos);
  EXPECT_EQ(run_dubsar({"info", in("silent.h5"), "--axis-order", "xxz"}).exit_code, 64);
}

TEST_F(ScanFiles, APhantomOnAFullDiskExitsWith74) {
  for (const long limit : {0L, 1000L, 100'000L, 1'000'000L, 2'360'000L}) {
    const ProgramRun run = run_dubsar({"phantom", in("p.h5"), "--preset", "tiny"}, {{}, limit});
    EXPECT_EQ(run.exit_code, 74) << limit << ": " << run.err;
    EXPECT_NE(run.err.find("is the disk full?"), std::string::npos) << limit << ": " << run.err;
    EXPECT_TRUE(empty()) << limit;
  }
}

}  // namespace
}  // namespace dubsar::test
