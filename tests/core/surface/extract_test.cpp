#include "core/surface/extract.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/parallel.h"
#include "core/surface/mesh_check.h"
#include "core/surface/triangulate.h"
#include "tests/core/surface/random_volume.h"

namespace dubsar {
namespace {

/// f = -|x - c|, c = (n - 1) / 2, as the paper's table 1: values are made when they are asked for.
class SphereSource final : public SlabSource {
 public:
  explicit SphereSource(std::int64_t n) : n_(n) {}
  Dims dims() const noexcept override { return {n_, n_, n_}; }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    const float c = 0.5f * static_cast<float>(n_ - 1);
    parallel_for((z_end - z_begin) * n_, 64, [&](std::int64_t r) {
      const float dy = static_cast<float>(r % n_) - c, dz = static_cast<float>(z_begin + r / n_) - c;
      for (std::int64_t x = 0; x < n_; ++x) {
        const float dx = static_cast<float>(x) - c;
        out[static_cast<std::size_t>(r * n_ + x)] = -std::sqrt(dx * dx + dy * dy + dz * dz);
      }
    });
    return {};
  }

 private:
  std::int64_t n_;
  GridFrame frame_;
};

SurfaceSamples sample(SlabSource& source, float isovalue, bool closed = true, int bits = 4, std::int64_t slab = 0) {
  SilentProgress progress;
  auto samples = sample_surface(source, {isovalue, bits, closed, slab}, progress);
  EXPECT_TRUE(samples.has_value()) << samples.error().message;
  return std::move(*samples);
}

SurfaceSamples sample(const Volume<float>& volume, float isovalue, bool closed = true, int bits = 4,
                      std::int64_t slab = 0) {
  VolumeSource source(volume);
  return sample(source, isovalue, closed, bits, slab);
}

QuadMesh build(const SurfaceSamples& samples) {
  SilentProgress progress;
  auto mesh = build_quad_mesh(samples, progress);
  EXPECT_TRUE(mesh.has_value()) << mesh.error().message;
  return std::move(*mesh);
}

MeshCheck check(const QuadMesh& mesh) {
  const Triangulation cut = triangulate(mesh, {});
  std::vector<glm::vec3> positions = mesh.positions;
  positions.insert(positions.end(), cut.steiner.begin(), cut.steiner.end());
  return check_mesh(positions, cut.triangles);
}

TEST(Extract, SpheresHaveThePapersVertexCounts) {
  for (const auto& [n, vertices] : {std::pair{256, 248426}, {512, 996842}}) {
    SphereSource source(n);
    const QuadMesh mesh = build(sample(source, -0.9f * 0.5f * static_cast<float>(n - 1)));
    EXPECT_EQ(mesh.vertex_count(), vertices);
    EXPECT_EQ(mesh.vertex_count() - mesh.quad_count(), 2);
    const MeshCheck found = check(mesh);
    EXPECT_EQ(found.euler, 2);
    EXPECT_EQ(found.components, 1);
    EXPECT_TRUE(found.watertight());
    const double c = 0.5 * (n - 1), radius = 0.9 * c;
    double worst = 0.0;
    for (const glm::vec3& p : mesh.positions) {
      worst = std::max(worst, std::abs(std::hypot(p.x - c, p.y - c, p.z - c) - radius));
    }
    EXPECT_LT(worst, 0.1);
  }
}

TEST(Extract, RandomVolumesGiveManifolds) {
  int doubled = 0, steiner = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Dims dims{24 + seed % 9, 24 + seed % 5, 24 + seed % 7};
    const bool closed = seed % 3 != 0;
    const Volume<float> volume = random_volume(dims, seed, static_cast<int>(seed % 5));
    const QuadMesh mesh = build(sample(volume, 0.0f, closed));
    const Triangulation cut = triangulate(mesh, {});
    std::vector<glm::vec3> positions = mesh.positions;
    positions.insert(positions.end(), cut.steiner.begin(), cut.steiner.end());
    const MeshCheck found = check_mesh(positions, cut.triangles);
    doubled += static_cast<int>(mesh.doubled.size());
    steiner += static_cast<int>(cut.steiner.size());
    EXPECT_EQ(found.nonmanifold_edges, 0) << "seed " << seed;
    EXPECT_EQ(found.nonmanifold_vertices, 0) << "seed " << seed;
    EXPECT_EQ(found.inconsistent_edges, 0) << "seed " << seed;
    EXPECT_EQ(found.degenerate_triangles, 0) << "seed " << seed;
    EXPECT_EQ(found.vertices, static_cast<std::int64_t>(positions.size())) << "seed " << seed << ": unused vertices";
    if (closed) {
      EXPECT_EQ(found.boundary_edges, 0) << "seed " << seed;
      EXPECT_EQ(found.euler % 2, 0) << "seed " << seed;
    } else {
      EXPECT_GT(found.boundary_edges, 0) << "seed " << seed;
    }
  }
  EXPECT_GT(doubled, 10000) << "the volumes do not reach the split cells";
  EXPECT_GT(steiner, 1000) << "the volumes do not reach the x-quads with neighbouring doubled corners";
}

bool same_bytes(const QuadMesh& a, const QuadMesh& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return same(a.positions, b.positions) && same(a.quads, b.quads) && a.doubled == b.doubled &&
         same(a.first_incident, b.first_incident) && same(a.incident, b.incident) &&
         same(a.doubled_bits, b.doubled_bits);
}

TEST(Extract, AnyThreadCountAndSlabHeightGiveTheSameBytes) {
  const Volume<float> volume = random_volume({67, 31, 29}, 7, 2);
  for (const bool closed : {true, false}) {
    set_thread_count(1);
    const SurfaceSamples expected = sample(volume, 0.0f, closed);
    const QuadMesh mesh = build(expected);
    const Triangulation cut = triangulate(mesh, {});
    for (const int threads : {1, 2, 7}) {
      set_thread_count(threads);
      for (const std::int64_t slab : {1, 2, 5, 28, 29, 1000}) EXPECT_EQ(sample(volume, 0.0f, closed, 4, slab), expected);
      const QuadMesh again = build(expected);
      EXPECT_TRUE(same_bytes(again, mesh));
      EXPECT_EQ(triangulate(again, {}).triangles, cut.triangles);
      QuadMesh rebuilt = mesh;
      rebuilt.build_incidence();
      EXPECT_TRUE(same_bytes(rebuilt, mesh)) << "incidence of the table and incidence of the x-quads differ";
    }
    set_thread_count(0);
  }
}

}  // namespace
}  // namespace dubsar
