#pragma once
// What the tests of the surface room share: a sphere as a source, and extraction in one call.

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/system/parallel.h"
#include "core/extract/extract.h"
#include "core/extract/triangulate.h"
#include "core/mesh/mesh_check.h"

namespace dubsar {

/// f = -|x - c|, c = (n - 1) / 2, as the paper's table 1: values are made when they are asked for.
class SphereSource final : public SlabSource {
 public:
  explicit SphereSource(std::int64_t n) : n_(n) {}
  Dims dims() const noexcept override { return {n_, n_, n_}; }
  const GridFrame& frame() const noexcept override { return frame_; }
  /// 90 % of the largest radius.
  float isovalue() const noexcept { return -0.9f * 0.5f * static_cast<float>(n_ - 1); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    const float c = 0.5f * static_cast<float>(n_ - 1);
    parallel_for((z_end - z_begin) * n_, 1 << 10, [&](std::int64_t r) {
      const float dy = static_cast<float>(r % n_) - c, dz = static_cast<float>(z_begin + r / n_) - c;
      float* row = out.data() + r * n_;
      for (int x = 0; x < static_cast<int>(n_); ++x) {
        const float dx = static_cast<float>(x) - c;
        row[x] = -std::sqrt(dx * dx + dy * dy + dz * dz);
      }
    });
    return {};
  }

 private:
  std::int64_t n_;
  GridFrame frame_;
};

inline SurfaceSamples sample(SlabSource& source, float isovalue, bool closed = true, int bits = 4,
                             std::int64_t slab = 0) {
  SilentProgress progress;
  auto samples = sample_surface(source, {isovalue, bits, closed, slab}, progress);
  EXPECT_TRUE(samples.has_value()) << samples.error().message;
  return std::move(*samples);
}

inline SurfaceSamples sample(const Volume<float>& volume, float isovalue, bool closed = true, int bits = 4,
                             std::int64_t slab = 0) {
  VolumeSource source(volume);
  return sample(source, isovalue, closed, bits, slab);
}

inline QuadMesh build(const SurfaceSamples& samples) {
  SilentProgress progress;
  auto mesh = build_quad_mesh(samples, progress);
  EXPECT_TRUE(mesh.has_value()) << mesh.error().message;
  return std::move(*mesh);
}

/// Vertices and Steiner points, as the triangles number them.
inline std::vector<glm::vec3> all_positions(const QuadMesh& mesh, const Triangulation& cut) {
  std::vector<glm::vec3> positions = mesh.positions;
  positions.insert(positions.end(), cut.steiner.begin(), cut.steiner.end());
  return positions;
}

inline MeshCheck check(const QuadMesh& mesh) {
  const Triangulation cut = triangulate(mesh, {});
  return check_mesh(all_positions(mesh, cut), cut.triangles);
}

}  // namespace dubsar
