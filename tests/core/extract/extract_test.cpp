#include "core/extract/extract.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <random>

#include "core/extract/row_kernels.h"
#include "tests/core/extract/extract_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

TEST(Extract, SpheresHaveThePapersVertexCounts) {
  for (const auto& [n, vertices] : {std::pair{256, 248426}, {512, 996842}}) {
    SphereSource source(n);
    const QuadMesh mesh = build(sample(source, source.isovalue()));
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
  set_thread_count(1);  // the work is too small for more
  int doubled = 0, steiner = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Dims dims{24 + seed % 9, 24 + seed % 5, 24 + seed % 7};
    const bool closed = seed % 3 != 0;
    const Volume<float> volume = random_volume(dims, seed, static_cast<int>(seed % 5));
    const QuadMesh mesh = build(sample(volume, 0.0f, closed));
    const Triangulation cut = triangulate(mesh, {});
    const std::vector<glm::vec3> positions = all_positions(mesh, cut);
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
  set_thread_count(0);
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
      for (const std::int64_t slab : {1, 2, 5, 28, 29, 1000})
        EXPECT_EQ(sample(volume, 0.0f, closed, 4, slab), expected);
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

TEST(Extract, EveryInstructionSetGivesTheSameBytes) {
  for (const int bits : {4, 16}) {
    const Volume<float> volume = random_volume({203, 11, 12}, 5, 2);
    const SurfaceSamples expected = sample(volume, 0.0f, true, bits);
    const QuadMesh mesh = build(expected);
    int targets = 0;
    for (std::int64_t rest = hwy::SupportedTargets(); rest != 0; rest &= rest - 1) {
      hwy::SetSupportedTargetsForTest(rest & -rest);
      EXPECT_EQ(sample(volume, 0.0f, true, bits), expected) << hwy::TargetName(rest & -rest);
      EXPECT_TRUE(same_bytes(build(expected), mesh)) << hwy::TargetName(rest & -rest);
      ++targets;
    }
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_GE(targets, 1);
  }
}

TEST(Extract, VertexCountAt1024IsThePapersWithoutAnyVolume) {
  // The signs of the same sphere, row by row: inside where |dx| <= sqrt(r^2 - dy^2 - dz^2).
  constexpr std::int64_t n = 1024;
  const double c = 0.5 * (n - 1), radius = 0.9 * c;
  SurfaceSamples samples;
  samples.dims = {n, n, n};
  samples.signs = BitVolume(samples.dims);
  for (std::int64_t z = 0; z < n; ++z) {
    for (std::int64_t y = 0; y < n; ++y) {
      const double dy = static_cast<double>(y) - c, dz = static_cast<double>(z) - c;
      const double square = radius * radius - dy * dy - dz * dz;
      if (square < 0.25) continue;
      const auto from = static_cast<std::int64_t>(std::ceil(c - std::sqrt(square))), to = n - 1 - from;
      for (std::int64_t w = from / 64; w <= to / 64; ++w) {
        const std::uint64_t low = w == from / 64 ? ~std::uint64_t{0} << (from % 64) : ~std::uint64_t{0};
        const std::uint64_t high = w == to / 64 ? ~std::uint64_t{0} >> (63 - to % 64) : ~std::uint64_t{0};
        samples.signs.row(y, z)[w] = low & high;
      }
    }
  }
  const SampleCounts counts = count_samples(samples.signs);
  samples.offsets.assign(static_cast<std::size_t>(counts.edges), 8);
  samples.joined.assign(static_cast<std::size_t>(counts.faces), 0);
  const QuadMesh mesh = build(samples);
  EXPECT_EQ(mesh.vertex_count(), 3994274);
  EXPECT_EQ(mesh.vertex_count() - mesh.quad_count(), 2);
}

TEST(Extract, DeciderDoesNotDependOnTheOrderOfTheCorners) {
  std::mt19937 bits(1);
  int joined = 0, separate = 0;
  for (int i = 0; i < 100000; ++i) {
    const auto value = [&] { return static_cast<float>(bits() >> 8) * 0x1p-24f + (i % 2 == 0 ? 0.0f : 0x1p-20f); };
    const float tau = value() * 0.01f;
    const float a = tau + value(), d = tau + value();
    float b = tau - value(), c = tau - value();
    if (i % 3 == 0) b = 2 * tau - a, c = 2 * tau - d;  // nearly a tie
    if (!(a > tau && d > tau && b < tau && c < tau)) continue;
    const bool first = joins_inside(a, b, c, d, tau);
    for (const bool other :
         {joins_inside(d, b, c, a, tau), joins_inside(a, c, b, d, tau), joins_inside(d, c, b, a, tau),
          joins_inside(b, a, d, c, tau), joins_inside(c, a, d, b, tau), joins_inside(b, d, a, c, tau),
          joins_inside(c, d, a, b, tau)}) {
      ASSERT_EQ(other, first);
    }
    const double saddle = (double{a} * d - double{b} * c) / (double{a} + d - b - c);
    ASSERT_TRUE(std::abs(saddle - tau) < 1e-6 || first == (saddle > tau));
    const bool inverse = joins_inside(-a, -b, -c, -d, -tau);
    const double positive = (double{a} - tau) * (double{d} - tau), negative = (double{b} - tau) * (double{c} - tau);
    ASSERT_EQ(inverse, positive == negative ? first : !first);
    (first ? joined : separate) += 1;
  }
  EXPECT_GT(joined, 1000);
  EXPECT_GT(separate, 1000);
  EXPECT_FALSE(joins_inside(1, -1, -1, 1, 0));
  EXPECT_FALSE(joins_inside(1, NAN, -1, 1, 0));
  EXPECT_TRUE(joins_inside(INFINITY, -1, -1, 1, 0));
  EXPECT_FALSE(joins_inside(INFINITY, -1, -1, 0, 0)) << "infinity times zero";
}

TEST(Extract, OffsetsErrByHalfAStepAtMost) {
  std::mt19937 bits(2);
  for (int n = 1; n <= 16; ++n) {
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double t = static_cast<double>(bits() >> 8) * 0x1p-24;
      const auto v0 = static_cast<float>(t), v1 = static_cast<float>(t - 1.0);
      const int q = quantise_crossing(v0, v1, 0.0f, n);
      ASSERT_GE(q, 0);
      ASSERT_LT(q, 1 << n);
      worst = std::max(worst, std::abs((q + 0.5) / (1 << n) - t));
    }
    EXPECT_LE(worst, 0.5 / (1 << n) + 1e-7);
    EXPECT_GE(worst, 0.49 / (1 << n)) << "the steps are finer than N bits";
  }
  EXPECT_EQ(quantise_crossing(0.0f, -1.0f, 0.0f, 4), 0);
  EXPECT_EQ(quantise_crossing(-1.0f, 0.0f, 0.0f, 4), 15);
  EXPECT_EQ(quantise_crossing(NAN, 1.0f, 0.0f, 4), 8);
  EXPECT_EQ(quantise_crossing(INFINITY, -INFINITY, 0.0f, 4), 8);
  EXPECT_EQ(quantise_crossing(1.0f, -INFINITY, 0.0f, 4), 0);
}

TEST(Extract, EqualIsInsideAndNanIsOutside) {
  Volume<float> volume({70, 1, 1});
  for (std::int64_t x = 0; x < 70; ++x)
    volume.voxels[x] = x % 7 == 0 ? 0.5f : x % 7 == 1 ? NAN : x % 7 == 2 ? INFINITY : 0.4f;
  const SurfaceSamples samples = sample(volume, 0.5f);
  for (std::int64_t x = 0; x < 70; ++x) EXPECT_EQ(samples.signs.get(x, 0, 0), x % 7 == 0 || x % 7 == 2) << x;
  EXPECT_EQ(samples.signs.words().back() >> 6, 0u) << "padding bits";
}

TEST(Extract, SamplesThatContradictEachOtherAreRefused) {
  const SurfaceSamples good = sample(random_volume({20, 9, 8}, 3, 0), 0.0f);
  ASSERT_FALSE(good.joined.empty());
  const auto refused = [&](auto damage) {
    SurfaceSamples bad = good;
    damage(bad);
    SilentProgress progress;
    const auto mesh = build_quad_mesh(bad, progress);
    return !mesh && mesh.error().kind == ErrorKind::kBadData;
  };
  EXPECT_FALSE(refused([](SurfaceSamples&) {}));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.offsets.pop_back(); }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.offsets.push_back(0); }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.offsets[7] = 16; }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.joined.pop_back(); }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.joined.push_back(1); }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.joined[0] = 2; }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.offset_bits = 0; }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.offset_bits = 17; }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.dims.z = 9; }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.dims = {}, s.signs = {}; }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) {
    s.signs.set(3, 3, 3, !s.signs.get(3, 3, 3));
    s.offsets.push_back(0);
  }));
  EXPECT_TRUE(refused([](SurfaceSamples& s) { s.signs.row(2, 2)[0] |= std::uint64_t{1} << 20; })) << "padding bit";
}

TEST(Extract, BadOptionsAreRefused) {
  const Volume<float> volume = random_volume({4, 4, 4}, 1, 0);
  VolumeSource source(volume);
  SilentProgress progress;
  for (const ExtractOptions& bad : {ExtractOptions{.isovalue = NAN}, ExtractOptions{.isovalue = INFINITY},
                                    ExtractOptions{.offset_bits = 0}, ExtractOptions{.offset_bits = 17}}) {
    const auto samples = sample_surface(source, bad, progress);
    ASSERT_FALSE(samples.has_value());
    EXPECT_EQ(samples.error().kind, ErrorKind::kUsage);
  }
}

class CountingProgress final : public Progress {
 public:
  std::atomic<std::int64_t> seen{0};

 private:
  void on_advance(std::int64_t done) override {
    for (std::int64_t old = seen; old < done && !seen.compare_exchange_weak(old, done);) {
    }
  }
};

TEST(Extract, ProgressEndsAtTheNumberOfVoxelsAndCancelStops) {
  const Volume<float> volume = random_volume({40, 30, 20}, 1, 0);
  VolumeSource source(volume);
  CountingProgress sampling, building;
  const auto samples = sample_surface(source, {}, sampling);
  ASSERT_TRUE(samples.has_value());
  EXPECT_EQ(sampling.seen, volume.dims.count());
  ASSERT_TRUE(build_quad_mesh(*samples, building).has_value());
  EXPECT_EQ(building.seen, volume.dims.count());
  sampling.cancel();
  building.cancel();
  EXPECT_EQ(sample_surface(source, {}, sampling).error().kind, ErrorKind::kCancelled);
  EXPECT_EQ(build_quad_mesh(*samples, building).error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace dubsar
