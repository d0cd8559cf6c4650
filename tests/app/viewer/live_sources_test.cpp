// Sources that come and go while a session runs, its recording and its end.

#include <atomic>

#include "app/calibration/adjust_window.h"
#include "core/base/files/atomic_file.h"
#include "tests/app/viewer/live_fixture.h"
#include "tests/input/recorded_frames.h"

namespace dubsar::app {
namespace {

TEST_F(Live, KeysOnAPanelChangeItsFiguresAndSaveThem) {
  const auto root = std::filesystem::temp_directory_path() / ("dubsar_tuner_" + std::to_string(::getpid()));
  const auto folder = root / "panels";
  auto tuner = LensTuner::create(options_.stage.catalog, folder, "lens-sheet-24-5-views");
  ASSERT_TRUE(tuner) << tuner.error().message;
  const std::string first = tuner->text();
  options_.stage.display = tuner->display();
  options_.stage.subject = Subject::kPattern;
  options_.displays = {{"mono"}};
  std::string taken;
  options_.commands = tuner->commands();
  for (Command& command : options_.commands)
    command.run = [&taken, run = command.run, key = command.keys.front().key](Editor& editor,
                                                                              const std::string& argument) {
      taken += key + " ";
      return run(editor, argument);
    };
  Image before, moved, back;
  const auto took = [&](const char* keys) { return [&, keys](const ViewMoment&) { return taken == keys; }; };
  const auto done = play({
      look(before),
      {[&] { person_->key("right"); }, took("right ")},
      {[&] { person_->key("right"); }, took("right right ")},
      look(moved),
      {[&] { person_->key("s"); }, took("right right s ")},
      {[&] { person_->key("0"); }, took("right right s 0 ")},
      look(back),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(differing_share(before, moved), 0.001);
  EXPECT_EQ(before.pixels, back.pixels);
  EXPECT_EQ(tuner->text(), first);
  EXPECT_TRUE(tuner->saved());
  const auto profile = load_panels(folder).find("lens-sheet-24-5-views");
  ASSERT_TRUE(profile) << profile.error().message;
  ASSERT_TRUE(profile->lenses.adjustment.center);
  const auto untouched = built_in_panels().find("lens-sheet-24-5-views");
  EXPECT_NEAR(*profile->lenses.adjustment.center - untouched->sheet->center, 0.02, 1e-9);
  EXPECT_EQ(turn_between_deg(done->view.rotation, {1, 0, 0, 0}), 0.0) << "the arrows belong to the panel";
  std::filesystem::remove_all(root);
}

/// A device that a test plugs in and out; it pushes the object to the right while it is there.
struct FakeDevice {
  std::atomic<bool> plugged{true};
  std::atomic<int> starts{0};
};
class FakeSource final : public InputSource {
 public:
  explicit FakeSource(std::shared_ptr<FakeDevice> device) : device_(std::move(device)) {}
  std::string_view name() const noexcept override { return "fake"; }
  Result<void> start() override { return {}; }
  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    if (!device_->plugged) return Freshness::kLost;
    newest.time = now;
    return Freshness::kNew;
  }

 private:
  std::shared_ptr<FakeDevice> device_;
};

TEST_F(Live, ALostSourceIsNamedAndUsedAgainAndAMissingOneIsTriedAgain) {
  auto device = std::make_shared<FakeDevice>();
  std::atomic<bool> second_is_there{false};
  options_.inputs = {"mouse", "fake", "absent"};
  options_.sources.make = [&](std::string_view spec,
                              const InputConfig& config) -> Result<std::unique_ptr<InputSource>> {
    if (spec == "absent" && !second_is_there)
      return fail(ErrorKind::kUnavailable, "input absent: no such device is plugged in");
    if (spec == "absent" || spec == "fake") {
      ++device->starts;
      return std::make_unique<FakeSource>(device);
    }
    return make_input(spec, config);
  };
  std::string reason;
  const auto health = [](std::size_t index, SourceHealth wanted) {
    return [index, wanted](const ViewMoment& m) {
      return m.viewer.sources().size() == 3 && m.viewer.sources()[index].health == wanted;
    };
  };
  const auto done = play({
      {{}, health(1, SourceHealth::kPresent)},
      {{},
       [&](const ViewMoment& m) {
         reason = m.viewer.sources()[2].reason;
         return m.viewer.sources()[2].health == SourceHealth::kMissing;
       }},
      {[&] { device->plugged = false; }, health(1, SourceHealth::kLost)},
      {[&] { device->plugged = true; }, health(1, SourceHealth::kPresent)},
      {[&] {
         second_is_there = true;
         person_->key("f5");
       },
       health(2, SourceHealth::kPresent)},
      {[&] {
         person_->key("f1");
         person_->key("2");
       },
       health(1, SourceHealth::kOff)},
      {[&] { person_->key("2"); }, health(1, SourceHealth::kPresent)},
      {[&] { person_->key("f1"); }, [](const ViewMoment& m) { return !m.viewer.ui().help; }},
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_NE(reason.find("no such device"), std::string::npos) << reason;
  EXPECT_EQ(device->starts, 3);
  ASSERT_EQ(done->rows.size(), 3u);
  EXPECT_EQ(done->rows[2].health, SourceHealth::kPresent);
}

TEST_F(Live, MistakesInTheInputsAreRefusedAndNothingElseIsTriedInTheirPlace) {
  SilentProgress progress;
  options_.inputs = {"mouse", "crystal_ball"};
  auto done = run_view(testing::lettered_box(), options_, progress);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kUsage) << done.error().message;
  options_.inputs = {"absent"};
  options_.sources.make = [](std::string_view, const InputConfig&) -> Result<std::unique_ptr<InputSource>> {
    return fail(ErrorKind::kPermission, "input absent: not allowed");
  };
  done = run_view(testing::lettered_box(), options_, progress);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kPermission);
}

TEST_F(Live, ItEndsByClosingByTimeAndBySignal) {
  SilentProgress cancelled;
  options_.time.longest_s = 0.3;
  SilentProgress progress;
  auto done = run_view(testing::lettered_box(), options_, progress);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GE(done->seconds, 0.3);
  EXPECT_LT(done->seconds, 2.3);
  options_.time.longest_s = 20;
  done = run_view(testing::lettered_box(), options_, progress, [](const ViewMoment& m) {
    if (m.frames > 0) m.presenter.window()->close();
  });
  ASSERT_TRUE(done);
  EXPECT_LT(done->seconds, 5.0);
  const TimestampNs start = SteadyClock().now();
  TimestampNs asked = start;
  options_.files.record = std::filesystem::temp_directory_path() / fmt::format("dubsar_live_{}.jsonl", ::getpid());
  done = run_view(testing::lettered_box(), options_, cancelled, [&](const ViewMoment& m) {
    if (m.frames == 0 || cancelled.cancelled()) return;
    asked = SteadyClock().now();
    cancelled.cancel();
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kCancelled);
  EXPECT_LT(SteadyClock().now() - asked, 2'000'000'000);
  EXPECT_TRUE(frames_of(read_text_file(options_.files.record).value(), "what was recorded before Ctrl-C"));
  std::filesystem::remove(options_.files.record);
}

TEST_F(Live, KeysThatTheSessionItselfTakesAreInItsRecording) {
  options_.files.record = std::filesystem::temp_directory_path() / fmt::format("dubsar_live_keys_{}.jsonl", ::getpid());
  const auto help = [](bool open) { return [open](const ViewMoment& m) { return m.viewer.ui().help == open; }; };
  const auto done = play({{[] { person_->key("f1"); }, help(true)},
                          {[] { person_->key("f1"); }, help(false)},
                          {[] { person_->key("right"); },
                           [](const ViewMoment& m) {
                             return turn_between_deg(m.report.view.rotation, {1, 0, 0, 0}) > 4.9;
                           }},
                          end_without_work()});
  ASSERT_TRUE(done) << done.error().message;
  const auto frames = frames_of(read_text_file(options_.files.record).value(), "recording");
  ASSERT_TRUE(frames) << frames.error().message;
  std::string keys;
  for (const RecordedFrame& frame : *frames)
    for (const InputEvent& event : frame.frame.events)
      if (event.kind == EventKind::kKey && event.down) keys += event.key + " ";
  EXPECT_EQ(keys, "f1 f1 right escape ");
  std::filesystem::remove(options_.files.record);
}

}  // namespace
}  // namespace dubsar::app
