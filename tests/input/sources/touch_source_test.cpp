// A touch panel as a source: its fingers, taps between two polls, unplugging, a scripted person's hands on the glass.

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "devices/touch/simulated_touch.h"
#include "input/mixer.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {

TEST(TouchSource, EveryMomentComesThoughSeveralLieBetweenTwoPolls) {
  SourceBench bench;
  TouchPanelSim panel;
  bench.put(panel.device());
  const auto source = bench.make("touch");
  EXPECT_EQ(bench.poll(*source), Freshness::kUnchanged) << "a glass that nobody touches is there all the same";
  bench.clock.advance(10 * kSecond);
  EXPECT_EQ(bench.poll(*source), Freshness::kUnchanged);
  panel.touch(kMs, {{1, {0.5, 0.25}}});
  panel.touch(2 * kMs, {});
  panel.touch(3 * kMs, {{2, {0.5, 0.75}}});
  ASSERT_EQ(bench.poll(*source), Freshness::kNew);
  ASSERT_EQ(bench.frame.touches.size(), 3U);
  EXPECT_EQ(bench.frame.touches[0].contacts[0].at, glm::dvec2(0.5, 0.25));
  EXPECT_TRUE(bench.frame.touches[1].contacts.empty());
  EXPECT_FALSE(bench.frame.touches[1].cancelled);
  EXPECT_NE(bench.frame.touches[2].contacts[0].id, bench.frame.touches[0].contacts[0].id);
  EXPECT_EQ(bench.poll(*source), Freshness::kUnchanged);
  EXPECT_TRUE(bench.frame.touches.empty()) << "each comes once";
}

TEST(TouchSource, FingersAreGoneWhenThePanelIsUnpluggedAndItComesBack) {
  SourceBench bench;
  TouchPanelSim panel;
  bench.put(panel.device());
  const auto source = bench.make("touch");
  bench.poll(*source);
  for (int cycle = 0; cycle < 100; ++cycle) {
    panel.touch(kMs, {{1, {0.5, 0.5}}});
    ASSERT_EQ(bench.poll(*source), Freshness::kNew);
    ASSERT_EQ(bench.frame.touches.back().contacts.size(), 1U) << "cycle " << cycle;
    panel.device().unplug();
    bench.poll(*source);
    ASSERT_EQ(bench.frame.touches.size(), 1U);
    EXPECT_TRUE(bench.frame.touches[0].contacts.empty());
    EXPECT_TRUE(bench.frame.touches[0].cancelled) << "nobody lifted it";
    EXPECT_EQ(bench.poll(*source), Freshness::kLost);
    EXPECT_NE(source->note().find("unplugged"), std::string::npos) << source->note();
    panel.touch(kMs, {});
    panel.device().plug();
    bench.bell->ring();
    EXPECT_NE(bench.poll(*source), Freshness::kLost);
  }
}

TEST(TouchSource, OptionsThatItDoesNotHaveAreRefused) {
  SourceBench bench;
  TouchPanelSim panel;
  bench.put(panel.device());
  EXPECT_TRUE(make_input("touch:turn=270,device=/dev/input/event7", bench.config));
  const auto refused = [&](std::string_view spec) {
    const auto made = make_input(spec, bench.config);
    return made ? std::string("taken") : made.error().message;
  };
  EXPECT_NE(refused("touch:turn=45").find("45 found, expected 0, 90, 180 or 270"), std::string::npos);
  EXPECT_NE(refused("touch:at=0/0/0").find("\"at\" is not an option"), std::string::npos) << refused("touch:at=0/0/0");
}

TEST(TouchSource, IsTakenUnaskedByWhoCoversTheScreenAlone) {
  DeviceInfo info;
  info.driver = "touch";
  using Inputs = std::vector<std::string>;
  EXPECT_EQ(present_inputs({info}, true), Inputs{"touch"});
  EXPECT_EQ(present_inputs({info}, false), Inputs{}) << "other windows want it as well";
  info.state = DeviceState::kNoPermission;
  EXPECT_EQ(present_inputs({info}, true), Inputs{});
}

TEST(TouchSource, OfTwoPanelsTheOneThatIsTouchedFirstCounts) {
  SourceBench one, two;
  TouchPanelSim first, second;
  one.put(first.device());
  two.put(second.device());
  InputMixer mixer;
  mixer.add(one.make("touch"));
  mixer.add(two.make("touch"));
  const auto poll = [&] { return mixer.poll(one.clock.now()).touches; };
  poll();
  second.touch(kMs, {{1, {0.25, 0.25}}});
  EXPECT_EQ(poll().size(), 1U);
  first.touch(kMs, {{1, {0.75, 0.75}}});
  EXPECT_TRUE(poll().empty());
  second.touch(2 * kMs, {});
  first.touch(2 * kMs, {{1, {0.7, 0.75}}});
  auto touches = poll();
  ASSERT_EQ(touches.size(), 1U);
  EXPECT_TRUE(touches[0].contacts.empty());
  first.touch(3 * kMs, {{1, {0.6, 0.75}}});
  touches = poll();
  ASSERT_EQ(touches.size(), 1U);
  EXPECT_EQ(touches[0].contacts[0].at.x, 0.6);
}

TEST(TouchSource, HandsOfAScriptThatGrabAreFingersOnTheGlass) {
  const auto path = std::filesystem::temp_directory_path() / ("dubsar_touch_" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << R"({"duration_s": 2, "rate_hz": 100, "latency_ms": 0, "hands": [
    {"chirality": "left", "keys": [{"t": 0, "at_mm": [-86, 0, 100], "grab": 0}, {"t": 0.5, "grab": 1}, {"t": 2}]},
    {"chirality": "right", "keys": [{"t": 0, "at_mm": [86, 48.5, 100], "grab": 0}, {"t": 1, "grab": 1}, {"t": 2}]}]})";
  SourceBench bench;
  const auto source = bench.make("touch:simulate=" + path.string());
  std::size_t fingers = 0, most = 0;
  std::vector<TouchContact> last;
  for (int i = 0; i < 220; ++i, bench.clock.advance(10 * kMs)) {
    bench.poll(*source);
    for (const TouchFrame& frame : bench.frame.touches) {
      fingers = frame.contacts.size();
      most = std::max(most, fingers);
      if (fingers == 2) last = frame.contacts;
    }
    EXPECT_TRUE(i != 60 || fingers == 1U) << "the right hand closes later";
  }
  EXPECT_EQ(most, 2U);
  ASSERT_EQ(last.size(), 2U);
  EXPECT_EQ(last[0].at, glm::dvec2(0.25, 0.5)) << "the panel is 344 mm wide and 194 mm high";
  EXPECT_EQ(last[1].at, glm::dvec2(0.75, 0.25));
  EXPECT_TRUE(source->finished());
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace dubsar::test
