
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "devices/driver.h"
#include "devices/spacemouse/spacemouse_sim.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "devices/transport/record_transport.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {

TEST(SpaceMouseSource, ReportsBecomeMotionInScreenAxesAndItsButtonsKeys) {
  SourceBench bench;
  SpaceMouseSim mouse;
  bench.put(mouse.device());
  const auto source = bench.make("spacemouse");
  EXPECT_EQ(bench.poll(*source), Freshness::kUnchanged);
  EXPECT_TRUE(mouse.light_is_on());
  mouse.move({350, 0, -175}, {0, 0, 0});
  mouse.press(0b10);
  bench.clock.advance(10 * kMs);
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  ASSERT_TRUE(bench.frame.space_mouse);
  EXPECT_EQ(bench.frame.space_mouse->push, glm::dvec3(1.0, 0.5, 0.0));
  EXPECT_EQ(bench.frame.time, kSecond + 10 * kMs);
  ASSERT_EQ(bench.frame.events.size(), 1u);
  EXPECT_EQ(bench.frame.events[0].key, "puck2");
  EXPECT_TRUE(bench.frame.events[0].down);
  bench.clock.advance(10 * kMs);
  EXPECT_EQ(bench.poll(*source), Freshness::kUnchanged);
  EXPECT_TRUE(bench.frame.events.empty());
  ASSERT_TRUE(bench.frame.space_mouse);  // stays pushed until it says otherwise
}

TEST(SpaceMouseSource, ASpaceMouseThatIsPulledOutIsAtRestAndHoldsNoButton) {
  SourceBench bench;
  SpaceMouseSim mouse;
  bench.put(mouse.device());
  const auto source = bench.make("spacemouse");
  bench.poll(*source);
  mouse.move({350, 0, 0}, {0, 0, 0});
  mouse.press(1);
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  mouse.device().unplug();
  bench.clock.advance(kMs);
  bench.poll(*source);
  EXPECT_FALSE(bench.frame.space_mouse);
  ASSERT_EQ(bench.frame.events.size(), 1u);
  EXPECT_FALSE(bench.frame.events[0].down);
  bench.clock.advance(kMs);
  EXPECT_EQ(bench.poll(*source), Freshness::kLost);
  EXPECT_NE(source->note().find("unplugged"), std::string::npos) << source->note();
  bench.clock.advance(60 * kSecond);
  EXPECT_EQ(bench.poll(*source), Freshness::kLost);  // the pause until the next attempt is long by now

  mouse.device().plug();
  bench.bell->ring();
  bench.clock.advance(kMs);
  EXPECT_EQ(bench.poll(*source), Freshness::kUnchanged);
  EXPECT_TRUE(source->note().empty()) << source->note();
}

TEST(SpaceMouseSource, ARecordingOfTheDevicePlaysThroughTheSameDriverAndEnds) {
  const auto file = std::filesystem::temp_directory_path() / ("dubsar_spacemouse_" + std::to_string(::getpid()));
  {
    ManualClock clock;
    SpaceMouseSim mouse;
    const auto writer = RecordingWriter::create(file, "spacemouse", "", clock).value();
    Driver<SpaceMouseProtocol> driver(
        [&]() -> Result<std::unique_ptr<Transport>> {
          auto opened = mouse.device().open();
          if (!opened) return opened;
          return make_record_transport(std::move(*opened), writer);
        },
        SpaceMouseProtocol());
    driver.poll(clock.now());
    for (int i = 1; i <= 10; ++i) {
      clock.advance(20 * kMs);
      mouse.move({35 * i, 0, 0}, {0, 0, 0});
      driver.poll(clock.now());
    }
    ASSERT_TRUE(writer->finish());
  }
  SourceBench bench;
  const auto source = bench.make("spacemouse:replay=" + file.string());
  EXPECT_TRUE(source->has_end());
  bench.clock.advance(105 * kMs);
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  EXPECT_NEAR(bench.frame.space_mouse->push.x, 0.5, 1e-12);
  EXPECT_FALSE(source->finished());
  bench.clock.advance(100 * kMs);
  bench.poll(*source);
  bench.clock.advance(kMs);
  bench.poll(*source);
  EXPECT_TRUE(source->finished());
  std::ofstream(file) << "dubsar-recording 1\ndriver rift\n";
  EXPECT_EQ(make_input("spacemouse:replay=" + file.string(), bench.config).error().kind, ErrorKind::kBadData);
  std::filesystem::remove(file);
}

TEST(SpaceMouseSource, ItsThreadStampsReportsWhenTheyComeNotWhenTheyAreAskedFor) {
  SourceBench bench;
  bench.config.simulated_time = false;
  SpaceMouseSim mouse;
  bench.put(mouse.device());
  const auto source = bench.make("spacemouse");
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  const auto wait_for = [&](auto condition) {
    while (std::chrono::steady_clock::now() < until) {
      if (condition()) return true;
      std::this_thread::yield();
    }
    return false;
  };
  ASSERT_TRUE(wait_for([&] { return mouse.light_is_on(); }));
  bench.clock.set(5 * kSecond);
  mouse.move({70, 0, 0}, {0, 0, 0});
  Freshness freshness = Freshness::kLost;
  InputFrame frame;
  // polls that claim to come 25 ms later, as a display does that shows what was measured meanwhile
  ASSERT_TRUE(wait_for([&] { return (freshness = source->poll(5 * kSecond + 25 * kMs, frame)) == Freshness::kNew; }));
  EXPECT_EQ(frame.time, 5 * kSecond);
}

TEST(SpacenavSource, EventsOfTheDaemonAreMotions) {
  SourceBench bench;
  SimDevice daemon("simulated spacenavd", false);
  bench.put(daemon);
  const auto source = bench.make("spacenav");
  bench.poll(*source);
  daemon.send(spacenav_hello(1));
  SpacenavEvent event;
  event.rotation = {0, 250, 0};
  daemon.send(format_spacenav(event));
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  EXPECT_EQ(bench.frame.space_mouse->twist, glm::dvec3(0.0, 0.5, 0.0));

  // A daemon that comes back makes no device node: it is found by itself within a second.
  daemon.unplug();
  for (int i = 0; i < 300; ++i) {
    bench.clock.advance(100 * kMs);
    bench.poll(*source);
  }
  daemon.plug();
  const TimestampNs plugged = bench.clock.now();
  while (bench.poll(*source) == Freshness::kLost && bench.clock.now() < plugged + 5 * kSecond)
    bench.clock.advance(10 * kMs);
  EXPECT_LE(bench.clock.now() - plugged, kSecond);
}

}  // namespace
}  // namespace dubsar::test
