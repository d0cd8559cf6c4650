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

/// Clay, and patches along both faces of a slab of it, `thick` steps apart, with a reach of 10.
ContactBand around_slab(int thick) {
  BitVolume inside(Dims{kRoomEdge, kRoomEdge, kRoomEdge});
  for (int z = 0; z < kRoomEdge; ++z)
    for (int y = 0; y < kRoomEdge; ++y)
      for (int x = 0; x < kRoomEdge; ++x) inside.set(x, y, z, true);
  const float middle = 0.5f * kRoomEdge, half = 0.5f * static_cast<float>(thick);
  std::vector<PatchPoint> samples;
  for (int z = 4; z < kRoomEdge - 4; ++z)
    for (int x = 4; x < kRoomEdge - 4; ++x)
      for (const float out : {-1.0f, 1.0f})
        samples.push_back({{static_cast<float>(x), middle + out * half, static_cast<float>(z)}, {0, out, 0}});
  SilentProgress progress;
  return ContactBand::make(inside, std::move(samples), 10.0f, progress).value();
}

TEST(ClayDivision, ATabletThinnerThanBothReachesIsFound) {
  for (const int thick : {13, 16, 19, 23}) {
    const ContactBand band = around_slab(thick);
    const float film = 0.5f * static_cast<float>(thick) + 6.0f;  // from the middle: the patches miss it by 6 steps
    Dips dips{std::vector<float>(band.nodes.size(), 0.0f), {}};
    const auto from_middle = [&](std::uint32_t n) {
      return std::abs(static_cast<float>(band.nodes[n].y) - 0.5f * kRoomEdge);
    };
    for (std::uint32_t n = 0; n < band.nodes.size(); ++n)
      if (std::abs(from_middle(n) - film) < 1.0f) dips.strength[n] = 3.0f;
    SilentProgress progress;
    const std::vector<ClaySide> side = ClayDivision({band, dips, {}, {}, {}}).sides(progress).value();
    int all = 0, wrong = 0;
    for (std::uint32_t n = 0; n < band.nodes.size(); ++n) {
      const auto& node = band.nodes[n];
      if (std::min(node.x, node.z) < 14 || std::max(node.x, node.z) > kRoomEdge - 14) continue;
      if (std::abs(from_middle(n) - film) < 2.0f) continue;
      ++all;
      wrong += (from_middle(n) < film) != (side[n] == ClaySide::kTablet);
    }
    EXPECT_GT(all, 5000);
    EXPECT_EQ(wrong, 0) << "of " << all << ", " << thick << " steps thick";
  }
}

}  // namespace
}  // namespace dubsar
