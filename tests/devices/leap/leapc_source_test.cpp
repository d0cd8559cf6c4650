#include "input/sources/leapc_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <thread>

#include "core/base/text/option_reader.h"
#include "fake_hand.h"
#include "input/sources/leapc_hands.h"

namespace dubsar {
namespace {

using std::chrono::steady_clock;
using ::testing::HasSubstr;

leapc::Hand decoded(const FakeHand& fake) { return *leapc::decode_hand(std::as_bytes(std::span(&fake, 1))); }

void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-6);
  EXPECT_NEAR(found.y, expected.y, 1e-6);
  EXPECT_NEAR(found.z, expected.z, 1e-6);
}

TEST(LeapcHands, All26JointsAreWhereTheBonesPutThem) {
  FakeHand fake = flat_fake_hand(5, true, 30, 250, -10, 0.5F);
  fake.digits[1].distal.next_joint = {-5.0F, 240.0F, -95.0F};
  const HandFrame hand = hand_from_leapc(decoded(fake), 1234);
  EXPECT_EQ(hand.time, 1234);
  EXPECT_EQ(hand.id, 5U);
  EXPECT_EQ(hand.chirality, Chirality::kRight);
  EXPECT_TRUE(hand.valid && hand.tracked);
  EXPECT_EQ(hand.grab_strength, 0.5);
  expect_near(hand.palm.position_m, {0.030, 0.250, -0.010});
  expect_near(hand.velocity_mps, {0.1, 0.0, -0.05});
  for (const HandJointPose& joint : hand.joints) EXPECT_TRUE(joint.valid && joint.tracked && joint.radius_m > 0.0);
  // Bones are 30 mm long and start 40 mm behind the palm's centre; thumb at -40, index -20 ... little +40 mm.
  expect_near(hand.joint(HandJoint::kWrist).pose.position_m, {0.030, 0.250, 0.040});
  expect_near(hand.joint(HandJoint::kThumbMetacarpal).pose.position_m, {-0.010, 0.250, 0.030});
  expect_near(hand.joint(HandJoint::kThumbProximal).pose.position_m, {-0.010, 0.250, 0.000});
  expect_near(hand.joint(HandJoint::kThumbDistal).pose.position_m, {-0.010, 0.250, -0.030});
  expect_near(hand.joint(HandJoint::kThumbTip).pose.position_m, {-0.010, 0.250, -0.060});
  expect_near(hand.joint(HandJoint::kIndexTip).pose.position_m, {-0.005, 0.240, -0.095});
  double x = -0.020;
  for (int finger = 0; finger < 4; ++finger, x += 0.020)
    for (int joint = 0; joint < 4; ++joint) {
      const auto which = static_cast<HandJoint>(static_cast<int>(HandJoint::kIndexMetacarpal) + 5 * finger + joint);
      expect_near(hand.joint(which).pose.position_m, {0.030 + x, 0.250, 0.030 - 0.030 * joint});
      EXPECT_NEAR(hand.joint(which).radius_m, 0.5e-3 * (17 + finger), 1e-9);
    }
  expect_near(hand.joint(HandJoint::kLittleTip).pose.position_m, {0.070, 0.250, -0.090});
  EXPECT_NEAR(hand.pinch_distance_m, std::sqrt(0.005 * 0.005 + 0.010 * 0.010 + 0.035 * 0.035), 1e-6);
}

TEST(LeapcHands, AMissingRotationComesFromTheBoneAndThePalm) {
  FakeHand fake = flat_fake_hand(5, false, 0, 200, 0);
  fake.palm.orientation = {0, 0, 0, 0};
  fake.palm.normal = {-1, 0, 0};  // held like a blade, thumb up, fingers to the side of the user
  fake.palm.direction = {0, 0, 1};
  fake.digits[2].proximal.rotation = {0, 0, 0, 0};
  fake.digits[2].proximal.next_joint = plus(fake.digits[2].proximal.prev_joint, 0, -30, 0);
  const HandFrame hand = hand_from_leapc(decoded(fake), 0);
  EXPECT_EQ(hand.chirality, Chirality::kLeft);
  expect_near(hand.palm.rotation * glm::dvec3(0, 0, -1), {0, 0, 1});
  expect_near(hand.palm.rotation * glm::dvec3(0, 1, 0), {1, 0, 0});
  const glm::dquat bone = hand.joint(HandJoint::kMiddleProximal).pose.rotation;
  expect_near(bone * glm::dvec3(0, 0, -1), {0, -1, 0});
  expect_near(bone * glm::dvec3(0, 1, 0), {1, 0, 0});
  EXPECT_NEAR(glm::length(bone), 1.0, 1e-12);
}

TEST(Placement, WordsBecomeAPoseAndMistakesAreNamed) {
  const auto read = [](std::vector<Option> words, const Pose& usual) {
    OptionReader options(std::move(words), "test");
    const Pose pose = options.placement(usual);
    EXPECT_TRUE(options.finish());
    return pose;
  };
  const Pose usual{{0.0, -0.2, 0.15}, {1.0, 0.0, 0.0, 0.0}};
  EXPECT_EQ(read({}, usual), usual);
  const Pose moved_only = read({{"at", "10/-200.5/300"}}, usual);
  expect_near(moved_only.position_m, {0.010, -0.2005, 0.300});
  const Pose up = read({{"turn", "90/0/0"}}, usual);
  expect_near(up.position_m, usual.position_m);
  expect_near(up.rotation * glm::dvec3(0, 1, 0), {0, 0, 1});  // a device that looks up now looks at the user
  const Pose pose = read({{"turn", "0/180/90"}}, usual);
  expect_near(pose.rotation * glm::dvec3(1, 0, 0), {0, 1, 0});
  for (const char* bad : {"", "1/2", "1/2/3/4", "1/2/x", "1,2,3", "nan/0/0", "inf/0/0", "0/0/10001", "1/2/3 "}) {
    OptionReader options({{"at", bad}}, "test");
    static_cast<void>(options.placement(usual));
    EXPECT_EQ(options.finish().error().kind, ErrorKind::kUsage) << bad;
  }
}

class LeapcSource : public testing::Test {
 protected:
  void SetUp() override { fake_leapc_reset(); }
  /// Polls until the freshness is as wished.
  static bool reaches(InputSource& source, Freshness wished, InputFrame& frame) {
    const auto until = steady_clock::now() + std::chrono::seconds(10);
    const SteadyClock clock;
    while (steady_clock::now() < until) {
      if (source.poll(clock.now(), frame) == wished) return true;
      std::this_thread::yield();
    }
    return false;
  }
  const std::string spec = std::string("leapc:library=") + DUBSAR_FAKE_LEAPC;
};

TEST_F(LeapcSource, HandsComeInTheScreenFrameAndALostServiceTakesThemAway) {
  auto source = make_input(spec + ",at=0/-100/200,turn=0/90/0");
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->name(), "leapc");
  InputFrame frame;
  ASSERT_TRUE(reaches(**source, Freshness::kUnchanged, frame));
  const FakeHand hand = flat_fake_hand(9, true, 40, 250, 0);
  fake_leapc_send_frame(1, 0, &hand, 1);
  ASSERT_TRUE(reaches(**source, Freshness::kNew, frame));
  ASSERT_EQ(frame.hands.size(), 1U);
  EXPECT_EQ(frame.time, frame.hands[0].time);
  expect_near(frame.hands[0].palm.position_m, {0.0, 0.150, 0.160});  // x of the device runs to the screen
  expect_near(frame.hands[0].velocity_mps, {-0.05, 0.0, -0.1});
  expect_near(frame.hands[0].joint(HandJoint::kWrist).pose.position_m, {0.050, 0.150, 0.160});
  fake_leapc_set_service(false);
  ASSERT_TRUE(reaches(**source, Freshness::kLost, frame));
  EXPECT_TRUE(frame.hands.empty());
  EXPECT_THAT((*source)->note(), HasSubstr("systemctl start"));
  fake_leapc_set_service(true);
  EXPECT_TRUE(reaches(**source, Freshness::kUnchanged, frame));
}

TEST_F(LeapcSource, StartsBeforeTheServiceDoesAndSaysWhatItWaitsFor) {
  fake_leapc_set_service(false);
  auto source = make_input(spec);
  ASSERT_TRUE(source) << source.error().message;
  InputFrame frame;
  ASSERT_TRUE(reaches(**source, Freshness::kLost, frame));
  EXPECT_THAT((*source)->note(), HasSubstr("connecting"));
  fake_leapc_set_service(true);
  ASSERT_TRUE(reaches(**source, Freshness::kUnchanged, frame));
  EXPECT_EQ((*source)->note(), "");
}

TEST_F(LeapcSource, SaysWhatIsMissing) {
  const auto absent = make_input("leapc:library=/nowhere/libLeapC.so");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::kUnavailable);
  EXPECT_THAT(absent.error().message, HasSubstr("/nowhere/libLeapC.so"));
  EXPECT_EQ(make_input("leapc:mode=ceiling").error().kind, ErrorKind::kUsage);
  EXPECT_EQ(make_input("leapc:volume=11").error().kind, ErrorKind::kUsage);
  EXPECT_EQ(make_input("leapc:library=").error().kind, ErrorKind::kUsage);
}

/// A connection whose frames and state the test sets.
class ScriptedConnection final : public leapc::Connection {
 public:
  Result<void> start() override { return {}; }
  void stop() noexcept override {}
  bool poll(leapc::ServiceFrame& newest) override {
    if (!fresh) return false;
    newest = frame;
    fresh = false;
    return true;
  }
  leapc::State state() const override { return now; }
  std::string reason() const override { return {}; }
  leapc::Counters counters() const override { return {}; }

  leapc::ServiceFrame frame;
  leapc::State now = leapc::State::kTracking;
  bool fresh = false;
};

TEST_F(LeapcSource, ADeviceThatFallsSilentIsLostAndTooManyHandsAreCut) {
  auto owned = std::make_unique<ScriptedConnection>();
  ScriptedConnection& connection = *owned;
  const auto source = leapc_source(std::move(owned), Pose{});
  ASSERT_TRUE(source->start());
  InputFrame frame;
  connection.frame.time = 5;
  connection.frame.hands.resize(leapc::kMostHands);
  connection.fresh = true;
  EXPECT_EQ(source->poll(1'000, frame), Freshness::kNew);
  EXPECT_EQ(frame.hands.size(), kMaxHands);
  EXPECT_EQ(source->poll(1'000 + kLeapcSilentNs, frame), Freshness::kUnchanged);
  EXPECT_EQ(frame.hands.size(), kMaxHands);
  EXPECT_EQ(source->note(), "");
  EXPECT_EQ(source->poll(1'001 + kLeapcSilentNs, frame), Freshness::kLost);
  EXPECT_THAT(source->note(), HasSubstr("sends nothing"));
  EXPECT_TRUE(frame.hands.empty());
  connection.fresh = true;
  EXPECT_EQ(source->poll(9'000 + kLeapcSilentNs, frame), Freshness::kNew);
  connection.now = leapc::State::kNoDevice;
  EXPECT_EQ(source->poll(9'001 + kLeapcSilentNs, frame), Freshness::kLost);
}

TEST_F(LeapcSource, InSimulatedTimeHandsBearTheTimeOfThePollAndSilenceMeansNothing) {
  auto owned = std::make_unique<ScriptedConnection>();
  ScriptedConnection& connection = *owned;
  const auto source = leapc_source(std::move(owned), Pose{}, true);
  InputFrame frame;
  connection.frame.time = 5;
  connection.frame.hands.resize(1);
  connection.fresh = true;
  EXPECT_EQ(source->poll(1'000, frame), Freshness::kNew);
  EXPECT_EQ(frame.time, 1'000);
  EXPECT_EQ(frame.hands.at(0).time, 1'000);
  EXPECT_EQ(source->poll(9 * kLeapcSilentNs, frame), Freshness::kUnchanged);
}

}  // namespace
}  // namespace dubsar
