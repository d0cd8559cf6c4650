
#include <glm/geometric.hpp>
#include <numbers>

#include "devices/leap/lmc1_simulator.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {

TEST(LeapSource, PicturesBecomeHandsInTheScreenFrame) {
  SourceBench bench;
  Lmc1SimulatorOptions device;
  device.paced = true;
  device.clock = &bench.clock;
  device.hands = [](std::uint64_t) {
    HandPose pose;
    pose.palm.position_m = {0.02, 0.25, 0.01};
    return std::vector{pose_hand(pose)};
  };
  Lmc1Simulator simulator(device);
  bench.config.reach_device = [&](const DeviceSpec& choice, const Clock&) -> Result<OpenTransport> {
    EXPECT_EQ(choice.driver, "leap");
    return OpenTransport([&] { return simulator.open(); });
  };
  const auto source = bench.make("leap:at=0/-200/300");
  int seen = 0;
  for (int i = 0; i < 20; ++i) {
    bench.clock.advance(10 * kMs);
    if (bench.poll(*source) != Freshness::kNew) continue;
    ++seen;
    EXPECT_EQ(bench.frame.time, bench.clock.now());
    ASSERT_EQ(bench.frame.hands.size(), 1u);
    EXPECT_LE(glm::distance(bench.frame.hands[0].palm.position_m, glm::dvec3(0.02, 0.05, 0.31)), 0.012);
    EXPECT_LT(bench.frame.hands[0].grab_strength, 0.5);
  }
  EXPECT_GE(seen, 19);

  simulator.unplug();
  bench.clock.advance(10 * kMs);
  bench.poll(*source);
  bench.clock.advance(400 * kMs);
  EXPECT_EQ(bench.poll(*source), Freshness::kLost);
  EXPECT_TRUE(bench.frame.hands.empty());
  EXPECT_NE(source->note().find("unplugged"), std::string::npos) << source->note();
}

}  // namespace
}  // namespace dubsar::test
