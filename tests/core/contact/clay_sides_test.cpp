#include "core/contact/clay_sides.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/contact/dips.h"

namespace dubsar {
namespace {

constexpr int kRoomEdge = 48, kWall = 22, kRoof = 24, kFloor = 14;
constexpr float kGapMiddle = 0.5f * (kFloor + kRoof);

/// Clay in which a gap, from kFloor to kRoof along y, ends in an upright wall. The tablet is over it; it touches the
/// envelope beside it, half-way up, and the patch bends up to where wall and roof meet.
ContactBand end_of_gap(bool rim_is_known) {
  BitVolume inside(Dims{kRoomEdge, kRoomEdge, kRoomEdge});
  for (int z = 0; z < kRoomEdge; ++z)
    for (int y = 0; y < kRoomEdge; ++y)
      for (int x = 0; x < kRoomEdge; ++x) inside.set(x, y, z, x < kWall || y < kFloor || y >= kRoof);
  constexpr float kBend = 3.0f, kCorner = kRoof - 0.5f;
  std::vector<PatchPoint> samples;
  for (int z = 4; z < kRoomEdge - 4; ++z) {
    const auto depth = static_cast<float>(z);
    for (float x = 4.0f; x < kWall - 1 - kBend; x += 0.5f) samples.push_back({{x, kGapMiddle, depth}, {0, -1, 0}});
    for (float y = kGapMiddle; y <= kCorner; y += 0.5f)
      samples.push_back({{kWall - 1, y, depth}, {1, 0, 0}, rim_is_known && y > kCorner - 0.75f});
  }
  SilentProgress progress;
  return ContactBand::make(inside, std::move(samples), 10.5f, progress).value();
}

/// Share of the tablet's clay over the gap that is not taken for the tablet's.
double lost_over_the_gap(const ContactBand& band) {
  Dips dips{std::vector<float>(band.nodes.size(), 0.0f), {}};
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    if (std::abs(static_cast<float>(band.nodes[n].y) - kGapMiddle) < 1.0f)
      dips.strength[n] = 3.0f;  // a film, to the wall
  SilentProgress progress;
  const std::vector<ClaySide> side = ClayDivision({band, dips, {}, {}, {}}).sides(progress).value();
  std::int64_t all = 0, lost = 0;
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
    if (band.nodes[n].x > kWall + 1 && band.nodes[n].y >= kRoof) {
      ++all;
      lost += side[n] != ClaySide::kTablet;
    }
  return all > 100 ? static_cast<double>(lost) / static_cast<double>(all) : 1.0;
}

TEST(ClayDivision, TheTabletOverAGapThatEndsInAWallIsNoEnvelope) {
  EXPECT_EQ(lost_over_the_gap(end_of_gap(true)), 0.0);
  EXPECT_GT(lost_over_the_gap(end_of_gap(false)), 0.02) << "the patch goes straight on where it ends: nothing to do";
}

}  // namespace
}  // namespace dubsar
