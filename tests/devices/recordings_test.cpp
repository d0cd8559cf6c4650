// Recordings of devices, replayed to known values.

#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/files/atomic_file.h"
#include "devices/driver.h"
#include "devices/spacemouse/spacemouse_protocol.h"
#include "devices/transport/record_transport.h"
#include "devices/transport/replay_transport.h"

namespace dubsar {
namespace {

TEST(Recordings, SpaceMouseTurnedAndUnplugged) {
  auto recording = read_recording(std::filesystem::path(DUBSAR_RECORDINGS) / "spacemouse_turn_unplug.txt");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->driver, "spacemouse");
  const ManualClock clock;
  ReplaySession session(*recording, clock, 0.0);
  Driver<SpaceMouseProtocol> driver([&] { return session.open(); }, SpaceMouseProtocol());
  // polled as fast as it goes, the whole stay between two losses arrives at once
  TimestampNs now = 0;
  const auto last = driver.poll(now);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->rotation, glm::dvec3(0));
  EXPECT_FALSE(driver.connected());
  EXPECT_EQ(driver.counts().accepted, 13U);
  EXPECT_EQ(driver.counts().refused, 1U);
  EXPECT_EQ(driver.counts().losses, 1U);
  EXPECT_EQ(session.recorded_clock().now(), 128'000'000);
  now += 500'000'000;
  driver.poll(now);
  const auto counts = driver.counts();
  EXPECT_EQ(counts.accepted, 15U);
  EXPECT_EQ(session.recorded_clock().now(), 2'032'000'000);
  EXPECT_TRUE(session.finished());
}

TEST(Recordings, SpaceMousePaceIsTheRecordedOne) {
  auto recording = read_recording(std::filesystem::path(DUBSAR_RECORDINGS) / "spacemouse_turn_unplug.txt");
  ASSERT_TRUE(recording) << recording.error().message;
  ManualClock clock;
  ReplaySession session(*recording, clock, 1.0);
  Driver<SpaceMouseProtocol> driver([&] { return session.open(); }, SpaceMouseProtocol());
  std::vector<SpaceMouseSample> samples;
  for (; clock.now() <= 120'000'000; clock.advance(8'000'000))
    if (const auto sample = driver.poll(clock.now())) samples.push_back(*sample);
  ASSERT_EQ(samples.size(), 7U);
  EXPECT_EQ(samples.front().time, 16'000'000);
  EXPECT_NEAR(samples.front().rotation.y, 0.1, 1e-12);  // -35 about the device's downward axis
  EXPECT_NEAR(samples[3].rotation.y, 1.0, 1e-12);
  EXPECT_EQ(samples[5].buttons, 1U);
  EXPECT_EQ(samples.back().rotation.y, 0.0);
}

}  // namespace
}  // namespace dubsar
