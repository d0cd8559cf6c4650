// The one real tablet that lies beside the project: S264 of Smith College (CC BY 4.0), 20 000 triangles, written on all
// sides. Which way it stands was read off the photograph in its file: heads above and at the left.

#include <gtest/gtest.h>

#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <random>

#include "core/mesh/simplify.h"
#include "core/mesh/tablet_frame.h"
#include "core/mesh_io/mesh_io.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class RealTablet : public ::testing::Test {
 protected:
  static fs::path file() {
    return fs::path(DUBSAR_SOURCE_DIR).parent_path() / "shared/data/real/s264_smith_college_cc-by.glb";
  }
  void SetUp() override {
    if (!fs::exists(file())) GTEST_SKIP() << "the scan of S264 lies only beside the project: " << file();
    Progress progress;
    const auto read = read_mesh(file(), progress);
    ASSERT_TRUE(read) << read.error().message;
    mesh_ = *read;
  }

  /// Stands it upright from some attitudes, of any size; `probability` is the least that must be claimed.
  void stands_upright(const TriMesh& mesh, unsigned seed, double probability) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int attitude = 0; attitude < 5; ++attitude) {
      const glm::dvec3 axis = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
      const double angle = std::uniform_real_distribution<double>(0.0, 6.283)(random);
      const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle, axis));
      const double size = std::exp(3.0 * normal(random));
      TriMesh lying = mesh;
      for (glm::vec3& p : lying.positions) p = glm::vec3(size * (turn * glm::dvec3(p)));
      const auto found = find_tablet_frame(lying);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_GT(glm::dot(found->front, turn * front_), 0.98) << "attitude " << attitude;
      EXPECT_GT(glm::dot(found->up, turn * up_), 0.98) << "attitude " << attitude;
      EXPECT_GE(found->up_probability, probability) << "attitude " << attitude;
      EXPECT_GE(found->obverse_probability, probability) << "attitude " << attitude;
    }
  }

  TriMesh mesh_;
  const glm::dvec3 front_ = glm::normalize(glm::dvec3(-0.630, -0.007, 0.776));
  const glm::dvec3 up_ = glm::normalize(glm::dvec3(-0.776, -0.038, -0.630));
};

TEST_F(RealTablet, StandsUprightHoweverItLay) { stands_upright(mesh_, 1, kSureOfTheWay); }

TEST_F(RealTablet, ItsFileIsToldWithTheProbability) {
  Progress progress;
  const auto info = mesh_info(file(), progress);
  ASSERT_TRUE(info && info->way);
  EXPECT_GT(info->way->up_probability, 0.99);
  EXPECT_EQ(info->way->doubt(), "");
}

TEST_F(RealTablet, StandsUprightWithHalfOfItsTriangles) {
  TriMesh joined = mesh_;  // its seams are of the photograph, not of the clay
  std::map<std::array<float, 3>, std::uint32_t> first;
  for (Triangle& t : joined.triangles)
    for (std::uint32_t& v : t) {
      const glm::vec3& p = mesh_.positions[v];
      v = first.try_emplace({p.x, p.y, p.z}, v).first->second;
    }
  joined.normals.clear();
  // simplify() counts in steps of the grid, a file of triangles in its unit: 1 mm of 30, whatever unit that is.
  glm::vec3 least(joined.positions[0]), most(least);
  for (const glm::vec3& p : joined.positions) least = glm::min(least, p), most = glm::max(most, p);
  for (glm::vec3& p : joined.positions) p *= 30.f / glm::distance(least, most);
  Progress progress;
  const auto fewer = simplify(joined, {}, progress);
  ASSERT_TRUE(fewer) << fewer.error().message;
  ASSERT_LT(fewer->triangles.size(), 13000u);
  stands_upright(*fewer, 2, kSureOfTheWay);
}

TEST_F(RealTablet, StandsUprightWithShakenVertices) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double edges = 0.0;
  for (const Triangle& t : mesh_.triangles)
    edges += static_cast<double>(glm::distance(mesh_.positions[t[0]], mesh_.positions[t[1]]));
  const double shake = 0.1 * edges / static_cast<double>(mesh_.triangles.size());
  std::map<std::array<float, 3>, glm::dvec3> moved;  // the same at both sides of a seam
  TriMesh shaken = mesh_;
  for (glm::vec3& p : shaken.positions) {
    const auto [at, fresh] = moved.try_emplace({p.x, p.y, p.z});
    if (fresh) at->second = shake * glm::dvec3(normal(random), normal(random), normal(random));
    p += glm::vec3(at->second);
  }
  stands_upright(shaken, 4, 0.8);
}

TEST_F(RealTablet, ItsMirrorImageIsNotCalledUpright) {
  TriMesh image = mesh_;
  for (glm::vec3& p : image.positions) p.x = -p.x;
  for (Triangle& t : image.triangles) std::swap(t[1], t[2]);
  const auto found = find_tablet_frame(image);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->sure());
  EXPECT_GT(found->mirrored_probability, 0.9);
}

}  // namespace
}  // namespace dubsar
