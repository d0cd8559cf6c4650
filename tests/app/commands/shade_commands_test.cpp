// Commands for shades, parts, the box of cuts, and what follows the pointer.

#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {

TEST(ShadeCommands, BlendsKeepTheirStyleAndShare) {
  Bench bench;
  bench.run("blend phong 40");
  EXPECT_EQ(bench.editor.document().style.other, "phong");
  EXPECT_DOUBLE_EQ(bench.editor.document().style.share, 0.4);
  bench.run("blend sky-sun 0");
  EXPECT_EQ(bench.editor.document().style.other, "");
  for (const char* wrong : {"blend", "blend phong", "blend dance 40", "blend phong 140"})
    EXPECT_FALSE(bench.commands.run(wrong, bench.editor)) << wrong;
  EXPECT_TRUE(bench.editor.undo());
  EXPECT_EQ(bench.editor.document().style.other, "phong") << "undone as everything is";
}

TEST(ShadeCommands, RadianceAndColoursGoOnWithoutAnArgument) {
  Bench bench;
  bench.run("radiance 150");
  EXPECT_DOUBLE_EQ(bench.editor.document().style.radiance, 1.5);
  bench.run("radiance");
  EXPECT_EQ(bench.editor.document().style.radiance, 0.0);
  bench.run("radiance");
  EXPECT_EQ(bench.editor.document().style.radiance, 1.0);
  for (const char* name : {"blue-orange", "cividis", "grey", "designed"}) {
    bench.run("colours");
    EXPECT_EQ(bench.editor.document().style.colours, name);
  }
  bench.run("legend");
  EXPECT_FALSE(bench.editor.ui().legend);
}

TEST(Hatch, IsSepiaUnlessBlueIsAskedFor) {
  Bench bench;
  EXPECT_EQ(bench.editor.document().style.hatch, "");
  for (const char* name : {"blue", "sepia", "blue"}) {
    bench.run("hatch");
    EXPECT_EQ(bench.editor.document().style.hatch, name);
  }
  bench.run("hatch sepia");
  EXPECT_EQ(bench.editor.document().style.hatch, "sepia");
  EXPECT_FALSE(bench.commands.run("hatch green", bench.editor));
}

TEST(BackFaces, GoThroughThreeWays) {
  Bench bench;
  for (const char* name : {"tint", "hide", "show"}) {
    bench.run("back_faces");
    EXPECT_EQ(bench.editor.document().style.back_faces, name);
  }
  EXPECT_FALSE(bench.commands.run("back_faces maybe", bench.editor));
}

TEST(CutBox, TakesTheSameOrSixSharesOfTheReach) {
  Bench bench;  // from -20 to 10 mm in every direction
  bench.run("cut_box 10");
  ASSERT_EQ(bench.editor.document().clips.size(), 6u);
  for (const Cut& cut : bench.editor.document().clips) EXPECT_DOUBLE_EQ(cut.distance_mm, 7.0);
  bench.run("cut_box 0,20,0,0,0,50");
  ASSERT_EQ(bench.editor.document().clips.size(), 2u);
  EXPECT_EQ(bench.editor.document().clips[0].normal, glm::dvec3(1, 0, 0));
  EXPECT_DOUBLE_EQ(bench.editor.document().clips[0].distance_mm, 4.0);
  EXPECT_DOUBLE_EQ(bench.editor.document().clips[1].distance_mm, -5.0);
  bench.run("cut_box 0");
  EXPECT_TRUE(bench.editor.document().clips.empty());
  for (const char* wrong : {"cut_box 50", "cut_box 1,2,3", "cut_box 1,2,3,4,5,6,7", "cut_box a"})
    EXPECT_FALSE(bench.commands.run(wrong, bench.editor)) << wrong;
  bench.run("section");
  EXPECT_FALSE(bench.editor.document().style.section);
}

TEST(CutBox, ASideThatIsCutNoMoreTakesItsOwnCutAwayAndNoOther) {
  Bench bench;
  bench.run("cut left 30");
  bench.run("cut front 20");
  bench.run("cut left 0");
  ASSERT_EQ(bench.editor.document().clips.size(), 1u);
  EXPECT_EQ(bench.editor.document().clips[0].normal, glm::dvec3(0, 0, 1));
  bench.run("cut left 0");
  EXPECT_EQ(bench.editor.document().clips.size(), 1u) << "there was none";
}

TEST(CutBox, ItsHandlesComeAndGoAndEscapeTakesThemAway) {
  Bench bench;
  bench.run("cut_handles");
  EXPECT_TRUE(bench.editor.ui().pointing.cut_box);
  bench.run("cut_handles");
  EXPECT_FALSE(bench.editor.ui().pointing.cut_box);
  bench.run("cut_handles");
  bench.run("close");
  EXPECT_FALSE(bench.editor.ui().pointing.cut_box);
  EXPECT_EQ(bench.editor.history().undo_depth(), 0u) << "nothing of the document";
}

TEST(PointerCommands, AreOfTheDeskAndAreNotUndone) {
  Bench bench;
  bench.run("magnify");
  EXPECT_EQ(bench.editor.ui().pointing.magnify, 3.0);
  bench.run("magnify 8");
  bench.run("cursor");
  bench.run("pointer -0.25,0.125");
  EXPECT_EQ(bench.editor.ui().pointing.magnify, 8.0);
  EXPECT_TRUE(bench.editor.ui().pointing.cursor);
  EXPECT_EQ(bench.editor.ui().pointing.at, glm::dvec2(-0.25, 0.125));
  bench.run("sweep 30");
  EXPECT_EQ(bench.editor.ui().sweep, (LightSweep{30.0, 8.0}));
  bench.run("sweep");
  EXPECT_FALSE(bench.editor.ui().sweep);
  EXPECT_FALSE(bench.editor.undo());
  for (const char* wrong : {"magnify 9", "pointer 1", "sweep 2", "sweep 20 1"})
    EXPECT_FALSE(bench.commands.run(wrong, bench.editor)) << wrong;
}

}  // namespace
}  // namespace dubsar::app
