// Lines of text, the record of the tablet, and ATF by commands, without a window.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/document/document_file.h"
#include "app/document/join.h"
#include "app/document/mark_file.h"
#include "app/document/text_lines.h"
#include "core/base/files/atomic_file.h"
#include "tests/app/commands/bench.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

struct TextFolder {
  fs::path path = fs::temp_directory_path() / fmt::format("dubsar_text_{}", ::getpid());
  TextFolder() { fs::create_directories(path); }
  ~TextFolder() { fs::remove_all(path); }
  std::string file(const std::string& name, const std::string& text = {}) const {
    if (!text.empty()) std::ofstream(path / name, std::ios::binary) << text;
    return (path / name).string();
  }
};

/// "o. 1 text" of each line, as they are read.
std::vector<std::string> lines_of(const Document& document) {
  std::vector<std::string> out;
  for (const TextPassage& each : passages_of(document))
    out.push_back(each.spot.surface + " " + each.spot.number + " " + each.text);
  return out;
}
using Lines = std::vector<std::string>;

TEST(TextCommands, LinesCountForEachSideByTheirPlaceAndOneMayBeInserted) {
  Bench bench;
  bench.run("add_line 1,30,0 9,30,0 a");
  bench.run("add_line 1,25,0 9,25,0 b");
  bench.run("add_line -9,30,0 -1,30,0 x");  // of the reverse
  bench.run("add_line 1,20,0 9,20,0 c");
  EXPECT_EQ(lines_of(bench.now()), (Lines{"obverse 1 a", "obverse 2 b", "obverse 3 c", "reverse 1 x"}));
  bench.run("add_line 1,22.5,0 9,22.5,0 between");
  EXPECT_EQ(lines_of(bench.now()),
            (Lines{"obverse 1 a", "obverse 2 b", "obverse 3 between", "obverse 4 c", "reverse 1 x"}));
  bench.run("add_line 1,35,0 9,35,0 first");
  EXPECT_EQ(lines_of(bench.now()), (Lines{"obverse 1 first", "obverse 2 a", "obverse 3 b", "obverse 4 between",
                                          "obverse 5 c", "reverse 1 x"}));
  bench.run("undo");
  EXPECT_EQ(lines_of(bench.now()).front(), "obverse 1 a") << "one step";
  bench.run("add_note 5,5,5 a pin");
  EXPECT_EQ(lines_of(bench.now()).size(), 5u) << "pins are no lines";
}

TEST(TextCommands, TheNextLineLiesAtTheSameIntervalAndOneAboveHalfWay) {
  Bench bench;
  bench.run("add_line 1,30,0 9,30,0 a");
  bench.run("next_line 1");
  EXPECT_EQ(bench.now().notes[1].line_mm, (std::vector<glm::dvec3>{{1, 25, 5}, {9, 25, 5}}))
      << "5 mm, as letters have it";
  EXPECT_EQ(bench.now().notes[1].label, "o. 2");
  EXPECT_EQ(bench.editor.ui().note, 2u) << "it is open, and what is typed is its text";
  EXPECT_EQ(bench.editor.ui().pointing.notes, 1u);
  bench.run("delete_note 2");
  bench.run("add_line 1,27,0 9,27,0 b");
  bench.run("next_line 2");
  EXPECT_EQ(bench.now().notes[2].line_mm[0], glm::dvec3(1, 24, 5)) << "3 mm, as between the two before";
  bench.run("insert_line 2");
  EXPECT_EQ(bench.now().notes[3].line_mm[0], glm::dvec3(1, 28.5, 5));
  EXPECT_EQ(bench.now().notes[3].label, "o. 2");
  EXPECT_EQ(bench.now().notes[1].label, "o. 3");
  EXPECT_EQ(bench.now().notes[2].label, "o. 4");
  bench.run("add_note 1,1,1 pin");
  EXPECT_EQ(bench.refusal("next_line 5"),
            "next_line: note 5 is a pin; expected one that runs along a line of the text");
}

TEST(TextCommands, NumbersWithPrimesAndGapsStay) {
  Bench bench;
  bench.run("add_line 1,30,0 9,30,0 a");
  bench.run("note_label 1 r. ii 3'");
  bench.run("note_label 1 o. ii 3'");
  bench.run("add_line 1,20,0 9,20,0 b");
  EXPECT_EQ(bench.now().notes[1].label, "o. ii 4'");
  bench.run("note_label 2 o. ii 9'");
  bench.run("add_line 1,25,0 9,25,0 c");
  EXPECT_EQ(bench.now().notes[2].label, "o. ii 4'");
  EXPECT_EQ(bench.now().notes[1].label, "o. ii 9'") << "there was room";
}

TEST(TextCommands, ALineOverAPatchWithoutBracketsIsWarnedOf) {
  Bench bench;
  bench.run("add_line 1,45,0 9,45,0 a-na");
  EXPECT_NE(bench.place.said.find("under about 100 % of line o. 1"), std::string::npos) << bench.place.said;
  bench.place.said.clear();
  bench.run("note_text 1 [a-na]");
  EXPECT_EQ(bench.place.said, "");
  bench.run("note_text 1 a-na");
  EXPECT_NE(bench.place.said.find("belongs in [ ]"), std::string::npos);
  bench.place.said.clear();
  bench.run("add_line 1,30,0 9,30,0 a-na");
  EXPECT_EQ(bench.place.said, "");
}

TEST(TextCommands, AtfGoesOutAndComesInAndLinesWaitToBePinned) {
  const TextFolder folder;
  const std::string text =
      "&P999001 = AO 0\r\n#project: ours\r\n#atf: lang akk-x-oldass\r\n@tablet\r\n@obverse\r\n1.  a-na\r\n#lem: x\r\n"
      "2. um-ma\r\n#tr.en: thus\r\n$ ruling\r\n@reverse\r\n1'. x\r\n";
  const std::string file = folder.file("in.atf", text);
  Bench bench;
  bench.run("add_line 1,30,0 9,30,0 other");
  bench.run("read_atf " + file);
  EXPECT_EQ(bench.place.said, "3 lines read, 1 of them pinned already; 2 wait: tool line pins them");
  EXPECT_EQ(bench.now().notes[0].text, "a-na") << "the file's words";
  EXPECT_EQ(bench.now().edition.record.p_number, "P999001");
  EXPECT_EQ(bench.now().edition.record.language, "akk-Latn-x-oldass");
  bench.run("next_line 1");
  EXPECT_EQ(bench.now().notes[1].text, "um-ma");
  EXPECT_EQ(bench.now().notes[1].translation, "thus");
  bench.run("add_line -9,30,0 -1,30,0");
  EXPECT_EQ(bench.now().notes[2].label, "r. 1'");
  EXPECT_TRUE(waiting_lines(bench.now()).empty());
  const std::string out = folder.file("out.atf");
  bench.run("write_atf " + out);
  EXPECT_EQ(read_text_file(out).value(), text) << "nobody changed anything";
  bench.run("note_text 2 um-ma I-din");
  bench.run("next_line 2");
  bench.run("note_text 4 qi-bi-ma");
  bench.run("write_atf " + out);
  std::string expected = text;
  expected.replace(expected.find("um-ma"), 5, "um-ma I-din");
  expected.insert(expected.find("$ ruling"), "3. qi-bi-ma\r\n");
  EXPECT_EQ(read_text_file(out).value(), expected);
  bench.run("forget_atf");
  bench.run("write_atf " + folder.file("own.atf"));
  EXPECT_EQ(read_text_file(folder.file("own.atf")).value(),
            "&P999001 = AO 0\n#atf: lang akk-x-oldass\n@tablet\n@obverse\n1. a-na\n2. um-ma I-din\n#tr.en: thus\n"
            "3. qi-bi-ma\n@reverse\n1'. x\n");
}

TEST(TextCommands, NoFileOfAnotherKindOrTextIsWrittenOver) {
  const TextFolder folder;
  Bench bench;
  bench.run("p_number P999001");
  bench.run("add_line 1,30,0 9,30,0 a");
  EXPECT_EQ(bench.refusal("write_atf " + folder.file("a.txt")),
            "cannot write " + folder.file("a.txt") + ": expected a name that ends in .atf");
  EXPECT_NE(bench.refusal("write_atf " + folder.file("b.atf", "my notes\n")).find("something else is there"),
            std::string::npos);
  EXPECT_NE(bench.refusal("write_atf " + folder.file("c.atf", "&P999002 = B\n1. b\n"))
                .find("another text, P999002, is there"),
            std::string::npos);
  EXPECT_NE(bench.refusal("write_atf " + folder.file("d.atf", "&P999001 = B\n1. b\n&P999003 = C\n"))
                .find("a file of 2 texts"),
            std::string::npos);
  bench.run("write_atf " + folder.file("e.atf", "&P999001 = B\n1. b\n"));
  EXPECT_NE(bench.refusal("read_atf " + folder.file("b.atf")).find("no text found"), std::string::npos);
  EXPECT_NE(bench.refusal("read_atf " + folder.file("none.atf")), "accepted");
}

TEST(TextCommands, TheRecordIsSaidOnceKeptJoinedAndInAllThatIsWritten) {
  Bench bench;
  bench.run("museum_number AO 8295");
  bench.run("p_number 293386");
  bench.run("rights CC BY 4.0");
  bench.run("creator A. Scribe");
  bench.run("language Old Assyrian");
  EXPECT_EQ(bench.refusal("p_number AO 8295"),
            "p_number: \"AO 8295\" found, expected a number of CDLI such as P293386");
  EXPECT_NE(bench.refusal("language the mother's"), "accepted");
  EXPECT_EQ(bench.now().edition.record.p_number, "P293386");
  bench.run("add_line 1,30,0 9,30,0 a-na");
  bench.run("line_translation 1 to");
  const Document kept = parse_document(format_document(bench.now()), "kept").value();
  EXPECT_EQ(kept.edition, bench.now().edition);
  EXPECT_EQ(kept.notes, bench.now().notes);
  const json w = json::parse(format_annotations(bench.now()));
  EXPECT_EQ(w["creator"]["name"], "A. Scribe");
  EXPECT_EQ(w["label"], "notes on AO 8295");
  EXPECT_EQ(w["first"]["items"][0]["body"][0]["language"], "akk-Latn-x-oldass");
  EXPECT_EQ(w["first"]["items"][0]["body"][1]["language"], "en");
  EXPECT_EQ(w["first"]["items"][0]["created"], "2026-11-27T00:00:00Z");
  EXPECT_EQ(w["first"]["items"][0]["motivation"][0], "describing");
  Document other = bench.now();
  other.source.content = "of another surface";
  EXPECT_NE(json::parse(format_annotations(other))["first"]["items"][0]["id"], w["first"]["items"][0]["id"]);
  EXPECT_EQ(add_marks(two_parts(), bench.now()).edition, bench.now().edition);
  EXPECT_EQ(marks_more(two_parts(), add_marks(two_parts(), bench.now())), "1 note, what is said of the tablet");
  Document mine = two_parts();
  mine.edition.record.title = "mine";
  EXPECT_EQ(add_marks(mine, bench.now()).edition.record.title, "mine");
  bench.run("museum_number");
  EXPECT_EQ(bench.now().edition.record.museum_number, "") << "nothing after it takes it away";
}

}  // namespace
}  // namespace dubsar::app
