// Values move with the places beside them, and nothing else does.
#include "core/volume/carried_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/system/parallel.h"
#include "tests/core/volume/read_all.h"

namespace dubsar {
namespace {

constexpr Dims kDims{24, 14, 12};
constexpr float kPlane = 11.3f, kMove = 0.3f;

/// Falls by 1 a step along x; places all over a plane across x move by kMove along it.
struct Ramp {
  Volume<float> volume{kDims};
  std::vector<glm::vec3> places, moves;
  Ramp() {
    for (std::int64_t z = 0; z < kDims.z; ++z)
      for (std::int64_t y = 0; y < kDims.y; ++y) {
        for (std::int64_t x = 0; x < kDims.x; ++x) volume.row(y, z)[x] = kPlane - static_cast<float>(x);
        places.push_back({kPlane, static_cast<float>(y) + 0.4f, static_cast<float>(z) + 0.6f});
        moves.push_back({kMove, 0.0f, 0.0f});
      }
  }
};

TEST(CarriedSource, TakesASurfaceAlongAndLeavesTheRestToTheBit) {
  Ramp ramp;
  VolumeSource source(ramp.volume);
  CarriedSource carried(source, ramp.places, ramp.moves, 1.0f);
  const Volume<float> moved = testing::read_all(carried).value();
  for (std::int64_t x = 0; x < kDims.x; ++x) {
    const float before = ramp.volume.row(6, 5)[x], after = moved.row(6, 5)[x];
    const float away = std::abs(static_cast<float>(x) - kPlane);
    if (away < 1.9f) {
      EXPECT_NEAR(after, before + kMove, 1e-5f) << x;
    } else if (away >= CarriedSource::kReach) {
      EXPECT_EQ(after, before) << x;
    }
  }
}

TEST(CarriedSource, IsTheSameInSlabsOfAnyHeightAndForAnyNumberOfThreads) {
  Ramp ramp;
  for (std::size_t i = 0; i < ramp.moves.size(); ++i) ramp.moves[i] = {0.1f * static_cast<float>(i % 5), 0.2f, -0.1f};
  VolumeSource source(ramp.volume);
  CarriedSource carried(source, ramp.places, ramp.moves, 0.7f);
  const Volume<float> whole = testing::read_all(carried, kDims.z).value();
  set_thread_count(1);
  const Volume<float> thin = testing::read_all(carried, 1).value();
  set_thread_count(0);
  for (std::int64_t z = 0; z < kDims.z; ++z)
    for (std::int64_t y = 0; y < kDims.y; ++y)
      for (std::int64_t x = 0; x < kDims.x; ++x) ASSERT_EQ(whole.row(y, z)[x], thin.row(y, z)[x]);
}

TEST(CarriedSource, WithoutPlacesIsTheSource) {
  Ramp ramp;
  VolumeSource source(ramp.volume);
  CarriedSource carried(source, {}, {}, 1.0f);
  const Volume<float> same = testing::read_all(carried, 5).value();
  for (std::int64_t x = 0; x < kDims.x; ++x) EXPECT_EQ(same.row(3, 4)[x], ramp.volume.row(3, 4)[x]);
}

}  // namespace
}  // namespace dubsar
