// The simulated scanner's rays: line integrals against chords of balls, volumes back from them, axis, rings, noise.

#include <gtest/gtest.h>

#include <cstring>
#include <numbers>
#include <random>

#include "core/base/system/parallel.h"
#include "core/phantom/scanner/ray_kernels.h"
#include "tests/core/phantom/scanner_object.h"

namespace dubsar::phantom {
namespace {

using namespace testing;  // NOLINT

constexpr double kVoxelMm = 0.25;
const Dims kDims{72, 64, 48};

struct Off {
  double rms = 0.0, largest = 0.0, mean = 0.0;
};

/// Of the rays that pass within `within` radii of the centre, in diameters; the mean is over all rays.
Off against_chords(const ScanGeometry& g, const glm::dvec3& centre, double radius, double within) {
  const Columns views = project_quietly(ball(g.dims, centre, radius), g);
  Off off;
  double n = 0.0, all = 0.0;
  const double least = 2.0 * radius * std::sqrt(1.0 - within * within);
  for (std::int64_t view = 0; view < g.views; ++view)
    for (std::int64_t column = 0; column < g.columns; ++column)
      for (std::int64_t row = 0; row < g.rows; ++row) {
        const double u = g.u_of(static_cast<double>(column)) + g.axis_px, v = g.v_of(static_cast<double>(row));
        const double expected = chord(g, g.angle(view), u, v, centre, radius);
        const double error =
            (static_cast<double>(views.at(view, column)[row]) / g.voxel_mm - expected) / (2.0 * radius);
        off.mean += error;
        all += 1.0;
        if (expected <= least) continue;
        off.rms += error * error;
        off.largest = std::max(off.largest, std::abs(error));
        n += 1.0;
      }
  off.rms = std::sqrt(off.rms / n);
  off.mean /= all;
  return off;
}

// At the rim, where a chord grows as a root, a pixel shows the mean of its area: as much light in all.
TEST(ScannerRays, ChordsOfABallParallelAndInACone) {
  for (const double cone : {0.0, 5.0, 10.0}) {
    const Off off = against_chords(geometry(kDims, cone, true, 9, 0.3), {4.0, -3.0, 1.5}, 18.0, 0.9);
    EXPECT_LT(off.rms, 0.003) << cone;
    EXPECT_LT(off.largest, 0.018) << cone;
    EXPECT_LT(std::abs(off.mean), 3e-4) << cone;
  }
}

// Short steps are read by permutations of two vectors, long ones number by number.
TEST(ScannerRays, ColumnsAreReadBetweenTheirNumbersAtAnyStep) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  std::vector<float> first(160), second(160);
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = uniform(random), second[i] = uniform(random);
  constexpr float kLast = 90.0f;
  for (const float step : {0.4f, 0.93f, 1.0f, 1.21f, 1.6f, 1.95f, 3.3f})
    for (const float start : {-7.3f, 0.0f, 20.6f, 120.0f}) {
      const kernels::Tap tap{first.data(), second.data(), 0.3f, 0.7f, start, step};
      std::vector<float> sum(96, 1.0f);
      kernels::sum_magnified({&tap, 1}, kLast, sum);
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const float place = std::clamp(start + step * static_cast<float>(i), 0.0f, kLast);
        const auto below = static_cast<std::size_t>(place);
        const float part = place - static_cast<float>(below);
        const auto both = [&](std::size_t k) { return 0.3f * first[k] + 0.7f * second[k]; };
        ASSERT_NEAR(sum[i], 1.0f + both(below) + part * (both(below + 1) - both(below)), 1e-5f)
            << step << " from " << start << " at " << i;
      }
    }
}

struct SeenBall {
  double inside, radius;
};

/// Mean within two thirds of the radius in the middle slice, and where the slice passes half of it, mean over angles.
SeenBall look(const Columns& volume, const Dims& d, const glm::dvec3& centre, double radius) {
  const auto z = static_cast<std::int64_t>(std::lround(0.5 * static_cast<double>(d.z - 1)));
  const double dz = static_cast<double>(z) - 0.5 * static_cast<double>(d.z - 1) - centre.z;
  const double x0 = 0.5 * static_cast<double>(d.x - 1) + centre.x, y0 = 0.5 * static_cast<double>(d.y - 1) + centre.y;
  const auto at = [&](double x, double y) {
    const auto ix = static_cast<std::int64_t>(x), iy = static_cast<std::int64_t>(y);
    const double tx = x - static_cast<double>(ix), ty = y - static_cast<double>(iy);
    const auto v = [&](std::int64_t a, std::int64_t b) { return static_cast<double>(volume.at(a, b)[z]); };
    return (1 - tx) * ((1 - ty) * v(ix, iy) + ty * v(ix, iy + 1)) +
           tx * ((1 - ty) * v(ix + 1, iy) + ty * v(ix + 1, iy + 1));
  };
  SeenBall seen{0.0, 0.0};
  double n = 0.0;
  for (double y = -radius; y <= radius; y += 1.0)
    for (double x = -radius; x <= radius; x += 1.0)
      if (std::hypot(x, y) < radius * 2.0 / 3.0) seen.inside += at(x0 + x, y0 + y), n += 1.0;
  seen.inside /= n;
  for (int k = 0; k < 90; ++k) {
    const double a = 2.0 * std::numbers::pi * k / 90.0;
    for (double r = radius - 4.0; r < radius + 4.0; r += 0.01)
      if (at(x0 + r * std::cos(a), y0 + r * std::sin(a)) < 0.5 * seen.inside) {
        seen.radius += r / 90.0;
        break;
      }
  }
  seen.radius = std::hypot(seen.radius, dz);
  return seen;
}

TEST(ScannerRays, ABallComesBackWithItsDensityAndSize) {
  const glm::dvec3 centre(5.0, -4.0, 0.5);
  const Columns object = ball(kDims, centre, 16.0);
  struct Case {
    double cone;
    bool full;
  };
  for (const Case& c : {Case{0.0, false}, Case{0.0, true}, Case{5.0, true}, Case{5.0, false}}) {
    const ScanGeometry g = geometry(kDims, c.cone, c.full, 150);
    const SeenBall seen = look(reconstruct_quietly(project_quietly(object, g), g), kDims, centre, 16.0);
    EXPECT_NEAR(seen.inside, 1.0, 0.01) << c.cone << c.full;
    EXPECT_NEAR(seen.radius, 16.0, 0.06) << c.cone << c.full;
  }
}

TEST(ScannerRays, AConesMiddlePlaneIsThatOfParallelRays) {
  const Dims d{72, 64, 33};  // a slice in the middle plane
  const glm::dvec3 centre(6.0, 2.0, 0.0);
  const Columns object = ball(d, centre, 14.0);
  const ScanGeometry flat = geometry(d, 0.0, true, 200), cone = geometry(d, 8.0, true, 200);
  const Columns a = reconstruct_quietly(project_quietly(object, flat), flat);
  const Columns b = reconstruct_quietly(project_quietly(object, cone), cone);
  double squares = 0.0;
  for (std::int64_t x = 0; x < d.x; ++x)
    for (std::int64_t y = 0; y < d.y; ++y) {
      const double off = static_cast<double>(a.at(x, y)[16] - b.at(x, y)[16]);
      squares += off * off / static_cast<double>(d.slice());
    }
  EXPECT_LT(std::sqrt(squares), 0.01);
}

TEST(ScannerRays, SameBytesForAnyThreads) {
  const Columns object = ball(kDims, {3.0, 1.0, -2.0}, 15.0);
  for (const double cone : {0.0, 6.0}) {
    const ScanGeometry g = geometry(kDims, cone, true, 40);
    set_thread_count(1);
    const Columns views = project_quietly(object, g), volume = reconstruct_quietly(views, g);
    set_thread_count(3);
    const Columns views3 = project_quietly(object, g), volume3 = reconstruct_quietly(views3, g);
    set_thread_count(0);
    EXPECT_EQ(0, std::memcmp(views.values.data(), views3.values.data(), sizeof(float) * views.values.size()));
    EXPECT_EQ(0, std::memcmp(volume.values.data(), volume3.values.data(), sizeof(float) * volume.values.size()));
  }
}

// To first order a shift of all readings of half a turn is a phase that changes its sign with the direction: the object
// moves by the mean of |cos| over that of cos^2, 4/pi of it, along the rows of the panel at mid-turn (there -x).
TEST(ScannerRays, AnAxisOffMovesAHalfTurnsObjectBy4OverPiOfIt) {
  const Dims d{64, 64, 8};
  Columns object(d.x, d.y, d.z);  // smooth, so that differences are slopes
  object.clear();
  for (std::int64_t x = 0; x < d.x; ++x)
    for (std::int64_t y = 0; y < d.y; ++y)
      std::fill_n(object.at(x, y), d.z,
                  std::exp(-static_cast<float>((x - 38) * (x - 38) + (y - 36) * (y - 36)) / (2.0f * 16.0f)));
  const auto scan = [&](double axis) {
    const ScanGeometry g = geometry(d, 0.0, false, 120, axis);
    return reconstruct_quietly(project_quietly(object, g), g, Window::kHann);
  };
  const Columns right = scan(0.0);
  for (const double axis : {0.2, -0.4}) {
    const Columns off = scan(axis);
    double numerator[2] = {0, 0}, denominator[2] = {0, 0};
    for (std::int64_t x = 1; x < d.x - 1; ++x)
      for (std::int64_t y = 1; y < d.y - 1; ++y) {
        const auto change = static_cast<double>(off.at(x, y)[4] - right.at(x, y)[4]);
        const double slope[2] = {0.5 * static_cast<double>(right.at(x + 1, y)[4] - right.at(x - 1, y)[4]),
                                 0.5 * static_cast<double>(right.at(x, y + 1)[4] - right.at(x, y - 1)[4])};
        for (int a = 0; a < 2; ++a) {
          numerator[a] -= change * slope[a];
          denominator[a] += slope[a] * slope[a];
        }
      }
    EXPECT_NEAR(numerator[0] / denominator[0], 4.0 / std::numbers::pi * axis, 0.04 * std::abs(axis)) << axis;
    EXPECT_NEAR(numerator[1] / denominator[1], 0.0, 0.05 * std::abs(axis)) << axis;
  }
}

// White noise of variance s^2 in A views of half a turn, pixels of t: s^2 pi^2 / (12 A t^2) where nothing interpolates
// (Kak, Slaney 1988, 5.2): at the axis every view is read at a pixel or half way between two.
TEST(ScannerRays, NoiseOfASliceIsThatOfTheRamp) {
  const Dims d{33, 33, 2048};  // each slice is a sample
  const ScanGeometry g = geometry(d, 0.0, false, 60);
  Columns views(g.views, g.columns, g.rows);
  views.clear();
  std::mt19937 random(7);
  std::normal_distribution<float> normal(0.0f, 0.02f);
  for (std::int64_t i = 0; i < g.views * g.columns; ++i)
    for (std::int64_t row = 0; row < g.rows; ++row) views.values[i * views.stride + row] = normal(random);
  const Columns volume = reconstruct_quietly(views, g);
  double squares = 0.0;
  for (std::int64_t z = 0; z < d.z; ++z)
    squares += std::pow(static_cast<double>(volume.at(16, 16)[z]), 2.0) / static_cast<double>(d.z);
  const double expected = 4e-4 * std::pow(std::numbers::pi, 2.0) / (12.0 * 60.0 * kVoxelMm * kVoxelMm);
  EXPECT_NEAR(squares / expected, 1.0, 0.1);  // 2048 samples: 3 % of deviation
}

TEST(ScannerRays, AConstantErrorOfAPixelIsARingAtItsRadius) {
  const Dims d{81, 81, 8};
  const ScanGeometry g = geometry(d, 0.0, true, 200);
  Columns views(g.views, g.columns, g.rows);
  views.clear();
  const auto column = static_cast<std::int64_t>(std::lround(20.5 + 0.5 * static_cast<double>(g.columns - 1)));
  for (std::int64_t view = 0; view < g.views; ++view) std::fill_n(views.at(view, column), g.rows, 0.01f);
  const Columns volume = reconstruct_quietly(views, g, Window::kCosine);
  std::vector<double> sum(80), count(80);  // of half pixels
  for (std::int64_t x = 0; x < d.x; ++x)
    for (std::int64_t y = 0; y < d.y; ++y) {
      const auto bin =
          static_cast<std::size_t>(2.0 * std::hypot(static_cast<double>(x - 40), static_cast<double>(y - 40)));
      if (bin >= 78) continue;
      sum[bin] += static_cast<double>(volume.at(x, y)[4]);
      count[bin] += 1.0;
    }
  std::size_t brightest = 0;
  for (std::size_t bin = 1; bin < 78; ++bin)
    if (count[bin] > 0.0 && sum[bin] / count[bin] > sum[brightest] / count[brightest]) brightest = bin;
  // A ring falls steeply inwards and slowly outwards: its top lies up to half a pixel outside.
  EXPECT_NEAR(0.5 * (static_cast<double>(brightest) + 0.5), g.u_of(static_cast<double>(column)) + 0.25, 0.51);
}

}  // namespace
}  // namespace dubsar::phantom
