// Scenes of glTF: what stands in them, where, in which shape, and what is said of data that lie elsewhere.

#include <gmock/gmock.h>

#include <chrono>

#include "core/mesh_io/mesh_formats.h"
#include "tests/core/mesh_io/foreign_body.h"
#include "tests/core/mesh_io/mesh_samples.h"

namespace dubsar {
namespace {

using foreign::GlbMaker;
using foreign::Json;
using ::testing::HasSubstr;

std::string says(const GlbMaker& maker) {
  SilentProgress progress;
  const auto mesh = parse_glb(maker.file(), progress);
  return mesh ? "accepted" : mesh.error().message;
}

std::vector<glm::dvec3> moved_by_m(double x) {
  return std::vector<glm::dvec3>(foreign::kCorners.size(), glm::dvec3(x, 0, 0));
}

TEST(ForeignScene, MorphTargetsMoveBySharesOfTheNodeOrOfTheMesh) {
  GlbMaker maker = foreign::plain_glb();
  maker.primitive()["targets"] =
      Json::array({{{"POSITION", maker.floats(moved_by_m(0.1))}}, {{"POSITION", maker.floats(moved_by_m(-0.01))}}});
  const auto low = [&] { return foreign::extent_of(read(maker)).low.x; };
  EXPECT_NEAR(low(), -20.0, 1e-3) << "no shares: 0";
  maker.json["meshes"][0]["weights"] = {1, 0};
  EXPECT_NEAR(low(), 80.0, 1e-3);
  maker.json["nodes"][0]["weights"] = {0.5, 1};
  EXPECT_NEAR(low(), 20.0, 1e-3) << "the node's come first";
  maker.json["nodes"][0]["scale"] = {2, 2, 2};
  EXPECT_NEAR(low(), 40.0, 1e-3) << "morphed, then moved";
  maker.json["nodes"][0]["weights"] = {1, 1, 1, 1};
  EXPECT_NEAR(foreign::volume_of(read(maker)), 32000.0, 1.0) << "shares of targets that do not exist";
}

TEST(ForeignScene, InstancesAreCountedByAnyOfTheirAttributes) {
  GlbMaker maker = foreign::plain_glb();
  const std::size_t ids = maker.accessor(foreign::little(0.0f) + foreign::little(1.0f), 2, 5126, "SCALAR");
  maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"_ID", ids}};
  EXPECT_NEAR(foreign::volume_of(read(maker)), 8000.0, 1.0);
}

TEST(ForeignScene, ManyInstancesDoNotAskTheSystemForEach) {
  GlbMaker maker = foreign::plain_glb();
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 30000; ++i) places.emplace_back(0.1 * i, 0, 0);
  maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", maker.floats(places)}};
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(read(maker).triangles.size(), 8u * 30000u);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15)) << "some .3 s, once a minute";
}

TEST(ForeignScene, RotationsAreOfLengthOne) {
  GlbMaker maker = foreign::plain_glb();
  maker.json["nodes"][0]["rotation"] = {0, 0, 1.4142, 1.4142};
  const auto size = foreign::extent_of(read(maker)).size();
  EXPECT_NEAR(size.x, 30.0, 1e-3);
  EXPECT_NEAR(size.y, 40.0, 1e-3);
  maker.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  EXPECT_NEAR(foreign::extent_of(read(maker)).size().x, 40.0, 1e-3);
}

TEST(ForeignScene, WithoutScenesWhatIsNoChildIsShown) {
  GlbMaker maker = foreign::plain_glb();
  maker.json.erase("scenes");
  maker.json.erase("scene");
  maker.json["nodes"] =
      Json::array({{{"mesh", 0}, {"translation", {1, 0, 0}}}, {{"children", {0}}, {"translation", {1, 0, 0}}}});
  EXPECT_NEAR(foreign::extent_of(read(maker)).low.x, 1980.0, 1e-3);
  maker = foreign::plain_glb();
  maker.json["scene"] = 5;
  EXPECT_THAT(says(maker), HasSubstr("the scene to be shown does not exist"));
  maker.json.erase("nodes");
  EXPECT_THAT(says(maker), HasSubstr("no nodes found"));
}

TEST(ForeignScene, CountsInFloatingPointAreCounts) {
  GlbMaker maker = foreign::plain_glb();
  maker.json["accessors"][0]["count"] = 6.0;
  maker.json["bufferViews"][1]["byteOffset"] = 72.0;
  EXPECT_NEAR(foreign::volume_of(read(maker)), 4000.0, 1.0);
  for (const double wrong : {6.5, -6.0, 1e300}) {
    maker.json["accessors"][0]["count"] = wrong;
    EXPECT_THAT(says(maker), HasSubstr("an accessor is broken"));
  }
}

TEST(ForeignScene, DataElsewhereAreToldAsThat) {
  const auto from = [](const std::string& uri) {
    std::string file = foreign::plain_glb().file();
    const std::string key = "\"buffers\":[{";
    const std::size_t at = file.find(key) + key.size();
    std::string insert = "\"uri\":\"" + uri + "\",";
    insert.resize((insert.size() + 3) / 4 * 4, ' ');
    file.insert(at, insert);
    for (const std::size_t length : {8u, 12u}) {
      std::uint32_t value = 0;
      std::memcpy(&value, file.data() + length, 4);
      file.replace(length, 4, foreign::little(value + insert.size(), 4));
    }
    SilentProgress progress;
    const auto mesh = parse_glb(file, progress);
    return mesh ? "accepted" : mesh.error().message;
  };
  EXPECT_THAT(from("my%20data.bin"), HasSubstr("in another file (my%20data.bin)"));
  EXPECT_THAT(from("data:application/octet-stream;base64,AAAA"), HasSubstr("as text (a data URI)"));

  // Of Draco there are counts, but no bytes.
  GlbMaker maker = foreign::plain_glb();
  maker.json["accessors"][0].erase("bufferView");
  maker.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  EXPECT_THAT(says(maker), HasSubstr("KHR_draco_mesh_compression found"));
}

}  // namespace
}  // namespace dubsar
