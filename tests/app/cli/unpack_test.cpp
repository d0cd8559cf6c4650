// Lifting the envelope away and putting it back, by number and by key: the picture is the same to the last byte.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/files/atomic_file.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

TEST(Unpack, ThereAndBackShowsTheSameTabletToTheLastByte) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_unpack_{}", ::getpid());
  fs::create_directories(folder);
  const auto in = [&](const char* name) { return (folder / name).string(); };
  ASSERT_EQ(run_dubsar({"phantom", in("s.h5"), "--preset", "tiny", "-q"}).exit_code, 0);
  ASSERT_EQ(run_dubsar({"process", in("s.h5"), "-o", in("s.exa"), "--no-ao", "-q"}).exit_code, 0);
  std::ofstream(in("steps.txt")) << "0 picture " << in("first.png") << "\n+0.2 unpack 100\n+0.2 picture "
                                 << in("apart.png") << "\n+0.2 unpack 37\n+0.2 unpack 0\n+0.2 picture "
                                 << in("back.png") << "\n+0.2 unpack_more\n+0.2 unpack_less\n+0.2 picture "
                                 << in("keys.png") << "\n+0.2 unpack 60\n+0.2 undo\n+0.2 picture " << in("undone.png")
                                 << "\n";
  const ProgramRun run = run_dubsar(
      {"view", in("s.exa"), "--offscreen", "--size", "320x240", "--steps", in("steps.txt"), "--every", "100", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto bytes = [&](const char* name) { return read_text_file(in(name), 1 << 24).value_or(name); };
  EXPECT_GT(bytes("first.png").size(), 2000u);
  EXPECT_EQ(bytes("back.png"), bytes("first.png"));
  EXPECT_EQ(bytes("keys.png"), bytes("first.png"));
  EXPECT_EQ(bytes("undone.png"), bytes("first.png"));
  EXPECT_NE(bytes("apart.png"), bytes("first.png"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dubsar::test
