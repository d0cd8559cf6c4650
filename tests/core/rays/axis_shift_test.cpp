#include "core/rays/axis_shift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rays/lane_planes.h"
#include "tests/core/rays/simulated_scan.h"

namespace dubsar {
namespace {
using kernels::kLanes;

constexpr Dims kDims{104, 72, kLanes};

struct Found {
  AxisShift shift;
  double before = 0.0, after = 0.0;  ///< root mean square from a scan about the right axis
};

Found find(test::Scanner scanner) {
  const auto object = test::tablet_in_envelope(1.0);
  const Volume<float> off = test::scan(object, kDims, scanner);
  scanner.axis_off = 0.0;
  scanner.noise = 0.0;
  const Volume<float> right = test::scan(object, kDims, scanner);
  const ParallelRays rays(kDims.x, kDims.y, 160);
  std::vector<std::int64_t> planes;
  for (std::int64_t z = 0; z < kLanes; ++z) planes.push_back(z);
  LaneImage image = rays.image();
  load_planes(off.voxels.data(), planes_across(kDims, TurnAxis::kZ), planes, {0.0, 1.0}, image);
  LaneSinogram recorded = rays.sinogram(), moved = rays.sinogram();
  rays.project(image, recorded);
  Found found{find_axis_shift(rays, image, recorded, [&](std::int64_t, const float*, float* bend) {
    std::fill(bend, bend + recorded.row_floats(), 0.0F);
  })};
  shift_rays(recorded, found.shift, moved);
  for (std::int64_t k = 0; k < rays.directions(); ++k)
    for (std::int64_t i = 0; i < moved.row_floats(); ++i) moved.row(k)[i] -= recorded.row(k)[i];
  rays.filter(moved);
  rays.backproject(moved, image);
  for (std::int64_t z = 0; z < kLanes; ++z)
    for (std::int64_t y = 0; y < kDims.y; ++y)
      for (std::int64_t x = 0; x < kDims.x; ++x) {
        const double before = off.at(x, y, z) - right.at(x, y, z), after = before + image.at(x, y)[z];
        found.before += before * before;
        found.after += after * after;
      }
  found.before = std::sqrt(found.before);
  found.after = std::sqrt(found.after);
  return found;
}

TEST(AxisShift, OfAHalfTurnIsFoundAndUndone) {
  const double quarter = 0.5 * std::numbers::pi;
  for (const auto& [off, first] : {std::pair{0.15, 0.0}, {0.15, quarter}, {0.5, quarter}, {-0.5, 0.0}}) {
    test::Scanner scanner;
    scanner.axis_off = off;
    scanner.first_angle = first;
    const Found found = find(scanner);
    EXPECT_EQ(found.shift.flipped, first > 0.0) << off;
    EXPECT_NEAR(std::abs(found.shift.pixels), std::abs(off), 0.1) << off << " from " << first;
    EXPECT_LT(found.after, 0.5 * found.before) << off << " from " << first;
  }
}

TEST(AxisShift, ThereIsNoneWhereTheAxisIsRightOrTheTurnFull) {
  test::Scanner scanner;
  scanner.noise = 0.3;
  EXPECT_EQ(find(scanner).shift.pixels, 0.0);
  scanner.axis_off = 0.5;
  scanner.turn = 2.0 * std::numbers::pi;
  scanner.views = 200;
  EXPECT_EQ(find(scanner).shift.pixels, 0.0);
}

}  // namespace
}  // namespace dubsar
