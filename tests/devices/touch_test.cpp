// Contacts of touch panels. The events are the kernel's own struct and numbers, in the order that
// Documentation/input/multi-touch-protocol.rst tells; nothing here is made by the code that reads it.

#include <gtest/gtest.h>
#include <linux/input.h>

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "devices/driver.h"
#include "devices/touch/simulated_touch.h"
#include "devices/touch/touch_protocol.h"

namespace dubsar {
namespace {

using Bytes = std::vector<std::byte>;
constexpr int kWide = 1000, kHigh = 500;  // the axes of the panel: 0 to these

Bytes bytes_of(const input_event& event) {
  Bytes out(sizeof event);
  std::memcpy(out.data(), &event, sizeof event);
  return out;
}

/// What a kernel driver would say, event by event, and what its ioctls would answer.
class Panel {
 public:
  explicit Panel(int slots = 10)
      : slots_(slots),
        id_(std::size_t(slots), -1),
        x_(std::size_t(slots)),
        y_(std::size_t(slots)),
        tool_(std::size_t(slots)) {
    SimBehaviour behaviour;
    behaviour.on_get_feature = [this](std::uint8_t code) -> Result<Bytes> { return answer(code); };
    device.set_behaviour(std::move(behaviour));
  }
  Bytes event(int type, int code, int value) {
    input_event out{};
    out.input_event_sec = 100 + ms_ / 1000;
    out.input_event_usec = ms_ % 1000 * 1000;
    out.type = static_cast<__u16>(type);
    out.code = static_cast<__u16>(code);
    out.value = value;
    return bytes_of(out);
  }
  Panel& say(int type, int code, int value) {
    const Bytes bytes = event(type, code, value);
    said.insert(said.end(), bytes.begin(), bytes.end());
    if (type == EV_ABS) remember(code, value);
    return *this;
  }
  Panel& slot(int number) { return say(EV_ABS, ABS_MT_SLOT, number); }
  Panel& id(int number) { return say(EV_ABS, ABS_MT_TRACKING_ID, number); }
  Panel& at(int x, int y) { return say(EV_ABS, ABS_MT_POSITION_X, x).say(EV_ABS, ABS_MT_POSITION_Y, y); }
  Panel& tool(int number) { return say(EV_ABS, ABS_MT_TOOL_TYPE, number); }
  Panel& report() {
    say(EV_SYN, SYN_REPORT, 0);
    ms_ += 8;
    return *this;
  }
  Bytes take() { return std::exchange(said, {}); }

  SimDevice device{"panel"};
  Bytes said;
  int asked = 0;
  bool tells_tools = true;

 private:
  void remember(int code, int value) {
    if (code == ABS_MT_SLOT) current_ = value;
    if (current_ < 0 || current_ >= slots_) return;
    const auto s = static_cast<std::size_t>(current_);
    if (code == ABS_MT_TRACKING_ID) id_[s] = value;
    if (code == ABS_MT_POSITION_X) x_[s] = value;
    if (code == ABS_MT_POSITION_Y) y_[s] = value;
    if (code == ABS_MT_TOOL_TYPE) tool_[s] = value;
  }
  Result<Bytes> answer(std::uint8_t code) {
    ++asked;
    std::vector<int> numbers{0, 0, 0};
    const auto with = [&](int high, const std::vector<int>& values) {
      numbers[2] = high;
      numbers.insert(numbers.end(), values.begin(), values.end());
    };
    if (code == ABS_MT_SLOT) numbers = {current_, 0, slots_ - 1};
    if (code == ABS_MT_TRACKING_ID) with(65535, id_);
    if (code == ABS_MT_POSITION_X) with(kWide, x_);
    if (code == ABS_MT_POSITION_Y) with(kHigh, y_);
    if (code == ABS_MT_TOOL_TYPE && !tells_tools) return fail(ErrorKind::kBadData, "none");
    if (code == ABS_MT_TOOL_TYPE) with(15, tool_);
    Bytes out(1 + 4 * numbers.size());
    out[0] = std::byte{code};
    std::memcpy(out.data() + 1, numbers.data(), 4 * numbers.size());
    return out;
  }
  int slots_, current_ = 0;
  std::vector<int> id_, x_, y_, tool_;
  int ms_ = 0;
};

/// The protocol, opened on a panel.
struct Reader {
  explicit Reader(Panel& of, int turn_deg = 0) : panel(of), protocol(turn_deg) {
    transport = panel.device.open().value();
    const auto started = protocol.start(*transport, now);
    EXPECT_TRUE(started) << started.error().message;
  }
  /// What the panel has said since the last time, as one read.
  std::vector<TouchFrame> read() { return read(panel.take()); }
  std::vector<TouchFrame> read(const Bytes& bytes) {
    now += 8'000'000;
    EXPECT_TRUE(protocol.keep_up(*transport, now));
    EXPECT_TRUE(bytes.empty() || protocol.accept(bytes, now));
    auto sample = protocol.newest();
    return sample ? std::move(sample->frames) : std::vector<TouchFrame>{};
  }
  Panel& panel;
  TouchProtocol protocol;
  std::unique_ptr<Transport> transport;
  TimestampNs now = 1'000'000'000;
};

// The example of the kernel's documentation: two contacts, the first moves, is lifted, then the second is.
TEST(Touch, TheExampleOfTheKernelsDocumentation) {
  Panel panel;
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
  Panel panel;
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
  Panel panel;
  Reader reader(panel);
  panel.slot(0).id(0).at(1, 1).report();
  EXPECT_EQ(reader.read()[0].contacts.size(), 1U) << "0 is a finger";
  panel.id(-7).report();
  EXPECT_TRUE(reader.read()[0].contacts.empty());
}

TEST(Touch, ReportsMayBeReadInAnyPieces) {
  Panel panel;
  panel.slot(0).id(1).at(100, 100).slot(3).id(2).at(200, 200).report();
  panel.slot(0).at(120, 130).report();
  panel.slot(3).id(-1).slot(0).at(140, 150).report();
  panel.id(-1).report();
  const Bytes all = panel.take();
  Panel still;
  std::vector<TouchFrame> whole;
  {
    Reader reader(still);
    whole = reader.read(all);
  }
  ASSERT_EQ(whole.size(), 4U);
  for (std::size_t cut = sizeof(input_event); cut < all.size(); cut += sizeof(input_event)) {
    Panel fresh;
    Reader reader(fresh);
    auto frames = reader.read(Bytes(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(cut)));
    for (const TouchFrame& frame : reader.read(Bytes(all.begin() + static_cast<std::ptrdiff_t>(cut), all.end())))
      frames.push_back(frame);
    ASSERT_EQ(frames.size(), whole.size()) << "cut at " << cut;
    for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(frames[i].contacts, whole[i].contacts) << "cut at " << cut;
  }
  Panel fresh;
  Reader reader(fresh);
  for (std::size_t cut = 1; cut < all.size(); ++cut)
    if (cut % sizeof(input_event) != 0) {
      EXPECT_FALSE(reader.protocol.accept(std::span(all).first(cut), 0)) << cut << " bytes are no whole events";
    }
  EXPECT_FALSE(reader.protocol.newest()) << "and nothing of them counts";
}

TEST(Touch, LostEventsAreMadeUpForByAskingTheSlots) {
  Panel panel;
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
  Panel panel;
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
  Panel panel;
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
  Panel panel;
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
  Panel panel;
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
    Panel panel;
    Reader reader(panel, turn);
    panel.slot(0).id(1).at(corner[0], corner[1]).report();
    EXPECT_EQ(reader.read()[0].contacts[0].at, glm::dvec2(1.0, 0.0)) << turn;
  }
}

TEST(Touch, SlotsThatThePanelDoesNotHaveAndPlacesBesideItAreNoHarm) {
  Panel panel(2);
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

/// Random fingers by a driver of one's own against what is told of them.
TEST(Touch, TenThousandRandomReportsAreToldAsTheyWere) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  Panel panel;
  Reader reader(panel);
  std::map<int, glm::ivec3> truth;  // by slot: tracking id, x, y
  int next_id = 0, losses = 0;
  for (int step = 0; step < 10'000; ++step) {
    bool lost = below(100) == 0;
    for (int change = below(4); change >= 0; --change) {
      const int s = below(5);  // so that they are never a blob
      if (truth.count(s) != 0 && below(3) == 0) {
        truth.erase(s);
        panel.slot(s).id(-1);
        continue;
      }
      if (truth.count(s) == 0) {
        truth[s] = {next_id, below(kWide + 1), below(kHigh + 1)};
        panel.slot(s).id(next_id).at(truth[s].y, truth[s].z);
        next_id = (next_id + 1) % 65536;
      } else {
        truth[s] = {truth[s].x, below(kWide + 1), below(kHigh + 1)};
        panel.slot(s).at(truth[s].y, truth[s].z);
      }
    }
    panel.report();
    if (lost) {
      static_cast<void>(panel.take());
      panel.say(EV_SYN, SYN_DROPPED, 0).report();
      EXPECT_TRUE(reader.read().empty());
      ++losses;
    }
    const auto frames = reader.read();
    if (frames.empty()) continue;
    std::vector<glm::dvec2> told, was;
    for (const TouchContact& contact : frames.back().contacts) told.push_back(contact.at);
    for (const auto& [s, finger] : truth)
      was.emplace_back(static_cast<double>(finger.y) / kWide, static_cast<double>(finger.z) / kHigh);
    const auto order = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
    std::sort(told.begin(), told.end(), order);
    std::sort(was.begin(), was.end(), order);
    ASSERT_EQ(told, was) << "seed " << seed << ", step " << step;
  }
  EXPECT_GT(losses, 20);
}

TEST(Touch, RandomBytesAndEventsNeverGiveMoreThanFiveFingersNorPlacesBesideThePanel) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  Panel panel;
  Reader reader(panel);
  const std::array<int, 8> codes{
      ABS_MT_SLOT, ABS_MT_TRACKING_ID, ABS_MT_POSITION_X, ABS_MT_POSITION_Y, ABS_MT_TOOL_TYPE, ABS_X, ABS_MT_PRESSURE,
      0xffff};
  std::int64_t accepted = 0, frames = 0;
  for (int round = 0; round < 200'000; ++round) {
    Bytes bytes;
    if (round % 4 == 0) {
      bytes.resize(random() % 100);
      for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    } else {
      for (auto n = 1 + random() % 6; n > 0; --n) {
        const auto kind = random() % 16;
        const int value = random() % 8 == 0 ? static_cast<int>(random()) : static_cast<int>(random() % 12) - 1;
        const Bytes event = kind == 0   ? panel.event(EV_SYN, SYN_DROPPED, 0)
                            : kind < 4  ? panel.event(EV_SYN, SYN_REPORT, 0)
                            : kind == 4 ? panel.event(static_cast<int>(random()), static_cast<int>(random()), value)
                                        : panel.event(EV_ABS, codes[random() % codes.size()], value);
        bytes.insert(bytes.end(), event.begin(), event.end());
      }
    }
    accepted += reader.protocol.accept(bytes, round);
    ASSERT_TRUE(reader.protocol.keep_up(*reader.transport, round));
    const auto sample = reader.protocol.newest();
    if (!sample) continue;
    ASSERT_FALSE(sample->frames.empty());
    for (const TouchFrame& frame : sample->frames) {
      ++frames;
      ASSERT_LE(frame.contacts.size(), kMostTouches) << "seed " << seed;
      for (std::size_t i = 0; i < frame.contacts.size(); ++i) {
        const glm::dvec2& at = frame.contacts[i].at;
        ASSERT_TRUE(at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1) << "seed " << seed;
        ASSERT_TRUE(i == 0 || frame.contacts[i].id > frame.contacts[i - 1].id) << "seed " << seed;
      }
    }
  }
  EXPECT_GT(accepted, 140'000);
  EXPECT_GT(frames, 1000);
}

TEST(Touch, WhatNobodyTakesIsBoundedAndKeepsWhatWasCancelled) {
  Panel panel;
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
