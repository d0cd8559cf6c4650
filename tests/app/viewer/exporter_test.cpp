// Exports by a program that stands for this one: a script that says how far it is, reads its session, and ends as told.

#include "app/viewer/exporter.h"

#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/core/volume/temp_folder.h"

namespace dubsar::app {
namespace {
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class Export : public testing_tools::TempFolder {
 protected:
  /// `body`: of a shell script; $4 is the session of a hand copy.
  std::string program(const std::string& name, const std::string& body) {
    const fs::path out = folder() / name;
    std::ofstream(out) << "#!/bin/sh\n" << body;
    fs::permissions(out, fs::perms::owner_all);
    return out.string();
  }
  Exporter::Order order(const std::string& by) const {
    return {"handcopy", (folder() / "t.exa").string(), (folder() / "t.svg").string(), "obverse", by};
  }
};

TEST_F(Export, OneThatIsStoppedLeavesTheNextOneItsSession) {
  // The first takes a while to end when it is asked to; the second looks for its session after that.
  const std::string slow = program(
      "slow", "trap 'sleep 0.6; exit 1' TERM\necho \"$4\" > " + (folder() / "first").string() + "\nsleep 30 & wait\n");
  const std::string later = program("later", "sleep 1.5\ncat \"$4\" > " + (folder() / "second").string() + "\n");
  Exporter exporter;
  ASSERT_TRUE(exporter.begin(order(slow), {}, {}));
  while (!fs::exists(folder() / "first")) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_TRUE(exporter.begin(order(later), {}, {}));
  exporter.wait();
  const auto said = exporter.ended();
  ASSERT_TRUE(said);
  std::ifstream second(folder() / "second");
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(second), {}), HasSubstr("{")) << *said;
}

TEST_F(Export, ARefusalNamesNoOptionThatNobodyTyped) {
  const std::string refuses =
      program("refuses", R"(echo '{"error":{"exit_code":73,"message":"-o,--output t.svg exists; expected another"}}'
exit 73
)");
  Exporter exporter;
  ASSERT_TRUE(exporter.begin(order(refuses), {}, {}));
  exporter.wait();
  const auto said = exporter.ended();
  ASSERT_TRUE(said);
  EXPECT_EQ(*said, "t.svg exists; expected another");
}

TEST_F(Export, SaysHowFarItIs) {
  const std::string half = program("half", "echo '{\"overall_percent\":50}' >&2\nsleep 1.2\n");
  Exporter exporter;
  ASSERT_TRUE(exporter.begin(order(half), {}, {}));
  double share = 0.0;
  while (!exporter.ended()) {
    if (const auto state = exporter.state()) share = std::max(share, state->share);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_DOUBLE_EQ(share, 0.5);
}

}  // namespace
}  // namespace dubsar::app
