#include "input/simulated/script.h"

#include <gtest/gtest.h>

#include "input/simulated/scripted_source.h"

namespace dubsar {
namespace {

constexpr std::string_view kExample = R"({
  "seed": 3, "duration_s": 4, "rate_hz": 50, "latency_ms": 40,
  "hands": [{"chirality": "left", "keys": [{"t": 1, "at_mm": [0, 0, 200]}, {"t": 2, "at_mm": [100, 0, 200], "grab": 1}, {"t": 3}]}],
  "heads": [{"ipd_mm": 60, "keys": [{"t": 0, "at_mm": [0, 0, 600]}, {"t": 4, "at_mm": [200, 0, 600]}]}],
  "events": [{"t": 2, "key": "home"}, {"t": 1, "move_px": [3, 4], "ctrl": true}]
})";

TEST(Script, PlaysKeysAsSmoothSteps) {
  const Script script = parse_script(kExample, "x").value();
  EXPECT_FALSE(sample_hand(script.hands[0], 0.99));
  EXPECT_FALSE(sample_hand(script.hands[0], 3.01));
  EXPECT_DOUBLE_EQ(sample_hand(script.hands[0], 1.5)->palm.position_m.x, 0.05);
  EXPECT_DOUBLE_EQ(sample_hand(script.hands[0], 1.25)->palm.position_m.x, 0.1 * 0.15625);
  EXPECT_DOUBLE_EQ(sample_hand(script.hands[0], 2.5)->palm.position_m.x, 0.1);  // keys keep what they do not say
  EXPECT_DOUBLE_EQ(sample_hand(script.hands[0], 2.5)->grab_strength, 1.0);
  EXPECT_DOUBLE_EQ(sample_head(script.heads[0], 2.0)->x, 0.1);
  EXPECT_EQ(script.events[0].kind, EventKind::kMotion);  // sorted
}

TEST(Script, IsSeenLateAndAtItsOwnRate) {
  const auto source = play_script(parse_script(kExample, "x").value(), nullptr).value();
  InputFrame frame;
  int fresh = 0;
  for (TimestampNs now = 1000; now <= 1'000'001'000; now += 1'000'000) {
    const Freshness state = source->poll(now, frame);
    if (state != Freshness::kNew) continue;
    ++fresh;
    EXPECT_GE(now - frame.time, 40'000'000);
    EXPECT_LT(now - frame.time, 41'000'001);
  }
  EXPECT_EQ(fresh, 49);  // 0 to 0.96 s at 50 Hz
  EXPECT_FALSE(source->finished());
  (void)source->poll(4'000'002'000, frame);
  EXPECT_TRUE(source->finished());
}

TEST(Script, DropoutsTakeHandsAwayForAShareOfTheTimeAndBringThemBackUnderANewId) {
  Script script;
  script.duration_s = 200;
  script.hand_dropouts = {1.0, 0.1, 0.3};  // on average 0.2 s missing after 1 s seen
  script.hands = {{Chirality::kRight, {0.2, -0.2, 0.75}, {{0, {0, 0, 0.2}}, {200, {0, 0, 0.2}}}}};
  const auto source = play_script(script, nullptr).value();
  InputFrame frame;
  int missing = 0, total = 0;
  std::uint32_t last_id = 0, changes = 0;
  for (TimestampNs now = 0; now < 200'000'000'000; now += 10'000'000) {
    (void)source->poll(now, frame);
    ++total;
    missing += frame.hands.empty();
    if (!frame.hands.empty() && frame.hands[0].id != last_id) {
      ++changes;
      last_id = frame.hands[0].id;
    }
  }
  EXPECT_NEAR(static_cast<double>(missing) / total, 0.2 / 1.2, 0.03);
  EXPECT_NEAR(changes, 200 / 1.2, 40);
}

TEST(Script, RefusesByNameAndRange) {
  const auto refused = [](std::string_view text) {
    const auto script = parse_script(text, "s.json");
    return script ? std::string("accepted") : script.error().message;
  };
  EXPECT_EQ(refused(R"({"rate_hz": 0})"), "s.json: rate_hz is 0, expected 1 to 1000");
  EXPECT_NE(refused(R"({"sed": 1})").find("\"sed\" is unknown, expected one of"), std::string::npos);
  EXPECT_EQ(refused(R"({"hands": [{"keys": [{"t": 2}, {"t": 1}]}]})"), "s.json: hand 0: key 1: t does not rise");
  EXPECT_NE(refused(R"({"hands": [{"keys": [{"t": 2}]}]})").find("fewer than 2"), std::string::npos);
  EXPECT_NE(refused(R"({"hands": [{"chirality": "middle", "keys": []}]})").find("chirality"), std::string::npos);
  EXPECT_NE(refused(R"({"hands": [{"keys": [{"t": 1, "at_mm": [1, 2]}]}]})").find("at_mm"), std::string::npos);
  EXPECT_NE(refused(R"({"events": [{"t": 1}]})").find("exactly one"), std::string::npos);
  EXPECT_NE(refused(R"({"events": [{"t": 1, "key": "a", "wheel": 1}]})").find("exactly one"), std::string::npos);
  EXPECT_NE(refused(R"({"visitor": {"zoom": 100}})").find("zoom is 100"), std::string::npos);
  EXPECT_NE(refused(R"({"hand_dropouts": {"shortest_ms": 90, "longest_ms": 20}})").find("below"), std::string::npos);
  for (const std::string field : {"hands", "heads", "events", "visitor", "hand_dropouts", "seed", "bystanders"})
    for (const std::string value : {"\"x\"", "[5]", "null"})
      EXPECT_NE(refused("{\"" + field + "\": " + value + "}"), "accepted") << field << value;
  for (std::size_t n = 0; n < kExample.size(); ++n) EXPECT_NE(refused(kExample.substr(0, n)), "accepted") << n;
}

}  // namespace
}  // namespace dubsar
