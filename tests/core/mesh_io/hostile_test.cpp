// Every parser meets every truncation, single bit flips and trailing bytes: it may accept or refuse, and what it
// accepts is a mesh with valid ids and finite positions.

#include <random>

#include "core/base/files/atomic_file.h"
#include "core/base/files/input_file.h"
#include "core/mesh_io/mesh_formats.h"
#include "core/mesh_io/mesh_output.h"
#include "mesh_samples.h"

namespace dubsar {
namespace {

class HostileMesh : public FileTest, public ::testing::WithParamInterface<const char*> {
 protected:
  std::string sample(MeshUnits units) {
    SilentProgress progress;
    const auto path = folder_ / (std::string("a.") + GetParam());
    EXPECT_TRUE(write_mesh(path, sample_mesh(6, 4), {units}, progress));
    return *read_file_bytes(path);
  }
  bool accepted(const std::string& bytes) {
    SilentProgress progress;
    Result<TriMesh> (*parse)(std::string_view, Progress&) = parse_ply;
    const std::string name = GetParam();
    if (name == "stl") parse = parse_stl;
    if (name == "obj") parse = parse_obj;
    if (name == "glb") parse = [](std::string_view all, Progress& told) { return parse_glb(all, told); };
    const auto mesh = parse(bytes, progress);
    if (mesh) {
      EXPECT_TRUE(check_tri_mesh(*mesh)) << check_tri_mesh(*mesh).error().message;
      return true;
    }
    EXPECT_EQ(mesh.error().kind, ErrorKind::kBadData) << mesh.error().message;
    EXPECT_GT(mesh.error().message.size(), 15u);
    return false;
  }
};

TEST_P(HostileMesh, TruncationsNeverCrashAndBinaryOnesAreRefused) {
  const std::string whole = sample(MeshUnits::kMm);
  ASSERT_TRUE(accepted(whole));
  const bool text = std::string(GetParam()) == "obj";
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 512 + 1) {
    const bool good = accepted(whole.substr(0, length));
    EXPECT_TRUE(text || !good) << length << " of " << whole.size() << " bytes were accepted";
  }
}

TEST_P(HostileMesh, BitFlipsNeverCrash) {
  const std::string whole = sample(MeshUnits::kVox);
  std::mt19937 random(7);
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = whole;
    for (int flips = round % 4; flips >= 0; --flips)
      bytes[random() % (round % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 1200))] ^=
          static_cast<char>(1u << (random() % 8));
    accepted(bytes);
  }
}

TEST_P(HostileMesh, BlocksMovedAroundNeverCrash) {
  const std::string whole = sample(MeshUnits::kVox);
  std::mt19937 random(11);
  for (int round = 0; round < 500; ++round) {
    std::string bytes = whole;
    const std::size_t from = random() % bytes.size(), length = random() % 64;
    bytes.insert(random() % bytes.size(), whole.substr(from, length));
    bytes.erase(random() % bytes.size(), random() % 64);
    accepted(bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileMesh, ::testing::Values("ply", "stl", "obj", "glb"),
                         [](const auto& format) { return std::string(format.param); });

class MeshDoor : public FileTest {};

TEST_F(MeshDoor, CancelLeavesTheOldFile) {
  class Impatient final : public Progress {
    void on_advance(std::int64_t) override { cancel(); }
  };
  const TriMesh mesh = sample_mesh(400, 60);
  for (const char* name : {"a.ply", "a.stl", "a.obj", "a.glb"}) {
    ASSERT_TRUE(write_file_atomically(folder_ / name, "old"));
    Impatient progress;
    if (std::string_view(name) == "a.glb") progress.cancel();
    const auto written = write_mesh(folder_ / name, mesh, {}, progress);
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().kind, ErrorKind::kCancelled);
    EXPECT_EQ(*read_file_bytes(folder_ / name), "old");
  }
}

TEST_F(MeshDoor, ContentWinsOverTheSuffix) {
  SilentProgress progress;
  ASSERT_TRUE(write_mesh(folder_ / "a.ply", sample_mesh(), {}, progress));
  std::filesystem::rename(folder_ / "a.ply", folder_ / "a.stl");
  EXPECT_EQ(mesh_info(folder_ / "a.stl", progress)->format, MeshFormat::kPly);
}

TEST_F(MeshDoor, WrongPathsHaveTheirKinds) {
  SilentProgress progress;
  EXPECT_EQ(read_mesh(folder_ / "none.ply", progress).error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(read_mesh(folder_, progress).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(write_mesh(folder_ / "a.xyz", {}, {}, progress).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(write_mesh(folder_ / "no" / "a.ply", {}, {}, progress).error().kind, ErrorKind::kCannotCreate);
  ASSERT_TRUE(write_file_atomically(folder_ / "empty.obj", ""));
  EXPECT_EQ(read_mesh(folder_ / "empty.obj", progress).error().kind, ErrorKind::kBadData);
}

TEST_F(MeshDoor, EmptyMeshCanBeWrittenAndRead) {
  SilentProgress progress;
  for (const char* name : {"a.ply", "a.stl", "a.obj", "a.glb"}) {
    ASSERT_TRUE(write_mesh(folder_ / name, {}, {}, progress)) << name;
    const auto mesh = read_mesh(folder_ / name, progress);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_TRUE(mesh->triangles.empty());
  }
}

}  // namespace
}  // namespace dubsar
