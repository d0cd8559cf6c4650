// A thousand times pulled out and plugged in: nothing is left behind, and the first pose comes within a
// second.

#include <malloc.h>

#include <atomic>
#include <filesystem>
#include <glm/geometric.hpp>
#include <thread>

#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/leap/lmc1_simulator.h"
#include "devices/spacemouse/spacemouse_sim.h"
#include "input/mixer.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {

#if defined(__SANITIZE_THREAD__)
constexpr bool kMeasures = false;
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer)
constexpr bool kMeasures = false;
#else
constexpr bool kMeasures = true;
#endif
#else
constexpr bool kMeasures = true;
#endif
constexpr int kCycles = 1000, kWarmUp = 100;
constexpr std::size_t kMostGrowth = 512 * 1024;  // a picture more or less under way; 570 bytes a cycle are found

std::ptrdiff_t entries(const char* folder) {
  return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

struct Held {
  std::ptrdiff_t threads = entries("/proc/self/task"), descriptors = entries("/proc/self/fd");
  std::size_t bytes = ::mallinfo2().uordblks;
};

void expect_nothing_left(const Held& before) {
  const Held after;
  EXPECT_EQ(after.threads, before.threads);
  EXPECT_EQ(after.descriptors, before.descriptors);
  if (kMeasures) {
    EXPECT_LE(after.bytes, before.bytes + kMostGrowth);
  }
}

TEST(Replug, AThousandTimesWithTheFirstPoseWithinASecond) {
  SourceBench bench;
  SpaceMouseSim mouse;
  SimDevice tracker("simulated opentrack");
  bench.config.reach_device = [&](const DeviceSpec& choice, const Clock&) -> Result<OpenTransport> {
    return OpenTransport([&, head = choice.driver == "opentrack"] { return (head ? tracker : mouse.device()).open(); });
  };
  const auto space_mouse = bench.make("spacemouse"), head = bench.make("head:opentrack");
  InputFrame space_mouse_frame, head_frame;
  Held before;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    if (cycle == kWarmUp) before = Held();
    mouse.device().plug();
    tracker.plug();
    bench.bell->ring();
    const TimestampNs plugged = bench.clock.now();
    bool pushed = false, seen = false;
    while (!pushed || !seen) {
      bench.clock.advance(20 * kMs);
      ASSERT_LE(bench.clock.now() - plugged, kSecond) << "cycle " << cycle;
      mouse.move({100, 0, 0}, {0, 0, 0});
      tracker.send(format_opentrack({0, 0, 0, 0, 0, 0}));
      pushed =
          space_mouse->poll(bench.clock.now(), space_mouse_frame) == Freshness::kNew && space_mouse_frame.space_mouse;
      seen = head->poll(bench.clock.now(), head_frame) == Freshness::kNew && !head_frame.heads.empty();
    }
    mouse.device().unplug();
    tracker.unplug();
    // away for up to 30 s, so that the pauses between attempts have grown
    for (int i = 0; i < 1 + cycle % 30; ++i) {
      bench.clock.advance(kSecond);
      space_mouse->poll(bench.clock.now(), space_mouse_frame);
      ASSERT_EQ(head->poll(bench.clock.now(), head_frame), Freshness::kLost);
    }
  }
  expect_nothing_left(before);
}

TEST(Replug, SourcesWithThreadsLeaveNothingBehind) {
  SourceBench bench;
  const SteadyClock clock;
  bench.config.clock = &clock;
  bench.config.simulated_time = false;
  SpaceMouseSim mouse;
  Lmc1SimulatorOptions leap_options;
  leap_options.paced = true;
  std::atomic<bool> shows{false};  // pictures of hands cost time
  leap_options.hands = [&](std::uint64_t) {
    if (!shows) return std::vector<PosedHand>{};
    HandPose pose;
    pose.palm.position_m = {0.02, 0.25, 0.01};
    return std::vector{pose_hand(pose)};
  };
  Lmc1Simulator leap(leap_options);
  bench.config.reach_device = [&](const DeviceSpec& choice, const Clock&) -> Result<OpenTransport> {
    if (choice.driver == "leap") return OpenTransport([&] { return leap.open(); });
    return OpenTransport([&] { return mouse.device().open(); });
  };
  leap.unplug();
  mouse.device().unplug();
  const Held before_all;
  {
    InputMixer mixer;
    mixer.add(bench.make("leap"));
    mixer.add(bench.make("spacemouse"));
    const auto wait_for = [&](auto condition) {
      const TimestampNs start = clock.now();
      while (clock.now() - start < 20 * kSecond) {
        mixer.poll(clock.now());
        if (condition()) return clock.now() - start;
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
      return TimestampNs{-1};
    };
    const auto open_now = [&] {
      return mixer.states()[0].note.find("unplugged") == std::string::npos && mouse.device().open_count() == 1;
    };
    // the driver's thread has ended and the hands' one waits: two threads of sources are left
    const auto lost_now = [&] {
      return mixer.states()[0].note.find("unplugged") != std::string::npos && mouse.device().open_count() == 0;
    };
    Held before;
    for (int cycle = 0; cycle < kCycles; ++cycle) {
      if (cycle == kWarmUp) {
        before = Held();
        EXPECT_EQ(before.threads, before_all.threads + 2);
      }
      shows = cycle % 50 == 0;
      leap.plug();
      mouse.device().plug();
      bench.bell->ring();
      ASSERT_GE(wait_for(open_now), 0) << "cycle " << cycle << ": " << mixer.states()[0].note;
      if (shows) {
        const double cpu_s = process_cpu_seconds();  // not wall: a busy machine is not the sources' fault
        ASSERT_GE(wait_for([&] { return !mixer.poll(clock.now()).hands.empty(); }), 0);
        if (kMeasures) {
          EXPECT_LE(process_cpu_seconds() - cpu_s, 1.0);
        }
      }
      leap.unplug();
      mouse.device().unplug();
      ASSERT_GE(wait_for(lost_now), 0) << "cycle " << cycle;
    }
    expect_nothing_left(before);
  }
  const Held after;
  EXPECT_EQ(after.threads, before_all.threads);
  EXPECT_EQ(after.descriptors, before_all.descriptors);
}

}  // namespace
}  // namespace dubsar::test
