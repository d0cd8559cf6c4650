// What people made of a surface is found again, whatever became of its file and of that of the work.

#include "app/session/file_session.h"

#include <nlohmann/json.hpp>

#include "tests/app/session/work_desk.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using Texts = std::set<std::string>;

class FileSessions : public ::testing::Test {
 protected:
  FileSessions() { write(a_, "surface a"); }
  static void write(const fs::path& file, const std::string& bytes) { std::ofstream(file) << bytes; }
  WorkWindow open(const fs::path& surface, const std::string& scan = {}) const {
    return WorkWindow(surface, folder_.state(), scan);
  }
  /// A session with these notes on `a`, ended in order.
  void noted(const Texts& texts, const std::string& scan = {}) const {
    WorkWindow window = open(a_, scan);
    for (const std::string& text : texts) window.note(text);
    ASSERT_TRUE(window.leave());
  }
  Texts files() const {
    Texts out;
    for (const fs::path& in : {a_.parent_path(), folder_.state()})
      if (fs::exists(in))
        for (const auto& each : fs::directory_iterator(in)) out.insert(each.path().filename().string());
    return out;
  }
  fs::path beside() const { return a_.string() + ".dubsar.json"; }
  fs::path state_file() const {
    for (const auto& each : fs::directory_iterator(folder_.state())) return each.path();
    return {};
  }
  static void replace(const fs::path& file, const std::string& what, const std::string& by) {
    std::string text = read_text_file(file).value();
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos);
    write(file, text.replace(at, what.size(), by));
  }
  WorkFolder folder_;
  const fs::path a_ = folder_.tablet("a.exa");
};

TEST_F(FileSessions, LookingLeavesNothingAndWorkIsKeptInTwoPlacesOfWhichEachIsEnough) {
  const Texts before = files();
  {
    WorkWindow looked = open(a_);
    looked.document.now.zoom = 2;
    EXPECT_TRUE(looked.keep() && looked.leave());
  }
  EXPECT_EQ(files(), before) << "having looked is no work";
  noted({"one"});
  EXPECT_EQ(files().size(), before.size() + 2);
  ASSERT_TRUE(fs::exists(beside()));
  fs::rename(beside(), folder_.path / "away");
  EXPECT_EQ(open(a_).texts(), Texts{"one"});
  fs::rename(folder_.path / "away", beside());
  fs::remove_all(folder_.state());
  EXPECT_EQ(open(a_).texts(), Texts{"one"});
}

// Not four members of a list: whatever a document has.
TEST_F(FileSessions, AnOrderlyEndKeepsEveryMemberThatAKillKeeps) {
  const std::vector<std::function<void(Document&)>> changes{[](Document& d) { d.style.name = "raking"; },
                                                            [](Document& d) { d.fog = 0.5; },
                                                            [](Document& d) { d.unpack = 0.25; },
                                                            [](Document& d) { d.light.azimuth_deg = 12; },
                                                            [](Document& d) { d.parts[0].visible = false; },
                                                            [](Document& d) { d.parts[0].offset_mm.x = 3; },
                                                            [](Document& d) { d.parts[0].colour[1] = 7; },
                                                            [](Document& d) { d.scan.cursor_mm.y = 4; },
                                                            [](Document& d) { d.home.zoom = 3; },
                                                            [](Document& d) { d.clips.emplace_back(); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    fs::remove(beside());
    fs::remove_all(folder_.state());
    Document expected;
    {
      WorkWindow window = open(a_);
      changes[i](window.document);
      expected = window.document;
      ASSERT_TRUE(window.leave());
    }
    EXPECT_EQ(open(a_).document, expected) << i;
  }
}

TEST_F(FileSessions, ATabletIsKnownUnderAnotherNameInAnotherFolderAndWithAnotherState) {
  noted({"one"});
  const fs::path copy = folder_.tablet("colleague.exa"), moved = folder_.path / "moved.exa";
  fs::copy_file(a_, copy);
  EXPECT_EQ(open(copy).texts(), Texts{"one"}) << "copied";
  fs::rename(copy, moved);
  EXPECT_EQ(open(moved).texts(), Texts{"one"}) << "moved";
  fs::rename(a_, folder_.tablet("b.exa"));
  EXPECT_EQ(WorkWindow(folder_.tablet("b.exa"), folder_.path / "another person").texts(), Texts{"one"})
      << "the work lies beside it under its old name";
  const fs::path far = folder_.path / "far";
  fs::create_directories(far);
  fs::copy_file(moved, far / "a.exa");
  fs::copy_file(beside(), far / "a.exa.dubsar.json");
  EXPECT_EQ(WorkWindow(far / "a.exa", {}).texts(), Texts{"one"}) << "sent with its work";
}

TEST_F(FileSessions, ASurfaceMadeAnewOfItsScanIsBareAndItsNotesAreOffered) {
  noted({"one", "two"}, "77-aa");
  const std::string old = read_text_file(a_).value();
  write(a_, "surface a, another threshold");
  {
    WorkWindow again = open(a_, "77-aa");
    EXPECT_EQ(again.texts(), Texts());
    ASSERT_EQ(again.session->others().size(), 1u);
    EXPECT_TRUE(again.session->others()[0].same_scan);
    again.document.now.zoom = 2;
    ASSERT_TRUE(again.leave());
  }
  EXPECT_EQ(note_texts(load_work(beside())->document), (Texts{"one", "two"})) << "looking changed nothing";
  {
    WorkWindow again = open(a_, "77-aa");
    again.note("new");
    ASSERT_TRUE(again.keep());
    again.take_over();
    EXPECT_EQ(again.texts(), (Texts{"new", "one", "two"}));
    ASSERT_TRUE(again.leave());
    EXPECT_FALSE(again.session->take_told().empty()) << "that something was set aside is told";
  }
  EXPECT_TRUE(open(a_, "77-aa").session->others().empty()) << "they were taken over";
  EXPECT_EQ(WorkWindow(a_, folder_.path / "another person", "77-aa").texts(), (Texts{"new", "one", "two"}));
  write(a_, old);
  EXPECT_EQ(open(a_, "77-aa").texts(), (Texts{"one", "two"})) << "the old surface is there again";
  EXPECT_EQ(WorkWindow(a_, folder_.path / "another person", "77-aa").texts(), (Texts{"one", "two"}))
      << "what was set aside beside it is found by itself";
}

TEST_F(FileSessions, UnderAnotherNameASurfaceOfTheScanFindsWhatWasNotedOnTheFirst) {
  noted({"one"}, "77-aa");
  write(folder_.path / "half.exa", "half the detail");
  EXPECT_EQ(open(folder_.path / "half.exa", "77-aa").session->others().size(), 1u);
  EXPECT_TRUE(open(folder_.path / "half.exa", "78-bb").session->others().empty());
  EXPECT_TRUE(open(folder_.path / "half.exa").session->others().empty());
}

TEST_F(FileSessions, WhatANewerProgramWroteIsSetAsideToldAndFoundByThatProgramAgain) {
  noted({"one"});
  for (const fs::path& file : {beside(), state_file()}) replace(file, "\"version\": 7", "\"version\": 99");
  const Texts before = files();
  {
    WorkWindow looked = open(a_);
    EXPECT_EQ(looked.texts(), Texts());
    const std::vector<std::string> told = looked.session->take_told();
    ASSERT_EQ(told.size(), 2u);
    EXPECT_NE(told[0].find("version 99 found"), std::string::npos) << told[0];
    ASSERT_TRUE(looked.leave());
  }
  EXPECT_EQ(files(), before) << "looking changed nothing";
  {
    WorkWindow wrote = open(a_);
    wrote.note("two");
    ASSERT_TRUE(wrote.leave());
  }
  EXPECT_EQ(open(a_).texts(), Texts{"two"});
  int newer = 0;
  for (const fs::path& in : {a_.parent_path(), folder_.state()})
    for (const auto& each : fs::directory_iterator(in))
      if (each.path().string().find(".orphan-") != std::string::npos) {
        replace(each.path(), "\"version\": 99", "\"version\": 7");  // the newer program reads it
        ++newer;
      }
  EXPECT_EQ(newer, 2);
  EXPECT_EQ(open(a_).texts(), (Texts{"one", "two"}));
}

TEST_F(FileSessions, ADamagedFileIsSetAsideAndTheOtherOneIsEnough) {
  noted({"one"});
  const std::string text = read_text_file(beside()).value();
  for (const std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{400}, text.size() / 2, text.size() - 3}) {
    write(beside(), text.substr(0, cut));
    WorkWindow window = open(a_);
    EXPECT_EQ(window.texts(), Texts{"one"}) << cut;
    EXPECT_FALSE(window.session->take_told().empty()) << cut;
    window.document.fog = 0.5 - window.document.fog;
    ASSERT_TRUE(window.leave()) << cut;
    EXPECT_EQ(note_texts(load_work(beside())->document), Texts{"one"}) << cut;
  }
  EXPECT_EQ(set_aside_of(beside()).size(), 5u) << "none took another one's name";
}

TEST_F(FileSessions, TwoWindowsKeepEachOthersNotesWhicheverIsLeftLast) {
  for (const bool first_left_last : {false, true}) {
    fs::remove(beside());
    fs::remove_all(folder_.state());
    noted({"old", "gone"});
    WorkWindow one = open(a_), two = open(a_);
    one.note("of one", 5);
    two.note("of two", 9);
    two.erase("gone");
    one.the("old").text = "old, read again";
    ASSERT_TRUE(one.keep());
    EXPECT_TRUE((first_left_last ? two : one).leave());
    EXPECT_TRUE((first_left_last ? one : two).leave());
    const Texts all{"old, read again", "of one", "of two"};
    EXPECT_EQ(open(a_).texts(), all) << first_left_last;
    ASSERT_TRUE(one.keep() && two.keep());
    EXPECT_EQ(one.texts(), all) << "and the windows show them";
    EXPECT_EQ(two.texts(), all);
  }
}

TEST_F(FileSessions, WhatTwoWindowsChangedDifferentlyIsThereTwiceAndOnlyOnce) {
  noted({"old"});
  WorkWindow one = open(a_), two = open(a_), three = open(a_);
  one.the("old").text = "o. 1 a-na";
  two.the("old").text = "o. 1 i-na";
  three.erase("old");
  ASSERT_TRUE(one.leave() && two.leave() && three.leave());
  EXPECT_EQ(open(a_).texts(), (Texts{"o. 1 a-na", "o. 1 i-na"}));
  EXPECT_EQ(open(a_).document.notes.size(), 2u);
  ASSERT_TRUE(one.leave() && two.leave());
  EXPECT_EQ(open(a_).document.notes.size(), 2u);
}

TEST_F(FileSessions, AWindowThatOnlyLookedTakesNothingAway) {
  WorkWindow looked = open(a_);
  noted({"one"});
  ASSERT_TRUE(looked.leave());
  EXPECT_EQ(open(a_).texts(), Texts{"one"});
  WorkWindow other = open(a_);
  noted({"two"});
  EXPECT_EQ(note_texts(other.session->look(other.document).value_or(Document())), (Texts{"one", "two"}));
  WorkWindow third = open(a_);
  noted({"three"});
  ASSERT_TRUE(third.keep());
  EXPECT_EQ(third.texts(), (Texts{"one", "two", "three"})) << "it appears while somebody looks";
  EXPECT_TRUE(third.session->take_told().size() == 1) << "and is told";
}

TEST_F(FileSessions, WhatWasDeletedStaysDeletedThoughAnOlderCopyLiesBeside) {
  noted({"one", "two"});
  fs::copy_file(beside(), folder_.tablet("old.exa.dubsar.json"));
  {
    WorkWindow window = open(a_);
    window.erase("one");
    ASSERT_TRUE(window.leave());
  }
  EXPECT_EQ(open(a_).texts(), Texts{"two"});
}

TEST_F(FileSessions, AWindowOnASurfaceThatWasReplacedLeavesThePlaceToTheNewOne) {
  WorkWindow old = open(a_, "77-aa");
  old.note("on the old one");
  ASSERT_TRUE(old.keep());
  write(a_, "made anew");
  WorkWindow anew = open(a_, "77-aa");
  anew.note("on the new one");
  ASSERT_TRUE(anew.keep());
  old.note("again on the old one");
  ASSERT_TRUE(old.keep());
  anew.note("again on the new one");
  ASSERT_TRUE(anew.leave() && old.leave());
  EXPECT_EQ(note_texts(load_work(beside())->document), (Texts{"on the new one", "again on the new one"}));
  EXPECT_EQ(set_aside_of(beside()).size(), 1u) << "they do not chase each other";
  WorkWindow found = open(a_, "77-aa");
  found.take_over();
  EXPECT_EQ(found.texts().size(), 4u);
}

TEST_F(FileSessions, WorkThatCannotBeWrittenIsToldHeldAndTriedAgain) {
  write(folder_.path / "state", "no folder");
  fs::create_directory(beside());
  write(beside() / "in it", "of a person");
  WorkWindow window = open(a_);
  window.note("one");
  EXPECT_FALSE(window.keep());
  EXPECT_FALSE(window.leave()) << "neither of its places";
  EXPECT_FALSE(window.session->has_kept(window.document));
  EXPECT_EQ(window.texts(), Texts{"one"});
  EXPECT_EQ(read_text_file(beside() / "in it").value(), "of a person");
  fs::remove(folder_.path / "state");
  ASSERT_TRUE(window.leave());
  const auto told = window.session->take_told();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_NE(told[0].find("it is left as it is"), std::string::npos) << told[0];
  EXPECT_NE(told[1].find("it is a folder"), std::string::npos) << told[1];
  EXPECT_NE(told[1].find("one place instead of two"), std::string::npos) << told[1];
  fs::remove_all(beside());
  ASSERT_TRUE(window.leave());
  EXPECT_EQ(note_texts(load_work(beside())->document), Texts{"one"}) << "the other place follows when it can";
}

TEST_F(FileSessions, SessionsOfBeforeAreFoundByThePathAndMoveToTheNewPlaces) {
  const SourceFile source = source_of(a_);
  Document old;
  old.source = {source.path, source.bytes};
  old.notes.emplace_back().text = "of version 4";
  nlohmann::json text = nlohmann::json::parse(format_document(old));
  text["version"] = 4;
  for (const char* name : {"content", "scan"}) text["source"].erase(name);
  text["notes"][0].erase("id");
  const fs::path place = old_place_of(source, folder_.state());
  fs::create_directories(folder_.state());
  write(place, text.dump());
  {
    WorkWindow window = open(a_);
    EXPECT_EQ(window.texts(), Texts{"of version 4"});
    window.erase("of version 4");
    window.note("now");
    ASSERT_TRUE(window.leave());
  }
  EXPECT_EQ(open(a_).texts(), Texts{"now"}) << "what was deleted does not come back from the old place";
  EXPECT_TRUE(fs::exists(place));
  text["notes"][0]["text"] = "by the old program again";
  write(place, text.dump());
  EXPECT_EQ(open(a_).texts(), (Texts{"now", "by the old program again"}));
  write(a_, "made anew, of another size");
  EXPECT_EQ(open(a_).texts(), Texts());
  EXPECT_FALSE(open(a_).session->others().empty()) << "offered";
}

TEST_F(FileSessions, AHostileFileBesideIsNoWorkOfOurs) {
  for (const char* text : {"", "{}", "[]", "\xff\xfe", "{\"format\": \"dubsar document\", \"version\": 7}"}) {
    write(beside(), text);
    WorkWindow window = open(a_);
    EXPECT_EQ(window.texts(), Texts()) << text;
  }
}

}  // namespace
}  // namespace dubsar::app
