// Commands without a window: what each does to a document, and that all of it can be undone.

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {

double apart_deg(const glm::dquat& a, const glm::dquat& b) { return turn_between_deg(a, b); }

TEST(Commands, TwoHundredUndoAndRedoStepsThroughEveryCommandReturnTheSameDocument) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  Bench bench;
  std::vector<std::string> texts = ways_to_say(bench.commands);
  std::erase_if(texts, [](const std::string& text) { return text == "undo" || text == "redo"; });
  std::vector<Document> states{bench.now()};
  while (states.size() <= 200) {  // in rounds: of a draw that puts back, all of them take more steps than are kept
    std::shuffle(texts.begin(), texts.end(), random);
    for (const std::string& text : texts) {
      static_cast<void>(bench.commands.run(text, bench.editor));  // some cannot be done now
      if (bench.now() != states.back()) states.push_back(bench.now());
    }
  }
  ASSERT_GE(states.size(), 200u);
  const Document last = bench.now();
  for (std::size_t i = states.size() - 1; i-- > 0;) {
    bench.run("undo");
    ASSERT_EQ(bench.now(), states[i]) << "seed " << seed << " step " << i;
  }
  EXPECT_EQ(bench.refusal("undo"), "undo: there is nothing to do it to now");
  for (std::size_t i = 1; i < states.size(); ++i) {
    bench.run("redo");
    ASSERT_EQ(bench.now(), states[i]) << "seed " << seed << " step " << i;
  }
  EXPECT_EQ(bench.now(), last);
}

TEST(Commands, SidesAreThoseOfATabletThatIsTurnedAsScribesDo) {
  // Towards the viewer: which way a side's outside points before it is turned; and what is up on it then.
  struct Row {
    const char* name;
    glm::dvec3 outside, up;
  };
  const std::array<Row, 6> rows{{{"obverse", {0, 0, 1}, {0, 1, 0}},
                                 {"bottom", {0, -1, 0}, {0, 0, 1}},    // its text goes on where the obverse ends
                                 {"reverse", {0, 0, -1}, {0, -1, 0}},  // upside down to the obverse
                                 {"top", {0, 1, 0}, {0, 0, -1}},
                                 {"left", {-1, 0, 0}, {0, 1, 0}},
                                 {"right", {1, 0, 0}, {0, 1, 0}}}};
  for (const glm::dquat& home : {glm::dquat(1, 0, 0, 0), turn_of({0, 0, 1.5}), turn_of({0.4, -1.0, 2.0})}) {
    Bench bench;
    Document at_home = bench.now();
    at_home.home.rotation = home;
    bench.editor.change(at_home, "test");
    for (const Row& row : rows) {
      bench.run(std::string("side ") + row.name);
      const glm::dquat q = bench.now().now.rotation * glm::conjugate(home);
      EXPECT_NEAR(glm::length(q * row.outside - glm::dvec3(0, 0, 1)), 0, 1e-12) << row.name;
      EXPECT_NEAR(glm::length(q * row.up - glm::dvec3(0, 1, 0)), 0, 1e-12) << row.name;
      EXPECT_EQ(kSideNames[static_cast<std::size_t>(facing_side(bench.now().now.rotation, home))], row.name);
      EXPECT_EQ(bench.editor.transition(), Transition::kGlide);
    }
  }
}

// Of a tablet that stands on its head, on its side, or with its reverse before the viewer: each puts it right in one
// step that can be undone, and the sides count from there.
TEST(Commands, ATabletIsStoodUprightWhereTheWritingMisled) {
  struct Row {
    const char* way;
    glm::dvec3 up, front;  // of the home view as it was, that are seen up and towards the viewer then
  };
  const std::array<Row, 4> rows{{{"half", {0, -1, 0}, {0, 0, 1}},
                                 {"left", {1, 0, 0}, {0, 0, 1}},
                                 {"right", {-1, 0, 0}, {0, 0, 1}},
                                 {"over", {0, -1, 0}, {0, 0, -1}}}};
  for (const Row& row : rows) {
    Bench bench;
    const glm::dquat home = bench.now().home.rotation;
    bench.run("side left");
    bench.run(std::string("upright ") + row.way);
    for (const glm::dquat& seen : {bench.now().home.rotation, bench.now().now.rotation}) {
      const glm::dquat turn = seen * glm::conjugate(home);
      EXPECT_NEAR(glm::length(turn * row.up - glm::dvec3(0, 1, 0)), 0, 1e-12) << row.way;
      EXPECT_NEAR(glm::length(turn * row.front - glm::dvec3(0, 0, 1)), 0, 1e-12) << row.way;
    }
    bench.run("side reverse");
    bench.run("undo");
    bench.run("undo");
    EXPECT_LT(apart_deg(bench.now().home.rotation, home), 1e-9) << row.way;
  }
  EXPECT_EQ(Bench().refusal("upright sideways"),
            "upright: \"sideways\" found, expected one of: half, left, right, over");
}

TEST(Commands, WhatFacesTheViewerBecomesTheObverse) {
  Bench bench;
  bench.run("side reverse");
  bench.run("turn_left 8");
  bench.run("obverse_here");
  EXPECT_LT(apart_deg(bench.now().now.rotation, turn_to(Side::kReverse)), 1e-9) << "squared up";
  EXPECT_EQ(facing_side(bench.now().now.rotation, bench.now().home.rotation), Side::kObverse);
  bench.run("side reverse");
  EXPECT_LT(apart_deg(bench.now().now.rotation, {1, 0, 0, 0}), 1e-9);
}

TEST(Commands, KeysStepAndResetGoesHomeWithItsLight) {
  Bench bench;
  for (int i = 0; i < 120; ++i) bench.run("turn_left");
  EXPECT_LT(apart_deg(bench.now().now.rotation, turn_of({0, -600 * 3.14159265358979 / 180, 0})), 1e-6);
  EXPECT_EQ(bench.editor.history().undo_depth(), 120u);
  bench.run("light_from left");
  EXPECT_EQ(bench.now().light, (LightPlace{270, 15}));
  for (int i = 0; i < 40; ++i) bench.run("zoom_in");
  EXPECT_DOUBLE_EQ(bench.now().now.zoom, 20.0);
  bench.run("reset");
  EXPECT_EQ(bench.now().now, bench.now().home);
  EXPECT_EQ(bench.now().light, bench.now().home_light);
  bench.run("undo");
  EXPECT_DOUBLE_EQ(bench.now().now.zoom, 20.0);
}

TEST(Commands, PartsAndTheEnvelope) {
  Bench bench;
  bench.run("part envelope");
  EXPECT_EQ(visible_partitions(bench.now()), 1);
  bench.run("part 1");
  EXPECT_EQ(visible_partitions(bench.now()), 0);
  bench.run("all_parts");
  EXPECT_EQ(visible_partitions(bench.now()), 7);
  bench.run("unpack 37.5");
  EXPECT_EQ(bench.now().unpack, 0.375);
  for (int i = 0; i < 30; ++i) bench.run("unpack_more");
  EXPECT_EQ(bench.now().unpack, 1.0);
  for (int i = 0; i < 30; ++i) bench.run("unpack_less");
  EXPECT_EQ(bench.now().unpack, 0.0) << "exactly back";
  EXPECT_NE(bench.refusal("part seal").find("expected a name or 1 to 2"), std::string::npos);
  FakePlace place;
  Document one;
  one.parts = {{"object", 1}};
  Editor alone(one, place);
  EXPECT_FALSE(bench.commands.run("part 1", alone));
  EXPECT_FALSE(bench.commands.run("unpack 50", alone));
}

TEST(Commands, MistakesAreSentencesWithWhatWasExpected) {
  Bench bench;
  EXPECT_EQ(bench.refusal("side backside"),
            "side: \"backside\" found, expected one of: obverse, bottom, reverse, top, left, right");
  EXPECT_EQ(bench.refusal("side"), "side: nothing found after it, expected a side");
  EXPECT_EQ(bench.refusal("reset now"), "reset: \"now\" found after it, expected nothing");
  EXPECT_NE(bench.refusal("dance").find("\"dance\" is no command, expected one of: help, "), std::string::npos);
  EXPECT_EQ(bench.refusal("turn_left 1x"), "turn_left: \"1x\" found, expected a number of 0 to 360");
  EXPECT_EQ(bench.refusal("turn_left nan"), "turn_left: \"nan\" found, expected a number of 0 to 360");
  EXPECT_EQ(bench.refusal("unpack 101"), "unpack: \"101\" found, expected a number of 0 to 100");
  EXPECT_EQ(bench.refusal("light 315"), "light: \"\" found, expected a number of 5 to 90");
  EXPECT_EQ(bench.editor.history().undo_depth(), 0u);
}

TEST(Commands, EveryNameIsSaidOnceAndEveryKeyDoesOneThingAtATime) {
  const CommandTable commands = CommandTable::standard(kStyles);
  std::set<std::string> names, keys;
  for (const Command& command : commands.all()) {
    EXPECT_TRUE(names.insert(command.name).second) << command.name;
    EXPECT_FALSE(command.words.empty()) << command.name;
    EXPECT_FALSE(command.group.empty()) << command.name;
    if (command.name == "toggle_source") continue;  // only while the help is open
    for (const DefaultKey& key : command.keys) EXPECT_TRUE(keys.insert(key.key).second) << key.key;
  }
}

InputEvent key(const std::string& name, std::uint8_t modifiers = 0) {
  return {0, EventKind::kKey, {}, {}, true, modifiers, name};
}

TEST(Keys, ChordsNameWhatIsHeld) {
  EXPECT_EQ(key_chord(key("left")), "left");
  EXPECT_EQ(key_chord(key("left", kShift)), "shift+left");
  EXPECT_EQ(key_chord(key("u", kShift)), "shift+u");
  EXPECT_EQ(key_chord(key("?", kShift)), "?") << "shift shows in what is typed";
  EXPECT_EQ(key_chord(key("z", kControl)), "ctrl+z");
  EXPECT_EQ(key_chord(key("z", kControl | kShift)), "ctrl+shift+z");
  EXPECT_EQ(key_chord(key("1", kAlt)), "alt+1");
}

TEST(Keys, AMappingMovesAndRemovesThem) {
  Bench bench;
  const KeyTable plain = KeyTable::create(bench.commands).value();
  EXPECT_EQ(plain.command_for("home", bench.editor), "reset");
  EXPECT_EQ(plain.command_for("3", bench.editor), "side reverse");
  EXPECT_EQ(plain.command_for("q", bench.editor), "");
  EXPECT_EQ(plain.command_for("ctrl+z", bench.editor), "") << "there is nothing to undo";
  EXPECT_EQ(plain.keys_for("help"), (std::vector<std::string>{"f1", "?"}));
  bench.editor.ui().help = true;
  EXPECT_EQ(plain.command_for("3", bench.editor), "toggle_source 3");
  bench.editor.ui().help = false;
  const KeyTable changed =
      KeyTable::create(bench.commands, {{"home", "none"}, {"q", "side reverse"}, {"f1", "next_display"}}).value();
  EXPECT_EQ(changed.command_for("home", bench.editor), "");
  EXPECT_EQ(changed.command_for("q", bench.editor), "side reverse");
  EXPECT_EQ(changed.command_for("f1", bench.editor), "next_display");
  EXPECT_EQ(changed.keys_for("help"), (std::vector<std::string>{"?"}));
  EXPECT_EQ(changed.keys_for("side reverse"), (std::vector<std::string>{"q", "3"}));
  const auto wrong = KeyTable::create(bench.commands, {{"x", "rotate"}});
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().kind, ErrorKind::kConfig);
  EXPECT_NE(wrong.error().message.find("mapping: keys: x is \"rotate\": \"rotate\" is no command"), std::string::npos)
      << wrong.error().message;
}

TEST(Commands, WindowCommandsReachThePlaceAndChangeNoDocument) {
  Bench bench;
  for (const char* text : {"next_display", "next_display", "previous_display", "retry_sources", "recentre",
                           "fullscreen", "help", "toggle_source 2", "close"})
    bench.run(text);
  EXPECT_EQ(bench.place.display, 1);
  EXPECT_EQ(bench.place.retries, 1);
  EXPECT_EQ(bench.place.recentred, 1);
  EXPECT_TRUE(bench.place.fullscreen);
  EXPECT_EQ(bench.place.toggled, (std::vector<std::size_t>{1}));
  EXPECT_FALSE(bench.place.ended) << "escape closed the help";
  EXPECT_FALSE(bench.editor.ui().help);
  bench.run("close");
  EXPECT_TRUE(bench.place.ended);
  EXPECT_EQ(bench.editor.history().undo_depth(), 0u);
}

/// The sample action: all that a new one needs, besides its row "command.stand_on_end" in app/words/en.json.
Command stand_on_end() {
  Command out{"stand_on_end", "group.view", {{"ctrl+e"}}};
  out.words = "command.upright";  // the table of the program has no row for it
  out.run = [why = out.name](Editor& editor, const std::string&) -> Result<void> {
    Document next = editor.document();
    next.now.rotation = turn_of({0, 0, 1.5707963267948966}) * next.home.rotation;
    editor.change(std::move(next), why, Transition::kGlide);
    return {};
  };
  return out;
}

TEST(Commands, ANewActionIsOneCommand) {
  Bench bench;
  bench.commands.add(stand_on_end());
  bench.run("stand_on_end");  // scripts
  EXPECT_LT(apart_deg(bench.now().now.rotation, turn_of({0, 0, 1.5707963267948966})), 1e-9);
  EXPECT_EQ(bench.editor.history().undo_words(), "stand_on_end");
  bench.run("undo");
  EXPECT_EQ(bench.now(), two_parts());
  const KeyTable keys = KeyTable::create(bench.commands, {{"x", "stand_on_end"}}).value();  // mapping files
  EXPECT_EQ(keys.keys_for("stand_on_end"), (std::vector<std::string>{"x", "ctrl+e"}));      // the help
  EXPECT_EQ(keys.command_for(key_chord(key("e", kControl)), bench.editor), "stand_on_end");
}

}  // namespace
}  // namespace dubsar::app
