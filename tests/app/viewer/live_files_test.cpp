// Files in a window: it is there before they are, they are opened, left, changed and dropped.

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <regex>

#include "app/viewer/first_document.h"
#include "tests/app/viewer/live_fixture.h"
#include "tests/app/viewer/x_drop.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// A reader whose files are boxes; those called slow come when they may.
class LiveFiles : public Live {
 protected:
  LiveFiles() {
    fs::create_directories(folder_);
    for (const char* name : {"a.ply", "b.ply", "slow.ply", "bad.ply"}) std::ofstream(folder_ / name) << name;
    options_.around.panels = true;
    options_.around.notices = true;
    options_.inputs = {"mouse", "keyboard"};
  }
  ~LiveFiles() override { fs::remove_all(folder_); }
  fs::path file(const char* name) const { return folder_ / name; }

  Result<OpenedSurface> read(const fs::path& path, Progress& progress, const TellCoarse& tell) {
    const std::string name = path.filename().string();
    if (name == "bad.ply") return fail(ErrorKind::kBadData, "bad.ply: it is torn");
    progress.begin("read ply vertex", 100, "item");
    progress.advance(40);
    if (name == "slow.ply") {
      if (tells_) tell(testing::sphere(20.0f, 12, 24));
      std::unique_lock lock(mutex_);
      while (!may_come_ && !progress.cancelled()) changed_.wait_for(lock, std::chrono::milliseconds(20));
      if (progress.cancelled()) {
        left_ = true;
        return cancelled_error();
      }
    }
    OpenedSurface out;
    out.mesh = testing::lettered_box();
    if (name == "b.ply") {
      out.mesh.triangles.resize(all_ / 2);
      out.mesh.triangle_partition.resize(all_ / 2);
    }
    out.title = name;
    out.work.surface = path;
    ViewOptions with = options_;
    with.work = out.work;
    out.work.document = first_document(with, out.mesh).document;
    return out;
  }
  void let_come() {
    const std::scoped_lock lock(mutex_);
    may_come_ = true;
    changed_.notify_all();
  }
  bool left() {
    const std::scoped_lock lock(mutex_);
    return left_;
  }
  /// As play(), of a session that begins with these files. Steps see every turn, drawn or not.
  Result<ViewResult> open_and(const std::vector<fs::path>& files, const std::vector<Step>& steps) {
    FileLoader loader(
        [this](const fs::path& path, Progress& progress, const TellCoarse& tell) { return read(path, progress, tell); },
        folder_ / "state" / "recent.json");
    EXPECT_TRUE(loader.open(files));
    SilentProgress silent;
    std::size_t at = 0;
    bool acted = false;
    auto out = run_view(
        TriMesh(), options_, silent,
        [&](const ViewMoment& moment) {
          if (at >= steps.size() || moment.frames == 0) return;
          if (!acted && steps[at].act) steps[at].act();
          if (!std::exchange(acted, true)) return;
          if (!steps[at].done(moment)) return;
          ++at;
          acted = false;
        },
        &loader);
    EXPECT_EQ(at, steps.size()) << "the step that never came true";
    expect_ended(out);
    shown_ = loader.files();
    return out;
  }
  static Step until(std::function<bool(const ViewMoment&)> done) { return {{}, std::move(done)}; }
  static std::size_t triangles(const ViewMoment& m) { return m.viewer.mesh().triangles.size(); }

  const std::size_t all_ = testing::lettered_box().triangles.size();
  std::vector<fs::path> shown_;
  bool tells_ = false;  ///< something coarse of the slow one

 private:
  fs::path folder_ =
      fs::temp_directory_path() /
      fmt::format("dubsar_live_{}_{}", ::getpid(), ::testing::UnitTest::GetInstance()->current_test_info()->name());
  std::mutex mutex_;  // for the two below
  std::condition_variable changed_;
  bool may_come_ = false, left_ = false;
};

TEST_F(LiveFiles, TheWindowIsThereBeforeTheSurfaceAndAnswersWhileItIsRead) {
  const auto done = open_and({file("slow.ply")},
                             {until([](const ViewMoment& m) { return m.frames > 0 && !m.viewer.has_surface(); }),
                              {[] { person_->key("f1"); }, [](const ViewMoment& m) { return m.viewer.ui().help; }},
                              {[] { person_->key("f1"); }, [](const ViewMoment& m) { return !m.viewer.ui().help; }},
                              {[this] { let_come(); }, [this](const ViewMoment& m) { return triangles(m) == all_; }},
                              end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->triangles, all_);
  ASSERT_TRUE(done->first.window_s && done->first.surface_s);
  EXPECT_LT(*done->first.window_s, *done->first.surface_s);
}

TEST_F(LiveFiles, SomethingCoarseStandsThereUntilTheSurfaceIsRead) {
  tells_ = true;
  Image coarse;
  const auto grey_at = [](const Image& image) { return static_cast<int>(image.at(kWidth / 2, 60)[1]); };
  const auto done = open_and(
      {file("slow.ply")},
      {until([](const ViewMoment& m) { return m.viewer.shows_surface() && m.drawn; }),
       until([&](const ViewMoment& m) {
         screen_ = m.presenter.window()->screen();
         coarse = shot();
         return !m.viewer.has_surface() && grey_at(coarse) > 60;
       }),
       {[this] { let_come(); }, [this](const ViewMoment& m) { return triangles(m) == all_ && !m.report.moving; }},
       end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->triangles, all_);
  ASSERT_TRUE(done->first.surface_s);
}

TEST_F(LiveFiles, TheWindowIsCalledByTheFileThatIsShownAndTheOneThatIsRead) {
  options_.window->title = "dubsar";
  options_.steps = {{0.3, "open " + file("slow.ply").string()}};
  const auto called = [](const std::string& words) {
    return [words](const ViewMoment&) { return std::regex_match(person_->title(), std::regex(words)); };
  };
  const auto done = open_and({file("a.ply")}, {until(called("dubsar: a\\.ply")),
                                               until(called("dubsar: a\\.ply, reading slow\\.ply: [1-9][0-9]? %")),
                                               {[this] { let_come(); }, called("dubsar: slow\\.ply")},
                                               end()});
  ASSERT_TRUE(done) << done.error().message;
  options_.steps.clear();
  const auto first = open_and({file("slow.ply")}, {until(called("dubsar: slow\\.ply")), end()});
  ASSERT_TRUE(first) << first.error().message;
}

TEST_F(LiveFiles, WithoutAFileTheDialogueIsOpenAndEscapeClosesItThenEnds) {
  const auto done =
      open_and({}, {until([](const ViewMoment& m) { return m.viewer.ui().choosing.open; }),
                    {[] { person_->key("escape"); }, [](const ViewMoment& m) { return !m.viewer.ui().choosing.open; }},
                    end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->triangles, 0u);
}

TEST_F(LiveFiles, ScriptsOpenFilesGoThroughThemAndUndoBelongsToEach) {
  options_.steps = {{0.0, "open " + file("b.ply").string()},
                    {0.1, "fog 40"},
                    {0.2, "previous_file"},
                    {0.3, "fog 20"},
                    {0.4, "undo"},
                    {0.5, "drawer light"}};
  const auto done =
      open_and({file("a.ply")},
               {until([](const ViewMoment& m) { return m.viewer.ui().drawer == "light"; }), close_drawer(), end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(shown_, (std::vector<fs::path>{file("a.ply"), file("b.ply")}));
  EXPECT_EQ(done->triangles, all_);
  EXPECT_EQ(done->document.fog, 0.0);
  options_.steps.insert(options_.steps.end() - 1, {0.45, "undo"});
  const auto twice = open_and({file("a.ply")}, {});
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().message, "at 0.45 s: undo: there is nothing to do it to now") << "what was done to the other";
}

TEST_F(LiveFiles, EscapeLeavesWhatIsReadAndTheSurfaceStays) {
  options_.steps = {{0.0, "open " + file("slow.ply").string()}};
  const auto done = open_and({file("a.ply")},
                             {until([this](const ViewMoment& m) { return triangles(m) == all_; }),
                              until([](const ViewMoment& m) { return m.viewer.opening(); }),
                              {[] { person_->key("escape"); }, [](const ViewMoment& m) { return !m.viewer.opening(); }},
                              until([this](const ViewMoment&) { return left(); }),
                              end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->triangles, all_);
}

TEST_F(LiveFiles, AFileThatCannotBeReadIsSaidAndThePresentOneStays) {
  options_.steps = {{0.0, "open " + file("bad.ply").string()}, {0.1, "fog 30"}};
  const auto done =
      open_and({file("a.ply")},
               {until([](const ViewMoment& m) { return m.viewer.document().fog > 0 && !m.viewer.opening(); }), end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->triangles, all_);
  EXPECT_EQ(shown_, std::vector<fs::path>{file("a.ply")}) << "it is not among the open ones";
  const auto alone = open_and({file("bad.ply")}, {});
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().message, "bad.ply: it is torn") << "what the session was begun for";
}

TEST_F(LiveFiles, ADamagedOneAmongOthersIsSaidAndTheNextIsShown) {
  const auto done = open_and({file("bad.ply"), file("b.ply"), file("a.ply")},
                             {until([this](const ViewMoment& m) { return triangles(m) == all_ / 2; }), end()});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->triangles, all_ / 2);
  EXPECT_EQ(shown_, (std::vector<fs::path>{file("b.ply"), file("a.ply")}));
}

TEST_F(LiveFiles, DroppedFilesAreOpened) {
  std::optional<testing::XDrop> drop;
  const auto done = open_and(
      {file("a.ply")}, {until([this](const ViewMoment& m) { return triangles(m) == all_; }),
                        {[&] {
                           drop.emplace(std::vector<std::string>{file("b.ply").string(), file("slow.ply").string()});
                         },
                         [this](const ViewMoment& m) { return triangles(m) < all_ && triangles(m) > 0; }},
                        end()});
  drop.reset();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(shown_, (std::vector<fs::path>{file("a.ply"), file("b.ply"), file("slow.ply")}));
}

}  // namespace
}  // namespace dubsar::app
