#include <glm/geometric.hpp>
#include <numbers>

#include "devices/head_tracker/imu_sim.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/vrpn_protocol.h"
#include "input/mixer.h"
#include "input/sources/head_placement.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
  EXPECT_LE(glm::distance(found, expected), tolerance) << found.x << " " << found.y << " " << found.z;
}

TEST(HeadFrame, EyesLieSidewaysOfTheTrackedPoint) {
  HeadPlacement placement;
  placement.screen_from_tracker = {{0.1, 0.2, 0.3}, glm::angleAxis(90 * kRad, glm::dvec3(0, 1, 0))};
  placement.ipd_m = 0.06;
  const auto head = head_frame({5, {{0.0, 0.0, 0.4}, {1, 0, 0, 0}}, true, true}, placement);
  ASSERT_TRUE(head);
  // the tracker's z is the screen's x, its x the screen's -z
  expect_near(*head->left_eye_m, {0.5, 0.2, 0.33}, 1e-12);
  expect_near(*head->right_eye_m, {0.5, 0.2, 0.27}, 1e-12);
  EXPECT_EQ(head->time, 5);
  EXPECT_TRUE(head->tracked);
}

TEST(HeadFrame, EyesBehindThePanelAreNotBelieved) {
  EXPECT_FALSE(head_frame({0, {{0.0, 0.0, 0.05}, {1, 0, 0, 0}}, true, true}, {}));
  EXPECT_FALSE(head_frame({0, {{0.0, 0.0, -0.5}, {1, 0, 0, 0}}, true, true}, {}));
  EXPECT_FALSE(head_frame({0, {{0.0, 0.0, 3.5}, {1, 0, 0, 0}}, true, true}, {}));
}

TEST(HeadFrame, WithoutPositionTheEyesTurnAboutTheNeck) {
  HeadPlacement placement;
  placement.screen_from_tracker.position_m = {0.0, 0.05, 0.6};
  const auto ahead = head_frame({0, {}, false, true}, placement);
  ASSERT_TRUE(ahead);
  expect_near(0.5 * (*ahead->left_eye_m + *ahead->right_eye_m), {0.0, 0.05, 0.6}, 1e-12);
  const auto left = head_frame({0, {{}, glm::angleAxis(90 * kRad, glm::dvec3(0, 1, 0))}, false, true}, placement);
  ASSERT_TRUE(left);
  expect_near(0.5 * (*left->left_eye_m + *left->right_eye_m), {-0.0805, 0.05, 0.6 + 0.0805}, 1e-12);
  EXPECT_LT(left->confidence, 1.0);
}

TEST(HeadSource, OpentrackDatagramsBecomeEyesBeforeThePanel) {
  SourceBench bench;
  SimDevice tracker("simulated opentrack");
  bench.put(tracker);
  const auto source = bench.make("head:opentrack,ipd=64,invert=x");
  bench.poll(*source);
  tracker.send(format_opentrack({10, 5, -8, 0, 0, 0}));
  bench.clock.advance(5 * kMs);
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  ASSERT_EQ(bench.frame.heads.size(), 1u);
  expect_near(*bench.frame.heads[0].left_eye_m, {0.068, 0.05, 0.52}, 1e-12);
  expect_near(*bench.frame.heads[0].right_eye_m, {0.132, 0.05, 0.52}, 1e-12);

  // silent: the head is not handed out for ever, and the source says so
  bench.clock.advance(400 * kMs);
  EXPECT_EQ(bench.poll(*source), Freshness::kUnchanged);
  EXPECT_TRUE(bench.frame.heads.empty());
  bench.clock.advance(kSecond);
  EXPECT_EQ(bench.poll(*source), Freshness::kLost);
  EXPECT_NE(source->note().find("says nothing"), std::string::npos) << source->note();
}

TEST(HeadSource, AHead120MillimetresToTheRightAsOpentrackSendsItHasItsEyesThere) {
  SourceBench bench;
  SimDevice tracker("simulated opentrack");
  bench.put(tracker);
  const auto source = bench.make("head:opentrack,ipd=63");
  bench.poll(*source);
  tracker.send(format_opentrack({-12, 0, 0, 0, 0, 0}));
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  ASSERT_EQ(bench.frame.heads.size(), 1u);
  expect_near(*bench.frame.heads[0].left_eye_m, {0.1200 - 0.0315, 0.0, 0.6}, 1e-12);
  expect_near(*bench.frame.heads[0].right_eye_m, {0.1200 + 0.0315, 0.0, 0.6}, 1e-12);
}

TEST(HeadSource, GlassesThatSpeakOpentrackAreToldByTheirLengthAndTurnAboutTheNeck) {
  SourceBench bench;
  SimDevice tracker("simulated XRLinuxDriver");
  bench.put(tracker);
  const auto source = bench.make("head:opentrack");
  bench.poll(*source);
  auto datagram = format_opentrack({0, 0, 0, 30, 0, 0});  // 30 degrees to the left, no place
  std::vector<std::byte> with_number(datagram.begin(), datagram.end());
  with_number.resize(52);
  tracker.send(with_number);
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  ASSERT_EQ(bench.frame.heads.size(), 1u);
  expect_near(0.5 * (*bench.frame.heads[0].left_eye_m + *bench.frame.heads[0].right_eye_m),
              {-0.0805 * std::sin(30 * kRad), 0.0, 0.6 + 0.0805 * (1 - std::cos(30 * kRad))}, 1e-12);
  EXPECT_NE(source->note().find("XRLinuxDriver"), std::string::npos) << source->note();
}

TEST(HeadSource, AHeadsetThatHasDriftedIsRecentred) {
  SourceBench bench;
  RiftSim rift(RiftModel::kDk1);
  bench.put(rift.device());
  InputMixer mixer;
  mixer.add(bench.make("head:rift"));
  const auto turn = [&](double rate_rad_s, int count) {
    for (int i = 0; i < count; ++i) {
      rift.step({0.0, rate_rad_s, 0.0}, 1);
      bench.clock.advance(kMs);
      mixer.poll(bench.clock.now());
    }
    return mixer.poll(bench.clock.now());
  };
  const auto middle = [](const InputFrame& frame) {
    return 0.5 * (*frame.heads.at(0).left_eye_m + *frame.heads.at(0).right_eye_m);
  };
  EXPECT_LT(middle(turn(60 * kRad, 500)).x, -0.03);
  mixer.recentre();
  expect_near(middle(turn(0.0, 5)), {0.0, 0.0, 0.6}, 1e-3);
}

TEST(HeadSource, VrpnPosesAreInTheScreenFrame) {
  SourceBench bench;
  SimDevice server("simulated VRPN server", false);
  bench.put(server);
  const auto source = bench.make("head:vrpn,tracker=Head,eyes=0/-50/-100");
  bench.poll(*source);
  server.send(vrpn_cookie());
  server.send(format_vrpn(vrpn_name_message(-1, 3, "Head")));
  server.send(format_vrpn(vrpn_name_message(-2, 7, "vrpn_Tracker Pos_Quat")));
  server.send(format_vrpn(vrpn_pose_message(3, 7, 0, {{0.0, 0.1, 0.7}, {1, 0, 0, 0}})));
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  ASSERT_EQ(bench.frame.heads.size(), 1u);
  expect_near(0.5 * (*bench.frame.heads[0].left_eye_m + *bench.frame.heads[0].right_eye_m), {0.0, 0.05, 0.6}, 1e-12);
}

TEST(HeadSource, ARoomTrackerWithItsOriginInACornerOfTheFloorWorks) {
  SourceBench bench;
  SimDevice server("simulated VRPN server", false);
  bench.put(server);
  // the panel's centre is 4 m along the wall, 1.4 m above the floor and 3 m into the room
  const auto source = bench.make("head:vrpn,at=-4000/-1400/-3000");
  bench.poll(*source);
  const auto say = [&](const glm::dvec3& at_m) {
    server.send(format_vrpn(vrpn_pose_message(0, 4, 0, {at_m, {1, 0, 0, 0}})));
    bench.clock.advance(kSecond);  // far apart, so that the speed is not what limits them
    return bench.poll(*source);
  };
  server.send(vrpn_cookie());
  server.send(format_vrpn(vrpn_name_message(-1, 0, "Head")));
  server.send(format_vrpn(vrpn_name_message(-2, 4, "vrpn_Tracker Pos_Quat")));
  ASSERT_EQ(say({4.0, 1.5, 3.7}), Freshness::kNew);
  ASSERT_EQ(bench.frame.heads.size(), 1u);
  expect_near(0.5 * (*bench.frame.heads[0].left_eye_m + *bench.frame.heads[0].right_eye_m), {0.0, 0.1, 0.7}, 1e-9);
  ASSERT_EQ(say({0.5, 1.5, 3.7}), Freshness::kNew);  // 3.5 m beside the panel: nobody who looks at it
  EXPECT_TRUE(bench.frame.heads.empty());
}

TEST(HeadSource, GlassesSayThatTheyMeasureNoPlace) {
  SourceBench bench;
  RiftSim rift(RiftModel::kDk1);
  bench.put(rift.device());
  const auto source = bench.make("head:rift");
  bench.poll(*source);
  for (int i = 0; i < 500; ++i) {
    rift.step({0.0, 60 * kRad, 0.0}, 1);  // to the left
    bench.clock.advance(kMs);
    bench.poll(*source);
  }
  ASSERT_EQ(bench.frame.heads.size(), 1u);
  const double turned = 30 * kRad;
  expect_near(0.5 * (*bench.frame.heads[0].left_eye_m + *bench.frame.heads[0].right_eye_m),
              {-0.0805 * std::sin(turned), 0.0, 0.6 + 0.0805 * (1 - std::cos(turned))}, 1e-3);
  EXPECT_NE(source->note().find("not where it is"), std::string::npos);
  XrealSim xreal;
  bench.put(xreal.device());
  EXPECT_EQ(bench.make("head:xreal")->name(), "head:xreal");
}

}  // namespace
}  // namespace dubsar::test
