// dubsar animate as its user: pictures in a folder, videos, and what a film that was stopped leaves behind.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/publish/video.h"
#include "core/base/files/atomic_file.h"
#include "core/image_io/picture_file.h"
#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

/// A box of 30 x 40 x 10 mm with a notch in its upper right corner, and a film of two seconds that turns it over.
class Animate : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_animate_{}", ::getpid());
    fs::create_directories(folder_);
    std::ofstream obj(in("box.obj"));
    for (const int z : {0, 10})
      for (const auto& [x, y] : std::vector<std::pair<int, int>>{{0, 0}, {30, 0}, {30, 25}, {15, 40}, {0, 40}})
        obj << "v " << x << " " << y << " " << z << "\n";
    obj << "f 1 5 4 3 2\nf 6 7 8 9 10\n";
    for (int k = 1; k <= 5; ++k) {
      const int next = k % 5 + 1;
      obj << "f " << k << " " << next << " " << next + 5 << " " << k + 5 << "\n";
    }
    std::ofstream(in("film.json")) << film(2.0);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }

  static std::string film(double length_s) {
    const auto key = [](double time, std::vector<double> turn, double zoom, double azimuth) {
      return nlohmann::json{{"time_s", time},
                            {"camera", {{"rotation_wxyz", turn}, {"zoom", zoom}, {"pan", {0.0, 0.0}}}},
                            {"light", {{"azimuth_deg", azimuth}, {"elevation_deg", 25.0}}},
                            {"unpack", 0.0},
                            {"style", "phong"},
                            {"parts", nlohmann::json::array()}};
    };
    const double h = std::sqrt(0.5);
    const nlohmann::json keys{key(0, {1, 0, 0, 0}, 1.0, 300), key(0.4 * length_s, {h, 0, h, 0}, 1.2, 20),
                              key(length_s, {0, 0, 1, 0}, 1.0, 60)};
    return nlohmann::json{{"format", "dubsar film"}, {"version", 1}, {"keyframes", keys}}.dump();
  }

  std::vector<std::string> words(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> all{"animate", in("film.json"), in("box.obj"), "-o",         in(out), "--size",
                                 "96x72",   "--samples",     "1",           "--progress", "json",  "--fps"};
    if (more.empty()) more = {"10"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// Bytes of all files by their names.
  std::map<std::string, std::string> files(const std::string& name) const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(in(name)))
      out[entry.path().filename().string()] = read_text_file(entry.path(), 1 << 24).value_or("unreadable");
    return out;
  }

  fs::path folder_;
};

int done_in(const std::string& progress, const std::string& stage) {
  int done = 0;
  std::istringstream lines(progress);
  for (std::string line; std::getline(lines, line);) {
    const auto object = nlohmann::json::parse(line, nullptr, false);
    if (object.is_object() && object.value("stage", "") == stage) done = object.value("done", 0);
  }
  return done;
}

TEST_F(Animate, MakesAPictureForEachMomentAndTheLastKeyToo) {
  const ProgramRun run = run_dubsar(words("pictures"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("21 pictures of 96x72 pixels"), std::string::npos) << run.out;
  const auto made = files("pictures");
  EXPECT_EQ(made.size(), 23u) << "and the two lists";
  EXPECT_TRUE(made.contains("picture_00001.png") && made.contains("picture_00021.png"));
  const auto first = read_picture(in("pictures/picture_00001.png"));
  const auto middle = read_picture(in("pictures/picture_00009.png"));
  ASSERT_TRUE(first && middle);
  const auto lit = [](const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) count += image.at(x, y)[0] > 60 ? 1 : 0;
    return count;
  };
  EXPECT_GT(2 * lit(*first), 3 * lit(*middle)) << "its broad side, and at the second key its narrow one";
  EXPECT_GT(lit(*middle), 200);
  // The last one is how render shows the box from behind, of the same size: only its outline is compared.
  const auto last = read_picture(in("pictures/picture_00021.png"));
  ASSERT_TRUE(last);
  EXPECT_NEAR(lit(*last), lit(*first), 0.03 * lit(*first));
}

TEST_F(Animate, AStyleGoesOverIntoTheOneItIsMixedWith) {
  const auto still = [&](const std::string& name, const std::string& style, double share, double radiance) {
    auto film = nlohmann::json::parse(Animate::film(1.0));
    for (std::size_t i = 0; i < 3; ++i) {
      auto& key = film["keyframes"][i];
      key["camera"] = film["keyframes"][0]["camera"];
      key["light"] = film["keyframes"][0]["light"];
      key["style"] = style;
      const double part = static_cast<double>(i) / 2;
      key["shade"] = {{"other", share > 0 ? "raking" : ""},
                      {"share", part * share},
                      {"radiance", part * radiance},
                      {"strength", 1.0}};
    }
    film["version"] = 2;
    std::ofstream(in("film.json")) << film.dump();
    const ProgramRun run = run_dubsar(words(name, {"4"}));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::vector<Image> out;
    for (int i = 1; i <= 5; ++i) {
      auto image = read_picture(in(fmt::format("{}/picture_{:05}.png", name, i)));
      EXPECT_TRUE(image);
      if (image) out.push_back(*std::move(image));
    }
    return out;
  };
  const auto apart = [](const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
    return sum / static_cast<double>(a.pixels.size());
  };
  const auto phong = still("phong", "phong", 0, 0), raking = still("raking", "raking", 0, 0),
             mixed = still("mixed", "phong", 1, 0);
  ASSERT_TRUE(phong.size() == 5 && raking.size() == 5 && mixed.size() == 5);
  EXPECT_GT(apart(phong[0], raking[0]), 2.0) << "they look different, or nothing is seen here";
  EXPECT_EQ(mixed[0].pixels, phong[0].pixels);
  EXPECT_LT(apart(mixed[4], raking[4]), 0.5);
  for (std::size_t i = 1; i < 5; ++i)
    EXPECT_GT(apart(mixed[i], phong[0]), apart(mixed[i - 1], phong[0])) << "it comes in by and by";
  nlohmann::json wrong = nlohmann::json::parse(Animate::film(1.0));
  wrong["keyframes"][0]["shade"] = {{"other", "rakin"}, {"share", 0.5}, {"radiance", 0.0}, {"strength", 1.0}};
  std::ofstream(in("film.json")) << wrong.dump();
  const ProgramRun refused = run_dubsar(words("wrong"));
  EXPECT_EQ(refused.exit_code, 64) << refused.err;
  EXPECT_NE(refused.err.find("raking"), std::string::npos) << "did you mean: " << refused.err;
}

TEST_F(Animate, GoesOnAfterKillWithTheSameBytes) {
  ASSERT_EQ(run_dubsar(words("whole")).exit_code, 0);
  RunOptions killed;
  killed.watch = [](const std::string& err) { return done_in(err, "animate") >= 3 ? SIGKILL : 0; };
  const ProgramRun dead = run_dubsar(words("parts"), killed);
  ASSERT_TRUE(dead.exit_code == 128 + SIGKILL || dead.exit_code == 0) << dead.err;
  // What a full disk and a bad copy leave: a cut file, flipped bytes, nothing, and half of one that was being written.
  fs::resize_file(in("parts/picture_00001.png"), 100);
  std::fstream bad(in("parts/picture_00002.png"), std::ios::in | std::ios::out | std::ios::binary);
  bad.seekp(200);
  bad.write("xxxxxxxxxxxx", 12);
  bad.close();
  std::ofstream(in("parts/.picture_00009.png.tmp-999999999-0badf00d")) << "half";
  const ProgramRun again = run_dubsar(words("parts"));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(files("parts"), files("whole"));
  fs::remove(in("parts/picture_00020.png"));
  const ProgramRun last = run_dubsar(words("parts"));
  EXPECT_NE(last.out.find("20 of them were there already"), std::string::npos) << last.out;
  EXPECT_EQ(files("parts"), files("whole"));
}

TEST_F(Animate, StopsWhenToldAndSaysWhereItIs) {
  RunOptions stopped;
  stopped.watch = [](const std::string& err) { return done_in(err, "animate") >= 2 ? SIGINT : 0; };
  const ProgramRun run = run_dubsar(words("pictures", {"200"}), stopped);
  ASSERT_EQ(run.exit_code, 130) << run.err;
  EXPECT_NE(run.err.find("of 401 pictures are in"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("the same command makes the others"), std::string::npos);
  int whole = 0;
  for (const auto& [name, bytes] : files("pictures")) {
    EXPECT_EQ(name.find(".tmp-"), std::string::npos) << name;
    if (name.starts_with("picture_")) whole += read_picture(in("pictures/" + name)) ? 1 : -1000;
  }
  EXPECT_GE(whole, 2);
}

TEST_F(Animate, NeverMixesTwoFilmsInAFolder) {
  ASSERT_EQ(run_dubsar(words("pictures", {"2"})).exit_code, 0);
  const ProgramRun other = run_dubsar(words("pictures", {"3"}));
  EXPECT_EQ(other.exit_code, 64);
  EXPECT_NE(other.err.find("holds other pictures"), std::string::npos) << other.err;
  std::ofstream(in("film.json")) << film(1.0);
  EXPECT_EQ(run_dubsar(words("pictures", {"4"})).exit_code, 64) << "as many pictures, another film";
  EXPECT_EQ(run_dubsar(words("pictures", {"4", "--again"})).exit_code, 0);
  EXPECT_EQ(files("pictures").size(), 7u) << "five pictures, what they show, and which of them it made";
}

TEST_F(Animate, TakesAwayOnlyPicturesThatItMadeAndThatNobodyChanged) {
  const std::map<std::string, std::string> mine{{"picture_of_my_cat.png", "a cat"}, {"picture_00003.xcf", "layers"},
                                                {"picture_1.png", "one"},           {"picture_00099.png", "another"},
                                                {".picture_00004.png.tmp-x", "x"},  {"picture_00001.png.bak", "old"}};
  fs::create_directories(in("pictures"));
  const auto put = [&](const std::string& name, const std::string& text) {
    std::ofstream(in("pictures/" + name)) << text;
  };
  for (const auto& [name, text] : mine) put(name, text);
  const std::string living = fmt::format(".picture_00002.png.tmp-{}-0badf00d", ::getpid());
  put(living, "half");
  const auto left = [&] {
    auto all = files("pictures");
    for (const auto& [name, text] : mine) EXPECT_EQ(all[name], text) << name;
    EXPECT_EQ(all[living], "half") << "its writer lives";
    return all;
  };
  ASSERT_EQ(run_dubsar(words("pictures", {"4"})).exit_code, 0);
  const auto first = left();
  ASSERT_EQ(run_dubsar(words("pictures", {"2", "--again"})).exit_code, 0);
  EXPECT_EQ(left().size(), first.size() - 4) << "five pictures instead of nine";
  // Painted over by somebody: neither removed nor written over, and nothing else is lost for it.
  put("picture_00002.png", "retouched");
  const auto before = left();
  const ProgramRun again = run_dubsar(words("pictures", {"2", "--again"}));
  EXPECT_EQ(again.exit_code, 73) << again.err;
  EXPECT_NE(again.err.find("picture_00002.png is not as this program made it"), std::string::npos) << again.err;
  EXPECT_EQ(left(), before);
  fs::create_directories(in("foreign"));
  std::ofstream(in("foreign/picture_00005.png")) << "mine";
  for (const auto& more : {std::vector<std::string>{"4"}, {"4", "--again"}})
    EXPECT_EQ(run_dubsar(words("foreign", more)).exit_code, 73);
  EXPECT_EQ(files("foreign").size(), 1u) << "nothing is touched";
}

TEST_F(Animate, RefusesInOneSentenceBeforeItReadsTheSurface) {
  const auto refusal = [&](const std::vector<std::string>& line) { return run_dubsar(line).err; };
  std::ofstream(in("style.json")) << nlohmann::json::parse(film(1)).dump().replace(film(1).find("phong"), 5, "fancy");
  EXPECT_NE(refusal({"animate", in("film.json"), in("none.obj"), "-o", in("y")}).find("there is no file"),
            std::string::npos);
  EXPECT_NE(refusal({"animate", in("style.json"), in("box.obj"), "-o", in("x")}).find("fancy"), std::string::npos);
  EXPECT_NE(refusal(words("film.avi")).find(".mp4, .mov, .webm or .mkv"), std::string::npos);
  EXPECT_NE(refusal({"animate", in("film.json"), in("box.obj"), "-o", in("x"), "--display", "mono", "--size", "7"})
                .find("WIDTHxHEIGHT"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(in("x")));
}

TEST_F(Animate, MakesQuiltsForADisplay) {
  const ProgramRun run =
      run_dubsar({"animate", in("film.json"), in("box.obj"), "-o", in("q"), "--fps", "1", "--samples", "1", "--display",
                  "quilt:columns=4,rows=2,width=512,height=256,aspect=0.75", "--pictures", "tif"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto quilt = read_picture(in("q/picture_00001_qs4x2a0.75.tif"));
  ASSERT_TRUE(quilt) << quilt.error().message;
  EXPECT_EQ(quilt->width, 512);
  EXPECT_EQ(quilt->height, 256);
}

/// PATH with an ffmpeg that only tells what it was asked, or with none.
struct OtherPath {
  std::string before = std::getenv("PATH");
  explicit OtherPath(const std::string& path) { ::setenv("PATH", path.c_str(), 1); }
  ~OtherPath() { ::setenv("PATH", before.c_str(), 1); }
};

TEST_F(Animate, SaysWhatIsMissingWhereThereIsNoFfmpeg) {
  const OtherPath path(in("nowhere"));
  const ProgramRun run = run_dubsar(words("film.mp4"));
  EXPECT_EQ(run.exit_code, 69);
  EXPECT_NE(run.err.find("apt install ffmpeg"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(in("film.mp4_pictures"))) << "said before the work";
}

TEST_F(Animate, AsksFfmpegForAVideoAndKeepsPicturesOnlyWhenItFails) {
  fs::create_directories(in("bin"));
  const auto program = [&](const std::string& text) {
    std::ofstream(in("bin/ffmpeg")) << "#!/bin/sh\n" << text;
    fs::permissions(in("bin/ffmpeg"), fs::perms::owner_all);
  };
  program(fmt::format("for word; do echo \"$word\"; last=$word; done > {}\necho frame=5; echo done > \"$last\"\n",
                      in("asked")));
  const OtherPath path(in("bin") + ":/usr/bin:/bin");
  ASSERT_EQ(run_dubsar(words("film.mp4", {"4"})).exit_code, 0);
  EXPECT_EQ(read_text_file(in("film.mp4")).value(), "done\n");
  EXPECT_FALSE(fs::exists(in("film.mp4_pictures")));
  const std::string asked = read_text_file(in("asked")).value();
  for (const std::string word : {"-framerate\n4\n", "picture_%05d.png\n", "libx264\n", "iec61966-2-1\n", "-f\nmp4\n"})
    EXPECT_NE(asked.find(word), std::string::npos) << word;
  program("echo broken pipe dream >&2; exit 3\n");
  const ProgramRun failed = run_dubsar(words("other.webm", {"4"}));
  EXPECT_EQ(failed.exit_code, 74);
  EXPECT_NE(failed.err.find("broken pipe dream"), std::string::npos) << failed.err;
  EXPECT_FALSE(fs::exists(in("other.webm")));
  EXPECT_EQ(files("other.webm_pictures").size(), 11u) << "the work is not lost";
}

TEST_F(Animate, AnExactVideoHasThePicturesToTheLastBit) {
  if (!app::find_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  ASSERT_EQ(run_dubsar(words("film.mkv", {"4", "--keep"})).exit_code, 0);
  ASSERT_EQ(
      std::system(fmt::format("ffmpeg -v error -i {} {}/back_%05d.png", in("film.mkv"), folder_.string()).c_str()), 0);
  for (int k = 1; k <= 9; ++k) {
    const auto made = read_picture(in(fmt::format("film.mkv_pictures/picture_{:05}.png", k)));
    const auto back = read_picture(in(fmt::format("back_{:05}.png", k)));
    ASSERT_TRUE(made && back) << k;
    EXPECT_EQ(made->pixels, back->pixels) << k;
  }
}

}  // namespace
}  // namespace dubsar::test
