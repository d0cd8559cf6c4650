// The command line as its users meet it: exit codes, streams, files that appear whole or not at all.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/base/files/atomic_file.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

const fs::path& folder() {
  static const struct Folder {
    fs::path path = fs::temp_directory_path() / fmt::format("dubsar_cli_{}", ::getpid());
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
  } folder;
  return folder.path;
}
std::string in_folder(const char* name) { return (folder() / name).string(); }

/// One small scan for all cases.
const std::string& scan() {
  static const std::string path = [] {
    const std::string file = in_folder("scan.h5");
    const ProgramRun run = run_dubsar({"phantom", file, "--preset", "tiny", "--seed", "3"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return file;
  }();
  return path;
}

/// The scan processed, with its report.
const std::string& tablet() {
  static const std::string path = [] {
    const std::string file = in_folder("tablet.exa");
    const ProgramRun run =
        run_dubsar({"process", scan(), "-o", file, "--detail", "half", "--json", in_folder("report.json"), "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return file;
  }();
  return path;
}

std::ptrdiff_t temporaries() {
  return std::count_if(fs::directory_iterator(folder()), fs::directory_iterator(), [](const auto& entry) {
    return entry.path().filename().string().find(".tmp-") != std::string::npos;
  });
}

TEST(CommandLine, EveryVerbHasHelpWithExamples) {
  for (const char* verb :
       {"phantom", "process", "info", "exa", "export", "render", "displays", "devices", "view", "doctor"}) {
    const ProgramRun run = run_dubsar({verb, "--help"});
    EXPECT_EQ(run.exit_code, 0) << verb;
    EXPECT_NE(run.out.find("Example"), std::string::npos) << verb;
    EXPECT_NE(run.out.find("--json"), std::string::npos) << verb;
  }
}

TEST(CommandLine, UsageErrorsExitWith64) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"nonsense"},
                                                    {"process"},
                                                    {"process", "a.h5", "-o", "b.exa", "--nonsense"},
                                                    {"process", "a.h5", "-o", "b.exa", "--window", "4"},
                                                    {"info", "a.h5", "--threads", "-1"},
                                                    {"info", "a.h5", "--progress", "often"},
                                                    {"process", "a.h5", "-o", "b.exa", "--crop", "backwards"},
                                                    {"phantom", "x.h5", "--size", "7"},
                                                    {"render", "a.exa", "-o", "b.gif"}}) {
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, 64) << (arguments.empty() ? "" : arguments[0]) << run.err;
    EXPECT_FALSE(run.err.empty());
    EXPECT_TRUE(run.out.empty()) << run.out;
  }
}

TEST(CommandLine, MissingInputExitsWith66AndWritesNothing) {
  const std::string out = in_folder("none.exa");
  const ProgramRun run = run_dubsar({"process", in_folder("missing.h5"), "-o", out});
  EXPECT_EQ(run.exit_code, 66) << run.err;
  EXPECT_FALSE(fs::exists(out));
  EXPECT_EQ(run_dubsar({"info", in_folder("missing.h5")}).exit_code, 66);
  EXPECT_EQ(run_dubsar({"info", in_folder("missing.exa")}).exit_code, 66);
  EXPECT_EQ(run_dubsar({"export", in_folder("missing.exa"), in_folder("x.ply")}).exit_code, 66);
  EXPECT_EQ(run_dubsar({"render", in_folder("missing.ply"), "-o", in_folder("x.png")}).exit_code, 66);
}

TEST(CommandLine, AnOutputThatCannotBeCreatedExitsWith73BeforeTheWork) {
  const ProgramRun run = run_dubsar({"process", scan(), "-o", in_folder("nowhere/x.exa")});
  EXPECT_EQ(run.exit_code, 73) << run.err;
  EXPECT_LT(run.seconds, 1.0);
  EXPECT_EQ(run_dubsar({"process", scan(), "-o", folder().string()}).exit_code, 73);
}

// Outputs of earlier runs, by how they begin; what dubsar did not write is never replaced.
const std::string kOldSurface =
    "\x89"
    "EXA\r\n\x1a\n the old output";
const std::string kOldMesh = "ply\ncomment made by dubsar\nthe old output";

TEST(CommandLine, DamagedInputExitsWith65AndLeavesTheOldOutput) {
  const std::string bad = in_folder("bad.h5"), old = in_folder("old.exa");
  ASSERT_TRUE(write_file_atomically(bad, "\x89HDF\r\n\x1a\n and then nothing that makes sense"));
  ASSERT_TRUE(write_file_atomically(old, kOldSurface));
  const ProgramRun run = run_dubsar({"process", bad, "-o", old});
  EXPECT_EQ(run.exit_code, 65) << run.err;
  EXPECT_EQ(*read_text_file(old), kOldSurface);
  EXPECT_EQ(temporaries(), 0);
}

TEST(CommandLine, TheReportHasItsKeys) {
  tablet();
  const json report = json::parse(*read_text_file(in_folder("report.json")));
  for (const char* key : {"stages", "estimates", "mesh", "partitions", "exa", "input"})
    EXPECT_TRUE(report.contains(key)) << key;
  for (const json& stage : report["stages"])
    for (const char* key : {"name", "wall_s", "cpu_s", "peak_rss_mib", "work"}) EXPECT_TRUE(stage.contains(key)) << key;
  for (const char* key : {"sigma", "snr_db", "threshold", "path", "filters"})
    EXPECT_TRUE(report["estimates"].contains(key)) << key;
  for (const char* key : {"vertices", "xquads", "triangles", "nonmanifold_edges", "nonmanifold_vertices",
                          "boundary_edges", "components", "euler"})
    EXPECT_TRUE(report["mesh"].contains(key)) << key;
  EXPECT_EQ(report["mesh"]["nonmanifold_edges"], 0);
  EXPECT_EQ(report["mesh"]["nonmanifold_vertices"], 0);
  EXPECT_EQ(report["mesh"]["boundary_edges"], 0);
  EXPECT_EQ(report["input"]["dims"], json({96, 64, 96}));
  EXPECT_EQ(report["input"]["dtype"], "float32");
  EXPECT_EQ(report["exa"]["bytes"], fs::file_size(tablet()));
  ASSERT_EQ(report["estimates"]["filters"].size(), 4u);
  EXPECT_GT(report["estimates"]["filters"][3]["snr_db"], report["estimates"]["filters"][0]["snr_db"]);
}

TEST(CommandLine, JsonOnStdoutIsNothingButJson) {
  const ProgramRun run = run_dubsar({"info", tablet(), "--json", "-"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(json::parse(run.out)["kind"], "exa");
}

TEST(CommandLine, ProgressAsJsonHasStagePercentRateAndEstimate) {
  const ProgramRun run =
      run_dubsar({"process", scan(), "-o", in_folder("progress.exa"), "--progress", "json", "--no-ao"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(run.err);
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] != '{') continue;
    const json state = json::parse(line);
    for (const char* key : {"stage", "percent", "rate_per_s", "eta_s", "done", "total"})
      EXPECT_TRUE(state.contains(key)) << key;
    ++count;
  }
  EXPECT_GE(count, 10);
}

TEST(CommandLine, EveryExportFormatIsWrittenAndUnderstoodByInfo) {
  for (const char* name : {"tablet.ply", "tablet.stl", "tablet.obj", "tablet.glb"}) {
    const ProgramRun written = run_dubsar({"export", tablet(), in_folder(name)});
    EXPECT_EQ(written.exit_code, 0) << written.err;
    const ProgramRun info = run_dubsar({"info", in_folder(name), "--json", "-"});
    ASSERT_EQ(info.exit_code, 0) << name << info.err;
    EXPECT_EQ(json::parse(info.out)["kind"], "mesh");
  }
  EXPECT_EQ(run_dubsar({"export", tablet(), in_folder("tablet.step")}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"export", tablet(), in_folder("x.stl"), "--partition", "lid"}).exit_code, 64);
}

TEST(CommandLine, EachPartAsStlIsWatertight) {
  const json info = json::parse(run_dubsar({"info", tablet(), "--json", "-"}).out);
  ASSERT_FALSE(info["partitions"].empty());
  for (const json& part : info["partitions"]) {
    const std::string file = in_folder("part.stl");
    ASSERT_EQ(run_dubsar({"export", tablet(), file, "--partition", part["part"].get<std::string>()}).exit_code, 0);
    EXPECT_TRUE(json::parse(run_dubsar({"info", file, "--json", "-"}).out)["watertight"].get<bool>()) << part.dump();
  }
}

TEST(CommandLine, SimplifyingKeepsAPartWatertightWithFewerTriangles) {
  const auto triangles = [](const std::vector<std::string>& extra) {
    std::vector<std::string> arguments{"export", tablet(), in_folder("s.ply"), "--partition", "0", "--json", "-"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const json result = json::parse(run_dubsar(arguments).out);
    EXPECT_TRUE(result["watertight"].get<bool>());
    return result["mesh"]["triangles"].get<int>();
  };
  EXPECT_LT(triangles({"--simplify", "--simplify-distance", "0.3", "--simplify-angle", "30"}), 0.8 * triangles({}));
}

TEST(CommandLine, OneThreadAndSevenGiveTheSameBytes) {
  const auto bytes = [](const char* name, const char* threads) {
    const std::string file = in_folder(name);
    EXPECT_EQ(
        run_dubsar({"process", scan(), "-o", file, "--detail", "half", "--threads", threads, "--quiet"}).exit_code, 0);
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_EQ(bytes("one.exa", "1"), bytes("seven.exa", "7"));
}

TEST(CommandLine, InterruptEndsWith130InTwoSecondsAndLeavesTheOldOutput) {
  const std::string out = in_folder("kept.exa");
  ASSERT_TRUE(write_file_atomically(out, kOldSurface));
  for (const char* stage : {"\"denoise\"", "\"smooth\"", "\"occlusion\""}) {
    RunOptions options;
    std::chrono::steady_clock::time_point sent;
    options.watch = [&](const std::string& err) {
      if (err.find(stage) == std::string::npos) return 0;
      sent = std::chrono::steady_clock::now();
      return SIGINT;
    };
    const ProgramRun run = run_dubsar({"process", scan(), "-o", out, "--progress", "json"}, options);
    if (run.exit_code == 0) continue;  // the stage was over before the signal came
    EXPECT_EQ(run.exit_code, 130) << run.err;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - sent).count(), 2.0) << stage;
    EXPECT_EQ(*read_text_file(out), kOldSurface);
    EXPECT_EQ(temporaries(), 0);
  }
}

TEST(CommandLine, AFullDiskExitsWith74AndLeavesTheOldOutput) {
  const std::string out = in_folder("full.ply");
  ASSERT_TRUE(write_file_atomically(out, kOldMesh));
  RunOptions options;
  options.file_size_limit = 4096;
  const ProgramRun run = run_dubsar({"export", tablet(), out}, options);
  EXPECT_EQ(run.exit_code, 74) << run.err;
  EXPECT_EQ(*read_text_file(out), kOldMesh);
  EXPECT_EQ(temporaries(), 0);
}

TEST(CommandLine, DoctorFindsEverythingThatTheProgramNeeds) {
  const ProgramRun run = run_dubsar({"doctor", "--json", "-"});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_GE(json::parse(run.out)["findings"].size(), 4u);
}

#ifdef DUBSAR_MADE_RUNTIME_JSON
TEST(CommandLine, DoctorOutlivesAHeadsetsRuntimeThatCrashes) {
  ::setenv("XR_RUNTIME_JSON", DUBSAR_MADE_RUNTIME_JSON, 1);
  for (const bool crashes : {false, true}) {
    if (crashes) ::setenv("DUBSAR_MADE_RUNTIME_ABORTS", "1", 1);
    const ProgramRun run = run_dubsar({"doctor"});
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    EXPECT_NE(run.out.find(crashes ? "the runtime crashes when it is asked (signal 6)" : "headset Made Headset"),
              std::string::npos)
        << run.out;
  }
  ::unsetenv("DUBSAR_MADE_RUNTIME_ABORTS");
  ::unsetenv("XR_RUNTIME_JSON");
}
#endif

}  // namespace
}  // namespace dubsar::test
