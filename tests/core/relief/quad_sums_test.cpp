// Normals and curvatures in vector units, against the same written down plainly in double, on surfaces of noise with
// every kind of x-quad, in several blocks.

#include "core/relief/smoothing/quad_sums.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>

#include "core/base/system/parallel.h"
#include "core/extract/extract.h"
#include "core/relief/curvature/curvature.h"
#include "core/relief/smoothing/corner_weights.h"
#include "core/relief/smoothing/face_median.h"
#include "core/relief/smoothing/scatter_blocks.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/extract/random_volume.h"
#include "tests/core/relief/same_bytes.h"

namespace dubsar {
namespace {

QuadMesh noise_mesh(Dims dims, unsigned seed, int kind, bool closed) {
  const Volume<float> volume = random_volume(dims, seed, kind);
  VolumeSource source(volume);
  SilentProgress progress;
  return build_quad_mesh(*sample_surface(source, {.isovalue = 0.0f, .closed = closed}, progress), progress).value();
}

/// Three blocks of vertices; more than a hundred doubled corners.
const QuadMesh& large_mesh() {
  static const QuadMesh mesh = noise_mesh({62, 58, 55}, 7, 0, true);
  EXPECT_GT(mesh.vertex_count(), 2 * kScatterBlock);
  EXPECT_GT(mesh.doubled.size(), 100u);
  return mesh;
}
std::vector<QuadMesh> meshes() {
  std::vector<QuadMesh> all{large_mesh()};
  for (int kind = 0; kind < 5; ++kind)
    all.push_back(noise_mesh({17, 16, 15}, 30u + unsigned(kind), kind, kind % 2 == 0));
  return all;
}

TEST(QuadSums, FacesAreNewellsAndVerticesTheirWeightedMean) {
  for (const QuadMesh& mesh : meshes()) {
    const std::vector<glm::vec4> faces = face_normals(mesh);
    for (std::uint32_t q = 0; q < faces.size(); ++q) {
      const Polygon polygon = mesh.polygon(q);
      glm::dvec3 sum(0.0), before(0.0);
      for (int i = 0; i < polygon.size; ++i) {
        const glm::dvec3 p =
            glm::dvec3(mesh.positions[polygon.vertex[std::size_t(i)]]) - glm::dvec3(mesh.positions[polygon.vertex[0]]);
        sum += 0.5 * glm::cross(before, p);
        before = p;
      }
      ASSERT_NEAR(double{faces[q].w}, glm::length(sum), 1e-5);
      ASSERT_LT(glm::length(glm::dvec3(glm::vec3(faces[q])) * double{faces[q].w} - sum), 1e-5) << q;
    }
    const std::vector<glm::vec3> normals = vertex_normals(mesh, faces);
    for (std::uint32_t v = 0; v < normals.size(); ++v) {
      glm::dvec3 sum(0.0);
      double size = 0.0;
      for (const std::uint32_t q : mesh.quads_of(v)) {
        const double weight = double{corner_weight(mesh, q, v)};
        sum += weight * glm::dvec3(glm::vec3(faces[q]));
        size += weight;
      }
      const double length = glm::length(sum);
      if (length < 1e-4 * size || length == 0.0) continue;  // normals that cancel
      ASSERT_LT(glm::length(glm::dvec3(normals[v]) - sum / length), 1e-5 * size / length) << v;
    }
  }
}

/// Does a face share four vertices with another? Lists of neighbours count three.
bool shares_four(const QuadMesh& mesh, std::uint32_t face) {
  std::map<std::uint32_t, int> shared;
  const Polygon polygon = mesh.polygon(face);
  for (int i = 0; i < polygon.size; ++i)
    for (const std::uint32_t other : mesh.quads_of(polygon.vertex[std::size_t(i)])) ++shared[other];
  shared.erase(face);
  return std::any_of(shared.begin(), shared.end(), [](const auto& item) { return item.second > 3; });
}

TEST(QuadSums, TheMedianOverVerticesIsTheOneOverListsOfNeighbours) {
  SilentProgress progress;
  for (const QuadMesh& mesh : meshes()) {
    NormalFilterOptions options;
    options.iterations = 1;
    options.epsilon = 0.1f;
    std::vector<glm::vec4> listed = face_normals(mesh);
    LargeArray<glm::vec4> found(listed.size());
    std::copy(listed.begin(), listed.end(), found.begin());
    ASSERT_TRUE(filter_normals(FaceNeighbours::build(mesh, progress).value(), options, listed, progress));
    ASSERT_TRUE(filter_face_normals(mesh, options, found, progress));
    for (std::uint32_t q = 0; q < found.size(); ++q)
      EXPECT_TRUE(glm::length(listed[q] - found.data()[q]) < 1e-4f || shares_four(mesh, q)) << q;
  }
}

TEST(QuadSums, AFewPassesOverASmoothSurfaceAreTheOnesOverLists) {
  Volume<float> volume({60, 50, 40});
  for (std::int64_t i = 0; i < volume.dims.count(); ++i) {
    const std::int64_t row = i / 60, slice = row / 50;
    const double x = double(i % 60), y = double(row % 50), z = double(slice);
    volume.voxels[i] = static_cast<float>(std::sin(.31 * x) + std::sin(.27 * y + 1.0) + std::sin(.23 * z));
  }
  VolumeSource source(volume);
  SilentProgress progress;
  const QuadMesh mesh = build_quad_mesh(*sample_surface(source, {.isovalue = 0.1f}, progress), progress).value();
  ASSERT_TRUE(mesh.doubled.empty());
  NormalFilterOptions options;
  options.iterations = 7;
  options.epsilon = 0.03f;
  std::vector<glm::vec4> listed = face_normals(mesh);
  LargeArray<glm::vec4> found(listed.size());
  std::copy(listed.begin(), listed.end(), found.begin());
  ASSERT_TRUE(filter_normals(FaceNeighbours::build(mesh, progress).value(), options, listed, progress));
  ASSERT_TRUE(filter_face_normals(mesh, options, found, progress));
  for (std::uint32_t q = 0; q < found.size(); ++q) ASSERT_LT(glm::length(listed[q] - found.data()[q]), 1e-4f) << q;
}

/// The fit of principal_curvatures() as its header states it.
glm::dvec2 fitted(const QuadMesh& mesh, const std::vector<glm::vec3>& normals, std::uint32_t v, double& firmness) {
  const glm::dvec3 n(normals[v]);
  const glm::dvec3 e0 =
      glm::normalize(std::abs(n.x) < 0.7 ? glm::cross(n, glm::dvec3(1, 0, 0)) : glm::cross(n, glm::dvec3(0, 1, 0)));
  const glm::dvec3 e1 = glm::cross(n, e0);
  double uu = 0, uv = 0, vv = 0, x = 0, y = 0, z = 0;
  for (const std::uint32_t q : mesh.quads_of(v)) {
    std::array<glm::dvec3, 4> p, m;
    std::array<int, 4> count{};
    const Polygon polygon = mesh.polygon(q);
    for (std::size_t i = 0; i < std::size_t(polygon.size); ++i) {
      const std::size_t c = polygon.corner[i];
      const glm::dvec3 at(mesh.positions[polygon.vertex[i]]), normal(normals[polygon.vertex[i]]);
      p[c] = count[c] == 0 ? at : 0.5 * (p[c] + at);
      m[c] = count[c]++ == 0 ? normal : 0.5 * (m[c] + normal);
    }
    const auto add = [&](const glm::dvec3& u, const glm::dvec3& d) {
      const double a = glm::dot(u, e0), b = glm::dot(u, e1), s = glm::dot(d, e0), t = glm::dot(d, e1);
      uu += a * a, uv += a * b, vv += b * b, x += a * s, y += a * t + b * s, z += b * t;
    };
    add(p[2] - p[0], m[2] - m[0]);
    add(p[3] - p[1], m[3] - m[1]);
    add(0.5 * (p[1] + p[2] - p[0] - p[3]), 0.5 * (m[1] + m[2] - m[0] - m[3]));
    add(0.5 * (p[2] + p[3] - p[0] - p[1]), 0.5 * (m[2] + m[3] - m[0] - m[1]));
  }
  firmness = (uu * vv - uv * uv) / ((uu + vv) * (uu + vv));
  const double ridge = 1e-5 * (uu + vv);
  uu += ridge, vv += ridge;
  const double b = (y - uv * (x / uu + z / vv)) / ((uu + vv) * (1.0 - uv * uv / (uu * vv)));
  const double a = (x - b * uv) / uu, c = (z - b * uv) / vv;
  const double mean = 0.5 * (a + c), half = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
  return {mean - half, mean + half};
}

TEST(QuadSums, CurvaturesFitTheDifferencesOfAllXQuadsAround) {
  SilentProgress progress;
  for (const QuadMesh& mesh : meshes()) {
    const std::vector<glm::vec3> normals = vertex_normals(mesh, face_normals(mesh));
    const Curvatures k = principal_curvatures(mesh, normals, CurvatureMethod::kFit, progress).value();
    std::size_t compared = 0;
    for (std::uint32_t v = 0; v < normals.size(); ++v) {
      double firmness = 0.0;
      const glm::dvec2 expected = fitted(mesh, normals, v, firmness);
      if (!(firmness > 1e-3)) continue;  // differences along one line
      ++compared;
      ASSERT_NEAR(double{k.k_min[v]}, expected.x, 1e-3 * (1.0 + std::abs(expected.x))) << v;
      ASSERT_NEAR(double{k.k_max[v]}, expected.y, 1e-3 * (1.0 + std::abs(expected.y))) << v;
    }
    EXPECT_GT(compared, normals.size() / 2);
  }
}

struct Relief {
  std::vector<glm::vec3> normals;
  Curvatures k;
};
Relief relief_of(const QuadMesh& mesh) {
  SilentProgress progress;
  LargeArray<glm::vec4> faces(mesh.quads.size());
  fill_face_normals(mesh, faces);
  NormalFilterOptions options;
  options.iterations = 2;
  EXPECT_TRUE(filter_face_normals(mesh, options, faces, progress));
  Relief relief{vertex_normals(mesh, faces), {}};
  relief.k = principal_curvatures(mesh, relief.normals, CurvatureMethod::kFit, progress).value();
  return relief;
}

TEST(QuadSums, AreTheSameForAnyVectorUnitAndAnyNumberOfThreads) {
  const QuadMesh& mesh = large_mesh();
  const Relief first = relief_of(mesh);
  const auto expect_same = [&](const Relief& other, const std::string& what) {
    EXPECT_TRUE(test::same_bytes(other.normals, first.normals)) << what;
    EXPECT_TRUE(test::same_bytes(other.k.k_min, first.k.k_min)) << what;
    EXPECT_TRUE(test::same_bytes(other.k.k_max, first.k.k_max)) << what;
  };
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    expect_same(relief_of(mesh), std::to_string(threads));
  }
  set_thread_count(0);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    expect_same(relief_of(mesh), hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(QuadSums, NormalsDoNotDependOnTheSizeOfBlocks) {
  const QuadMesh mesh = noise_mesh({110, 100, 90}, 12, 1, true);
  ASSERT_GT(mesh.quad_count(), 4 * kScatterBlock + 4);  // one thread takes larger blocks than five
  std::vector<glm::vec3> first;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    const Relief relief = relief_of(mesh);
    if (first.empty()) first = relief.normals;
    EXPECT_TRUE(test::same_bytes(relief.normals, first)) << threads;
  }
  set_thread_count(0);
}

TEST(QuadSums, AMeshWithoutFacesHasNormalsThatPointUp) {
  QuadMesh mesh;
  mesh.positions = {{1, 2, 3}, {4, 5, 6}};
  mesh.build_incidence();
  const std::vector<glm::vec3> normals = vertex_normals(mesh, face_normals(mesh));
  EXPECT_EQ(normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}}));
  SilentProgress progress;
  const Curvatures k = principal_curvatures(mesh, normals, CurvatureMethod::kFit, progress).value();
  EXPECT_EQ(k.k_max, (std::vector<float>{0.0f, 0.0f}));
}

}  // namespace
}  // namespace dubsar
