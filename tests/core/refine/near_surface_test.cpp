#include "core/refine/near_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/system/parallel.h"
#include "core/filter/resample.h"

namespace dubsar {
namespace {

Volume<float> make(Dims dims, const std::function<double(double, double, double)>& f) {
  Volume<float> volume(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x)
        volume.at(x, y, z) =
            static_cast<float>(f(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)));
  return volume;
}

NearSurface marked(const Volume<float>& scan, float margin) {
  VolumeSource source(scan);
  HalfResolutionSource half(source);
  SilentProgress progress;
  return mark_near_surface(half, scan.dims, {0.5f, margin, 4}, progress).value();
}

TEST(NearSurface, BricksAlongABallAreNearAndTheOthersKnowTheirSide) {
  for (const Dims dims : {Dims{81, 72, 67}, Dims{64, 64, 64}, Dims{90, 79, 71}}) {
    const glm::dvec3 centre = glm::dvec3(dims.x, dims.y, dims.z) * glm::dvec3(0.5, 0.48, 0.51);
    const double radius = 25.0;
    const Volume<float> ball = make(dims, [&](double x, double y, double z) {
      const glm::dvec3 d = glm::dvec3(x, y, z) - centre;
      return std::clamp(0.5 + radius - std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), 0.0, 1.0);
    });
    const NearSurface surface = marked(ball, 0.1f);
    const Dims b = surface.near.bricks();
    for (std::int64_t bz = 0; bz < b.z; ++bz)
      for (std::int64_t by = 0; by < b.y; ++by)
        for (std::int64_t bx = 0; bx < b.x; ++bx) {
          int inside = 0, points = 0;
          double least = 1e9;  // of a point from the surface
          for (std::int64_t z = 8 * bz; z < std::min(8 * bz + 8, dims.z); ++z)
            for (std::int64_t y = 8 * by; y < std::min(8 * by + 8, dims.y); ++y)
              for (std::int64_t x = 8 * bx; x < std::min(8 * bx + 8, dims.x); ++x) {
                ++points;
                inside += ball.at(x, y, z) >= 0.5f;
                const glm::dvec3 d = glm::dvec3(x, y, z) - centre;
                least = std::min(least, std::abs(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z) - radius));
              }
          const bool near = surface.near.get(bx, by, bz);
          if (least < 2.5) {
            EXPECT_TRUE(near) << bx << ' ' << by << ' ' << bz;
          }
          if (least > 14.0) {
            EXPECT_FALSE(near) << bx << ' ' << by << ' ' << bz;
          }
          if (near) continue;
          ASSERT_TRUE(inside == 0 || inside == points) << bx << ' ' << by << ' ' << bz;
          EXPECT_EQ(surface.inside.get(bx, by, bz), inside == points) << bx << ' ' << by << ' ' << bz;
        }
  }
}

TEST(NearSurface, AGapThatTheHalfGridBlursAwayIsMarkedByItsShadow) {
  // A slit of one voxel in clay: 2:1 leaves at least half of it, above the threshold.
  const Volume<float> slit = make({64, 64, 64}, [](double x, double, double) { return x == 30.0 ? 0.0 : 1.0; });
  EXPECT_EQ(marked(slit, 0.1f).near.count(), 0);
  const NearSurface surface = marked(slit, 0.3f);
  EXPECT_GE(surface.near.count(), 64);
  EXPECT_TRUE(surface.near.get(3, 4, 4));
  EXPECT_FALSE(surface.near.get(0, 4, 4));
  EXPECT_TRUE(surface.inside.get(0, 4, 4));
}

TEST(NearSurface, OfAThinScanAllIsNear) {
  const NearSurface surface = marked(make({40, 12, 40}, [](double, double, double) { return 1.0; }), 0.1f);
  EXPECT_EQ(surface.near.count(), 5 * 2 * 5);
}

TEST(NearSurface, ThreadsChangeNothing) {
  const Volume<float> waves =
      make({70, 61, 55}, [](double x, double y, double z) { return 0.5 + 0.5 * std::sin(0.2 * x + 0.1 * y * z / 30); });
  const NearSurface first = marked(waves, 0.2f);
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    const NearSurface again = marked(waves, 0.2f);
    for (std::int64_t bz = 0; bz < 7; ++bz)
      for (std::int64_t by = 0; by < 8; ++by) {
        EXPECT_EQ(*again.near.row(by, bz), *first.near.row(by, bz));
        EXPECT_EQ(*again.inside.row(by, bz), *first.inside.row(by, bz));
      }
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace dubsar
