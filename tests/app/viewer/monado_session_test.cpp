// A whole session in Monado, which nobody here wrote: its null compositor shows the pictures to nobody, its "remote"
// driver is the headset, told by a socket where head and controllers are. Skipped with a sentence where there is no
// such Monado.

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/viewer/run_view.h"
#include "tests/display/spec.h"
#include "tests/display/test_meshes.h"
#include "tests/openxr_runtime/monado_wearer.h"

namespace dubsar::app {
namespace {

using testing::MadePose;
using testing::MonadoPacket;
using testing::MonadoWearer;
using Clock = std::chrono::steady_clock;

/// That of DUBSAR_MONADO_JSON, else one that a package or `ninja install` left; empty: none.
std::filesystem::path monado_file() {
  if (const char* const said = std::getenv("DUBSAR_MONADO_JSON"); said != nullptr) return said;
  for (const char* const prefix : {"/usr/local/share", "/usr/share"})
    if (const auto file = std::filesystem::path(prefix) / "openxr/1/openxr_monado.json"; std::filesystem::exists(file))
      return file;
  return {};
}

class MonadoSession : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path runtime = monado_file();
    if (runtime.empty())
      GTEST_SKIP() << "Monado is not installed (openxr_monado.json); docs/displays.md says how it is built for tests";
    home_ = std::filesystem::temp_directory_path() / ("dubsar_monado_" + std::to_string(::getpid()));
    std::filesystem::create_directories(home_ / "monado");
    port_ = static_cast<std::uint16_t>(42000 + ::getpid() % 20000);
    std::ofstream(home_ / "monado" / "config_v0.json")
        << R"({"active": "remote", "remote": {"version": 0, "view_count": 2, "port": )" << port_ << "}}\n";
    ::setenv("XR_RUNTIME_JSON", runtime.c_str(), 1);
    ::setenv("XR_LOADER_DEBUG", "none", 1);
    ::setenv("XDG_CONFIG_HOME", home_.c_str(), 1);
    ::setenv("XRT_COMPOSITOR_NULL", "1", 1);
    ::setenv("XRT_LOG", "error", 0);
    options_.mapping = default_mapping().value();
    options_.stage.shading = shading_preset("relief").value();
    options_.stage.display = dubsar::testing::spec("openxr");
    options_.stage.screen = {.width_px = 160, .height_px = 120, .window_w = 160, .window_h = 120};
    options_.inputs = {"openxr"};
    options_.time.fps = 30.0;
    options_.around.notices = false;
  }
  void TearDown() override { std::filesystem::remove_all(home_); }

  /// A session of `seconds`; `look(view, step)` sees what each picture shows, from the first with the wearer on. False:
  /// skipped.
  template <class F>
  bool session(double seconds, MonadoWearer& wearer, F look) {
    options_.time.longest_s = seconds;
    int step = 0;
    const auto done = run_view(testing::lettered_box(), options_, progress_, [&](const ViewMoment& m) {
      last_ = Clock::now();
      if (wearer.met() && m.viewer.sources().at(0).health == SourceHealth::kPresent)
        look(view_of(m.viewer.document()), step++);
    });
    over_ = Clock::now();
    if (!done) {
      ADD_FAILURE() << done.error().message;
      return false;
    }
    if (!wearer.met())
      [&] {
        GTEST_SKIP() << "this Monado has no remote driver in the process with packets mndrmt3: build it with "
                        "XRT_FEATURE_SERVICE=OFF (docs/displays.md)";
      }();
    return wearer.met();
  }
  std::filesystem::path home_;
  std::uint16_t port_ = 0;
  ViewOptions options_;
  SilentProgress progress_;
  Clock::time_point last_, over_;
};

/// The object's middle in LOCAL: half a metre ahead, 25 degrees down.
const glm::dvec3 kMiddle(0, -0.2331538, -0.5);

TEST_F(MonadoSession, TheObjectFollowsAHeldGripInSixDegreesOfFreedom) {
  MonadoWearer wearer(port_);
  const MadePose taken{{0.05, -0.2, -0.45}, glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 0, 1)))};
  constexpr int kStill = 6, kPlaces = 12;  // pictures at each place: what was told has reached the last of them
  const auto place = [&](int i) {
    const double part = std::sin(1.7 * i);
    return MadePose{taken.position + glm::dvec3(0.1 * part, 0.06 * std::cos(2.3 * i), 0.012 * i),
                    glm::angleAxis(0.23 * i, glm::normalize(glm::dvec3(1, 2 + part, -0.5))) * taken.rotation};
  };
  double worst_m = 0.0, worst_deg = 0.0, went_m = 0.0, turned_deg = 0.0;
  const auto look = [&](const ViewState& view, int step) {
    const int turn = step / kStill - 2;  // first beside the object, then closed
    wearer.tell([&](MonadoPacket& packet) {
      packet.right.pose = testing::monado_pose(turn >= 0 ? place(turn) : taken);
      if (turn == -1) packet.right.squeeze = 1.0f;
    });
    if (turn < 0 || step % kStill != kStill - 1) return;
    const MadePose is = place(turn);
    const glm::dquat by = is.rotation * glm::conjugate(taken.rotation);
    const glm::dvec3 moved = is.position + by * (kMiddle - taken.position) - kMiddle;
    worst_m = std::max(worst_m, glm::distance(0.3 * glm::dvec3(view.pan, view.nearer), moved));
    worst_deg = std::max(worst_deg, turn_between_deg(view.rotation, by));
    went_m = std::max(went_m, glm::length(moved));
    turned_deg = std::max(turned_deg, turn_between_deg(by, {1, 0, 0, 0}));
  };
  if (!session((kPlaces + 6) * kStill / 30.0, wearer, look)) return;
  ASSERT_GT(went_m, 0.1) << "the session was too short to see it";
  ASSERT_GT(turned_deg, 90.0);
  EXPECT_LE(worst_m, 0.5e-3) << "metres";
  EXPECT_LE(worst_deg, 0.2);
  RecordProperty("worst_um", static_cast<int>(1e6 * worst_m));
  RecordProperty("worst_millidegrees", static_cast<int>(1e3 * worst_deg));
}

TEST_F(MonadoSession, FingersThatMonadoClosesRoundAControllerMoveNothing) {
  MonadoWearer wearer(port_);
  int seen = 0;
  double moved = 0.0;
  const auto look = [&](const ViewState& view, int step) {
    wearer.tell([&](MonadoPacket& packet) {
      for (testing::MonadoController* const each : {&packet.left, &packet.right}) {
        each->hand_tracking_active = 1;
        std::fill(std::begin(each->curl), std::end(each->curl), step < 10 ? 0.0f : 1.0f);
        each->squeeze = 0.0f;
        const double aside = each == &packet.left ? -0.02 : 0.02;
        each->pose = testing::monado_pose(
            {{aside + 0.1 * std::sin(0.1 * step), -0.23, -0.5}, glm::angleAxis(0.05 * step, glm::dvec3(0, 1, 0))});
      }
    });
    ++seen;
    moved = std::max({moved, glm::length(view.pan), std::abs(view.nearer),
                      turn_between_deg(view.rotation, {1, 0, 0, 0}), std::abs(view.zoom - 1.0)});
  };
  if (!session(3.0, wearer, look)) return;
  ASSERT_GT(seen, 40);
  EXPECT_EQ(moved, 0.0);
}

TEST_F(MonadoSession, TheEndOfASessionTakesLessThanASecond) {
  MonadoWearer wearer(port_);
  if (!session(2.0, wearer, [](const ViewState&, int) {})) return;
  const double took_s = std::chrono::duration<double>(over_ - last_).count();
  EXPECT_LT(took_s, 1.0);
  RecordProperty("took_ms", static_cast<int>(1e3 * took_s));
}

}  // namespace
}  // namespace dubsar::app
