#include "core/base/system/memory_left.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace dubsar {
namespace {

class MemoryLeft : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ =
        std::filesystem::temp_directory_path() /
        fmt::format("dubsar_memory_{}_{}", ::getpid(), ::testing::UnitTest::GetInstance()->current_test_info()->name());
    put("proc/meminfo", "MemTotal: 16000 kB\nMemAvailable:    8000 kB\n");
  }
  void TearDown() override { std::filesystem::remove_all(root_); }
  void put(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  std::uint64_t available() const { return memory_left(root_.string()); }
  std::filesystem::path root_;
};

TEST_F(MemoryLeft, WithoutGroupsTheMemoryOfTheMachineCounts) { EXPECT_EQ(available(), 8'000u * 1024); }

TEST_F(MemoryLeft, TheLimitOfANestedGroupIsSeen) {
  put("proc/self/cgroup", "0::/user.slice/run-7.scope\n");
  put("sys/fs/cgroup/user.slice/memory.max", "max\n");
  put("sys/fs/cgroup/user.slice/run-7.scope/memory.max", "3000000\n");
  put("sys/fs/cgroup/user.slice/run-7.scope/memory.current", "1000000\n");
  EXPECT_EQ(available(), 2'000'000u);
  put("sys/fs/cgroup/user.slice/memory.max", "500000\n");  // the group around it is smaller
  put("sys/fs/cgroup/user.slice/memory.current", "100000\n");
  EXPECT_EQ(available(), 400'000u);
  put("sys/fs/cgroup/user.slice/memory.current", "600000\n");  // and full
  EXPECT_EQ(available(), 0u);
}

TEST_F(MemoryLeft, InsideAContainerTheMountItselfHasTheLimit) {
  put("proc/self/cgroup", "0::/\n");
  put("sys/fs/cgroup/memory.max", "700000\n");
  put("sys/fs/cgroup/memory.current", "200000\n");
  EXPECT_EQ(available(), 500'000u);
}

TEST_F(MemoryLeft, VersionOneOfGroupsCountsToo) {
  put("proc/self/cgroup", "11:cpu,cpuacct:/a\n4:memory:/job/step\n0::/\n");
  put("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "900000\n");
  put("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "100000\n");
  EXPECT_EQ(available(), 800'000u);
}

// A run that has gone through a large scan fills its group with pages of files, which are given back when asked for.
TEST_F(MemoryLeft, PagesOfFilesAreNotInTheWay) {
  put("proc/self/cgroup", "0::/run\n");
  put("sys/fs/cgroup/run/memory.max", "6000000\n");
  put("sys/fs/cgroup/run/memory.current", "5990000\n");
  put("sys/fs/cgroup/run/memory.stat", "anon 390000\nfile 5600000\ninactive_file 5000000\nactive_file 600000\n");
  EXPECT_EQ(available(), 5'610'000u);
  put("proc/self/cgroup", "4:memory:/job\n0::/\n");
  put("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "6000000\n");
  put("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "6000000\n");
  put("sys/fs/cgroup/memory/job/memory.stat",
      "cache 100\ninactive_file 60\nactive_file 40\ntotal_inactive_file 5000000\ntotal_active_file 500000\n");
  EXPECT_EQ(available(), 5'500'000u);
}

}  // namespace
}  // namespace dubsar
