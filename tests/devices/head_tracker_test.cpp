// Head trackers: opentrack, VRPN, Rift, XREAL, and what holds them level.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/base/system/second.h"
#include "devices/driver.h"
#include "devices/head_tracker/imu_sim.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

double angle_between(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

TEST(Opentrack, GoldenDatagramInCentimetresAndDegrees) {
  // 10, -5, 60 cm, yaw 90, pitch 0, roll 0 degrees as little-endian doubles
  const auto bytes =
      from_hex("0000000000002440 00000000000014c0 0000000000004e40 0000000000805640 0000000000000000 0000000000000000");
  const auto packet = parse_opentrack(bytes);
  ASSERT_TRUE(packet);
  EXPECT_EQ(*packet, (OpentrackPacket{10, -5, 60, 90, 0, 0}));
  EXPECT_EQ(to_hex(format_opentrack(*packet)), to_hex(bytes));
  const Pose pose = opentrack_pose(*packet);
  EXPECT_NEAR(pose.position_m.x, -0.10, 1e-12);  // x on the wire counts to the user's left
  EXPECT_NEAR(pose.position_m.y, -0.05, 1e-12);
  EXPECT_NEAR(pose.position_m.z, 0.60, 1e-12);
  const glm::dvec3 gaze = pose.rotation * glm::dvec3(0, 0, -1);
  EXPECT_NEAR(gaze.x, 1.0, 1e-12);  // yaw on the wire counts to the right
  const OpentrackInvert yaw{false, false, false, true, false, false};
  EXPECT_NEAR((opentrack_pose(*packet, OpentrackSender::kOpentrack, yaw).rotation * glm::dvec3(0, 0, -1)).x, -1.0,
              1e-12);
}

// What opentrack's other outputs do with the same six numbers: proto-flightgear and proto-simconnect take positive
// pitch as up and negate x; tracker-steamvr and tracker-tobii negate x, which counts to the right there, on its way in.
TEST(Opentrack, PitchIsUpAndRollIsToTheLeft) {
  EXPECT_NEAR((opentrack_pose({0, 0, 0, 0, 30, 0}).rotation * glm::dvec3(0, 0, -1)).y, 0.5, 1e-12);
  // the right ear rises when the head is laid on the left shoulder
  EXPECT_NEAR((opentrack_pose({0, 0, 0, 0, 0, 30}).rotation * glm::dvec3(1, 0, 0)).y, 0.5, 1e-12);
}

TEST(Opentrack, XrLinuxDriverCountsXToTheRightYawToTheLeftPitchDownAndRollToTheRight) {
  const auto turned = [](const OpentrackPacket& packet, const glm::dvec3& axis) {
    return opentrack_pose(packet, OpentrackSender::kXrLinux).rotation * axis;
  };
  EXPECT_NEAR(opentrack_pose({12, 3, 4, 0, 0, 0}, OpentrackSender::kXrLinux).position_m.x, 0.12, 1e-12);
  EXPECT_NEAR(turned({0, 0, 0, 30, 0, 0}, {0, 0, -1}).x, -0.5, 1e-12);
  EXPECT_NEAR(turned({0, 0, 0, 0, 30, 0}, {0, 0, -1}).y, -0.5, 1e-12);
  EXPECT_NEAR(turned({0, 0, 0, 0, 0, 30}, {1, 0, 0}).y, -0.5, 1e-12);
}

TEST(Opentrack, DatagramsOf52BytesAreXrLinuxDriversUnlessAnotherSenderIsNamed) {
  // x 12 cm, yaw 30 degrees, and the frame number 7 behind them, as XRLinuxDriver packs them
  const auto bytes = from_hex(
      "0000000000002840 0000000000000000 0000000000000000 0000000000003e40 0000000000000000 0000000000000000"
      "07000000");
  ASSERT_EQ(bytes.size(), 52U);
  const auto hear = [&](std::optional<OpentrackSender> sender, std::string* note) {
    SimDevice device("opentrack");
    Driver<OpentrackProtocol> driver([&] { return device.open(); }, OpentrackProtocol({}, sender));
    driver.poll(0);
    device.send(bytes);
    const auto sample = driver.poll(1);
    *note = driver.note();
    return sample->pose;
  };
  std::string note;
  Pose pose = hear(std::nullopt, &note);
  EXPECT_NEAR(pose.position_m.x, 0.12, 1e-12);
  EXPECT_NEAR((pose.rotation * glm::dvec3(0, 0, -1)).x, -0.5, 1e-12);
  EXPECT_NE(note.find("XRLinuxDriver"), std::string::npos) << note;
  pose = hear(OpentrackSender::kXrLinux, &note);
  EXPECT_NEAR(pose.position_m.x, 0.12, 1e-12);
  EXPECT_EQ(note, "");
  pose = hear(OpentrackSender::kOpentrack, &note);
  EXPECT_NEAR(pose.position_m.x, -0.12, 1e-12);
  EXPECT_NEAR((pose.rotation * glm::dvec3(0, 0, -1)).x, 0.5, 1e-12);
  EXPECT_EQ(note, "");
  EXPECT_EQ(parse_opentrack_sender("freetrack").error().kind, ErrorKind::kUsage);
}

TEST(Opentrack, PoseAndPacketAreInverse) {
  for (double yaw = -170; yaw <= 170; yaw += 34)
    for (double pitch = -80; pitch <= 80; pitch += 20)
      for (double roll = -170; roll <= 170; roll += 34) {
        for (const OpentrackSender sender : {OpentrackSender::kOpentrack, OpentrackSender::kXrLinux}) {
          const OpentrackPacket back = opentrack_packet(opentrack_pose({1, 2, 3, yaw, pitch, roll}, sender), sender);
          ASSERT_NEAR(back.x_cm, 1, 1e-9);
          ASSERT_NEAR(back.z_cm, 3, 1e-9);
          ASSERT_NEAR(back.yaw_deg, yaw, 1e-9);
          ASSERT_NEAR(back.pitch_deg, pitch, 1e-9);
          ASSERT_NEAR(back.roll_deg, roll, 1e-9);
        }
      }
}

TEST(Opentrack, ReadsTheFirst48BytesOfLongerDatagramsAndRefusesShorterOnesAndValuesThatNoHeadHas) {
  const auto good = format_opentrack({1, 2, 3, 4, 5, 6});
  std::vector<std::byte> longer(good.begin(), good.end());
  for (int more = 0; more < 20; ++more) {
    longer.push_back(std::byte{0xff});
    EXPECT_EQ(parse_opentrack(longer), (OpentrackPacket{1, 2, 3, 4, 5, 6}));
  }
  for (std::size_t length = 0; length < 48; ++length) EXPECT_FALSE(parse_opentrack(std::span(good).first(length)));
  for (std::size_t field = 0; field < 6; ++field)
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300,
                             field < 3 ? 200.1 : 180.1}) {
      auto bytes = good;
      std::memcpy(bytes.data() + 8 * field, &bad, 8);
      EXPECT_FALSE(parse_opentrack(bytes)) << field << " " << bad;
    }
}

TEST(HeadGate, AJumpIsFollowedAtFiveMetresPerSecond) {
  HeadGate gate;
  gate.pass({0, {{0, 0, 0.6}, {1, 0, 0, 0}}, true, true});
  const auto jumped = gate.pass({kSecondNs / 100, {{1.0, 0, 0.6}, {1, 0, 0, 0}}, true, true});
  ASSERT_TRUE(jumped);
  EXPECT_NEAR(jumped->pose.position_m.x, 0.05, 1e-12);
  const auto later = gate.pass({kSecondNs, {{1.0, 0, 0.6}, {1, 0, 0, 0}}, true, true});
  EXPECT_NEAR(later->pose.position_m.x, 1.0, 1e-12);  // after a gap the new place is believed
  EXPECT_FALSE(gate.pass({kSecondNs, {{2.1, 0, 0}, {1, 0, 0, 0}}, true, true}));
  EXPECT_FALSE(gate.pass({kSecondNs, {{0, 0, 0}, {0.5, 0, 0, 0}}, true, true}));
}

TEST(Rift, PackedVectorsAreThreeSigned21BitNumbersBigEndian) {
  EXPECT_EQ(to_hex(pack_rift_vector({1, 0, 0})), "0000080000000000");
  EXPECT_EQ(to_hex(pack_rift_vector({0, 1, 0})), "0000000000400000");
  EXPECT_EQ(to_hex(pack_rift_vector({0, 0, 1})), "0000000000000002");
  EXPECT_EQ(to_hex(pack_rift_vector({-1, 0, 0})), "fffff80000000000");
  for (const std::array<std::int32_t, 3> v :
       {std::array{1048575, -1048576, 0}, std::array{-1, 77777, -99999}, std::array{98100, -98100, 1}})
    EXPECT_EQ(unpack_rift_vector(pack_rift_vector(v)), v);
}

TEST(Rift, GoldenReports) {
  auto dk1 = from_hex("01 02 3412 0000 0000 0000000000400000");
  dk1.resize(62);
  auto parsed = parse_rift(dk1);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->ticks, 0x1234U);
  EXPECT_EQ(parsed->count, 2);
  EXPECT_NEAR(parsed->samples[0].acceleration_m_s2.y, 1e-4, 1e-12);
  dk1.resize(64);  // OpenHMD accepts both lengths
  ASSERT_TRUE(parse_rift(dk1));
  EXPECT_EQ(parse_rift(dk1)->ticks, 0x1234U);
  auto dk2 = from_hex("0b 0000 05 ffff 0000 40e20100 0000080000000000 fffff80000000000");
  dk2.resize(64);
  parsed = parse_rift(dk2);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->ticks, 123456U);
  EXPECT_EQ(parsed->samples_since_last, 5);
  EXPECT_EQ(parsed->count, 2);
  EXPECT_NEAR(parsed->samples[0].turn_rate_rad_s.x, -1e-4, 1e-12);
  for (std::size_t length = 0; length < 64; ++length) EXPECT_FALSE(parse_rift(std::span(dk2).first(length)));
  dk2[3] = {};
  EXPECT_FALSE(parse_rift(dk2));
  EXPECT_EQ(to_hex(rift_keep_alive(10000)), "0800001027");
}

TEST(Rift, AQuarterTurnIsFollowedOnBothModels) {
  for (const RiftModel model : {RiftModel::kDk1, RiftModel::kDk2}) {
    RiftSim sim(model);
    Driver<RiftProtocol> driver([&] { return sim.device().open(); }, RiftProtocol());
    driver.poll(0);
    std::optional<HeadSample> newest;
    for (int i = 0; i < 500; ++i) {  // 1 s, two readings per report
      sim.step({0, 90 * kDeg, 0}, 2);
      if (const auto sample = driver.poll((i + 1) * 2'000'000)) newest = sample;
    }
    ASSERT_TRUE(newest);
    EXPECT_FALSE(newest->has_position);
    EXPECT_LT(angle_between(newest->pose.rotation, sim.motion().world_from_head()), 0.1 * kDeg);
    EXPECT_NEAR((newest->pose.rotation * glm::dvec3(0, 0, -1)).x, -1.0, 1e-2);  // right-handed about up: to the left
  }
}

TEST(Rift, StaysAwakeForAMinute) {
  RiftSim sim(RiftModel::kDk1);
  Driver<RiftProtocol> driver([&] { return sim.device().open(); }, RiftProtocol());
  driver.poll(0);
  for (int i = 1; i <= 3000; ++i) {
    sim.step({}, 20);
    ASSERT_FALSE(sim.silent()) << i;
    ASSERT_TRUE(driver.poll(i * TimestampNs{20'000'000}));
  }
}

TEST(ImuFusion, AStartAtASlantIsLevelAtOnceAndTiltErrorsFade) {
  const glm::dquat tilted = glm::angleAxis(30 * kDeg, glm::dvec3(0, 0, 1));
  ImuFusion fusion;
  fusion.update({glm::conjugate(tilted) * glm::dvec3(0, 9.81, 0), {}}, 0.001);
  EXPECT_LT(angle_between(fusion.world_from_head(), tilted), 1e-9);
  for (int i = 0; i < 10000; ++i) fusion.update({{0, 9.81, 0}, {}}, 0.001);  // now level: 10 s, five time constants
  EXPECT_LT(angle_between(fusion.world_from_head(), {1, 0, 0, 0}), 30 * kDeg * std::exp(-5.0) * 1.01);
}

TEST(ImuFusion, RecentringTakesTheHeadingAwayAndKeepsTheTilt) {
  ImuFusion fusion;
  HeadMotion head;
  for (int i = 0; i < 1000; ++i) fusion.update(head.turn({0, 1.2, 0}, 1e-3), 1e-3);
  for (int i = 0; i < 1000; ++i) fusion.update(head.turn({0.3, 0, 0}, 1e-3), 1e-3);
  fusion.recentre();
  EXPECT_LT(angle_between(fusion.world_from_head(), glm::angleAxis(0.3, glm::dvec3(1, 0, 0))), 1e-3);
}

TEST(ImuFusion, ABiasIsLearntAtRestAndTakenOffAndAHeadThatTurnsTeachesNone) {
  const glm::dvec3 bias(0.01, -0.02, 0.005);
  const auto heading = [](const ImuFusion& fusion) {
    const glm::dvec3 back = fusion.world_from_head() * glm::dvec3(0, 0, 1);
    return std::atan2(back.x, back.z);
  };
  ImuFusion fusion;
  for (int ms = 0; ms < 8000; ++ms) fusion.update({{0.0, 9.81, 0.0}, bias}, 1e-3);
  const double before = heading(fusion);
  for (int ms = 0; ms < 60000; ++ms) fusion.update({{0.0, 9.81, 0.0}, bias}, 1e-3);
  EXPECT_LE(std::abs(heading(fusion) - before), 0.2 * kDeg);  // 69 degrees without

  ImuFusion turning;  // 5 degrees a second, and a nod to and fro
  for (int ms = 0; ms < 10000; ++ms)
    turning.update({{0.0, 9.81, 0.0}, {0.05 * std::sin(2e-3 * ms), 5 * kDeg, 0.0}}, 1e-3);
  EXPECT_NEAR(heading(turning), 50 * kDeg, 1 * kDeg);
}

TEST(DeviceTimeline, AReportThatWasHeldUpHasTheTimeOfItsMeasurement) {
  DeviceTimeline timeline;
  constexpr TimestampNs kMs = 1'000'000, kOrigin = 77 * kSecondNs;  // of the device's clock
  for (int i = 0; i < 100; ++i)
    EXPECT_LE(std::abs(timeline.host_time(i * 10 * kMs + kOrigin, i * 10 * kMs + 2 * kMs) - (i * 10 * kMs + 2 * kMs)),
              1000);
  // 40 ms late
  EXPECT_LE(std::abs(timeline.host_time(kSecondNs + kOrigin, kSecondNs + 42 * kMs) - (kSecondNs + 2 * kMs)), kMs / 5);
  // never in the future
  EXPECT_EQ(timeline.host_time(2 * kSecondNs + kOrigin, 2 * kSecondNs + kMs), 2 * kSecondNs + kMs);
  // a clock that runs 50 us/s fast is followed
  TimestampNs worst = 0;
  for (int i = 0; i < 100; ++i) {
    const TimestampNs arrived = (3 + i) * kSecondNs;
    worst = std::max(worst, arrived - timeline.host_time(arrived + kOrigin - i * 50'000, arrived));
  }
  EXPECT_LE(worst, 2 * kMs);
  // a device that was started anew
  EXPECT_EQ(timeline.host_time(5, 500 * kSecondNs), 500 * kSecondNs);
}

TEST(Xreal, GoldenReportAndCommand) {
  // 1.5 s; gyro 1/1000 degree per unit: 1000, 2000, -3000; accelerometer 1/100 g: 0, 0, 100
  auto bytes =
      from_hex("0102 0000 002f685900000000 0100 e8030000 e80300 d00700 48f4ff 0100 64000000 000000 000000 640000");
  bytes.resize(64);
  const auto parsed = parse_xreal(bytes);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->time_ns, 1'500'000'000U);
  EXPECT_NEAR(parsed->sample.turn_rate_rad_s.x, -1 * kDeg, 1e-12);
  EXPECT_NEAR(parsed->sample.turn_rate_rad_s.y, -3 * kDeg, 1e-12);
  EXPECT_NEAR(parsed->sample.turn_rate_rad_s.z, 2 * kDeg, 1e-12);
  EXPECT_NEAR(parsed->sample.acceleration_m_s2.y, 9.81, 1e-12);
  for (std::size_t length = 0; length < 64; ++length) EXPECT_FALSE(parse_xreal(std::span(bytes).first(length)));
  auto bad = bytes;
  for (std::size_t i = 14; i < 18; ++i) bad[i] = {};
  EXPECT_FALSE(parse_xreal(bad));
  bad = bytes;
  bad[26] = std::byte{0x7f};
  EXPECT_FALSE(parse_xreal(bad));

  const auto command = format_xreal_command({kXrealStream, {std::byte{1}}});
  // CRC-32 of 04 00 19 01
  EXPECT_EQ(to_hex(std::span(command).first(9)),
            "aa"
            "c5d12142"
            "040019"
            "01");
  EXPECT_EQ(parse_xreal_command(command), (XrealCommand{kXrealStream, {std::byte{1}}}));
  for (std::size_t i = 0; i < 9; ++i) {
    auto broken = command;
    broken[i] ^= std::byte{0x10};
    EXPECT_FALSE(parse_xreal_command(broken)) << i;
  }
}

TEST(Xreal, StreamsAfterItsCommandAndFollowsANod) {
  XrealSim sim;
  Driver<XrealProtocol> driver([&] { return sim.device().open(); }, XrealProtocol());
  driver.poll(0);
  EXPECT_TRUE(sim.streaming());
  std::optional<HeadSample> newest;
  for (int i = 1; i <= 1000; ++i) {
    sim.step({20 * kDeg, 0, 0}, 1e-3);
    if (const auto sample = driver.poll(i * 1'000'000)) newest = sample;
  }
  ASSERT_TRUE(newest);
  EXPECT_LT(angle_between(newest->pose.rotation, glm::angleAxis(20 * kDeg, glm::dvec3(1, 0, 0))), 0.1 * kDeg);
  EXPECT_EQ(driver.counts().refused, 0U);
}

}  // namespace
}  // namespace dubsar
