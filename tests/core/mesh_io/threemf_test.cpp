// 3MF files as an independent reader finds them: Python's zipfile and XML parser.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/base/files/input_file.h"
#include "core/mesh_io/mesh_io.h"
#include "tests/core/mesh_io/mesh_samples.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

class ThreeMf : public FileTest {
 protected:
  /// What read_3mf.py prints; the word "failed" at the end when it complains.
  std::string read_by_python(const std::filesystem::path& file) {
    const std::string command = fmt::format("python3 '{}/tests/core/mesh_io/read_3mf.py' '{}' 2>&1 || echo failed",
                                            DUBSAR_SOURCE_DIR, file.string());
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
    std::string text;
    std::array<char, 4096> buffer;
    while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe.get()) != nullptr) text += buffer.data();
    return text;
  }
  SilentProgress progress_;
};

TEST_F(ThreeMf, PartsUnitsSizesAndColoursReachAnIndependentReader) {
  if (std::system("python3 -c '' 2>/dev/null") != 0) GTEST_SKIP() << "python3 is not installed";
  const TriMesh mesh = sample_mesh();
  ASSERT_TRUE(write_mesh(folder_ / "a.3mf", mesh, {}, progress_));
  const std::string said = read_by_python(folder_ / "a.3mf");
  EXPECT_THAT(said, HasSubstr("unit millimeter"));
  // Two tori of radii 30 and 10 grid steps of 2 voxels of .038 mm.
  EXPECT_THAT(said, HasSubstr("object tablet 288 576 closed 6.080 6.080 1.520 #0000C8"));
  EXPECT_THAT(said, HasSubstr("object envelope 288 576 closed 6.080 6.080 1.520"));
  EXPECT_THAT(said, ::testing::Not(HasSubstr("failed"))) << said;
}

TEST_F(ThreeMf, TheSameMeshGivesTheSameBytesAndCancelLeavesNothing) {
  const TriMesh mesh = sample_mesh(96, 48);
  ASSERT_TRUE(write_mesh(folder_ / "a.3mf", mesh, {}, progress_));
  ASSERT_TRUE(write_mesh(folder_ / "b.3mf", mesh, {}, progress_));
  EXPECT_EQ(*read_file_bytes(folder_ / "a.3mf"), *read_file_bytes(folder_ / "b.3mf"));
  EXPECT_EQ(read_mesh(folder_ / "a.3mf", progress_).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(write_mesh(folder_ / "c.3mf", TriMesh(), {}, progress_).error().kind, ErrorKind::kUsage);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c.3mf"));
}

}  // namespace
}  // namespace dubsar
