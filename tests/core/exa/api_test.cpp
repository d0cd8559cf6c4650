// The library as others see it: through its header alone, and through the example that is built with it.

#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "dubsar_exa.h"

namespace {
const std::string kFile = DUBSAR_GOLDEN "/exa3_smoothed.exa";

TEST(ExaLibrary, ReadsSurfacesLevelsPartsAndBoxes) {
  dubsar_exa::Info info;
  std::string error;
  ASSERT_TRUE(dubsar_exa::read_info(kFile, info, error)) << error;
  EXPECT_EQ(info.major, 3);
  EXPECT_EQ(info.grid, (std::array<std::int64_t, 3>{37, 33, 29}));
  EXPECT_EQ(info.vertices, 9180);
  EXPECT_NEAR(info.grid_step_mm[2], 0.08, 1e-12);
  dubsar_exa::Surface whole, coarse, part, bare;
  ASSERT_TRUE(dubsar_exa::read(kFile, {}, whole, error)) << error;
  EXPECT_GE(whole.positions_mm.size(), 9180u);
  EXPECT_EQ(whole.normals.size(), whole.positions_mm.size());
  EXPECT_EQ(whole.light.size(), whole.positions_mm.size());
  EXPECT_EQ(whole.triangle_partition.size(), whole.triangles.size());
  ASSERT_EQ(whole.partitions.size(), 2u);
  EXPECT_EQ(whole.partitions[1].body, "envelope");
  for (const auto& t : whole.triangles)
    for (const std::uint32_t v : t) ASSERT_LT(v, whole.positions_mm.size());
  dubsar_exa::ReadOptions options;
  options.level = 1;
  ASSERT_TRUE(dubsar_exa::read(kFile, options, coarse, error)) << error;
  EXPECT_LT(coarse.positions_mm.size(), whole.positions_mm.size() / 2);
  options = {};
  options.partition = 1;
  ASSERT_TRUE(dubsar_exa::read(kFile, options, part, error)) << error;
  EXPECT_LT(part.triangles.size(), whole.triangles.size());
  options = {};
  options.attributes = false;
  ASSERT_TRUE(dubsar_exa::read(kFile, options, bare, error)) << error;
  EXPECT_TRUE(bare.normals.empty());
  EXPECT_EQ(bare.light, whole.light);
  options = {};
  options.box_high = {20, 20, 20};
  EXPECT_TRUE(dubsar_exa::read(kFile, options, part, error)) << error;
  EXPECT_TRUE(dubsar_exa::check_sums(kFile, error)) << error;
}

TEST(ExaLibrary, ReadsBytesInMemoryLikeTheFile) {
  std::ifstream file(kFile, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  dubsar_exa::Surface from_file, from_bytes;
  std::string error;
  dubsar_exa::ReadOptions options;
  options.body = "tablet";
  ASSERT_TRUE(dubsar_exa::read(kFile, options, from_file, error)) << error;
  ASSERT_TRUE(dubsar_exa::read_bytes(bytes.data(), bytes.size(), options, from_bytes, error)) << error;
  EXPECT_EQ(from_bytes.positions_mm, from_file.positions_mm);
  EXPECT_EQ(from_bytes.triangles, from_file.triangles);
  EXPECT_EQ(from_bytes.normals, from_file.normals);
  EXPECT_EQ(from_bytes.light, from_file.light);
  EXPECT_FALSE(dubsar_exa::read_bytes(bytes.data(), bytes.size() - 1, options, from_bytes, error));
  EXPECT_THAT(error, ::testing::HasSubstr("truncated"));
  options.level = 1;
  EXPECT_FALSE(dubsar_exa::read_bytes(bytes.data(), bytes.size(), options, from_bytes, error));
  EXPECT_THAT(error, ::testing::HasSubstr("read a file"));
}

TEST(ExaLibrary, SaysWhatIsWrong) {
  dubsar_exa::Surface surface;
  std::string error;
  EXPECT_FALSE(dubsar_exa::read("no such file.exa", {}, surface, error));
  EXPECT_THAT(error, ::testing::HasSubstr("no such file.exa"));
  const auto path = std::filesystem::temp_directory_path() / ("dubsar_api_" + std::to_string(::getpid()) + ".exa");
  std::ofstream(path) << "no surface at all, but long enough to hold a head of some bytes";
  EXPECT_FALSE(dubsar_exa::read(path.string(), {}, surface, error));
  EXPECT_THAT(error, ::testing::HasSubstr("does not start with the EXA mark"));
  EXPECT_FALSE(dubsar_exa::check_sums(path.string(), error));
  std::filesystem::remove(path);
  dubsar_exa::ReadOptions options;
  options.level = 9;
  EXPECT_FALSE(dubsar_exa::read(kFile, options, surface, error));
  EXPECT_THAT(error, ::testing::HasSubstr("level 9"));
}

TEST(ExaLibrary, TheExampleWritesTheTriangles) {
  const auto path = std::filesystem::temp_directory_path() / ("dubsar_api_" + std::to_string(::getpid()) + ".obj");
  const std::string command = std::string("'" EXA_TO_OBJ "' '") + kFile + "' '" + path.string() + "'";
  FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  for (std::array<char, 256> text; std::fgets(text.data(), static_cast<int>(text.size()), pipe) != nullptr;)
    said += text.data();
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_THAT(said, ::testing::HasSubstr("37 x 33 x 29 points"));
  dubsar_exa::Surface surface;
  std::string error;
  ASSERT_TRUE(dubsar_exa::read(kFile, {}, surface, error)) << error;
  std::size_t vertices = 0, faces = 0;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) ++(line[0] == 'v' ? vertices : faces);
  EXPECT_EQ(vertices, surface.positions_mm.size());
  EXPECT_EQ(faces, surface.triangles.size());
  std::filesystem::remove(path);
}
}  // namespace
