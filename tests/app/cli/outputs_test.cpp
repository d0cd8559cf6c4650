// What a tired person may type as an output: the input itself, the same name twice, a link, a pipe, a device, somebody
// else's file. Nothing is ever lost, and one sentence says what to do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/base/files/atomic_file.h"
#include "core/exa/container.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Outputs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder() = fs::temp_directory_path() / fmt::format("dubsar_outputs_{}", ::getpid());
    fs::create_directories(folder());
    ASSERT_EQ(run_dubsar({"phantom", at("scan.h5"), "--preset", "tiny", "--seed", "77"}).exit_code, 0);
    ASSERT_EQ(
        run_dubsar({"process", at("scan.h5"), "-o", at("tablet.exa"), "--detail", "half", "--no-ao", "-q"}).exit_code,
        0);
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }
  static fs::path& folder() {
    static fs::path path;
    return path;
  }
  static std::string at(const std::string& name) { return (folder() / name).string(); }
  static std::string bytes(const std::string& name) { return read_text_file(at(name), 1 << 30).value_or("gone"); }

  /// The run is refused with `exit_code` and a sentence, and `kept` is what it was, byte for byte.
  static void refused(const std::vector<std::string>& arguments, int exit_code, const std::string& kept,
                      const std::string& says) {
    const std::string before = bytes(kept);
    const ProgramRun run = run_dubsar(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(says));
    EXPECT_EQ(bytes(kept), before) << kept << " was changed by " << ::testing::PrintToString(arguments);
  }
};

TEST_F(Outputs, TheScanThatIsReadIsNeverWrittenOver) {
  fs::create_symlink(at("scan.h5"), at("alias.exa"));
  fs::create_hard_link(at("scan.h5"), at("twin.exa"));
  fs::create_hard_link(at("scan.h5"), at("renamed.exa"));
  refused({"process", at("scan.h5"), "-o", at("scan.h5")}, 64, "scan.h5", "expected a name that ends in .exa");
  refused({"process", at("renamed.exa"), "-o", at("renamed.exa")}, 64, "scan.h5", "the file that is read");
  refused({"process", at("scan.h5"), "-o", at("alias.exa")}, 64, "scan.h5", "the file that is read");
  refused({"process", at("scan.h5"), "-o", at("twin.exa")}, 64, "scan.h5", "the file that is read");
  refused({"process", at("scan.h5") + ":/entry/data/data", "-o", at("x.exa"), "--json", at("scan.h5")}, 64, "scan.h5",
          "the file that is read");
  refused({"info", at("scan.h5"), "--json", folder().string() + "/./../" + folder().filename().string() + "/scan.h5"},
          64, "scan.h5", "the file that is read");
  EXPECT_TRUE(fs::is_symlink(at("alias.exa")));
}

TEST_F(Outputs, OneFileIsNotWrittenTwice) {
  refused({"process", at("scan.h5"), "-o", at("a.exa"), "--json", at("a.exa")}, 64, "scan.h5", "the same file");
  EXPECT_FALSE(fs::exists(at("a.exa")));
  // Neither is there yet, and each is said in another way.
  fs::create_symlink("behind.exa", at("before.exa"));
  fs::create_symlink("before.exa", at("before_that.exa"));
  RunOptions here;
  here.folder = folder();
  for (const auto& [product, report] : {std::pair<std::string, std::string>{"b.exa", "./b.exa"},
                                        {at("b.exa"), "b.exa"},
                                        {"b.exa", at("./b.exa")},
                                        {"before.exa", "behind.exa"},
                                        {"behind.exa", "before_that.exa"},
                                        {"before_that.exa", "./before.exa"}}) {
    const ProgramRun run = run_dubsar({"process", "scan.h5", "-o", product, "--json", report, "--no-ao", "-q"}, here);
    EXPECT_EQ(run.exit_code, 64) << product << " and " << report << "\n" << run.err;
    EXPECT_THAT(run.err, HasSubstr("the same file"));
  }
  for (const char* name : {"b.exa", "behind.exa"}) EXPECT_FALSE(fs::exists(at(name))) << name;
}

// A verb may write more than what it is told: the surfaces of a folder of scans, and a record beside each. What would
// be lost is said before hours of work and not after them.
TEST_F(Outputs, WhatAVerbMakesBesideIsNotWrittenOverByItsReport) {
  fs::create_directory(at("scans"));
  fs::create_directory(at("made"));
  fs::copy_file(at("scan.h5"), at("scans/one.h5"));
  for (const auto& [scans, product, report] :
       {std::tuple<std::string, std::string, std::string>{"scans", "made", "made/one.exa"},
        {"scans", "made", "made/one.run.json"},
        {"scans/one.h5", "made/one.exa", "made/../made/one.exa"}}) {
    std::vector<std::string> words{"process",  at(scans), "-o",      at(product), "--json",  at(report),
                                   "--detail", "half",    "--no-ao", "-q",        "--resume"};
    const ProgramRun many = run_dubsar(words);
    EXPECT_EQ(many.exit_code, 64) << report << "\n" << many.err;
    EXPECT_THAT(many.err, HasSubstr("is a file that this run makes"));
    EXPECT_TRUE(fs::is_empty(at("made"))) << "refused after the work";
  }
}

TEST_F(Outputs, TheRecordingThatIsReplayedIsNotWrittenOver) {
  const std::string script = at("visit.json"), old = at("old.jsonl");
  ASSERT_TRUE(write_file_atomically(script, R"({"seed": 1, "duration_s": 1, "visitor": {"yaw_deg": 20}})"));
  const auto view = [&](const std::string& input, const std::string& record) {
    return std::vector<std::string>{"view", at("tablet.exa"), "--offscreen", "--size",   "64x48", "--seconds",
                                    "0.2",  "--input",        input,         "--record", record};
  };
  ASSERT_EQ(run_dubsar(view("scripted:" + script, old)).exit_code, 0);
  refused(view("replay:" + old, old), 64, "old.jsonl", "the file that is read as --input");
  refused(view("scripted:" + script, script), 73, "visit.json", "which would be lost");
  refused(view("spacemouse:replay=" + old, old), 64, "old.jsonl", "the file that is read as --input");
}

TEST_F(Outputs, FilesOfAnotherKindStay) {
  fs::copy_file(at("scan.h5"), at("other.h5"));
  ASSERT_TRUE(write_file_atomically(at("thesis.txt"), "Chapter 1"));
  fs::copy_file(at("tablet.exa"), at("older.exa"));
  refused({"info", at("tablet.exa"), "--json", at("other.h5")}, 73, "other.h5", "an HDF5 file");
  refused({"info", at("tablet.exa"), "--json", at("thesis.txt")}, 73, "thesis.txt", "no JSON");
  refused({"render", at("tablet.exa"), "-o", at("other.h5")}, 73, "other.h5", "an HDF5 file");
  refused({"export", at("tablet.exa"), at("older.exa")}, 73, "older.exa", "a surface file");
  refused({"process", at("scan.h5"), "-o", at("x.png")}, 64, "scan.h5", "ends in .exa");
  EXPECT_FALSE(fs::exists(at("x.png")));
}

// A table or drawing is replaced by a new one of ours, and stays once somebody corrected it.
TEST_F(Outputs, CorrectedTablesAndDrawingsStay) {
  for (const char* name : {"w.csv", "w.json", "copy.svg", "copy.pdf", "copy.dxf"}) {
    const std::string verb = name[0] == 'w' ? "wedges" : "handcopy", out = at(name);
    ASSERT_EQ(run_dubsar({verb, at("tablet.exa"), "-o", out, "-q"}).exit_code, 0) << name;
    ASSERT_EQ(run_dubsar({verb, at("tablet.exa"), "-o", out, "-q"}).exit_code, 0) << name << ": ours was not replaced";
    auto text = read_text_file(out, 64 << 20);
    ASSERT_TRUE(text);
    const std::size_t digit = text->find_last_of("0123456789");
    (*text)[digit] = (*text)[digit] == '1' ? '2' : '1';
    ASSERT_TRUE(write_file_atomically(out, *text));
    refused({verb, at("tablet.exa"), "-o", out}, 73, name, "would be lost");
    EXPECT_EQ(*read_text_file(out, 64 << 20), *text);
  }
}

// Whatever dubsar itself did not write stays, also under names that nobody typed.
TEST_F(Outputs, FilesOfOthersStayWhateverTheyAre) {
  // A gray slice of 2 x 1 pixels, as of a scan; PNG and JPEG of somebody, meshes of other programs, a raw volume,
  // texts.
  const std::string slice(
      "II*\0\x0a\0\0\0\x05\x06"
      "\x07\0"
      "\0\x01\x04\0\x01\0\0\0\x02\0\0\0"
      "\x01\x01\x04\0\x01\0\0\0\x01\0\0\0"
      "\x02\x01\x03\0\x01\0\0\0\x08\0\0\0"
      "\x06\x01\x03\0\x01\0\0\0\x01\0\0\0"
      "\x11\x01\x04\0\x01\0\0\0\x08\0\0\0"
      "\x16\x01\x04\0\x01\0\0\0\x01\0\0\0"
      "\x17\x01\x04\0\x01\0\0\0\x02\0\0\0"
      "\0\0\0\0",
      10 + 2 + 7 * 12 + 4);
  const std::map<std::string, std::string> mine{
      {"volume.tif", slice},
      {"photo.png", "\x89PNG\r\n\x1a\n a picture of somebody"},
      {"photo.jpg", "\xff\xd8\xff\xe0 a photograph"},
      {"bust.ply", "ply\nformat ascii 1.0\ncomment made by MeshLab\n"},
      {"bust.stl", "solid bust\nendsolid\n"},
      {"bust.obj", "v 0 0 0\n"},
      {"bust.glb", "glTF\x02 another program's"},
      {"bust.3mf", "PK\x03\x04 an archive"},
      {"page.html", "<!DOCTYPE html><html>my page</html>"},
      {"notes.json", R"({"format": "dubsar notes", "version": 1, "notes": []})"},
      {"package.json", R"({"name": "mine"})"},
      {"scan.raw", "\1\2\3\4"},
  };
  for (const auto& [name, bytes] : mine) ASSERT_TRUE(write_file_atomically(at(name), bytes));
  for (const char* name : {"volume.tif", "photo.png", "photo.jpg"}) {
    refused({"render", at("tablet.exa"), "-o", at(name), "--size", "32x32"}, 73, name, "would be lost");
    refused({"show", at("photo.png"), "-o", at("volume.tif")}, 73, "volume.tif", "would be lost");
  }
  for (const char* name : {"bust.ply", "bust.stl", "bust.obj", "bust.glb", "bust.3mf"})
    refused({"export", at("tablet.exa"), at(name)}, 73, name, "did not write, which would be lost");
  refused({"report", at("tablet.exa"), "-o", at("page.html")}, 73, "page.html", "would be lost");
  for (const char* name : {"notes.json", "package.json", "scan.raw"})
    refused({"info", at("tablet.exa"), "--json", at(name)}, 73, name, "would be lost");
  refused({"view", at("tablet.exa"), "--offscreen", "--seconds", "0.1", "--record", at("notes.json")}, 73, "notes.json",
          "would be lost");
  refused({"devices", "simulate", "xreal", at("scan.raw"), "--seconds", "0.1"}, 73, "scan.raw", "would be lost");
  // Names that follow from the one that was typed.
  for (const char* name : {"cross_03.tif", "cross_raking.tif", "shown_qs4x2a0.75.png"})
    fs::copy_file(at("volume.tif"), at(name));
  refused({"fatcross", at("tablet.exa"), "-o", at("cross.tif"), "--dpi", "60"}, 73, "cross_03.tif",
          "cross_03.tif exists and is a gray TIFF picture, as the slices of a scan are, which would be lost");
  refused({"fatcross", at("tablet.exa"), "-o", at("cross.tif"), "--dpi", "60", "--no-sides", "--apart", "--layers",
           "phong,raking"},
          73, "cross_raking.tif", "cross_raking.tif exists");
  EXPECT_FALSE(fs::exists(at("cross.tif")) || fs::exists(at("cross_01.tif"))) << "said before the work";
  refused({"render", "--pattern", "-o", at("shown.png"), "--display",
           "quilt:columns=4,rows=2,width=512,height=256,aspect=0.75", "--bridge-port", "0"},
          73, "shown_qs4x2a0.75.png", "which would be lost");
  fs::create_directory(at("frames"));
  fs::copy_file(at("photo.png"), at("frames/frame-00001.png"));
  refused({"view", at("tablet.exa"), "--offscreen", "--seconds", "0.1", "--frames", at("frames")}, 73,
          "frames/frame-00001.png", "which would be lost");
}

TEST_F(Outputs, FilesThatDubsarWroteAreReplaced) {
  ASSERT_TRUE(write_file_atomically(at("person.json"), R"({"seed": 1, "duration_s": 1, "visitor": {"yaw_deg": 20}})"));
  const std::vector<std::vector<std::string>> runs{
      {"render", at("tablet.exa"), "-o", at("p.png"), "--size", "32x32"},
      {"render", at("tablet.exa"), "-o", at("p.tif"), "--size", "32x32"},
      {"render", at("tablet.exa"), "-o", at("p.jpg"), "--size", "32x32"},
      {"export", at("tablet.exa"), at("m.ply")},
      {"export", at("tablet.exa"), at("m.stl")},
      {"export", at("tablet.exa"), at("m.obj")},
      {"export", at("tablet.exa"), at("m.glb")},
      {"export", at("tablet.exa"), at("m.3mf")},
      {"info", at("tablet.exa"), "--json", at("i.json")},
      {"view", at("tablet.exa"), "--offscreen", "--size", "32x32", "--seconds", "0.2", "--script", at("person.json"),
       "--record", at("r.jsonl"), "--frames", at("f")},
      {"devices", "simulate", "xreal", at("x.txt"), "--seconds", "0.1"}};
  for (const auto& words : runs)
    for (int i = 0; i < 2; ++i) {
      const ProgramRun run = run_dubsar(words);
      EXPECT_EQ(run.exit_code, 0) << words[0] << " " << words.back() << ", run " << i << ": " << run.err;
    }
}

TEST_F(Outputs, NamesThatAreTooLongAreRefusedBeforeTheWork) {
  for (const std::size_t bytes : {234, 240, 255}) {
    const std::string name = std::string(bytes - 4, 'a') + ".exa";
    const ProgramRun run = run_dubsar({"process", at("scan.h5"), "-o", at(name), "--progress", "json"});
    EXPECT_EQ(run.exit_code, 73) << run.err;
    EXPECT_THAT(run.err, HasSubstr("its name has"));
    EXPECT_EQ(run.err.find("\"stage\""), std::string::npos) << "refused after the work began";
  }
  EXPECT_EQ(run_dubsar({"export", at("tablet.exa"), at(std::string(229, 'b') + ".ply")}).exit_code, 0);
}

TEST_F(Outputs, APhantomReplacesOnlyPhantoms) {
  // A scan by somebody else: the same file, but nothing says that a phantom made it.
  std::string foreign = bytes("scan.h5");
  for (std::size_t found; (found = foreign.find("dubsar phantom")) != std::string::npos;)
    foreign.replace(found, 14, "beamline P05  ");
  ASSERT_TRUE(write_file_atomically(at("foreign.h5"), foreign));
  refused({"phantom", at("foreign.h5"), "--preset", "tiny"}, 73, "foreign.h5", "no phantom made");
  ASSERT_EQ(run_dubsar({"phantom", at("again.h5"), "--preset", "tiny", "--truth", at("truth.h5")}).exit_code, 0);
  EXPECT_EQ(run_dubsar({"phantom", at("again.h5"), "--preset", "tiny", "--truth", at("truth.h5")}).exit_code, 0);
  refused({"phantom", at("again.h5"), "--preset", "tiny", "--truth", at("again.h5")}, 64, "again.h5", "the same file");
}

TEST_F(Outputs, ReportsAndSurfacesReplaceOlderOnes) {
  EXPECT_EQ(run_dubsar({"info", at("tablet.exa"), "--json", at("report.json")}).exit_code, 0);
  EXPECT_EQ(run_dubsar({"info", at("tablet.exa"), "--json", at("report.json")}).exit_code, 0);
  ASSERT_EQ(run_dubsar({"process", at("scan.h5"), "-o", at("made.exa"), "--detail", "half", "--no-ao", "-q"}).exit_code,
            0);
  EXPECT_EQ(run_dubsar({"process", at("scan.h5"), "-o", at("made.exa"), "--detail", "half", "--no-ao", "-q"}).exit_code,
            0);
}

TEST_F(Outputs, LinksStayLinksAndTheFileBehindThemIsReplaced) {
  ASSERT_TRUE(write_file_atomically(at("behind.json"), "{}"));
  fs::create_symlink("behind.json", at("link.json"));
  fs::create_symlink("not_there_yet.json", at("dangling.json"));
  EXPECT_EQ(run_dubsar({"info", at("tablet.exa"), "--json", at("link.json")}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(at("link.json")));
  EXPECT_GT(bytes("behind.json").size(), 2u);
  EXPECT_EQ(run_dubsar({"info", at("tablet.exa"), "--json", at("dangling.json")}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(at("dangling.json")));
  EXPECT_TRUE(fs::is_regular_file(at("not_there_yet.json")));
}

TEST_F(Outputs, LinksThatLeadNowhereAreRefusedBeforeTheWork) {
  fs::create_symlink("ring_b.exa", at("ring_a.exa"));
  fs::create_symlink("ring_a.exa", at("ring_b.exa"));
  fs::create_symlink("no_such_folder/x.exa", at("astray.exa"));
  for (const char* link : {"ring_a.exa", "astray.exa"}) {
    refused({"process", "no such scan.h5", "-o", at(link)}, 73, "scan.h5", "cannot create");
    refused({"process", "no such scan.h5", "-o", at("x.exa"), "--json", at(link)}, 73, "scan.h5", "cannot create");
    EXPECT_TRUE(fs::is_symlink(at(link)));
  }
}

TEST_F(Outputs, PipesAndDevicesAreNoFiles) {
  ASSERT_EQ(::mkfifo(at("pipe.exa").c_str(), 0600), 0);
  const ProgramRun pipe = run_dubsar({"process", at("scan.h5"), "-o", at("pipe.exa")});
  EXPECT_EQ(pipe.exit_code, 73);
  EXPECT_THAT(pipe.err, HasSubstr("it is a pipe"));
  EXPECT_TRUE(fs::is_fifo(at("pipe.exa")));
  const ProgramRun device = run_dubsar({"info", at("tablet.exa"), "--json", "/dev/null"});
  EXPECT_EQ(device.exit_code, 73);
  EXPECT_THAT(device.err, HasSubstr("it is a device"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Outputs, AnOldFilesRightsAreKept) {
  ASSERT_EQ(run_dubsar({"info", at("tablet.exa"), "--json", at("private.json")}).exit_code, 0);
  fs::permissions(at("private.json"), fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_EQ(run_dubsar({"info", at("tablet.exa"), "--json", at("private.json")}).exit_code, 0);
  EXPECT_EQ(fs::status(at("private.json")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(CommandLine, FailuresAreObjectsForProgramsThatAskedForJson) {
  const ProgramRun run = run_dubsar({"info", "/no/such/file.exa", "--json", "-"});
  EXPECT_EQ(run.exit_code, 66);
  const auto object = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(object.is_object()) << run.out;
  EXPECT_EQ(object["error"]["exit_code"], 66);
  EXPECT_THAT(object["error"]["message"].get<std::string>(), HasSubstr("/no/such/file.exa"));
}

TEST(CommandLine, AFullStdoutIsAnInputOutputError) {
  RunOptions full;
  full.out = "/dev/full";
  const ProgramRun run = run_dubsar({"doctor", "--json", "-"}, full);
  EXPECT_EQ(run.exit_code, 74) << run.err;
  EXPECT_THAT(run.err, HasSubstr("cannot write the result to stdout"));
}

TEST(CommandLine, NothingTypedListsTheVerbsAndSlipsAreNamed) {
  const ProgramRun nothing = run_dubsar({});
  EXPECT_EQ(nothing.exit_code, 64);
  EXPECT_THAT(nothing.err, HasSubstr("turn a CT scan into separated"));
  EXPECT_THAT(run_dubsar({"proces", "a.h5"}).err, HasSubstr("did you mean \"process\"?"));
  EXPECT_THAT(run_dubsar({"render", "a.exa", "--stile", "clay"}).err, HasSubstr("did you mean \"--style\"?"));
  EXPECT_THAT(run_dubsar({"render", "a.exa", "--xyzzy", "clay"}).err, ::testing::Not(HasSubstr("did you mean")));
}

}  // namespace
}  // namespace dubsar::test
