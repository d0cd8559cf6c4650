// Whole sessions with pictures: simulated people before simulated displays.

#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <thread>

#include "app/viewer/run_view.h"
#include "core/base/system/log.h"
#include "devices/head_tracker/vrpn_protocol.h"
#include "devices/transport/sim_transport.h"
#include "display/render/context/context_egl.h"
#include "display/render/passes/compose_pass.h"
#include "input/simulated/script.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"

namespace dubsar::app {
namespace {

namespace fs = std::filesystem;
constexpr double kRad = std::numbers::pi / 180.0;

class SessionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dubsar_session_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
    options_.mapping = default_mapping().value();
    options_.stage.shading = shading_preset("relief").value();
    options_.time.fps = 30.0;
    options_.time.longest_s = 60.0;
    options_.around.notices = false;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  fs::path folder_;
  ViewOptions options_;
  SilentProgress progress_;
};

/// `look` sees every picture.
Result<ViewResult> run_offscreen(const TriMesh& mesh, const ViewOptions& options, Progress& progress,
                                 const std::function<void(const Image&, const PictureReport&)>& look = {}) {
  return run_view(mesh, options, progress, [&](const ViewMoment& moment) {
    if (look) look(moment.presenter.picture().value(), moment.report);
  });
}

double differing_share(const Image& a, const Image& b) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) differ += std::abs(a.pixels[i] - b.pixels[i]) > 8;
  return static_cast<double>(differ) / static_cast<double>(a.pixels.size());
}

TEST_F(SessionTest, LargeBlocksThatWereFreedDoNotStayWithTheProcess) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "the C library's memory is not used here";
  options_.stage.display = testing::spec("quilt:columns=2,rows=1,width=64,height=64,aspect=1,cone=40");
  options_.inputs = {
      "scripted:" +
      file("short.json", R"({"seed": 1, "duration_s": 5, "visitor": {"yaw_deg": 40, "pitch_deg": 15, "zoom": 1.3}})")};
  options_.time.longest_s = 0.2;
  const auto mapped_one_by_one = [&] {
    const bool done = run_offscreen(testing::lettered_box(), options_, progress_).has_value();
    constexpr std::size_t kMiB = 1 << 20, kBlocks = 16;
    std::vector<std::vector<char>> blocks(kBlocks);
    blocks[0].resize(16 * kMiB);
    blocks[0] = {};
    const std::size_t before = mallinfo2().hblks;
    for (auto& block : blocks) block.resize(4 * kMiB);
    return done && mallinfo2().hblks >= before + kBlocks / 2;
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a new process: what other cases freed would be taken first
  EXPECT_EXIT(std::exit(mapped_one_by_one() ? 0 : 1), ::testing::ExitedWithCode(0), "");
}

TEST_F(SessionTest, AVisitorsHandsTurnAndZoomTheObjectOnAQuilt) {
  options_.stage.display = testing::spec("quilt:columns=4,rows=2,width=256,height=128,aspect=1,cone=40");
  options_.inputs = {"scripted:" +
                     file("visitor.json", R"({"seed": 4, "duration_s": 60, "noise_mm": 0.5, "bystanders": 1,
      "hand_dropouts": {"per_s": 0.3}, "visitor": {"yaw_deg": 40, "pitch_deg": 15, "zoom": 1.3}})")};
  options_.time.longest_s = 70;
  options_.files.record = folder_ / "recording.jsonl";
  Image first, last;
  const ViewResult done =
      run_offscreen(testing::lettered_box(), options_, progress_, [&](const Image& picture, const PictureReport&) {
        if (first.pixels.empty()) first = picture;
        last = picture;
      }).value();
  ASSERT_EQ(first.width, 256);
  EXPECT_GT(differing_share(first, last), 0.1);
  EXPECT_LE(turn_between_deg(done.view.rotation, turn_of({15 * kRad, 0, 0}) * turn_of({0, 40 * kRad, 0})), 5.0);
  EXPECT_NEAR(done.view.zoom, 1.3, 0.065);
  EXPECT_LE(done.largest_turn_deg, 2.0);
  // The script's tracker is 20 ms late and samples each 11.1 ms.
  EXPECT_GE(done.input_age_ms.quantile(0.5), 20.0);
  EXPECT_LE(done.input_age_ms.quantile(0.95), 20.0 + 11.2);
  EXPECT_LE(done.input_age_ms.quantile(1.0), 33.4);  // the very first sample waits for its frame

  options_.inputs = {"replay:" + options_.files.record.string()};
  options_.files.record.clear();
  Image replayed;
  const ViewResult again =
      run_offscreen(testing::lettered_box(), options_, progress_, [&](const Image& picture, const PictureReport&) {
        replayed = picture;
      }).value();
  EXPECT_LT(turn_between_deg(again.view.rotation, done.view.rotation), 0.05);
  EXPECT_LT(differing_share(last, replayed), 0.01);
}

TEST_F(SessionTest, EachEyeOfAMovingScholarSeesItsOwnViewInEveryFrame) {
  fs::create_directories(folder_ / "panels");
  file("panels/panel.json",
       R"([{"name": "small-tracked", "title": "test", "kind": "tracked", "width_px": 480, "height_px": 270,
      "width_mm": 43.2, "optics": {"pitch_mm": 0.200884, "tan_slant": 0.333333, "reduced_gap_mm": 0.956589,
      "refractive_index": 1.5, "phase0": 0.0, "spot_sigma_periods": 0.1}, "design_distance_mm": 600, "ipd_mm": 63}])");
  options_.stage.catalog = std::make_shared<SinkCatalog>(load_panels(folder_ / "panels"));
  options_.stage.display = testing::spec("lenticular:small-tracked");
  const std::string text = R"({"duration_s": 3, "latency_ms": 40, "rate_hz": 60, "noise_mm": 0.3, "heads": [{"keys": [
      {"t": 0, "at_mm": [-80, 0, 600]}, {"t": 1.2, "at_mm": [60, 20, 560]}, {"t": 2.6, "at_mm": [-60, 0, 640]}, {"t": 3, "at_mm": [-60, 0, 640]}]}]})";
  options_.inputs = {"scripted:" + file("scholar.json", text)};
  options_.time.fps = 60;
  options_.time.longest_s = 2.9;
  const Script script = parse_script(text, "scholar").value();
  int frame = 0, checked = 0;
  double worst = 0.0, unfollowed = 0.0, squares = 0.0;
  (void)run_offscreen(testing::lettered_box(), options_, progress_, [&](const Image&, const PictureReport& report) {
    const auto head = sample_head(script.heads[0], frame++ / 60.0);
    if (frame < 20 || !head) return;  // the tracker needs its first samples
    ASSERT_TRUE(report.light);
    ASSERT_EQ(report.head, Presence::kTracked);
    const glm::dvec3 left = 1e3 * *head - glm::dvec3(31.5, 0, 0), right = 1e3 * *head + glm::dvec3(31.5, 0, 0);
    const EyeLight seen_left = light_at(*report.light, left, 32), seen_right = light_at(*report.light, right, 32);
    EXPECT_EQ(seen_left.main_view, 0) << frame;
    EXPECT_EQ(seen_right.main_view, 1) << frame;
    worst = std::max({worst, seen_left.crosstalk, seen_right.crosstalk});
    PanelLight fixed_weave = *report.light;  // the same panel, woven for a head that does not move
    fixed_weave.woven_for = {};
    unfollowed = std::max(unfollowed, light_at(fixed_weave, left, 32).shares[1]);
    const glm::dvec3 error = report.viewer.centre_mm() - 1e3 * *head;
    squares += glm::dot(error, error);
    ++checked;
  }).value();
  EXPECT_GT(checked, 140);
  EXPECT_LE(worst, 0.05);      // 3 to 4 % at rest
  EXPECT_GT(unfollowed, 0.5);  // without following, an eye gets the other one's view
  EXPECT_LE(std::sqrt(squares / checked), 2.5);
  RecordProperty("worst_crosstalk", std::to_string(worst));
  RecordProperty("head_rms_mm", std::to_string(std::sqrt(squares / checked)));
}

TEST_F(SessionTest, AHead120MillimetresToTheRightAsOpentrackSendsItSeesWhatIsSeenFromThere) {
  options_.stage.display = testing::spec("side_by_side");
  options_.stage.screen = {.width_px = 480, .height_px = 270, .window_w = 480, .window_h = 270};
  options_.time.longest_s = 0.5;
  const auto last_picture = [&](const std::string& input) {
    options_.inputs = {input};
    Image last;
    const auto done = run_offscreen(testing::lettered_box(), options_, progress_,
                                    [&](const Image& picture, const PictureReport&) { last = picture; });
    EXPECT_TRUE(done) << done.error().message;
    return last;
  };
  // opentrack's datagram: x = -12.0 cm as a double, then y, z, yaw, pitch and roll, all 0.
  std::string datagrams = "dubsar-recording 1\ndriver opentrack\n0 o\n";
  for (int i = 0; i < 70; ++i)
    datagrams += std::to_string(i * 16'000'000) + " r 00000000000028c0" + std::string(80, '0') + "\n";
  const auto person_at = [](int x_mm) {
    const std::string key = ", \"at_mm\": [" + std::to_string(x_mm) + ", 0, 600]}";
    return R"({"duration_s": 2, "latency_ms": 0, "noise_mm": 0, "heads": [{"ipd_mm": 63, "keys": [{"t": 0)" + key +
           R"(, {"t": 2)" + key + "]}]}";
  };
  const Image seen = last_picture("head:opentrack,replay=" + file("head.txt", datagrams));
  const Image truth = last_picture("scripted:" + file("right.json", person_at(120)));
  const Image mirrored = last_picture("scripted:" + file("left.json", person_at(-120)));
  EXPECT_EQ(seen.pixels, truth.pixels);
  EXPECT_GT(differing_share(seen, mirrored), 0.01) << "the picture says where the head is";
}

TEST_F(SessionTest, RefusesWhatCannotRun) {
  const auto kind = [&](auto change) {
    ViewOptions options = options_;
    options.inputs = {"scripted:" + file("short.json", R"({"duration_s": 0.1})")};
    change(options);
    const auto done = run_offscreen(testing::lettered_box(), options, progress_);
    return done ? std::string("accepted") : std::to_string(exit_code(done.error().kind));
  };
  EXPECT_EQ(kind([](ViewOptions& o) { o.inputs.clear(); }), "64");
  EXPECT_EQ(kind([](ViewOptions& o) { o.inputs = {"mouse"}; }), "69");
  EXPECT_EQ(kind([](ViewOptions& o) { o.stage.display = {"hologram"}; }), "64");
  EXPECT_EQ(kind([](ViewOptions& o) { o.time.fps = 0; }), "64");
  EXPECT_EQ(kind([](ViewOptions& o) { o.files.frames = "/proc/nowhere/x"; }), "73");
}

TEST_F(SessionTest, AVisitorsHandsInInfraredPicturesTurnAndZoomTheObject) {
  options_.stage.screen.width_px = options_.stage.screen.window_w = 64;
  options_.stage.screen.height_px = options_.stage.screen.window_h = 64;
  // The script's hands are rendered, sent as USB transfers, found again by the hand tracker, and steer the view.
  options_.inputs = {"leap:simulate=" + file("visitor.json", R"({"seed": 1, "duration_s": 40, "rate_hz": 115,
      "visitor": {"yaw_deg": -50, "pitch_deg": 10, "zoom": 1.3}})")};
  options_.time.longest_s = 45;
  const ViewResult done = run_offscreen(testing::lettered_box(), options_, progress_).value();
  EXPECT_LE(turn_between_deg(done.view.rotation, turn_of({10 * kRad, 0, 0}) * turn_of({0, -50 * kRad, 0})), 5.0);
  EXPECT_NEAR(done.view.zoom, 1.3, 0.065);
  EXPECT_LE(done.largest_turn_deg, 2.0);
  EXPECT_LT(done.seconds, 40.0);  // the visitor was content
}

TEST_F(SessionTest, HandsSteerThoughAPictureTakesAQuarterOfASecond) {
  ManualClock clock(1'000'000'000);
  InputController steering(options_.mapping, {}, {});
  InputConfig config;
  config.seen_view = [seen = steering.seen()] { return seen->look(); };
  config.clock = &clock;
  config.simulated_time = true;
  steering.input().add(make_input("scripted:" + file("visitor.json", R"({"seed": 4, "duration_s": 90, "noise_mm": 0.5,
      "visitor": {"yaw_deg": 40, "pitch_deg": 15, "zoom": 1.3}})"),
                                  config)
                           .value());
  int heard = 0;
  steering.on_input([&](TimestampNs, const InputFrame& frame) { heard += frame.hands.empty() ? 0 : 1; });
  for (int step = 0; step < 90 * 120 && !steering.input().finished(); ++step, clock.advance(8'333'333)) {
    steering.steer(clock.now());
    if (step % 30 == 0) static_cast<void>(steering.look(clock.now(), clock.now()));  // a picture every 250 ms
  }
  EXPECT_GT(heard, 1000);
  const ViewState seen = steering.look(clock.now(), clock.now()).view;
  EXPECT_LE(turn_between_deg(seen.rotation, turn_of({15 * kRad, 0, 0}) * turn_of({0, 40 * kRad, 0})), 5.0);
  EXPECT_NEAR(seen.zoom, 1.3, 0.065);
}

TEST_F(SessionTest, AMistakeInTheThreadThatSteersIsSaidAndTheProgramGoesOn) {
  std::mutex mutex;
  std::string said;
  set_log_handler([&](LogLevel, std::string_view text) {
    const std::scoped_lock lock(mutex);
    said = text;
  });
  InputController steering(options_.mapping, {}, {});
  steering.on_input([](TimestampNs, const InputFrame&) { throw std::runtime_error("no such hand"); });
  const SteadyClock clock;
  steering.run(clock);
  for (int i = 0; i < 400; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const std::scoped_lock lock(mutex);
    if (!said.empty()) break;
  }
  steering.stop();
  set_log_handler({});
  EXPECT_EQ(said, "the thread that steers: stopped by a mistake of this program: no such hand; whoever draws steers");
}

TEST_F(SessionTest, TheAgeOfTheInputIsTheTimeFromItsMeasurementToTheCameras) {
  constexpr TimestampNs kMs = 1'000'000,
                        kServerOrigin = 1'700'000'000'000'000'000;  // the server's clock counts from 1970
  ManualClock clock(1000 * kMs);
  SimDevice server("simulated VRPN server", false);
  InputController steering(options_.mapping, {}, {});
  InputConfig config;
  config.clock = &clock;
  config.simulated_time = true;
  config.reach_device = [&](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
    return OpenTransport([&] { return server.open(); });
  };
  steering.input().add(make_input("head:vrpn", config).value());
  const auto draw = [&] {
    steering.steer(clock.now());
    return steering.look(clock.now(), clock.now());
  };
  const auto send_pose_measured = [&](TimestampNs time) {
    VrpnMessage message = vrpn_pose_message(0, 4, 0, {{0.02, 0.0, 0.6}, {1, 0, 0, 0}});
    message.seconds = static_cast<std::uint32_t>((kServerOrigin + time) / 1'000'000'000);
    message.microseconds = static_cast<std::uint32_t>((kServerOrigin + time) / 1000 % 1'000'000);
    server.send(format_vrpn(message));
  };
  EXPECT_FALSE(draw().input_age);
  server.send(vrpn_cookie());
  server.send(format_vrpn(vrpn_name_message(-1, 0, "Tracker0")));
  server.send(format_vrpn(vrpn_name_message(-2, 4, "vrpn_Tracker Pos_Quat")));
  send_pose_measured(clock.now());  // the quickest there is
  ASSERT_TRUE(draw().input_age);
  for (const TimestampNs lag : {40, 25, 90}) {
    clock.advance(200 * kMs);
    send_pose_measured(clock.now() - lag * kMs);
    const Steered report = draw();
    ASSERT_TRUE(report.input_age);
    EXPECT_NEAR(1e-6 * static_cast<double>(*report.input_age), static_cast<double>(lag), 0.1);
    EXPECT_NEAR(1e3 * report.eyes.right_m.x - 31.5, 20.0, 1e-3);
    EXPECT_FALSE(draw().input_age);  // nothing new
  }
}

}  // namespace
}  // namespace dubsar::app
