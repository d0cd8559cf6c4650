// Contacts of touch panels, as Documentation/input/multi-touch-protocol.rst of the kernel tells them.

#include "devices/touch/touch_protocol.h"

#include <array>
#include <map>

#include "devices/driver.h"
#include "devices/touch/simulated_touch.h"
#include "tests/devices/touch/touch_bench.h"

namespace dubsar {
namespace {
using namespace touch_bench;

// The example of the kernel's documentation: two contacts, the first moves, is lifted, then the second is.
TEST(Touch, TheExampleOfTheKernelsDocumentation) {
  KernelPanel panel;
  Reader reader(panel);
  panel.slot(0).id(45).at(100, 200).slot(1).id(46).at(300, 400).report();
  auto frames = reader.read();
  ASSERT_EQ(frames.size(), 1U);
  ASSERT_EQ(frames[0].contacts.size(), 2U);
  EXPECT_EQ(frames[0].contacts[0].at, glm::dvec2(0.1, 0.4));
  EXPECT_EQ(frames[0].contacts[1].at, glm::dvec2(0.3, 0.8));
  EXPECT_FALSE(frames[0].cancelled);
  const auto first = frames[0].contacts[0].id, second = frames[0].contacts[1].id;
  EXPECT_NE(first, second);
  panel.slot(0).say(EV_ABS, ABS_MT_POSITION_X, 110).report();
  frames = reader.read();
  ASSERT_EQ(frames.size(), 1U);
  ASSERT_EQ(frames[0].contacts.size(), 2U);
  EXPECT_EQ(frames[0].contacts[0].id, first);
  EXPECT_EQ(frames[0].contacts[0].at, glm::dvec2(0.11, 0.4));
  panel.id(-1).report();  // slot 0 is still the current one
  frames = reader.read();
  ASSERT_EQ(frames.size(), 1U);
  ASSERT_EQ(frames[0].contacts.size(), 1U);
  EXPECT_EQ(frames[0].contacts[0].id, second);
  EXPECT_FALSE(frames[0].cancelled);
  panel.slot(1).id(-1).report();
  frames = reader.read();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].contacts.empty());
  EXPECT_FALSE(frames[0].cancelled) << "it was lifted";
}

TEST(Touch, ASlotThatIsUsedAgainKeepsThePlacesThatAreNotSaidAgainForAnotherFinger) {
  KernelPanel panel;
  Reader reader(panel);
  panel.slot(0).id(7).at(500, 250).report();
  const auto first = reader.read()[0].contacts[0];
  panel.id(-1).report();
  panel.id(8).say(EV_ABS, ABS_MT_POSITION_Y, 100).report();  // the same x: the kernel does not say it again
  const auto frames = reader.read();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].contacts.empty());
  ASSERT_EQ(frames[1].contacts.size(), 1U);
  EXPECT_NE(frames[1].contacts[0].id, first.id);
  EXPECT_EQ(frames[1].contacts[0].at, glm::dvec2(0.5, 0.2));
  panel.id(9).report();  // another finger without a release between
  const auto replaced = reader.read();
  ASSERT_EQ(replaced.size(), 1U);
  ASSERT_EQ(replaced[0].contacts.size(), 1U);
  EXPECT_NE(replaced[0].contacts[0].id, frames[1].contacts[0].id);
}

TEST(Touch, AnyNegativeTrackingIdIsARelease) {
  KernelPanel panel;
  Reader reader(panel);
  panel.slot(0).id(0).at(1, 1).report();
  EXPECT_EQ(reader.read()[0].contacts.size(), 1U) << "0 is a finger";
  panel.id(-7).report();
  EXPECT_TRUE(reader.read()[0].contacts.empty());
}

TEST(Touch, ReportsMayBeReadInAnyPieces) {
  KernelPanel panel;
  panel.slot(0).id(1).at(100, 100).slot(3).id(2).at(200, 200).report();
  panel.slot(0).at(120, 130).report();
  panel.slot(3).id(-1).slot(0).at(140, 150).report();
  panel.id(-1).report();
  const Bytes all = panel.take();
  KernelPanel still;
  std::vector<TouchFrame> whole;
  {
    Reader reader(still);
    whole = reader.read(all);
  }
  ASSERT_EQ(whole.size(), 4U);
  for (std::size_t cut = sizeof(input_event); cut < all.size(); cut += sizeof(input_event)) {
    KernelPanel fresh;
    Reader reader(fresh);
    auto frames = reader.read(Bytes(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(cut)));
    for (const TouchFrame& frame : reader.read(Bytes(all.begin() + static_cast<std::ptrdiff_t>(cut), all.end())))
      frames.push_back(frame);
    ASSERT_EQ(frames.size(), whole.size()) << "cut at " << cut;
    for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(frames[i].contacts, whole[i].contacts) << "cut at " << cut;
  }
  KernelPanel fresh;
  Reader reader(fresh);
  for (std::size_t cut = 1; cut < all.size(); ++cut)
    if (cut % sizeof(input_event) != 0) {
      EXPECT_FALSE(reader.protocol.accept(std::span(all).first(cut), 0)) << cut << " bytes are no whole events";
    }
  EXPECT_FALSE(reader.protocol.newest()) << "and nothing of them counts";
}

TEST(Touch, LostEventsAreMadeUpForByAskingTheSlots) {
  KernelPanel panel;
  Reader reader(panel);
  panel.slot(0).id(1).at(100, 100).slot(1).id(2).at(200, 200).report();
  const auto before = reader.read()[0].contacts;
  // Lost: finger 2 is lifted, finger 3 comes, finger 1 moves. What comes up to the next report is of an unknown whole.
  panel.slot(1).id(-1).slot(2).id(3).at(300, 300).slot(0).at(110, 120).report();
  static_cast<void>(panel.take());
  const int asked = panel.asked;
  panel.say(EV_SYN, SYN_DROPPED, 0).say(EV_ABS, ABS_MT_POSITION_X, 999).report();
  panel.slot(2).at(310, 310).report();  // already in the answer, and read with the rest
  EXPECT_TRUE(reader.read().empty()) << "nothing is told of what is not known";
  panel.slot(0).at(115, 120);  // the true state, whatever was passed over
  static_cast<void>(panel.take());
  auto frames = reader.read();
  EXPECT_GE(panel.asked - asked, 4);
  ASSERT_EQ(frames.size(), 1U);
  ASSERT_EQ(frames[0].contacts.size(), 2U);
  EXPECT_EQ(frames[0].contacts[0].id, before[0].id) << "it stayed on the glass";
  EXPECT_EQ(frames[0].contacts[0].at, glm::dvec2(0.115, 0.24));
  EXPECT_EQ(frames[0].contacts[1].at, glm::dvec2(0.31, 0.62));
  EXPECT_TRUE(frames[0].cancelled) << "nobody saw how the other one went";
  panel.at(130, 140).report();  // without a slot: that of the answer
  frames = reader.read();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].contacts[0].at, glm::dvec2(0.13, 0.28));
}

TEST(Touch, ALossIsNotAskedAboutBeforeItsReportHasCome) {
  KernelPanel panel;
  Reader reader(panel);
  panel.slot(0).id(1).at(100, 100).report();
  EXPECT_EQ(reader.read().size(), 1U);
  const int asked = panel.asked;
  panel.say(EV_SYN, SYN_DROPPED, 0).at(200, 200);
  EXPECT_TRUE(reader.read().empty());
  EXPECT_TRUE(reader.read().empty());
  EXPECT_EQ(panel.asked, asked);
  panel.report();
  EXPECT_TRUE(reader.read().empty());
  const auto frames = reader.read();
  EXPECT_GT(panel.asked, asked);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].contacts[0].at, glm::dvec2(0.2, 0.4));
  EXPECT_FALSE(frames[0].cancelled);
}

TEST(Touch, PalmsDoNotCountAndAFingerThatBecomesOneIsNotLifted) {
  KernelPanel panel;
  Reader reader(panel);
  panel.slot(0).id(1).tool(MT_TOOL_PALM).at(100, 100).report();
  EXPECT_TRUE(reader.read().empty());
  panel.slot(1).id(2).tool(MT_TOOL_FINGER).at(200, 200).report();
  EXPECT_EQ(reader.read()[0].contacts.size(), 1U);
  panel.tool(MT_TOOL_PALM).report();
  const auto turned = reader.read();
  ASSERT_EQ(turned.size(), 1U);
  EXPECT_TRUE(turned[0].contacts.empty());
  EXPECT_TRUE(turned[0].cancelled);
  panel.tool(MT_TOOL_FINGER).at(210, 210).report();
  EXPECT_TRUE(reader.read().empty()) << "the palm's edge";
  panel.id(-1).report();
  panel.id(3).at(220, 220).report();
  EXPECT_EQ(reader.read().back().contacts.size(), 1U) << "the next finger in its slot";
}

TEST(Touch, MoreThanFiveAreABlobUntilTheGlassIsFree) {
  KernelPanel panel;
  Reader reader(panel);
  for (int i = 0; i < 5; ++i) panel.slot(i).id(10 + i).at(100 * i, 50);
  panel.report();
  EXPECT_EQ(reader.read()[0].contacts.size(), 5U);
  panel.slot(5).id(20).at(10, 10).report();
  const auto six = reader.read();
  ASSERT_EQ(six.size(), 1U);
  EXPECT_TRUE(six[0].contacts.empty());
  EXPECT_TRUE(six[0].cancelled);
  for (int i = 0; i < 5; ++i) panel.slot(i).id(-1).report();
  EXPECT_TRUE(reader.read().empty()) << "what is left of a blob is no finger";
  panel.slot(5).id(-1).report();
  panel.slot(0).id(30).at(1, 1).report();
  EXPECT_EQ(reader.read().back().contacts.size(), 1U);
}

TEST(Touch, FingersThatAreThereWhenItIsOpenedAreNobodys) {
  KernelPanel panel;
  panel.slot(2).id(5).at(100, 100);
  static_cast<void>(panel.take());
  Reader reader(panel);
  panel.at(120, 120).report();
  EXPECT_TRUE(reader.read().empty());
  panel.slot(0).id(6).at(300, 300).report();
  EXPECT_EQ(reader.read()[0].contacts.size(), 1U);
  panel.slot(2).id(-1).report();
  EXPECT_TRUE(reader.read().empty());
  panel.id(7).report();
  EXPECT_EQ(reader.read()[0].contacts.size(), 2U);
}

TEST(Touch, APanelThatIsTurnedTellsPlacesOfThePicture) {
  // Where the picture's upper right corner is touched, of panels whose own corner is turned clockwise.
  const std::map<int, std::array<int, 2>> corners{
      {0, {kWide, 0}}, {90, {0, 0}}, {180, {0, kHigh}}, {270, {kWide, kHigh}}};
  for (const auto& [turn, corner] : corners) {
    KernelPanel panel;
    Reader reader(panel, turn);
    panel.slot(0).id(1).at(corner[0], corner[1]).report();
    EXPECT_EQ(reader.read()[0].contacts[0].at, glm::dvec2(1.0, 0.0)) << turn;
  }
}

TEST(Touch, SlotsThatThePanelDoesNotHaveAndPlacesBesideItAreNoHarm) {
  KernelPanel panel(2);
  panel.tells_tools = false;
  Reader reader(panel);
  for (const int number : {-1, 2, 1000, INT32_MAX, INT32_MIN}) panel.slot(number).id(1).at(5, 5);
  panel.report();
  EXPECT_TRUE(reader.read().empty());
  panel.slot(1).id(4).at(-500, INT32_MAX).report();
  EXPECT_EQ(reader.read()[0].contacts[0].at, glm::dvec2(0.0, 1.0));
}

TEST(Touch, APanelWithoutARangeIsRefusedInOneSentence) {
  SimDevice device("flat");
  SimBehaviour behaviour;
  behaviour.on_get_feature = [](std::uint8_t code) -> Result<Bytes> {
    const std::array<int, 4> numbers{0, 0, 0, -1};
    Bytes out(code == ABS_MT_SLOT ? 13 : 17);
    out[0] = std::byte{code};
    std::memcpy(out.data() + 1, numbers.data(), out.size() - 1);
    return out;
  };
  device.set_behaviour(behaviour);
  TouchProtocol protocol;
  const auto transport = device.open().value();
  const auto started = protocol.start(*transport, 0);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().message, "touch: axes of 0 to 0 and 0 to 0 found, expected a range");
}

TEST(Touch, WhatNobodyTakesIsBoundedAndKeepsWhatWasCancelled) {
  KernelPanel panel;
  Reader reader(panel);
  panel.slot(0).id(1).at(1, 1).report().tool(MT_TOOL_PALM).report();
  for (int i = 0; i < 1000; ++i) panel.slot(1).id(2 + i).at(i % 100, 7).report();
  const auto frames = reader.read();
  ASSERT_EQ(frames.size(), TouchProtocol::kMostFrames);
  EXPECT_TRUE(frames.front().cancelled);
  EXPECT_EQ(frames.back().contacts[0].at.x, 0.099);
}

TEST(Touch, TheSimulatedPanelSaysOnlyWhatHasChangedAndIsHeardAsItWasTouched) {
  TouchPanelSim sim;
  const ManualClock clock(1'000'000'000);
  Driver<TouchProtocol> driver([&] { return sim.device().open(); }, TouchProtocol(), &clock);
  driver.poll(clock.now());
  ASSERT_TRUE(driver.connected()) << driver.reason();
  sim.touch(1, {{1, {0.25, 0.5}}, {2, {0.75, 0.5}}});
  auto sample = driver.poll(clock.now());
  ASSERT_TRUE(sample);
  ASSERT_EQ(sample->frames.back().contacts.size(), 2U);
  EXPECT_EQ(sample->frames.back().contacts[1].at, glm::dvec2(0.75, 0.5));
  sim.touch(2, {{1, {0.25, 0.5}}, {2, {0.75, 0.5}}});
  EXPECT_EQ(driver.counts().accepted, 1U);
  EXPECT_FALSE(driver.poll(clock.now()));
  EXPECT_EQ(driver.counts().accepted, 1U) << "nothing changed, nothing is said";
  sim.touch(3, {{2, {0.5, 0.25}}});
  sample = driver.poll(clock.now());
  ASSERT_TRUE(sample);
  ASSERT_EQ(sample->frames.back().contacts.size(), 1U);
  EXPECT_EQ(sample->frames.back().contacts[0].at, glm::dvec2(0.5, 0.25));
  sim.device().unplug();
  driver.poll(clock.now());
  EXPECT_FALSE(driver.connected());
}

}  // namespace
}  // namespace dubsar
