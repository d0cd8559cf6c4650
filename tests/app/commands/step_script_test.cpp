#include "app/commands/step_script.h"

#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {

TEST(Steps, LinesHaveATimeAndACommand) {
  const auto steps = parse_steps("# a film\n\n0 style relief\r\n1.5 side reverse\n  +0.25 note_text 1 a  b\n", "s");
  ASSERT_TRUE(steps) << steps.error().message;
  EXPECT_EQ(*steps,
            (std::vector<TimedCommand>{{0, "style relief"}, {1.5, "side reverse"}, {1.75, "note_text 1 a  b"}}));
  EXPECT_TRUE(check_steps(*steps, CommandTable::standard(kStyles), "s"));
  EXPECT_TRUE(parse_steps("", "s")->empty());
}

TEST(Steps, MistakesAreNamedWithTheirLine) {
  const auto refusal = [](std::string_view text) {
    const auto steps = parse_steps(text, "s.txt");
    if (!steps) return steps.error().message;
    const auto fits = check_steps(*steps, CommandTable::standard(kStyles), "s.txt");
    return fits ? std::string("accepted") : fits.error().message;
  };
  EXPECT_EQ(refusal("1 undo\nside reverse\n"),
            "s.txt: line 2: \"side reverse\" found, expected SECONDS COMMAND, not before 1 s");
  EXPECT_EQ(refusal("2 undo\n1 redo"), "s.txt: line 2: \"1 redo\" found, expected SECONDS COMMAND, not before 2 s");
  EXPECT_EQ(refusal("1"), "s.txt: line 1: \"1\" found, expected SECONDS COMMAND, not before 0 s");
  EXPECT_EQ(refusal("1x undo"), "s.txt: line 1: \"1x undo\" found, expected SECONDS COMMAND, not before 0 s");
  EXPECT_EQ(refusal("nan undo"), "s.txt: line 1: \"nan undo\" found, expected SECONDS COMMAND, not before 0 s");
  EXPECT_EQ(refusal("1e99 undo"), "s.txt: line 1: \"1e99 undo\" found, expected SECONDS COMMAND, not before 0 s");
  EXPECT_EQ(refusal("1 side inside"),
            "s.txt: at 1 s: side: \"inside\" found, expected one of: obverse, bottom, reverse, top, left, right");
}

}  // namespace
}  // namespace dubsar::app
