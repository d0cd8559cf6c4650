// Two documents become one, and nothing that somebody made is missing.

#include "app/document/join.h"

#include <gtest/gtest.h>

#include <set>

#include "app/document/document_file.h"

namespace dubsar::app {
namespace {

Note note(const std::string& id, const std::string& text) {
  Note out;
  out.id = id;
  out.text = text;
  return out;
}

std::multiset<std::string> texts(const Document& document) {
  std::multiset<std::string> out;
  for (const Note& each : document.notes) out.insert(each.text);
  return out;
}

using Texts = std::multiset<std::string>;

// All of: a note before, of ours and of theirs, which each may be missing, as it was, or changed.
TEST(Join, EveryFateOfANoteOnTwoSidesIsThatOfThreeWayMerging) {
  const std::vector<std::string> forms{"", "old", "mine", "theirs"};
  for (const std::string& before : {std::string(), std::string("old")})
    for (const std::string& mine : forms)
      for (const std::string& theirs : forms) {
        Document b, m, t;
        if (!before.empty()) b.notes = {note("1", before)};
        if (!mine.empty()) m.notes = {note("1", mine)};
        if (!theirs.empty()) t.notes = {note("1", theirs)};
        Texts expected;
        if (mine == theirs) {
          if (!mine.empty()) expected = {mine};
        } else if (mine == before) {
          if (!theirs.empty()) expected = {theirs};
        } else if (theirs == before) {
          if (!mine.empty()) expected = {mine};
        } else {  // both changed it, or one and the other took it away: nothing that was written is missing
          if (!mine.empty()) expected.insert(mine);
          if (!theirs.empty()) expected.insert(theirs);
        }
        EXPECT_EQ(texts(join(&b, m, t)), expected) << before << "|" << mine << "|" << theirs;
        Texts without;  // nobody knows what was before
        for (const std::string& text : std::set<std::string>{mine, theirs})
          if (!text.empty()) without.insert(text);
        EXPECT_EQ(texts(join(nullptr, m, t)), without) << mine << "|" << theirs;
        EXPECT_EQ(texts(join(nullptr, join(nullptr, m, t), t)), without) << "the second time nothing comes";
        EXPECT_EQ(texts(join(nullptr, t, join(nullptr, m, t))), without) << "nor on the other side";
      }
}

TEST(Join, LooksAreThoseOfTheSideThatChangedThemAndTheViewIsMine) {
  Document base;
  base.style.name = "relief";
  Document mine = base, theirs = base;
  mine.fog = 0.5;
  mine.now.zoom = 2;
  theirs.style.name = "raking";
  theirs.fog = 0.25;
  theirs.now.zoom = 3;
  theirs.unpack = 1;
  const Document out = join(&base, mine, theirs);
  EXPECT_EQ(out.style.name, "raking");
  EXPECT_EQ(out.unpack, 1);
  EXPECT_EQ(out.fog, 0.5) << "both: mine";
  EXPECT_EQ(out.now.zoom, 2);
  EXPECT_EQ(join(nullptr, mine, theirs), mine) << "without a base they are mine";
}

TEST(Join, FilmsThatBothMadeFollowEachOtherInRisingTimes) {
  const auto film = [](std::initializer_list<double> zooms) {
    std::vector<Keyframe> out;
    for (const double zoom : zooms) {
      Keyframe key;
      key.time_s = static_cast<double>(out.size());
      key.camera.zoom = zoom;
      out.push_back(key);
    }
    return out;
  };
  Document base, mine, theirs;
  base.keyframes = film({1});
  mine.keyframes = film({1, 2});
  theirs.keyframes = film({1, 3, 4});
  EXPECT_EQ(join(&base, base, theirs).keyframes, theirs.keyframes);
  EXPECT_EQ(join(&base, mine, base).keyframes, mine.keyframes);
  const Document both = join(&base, mine, theirs);
  std::vector<double> zooms;
  for (const Keyframe& key : both.keyframes) zooms.push_back(key.camera.zoom);
  EXPECT_EQ(zooms, (std::vector<double>{1, 2, 3, 4}));
  for (std::size_t i = 1; i < both.keyframes.size(); ++i)
    EXPECT_GT(both.keyframes[i].time_s, both.keyframes[i - 1].time_s);
  EXPECT_TRUE(parse_document(format_document(both), "joined"));
  EXPECT_EQ(marks_more(mine, both), "2 keyframes");
  EXPECT_EQ(marks_more(both, both), "");
}

}  // namespace
}  // namespace dubsar::app
