// make_gallery_strips SURFACE SCRIPT FOLDER: a visit to the kiosk as strips of the documentation, on a flat panel, for
// red and cyan glasses, and as a quilt; and the tour that a sealed tablet has. `./do strips gallery` runs it.

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <span>

#include "app/cli/mesh_input.h"
#include "app/kiosk/kiosk_controller.h"
#include "app/viewer/run_view.h"
#include "core/base/progress.h"
#include "core/image_io/png_file.h"
#include "tests/app/viewer/scripted_sessions.h"
#include "tests/app/viewer/strip_sheet.h"

namespace dubsar::app::test {
namespace {

constexpr double kFps = 20.0, kLongestSeconds = 31.0;
constexpr int kEvery = 22;  // steps a picture
constexpr int kColumns = 4, kRows = 3, kTileWidth = 480, kTileHeight = 360;
/// Seconds of the script, each that of a picture: nobody, a hand is there, it takes hold, it has turned the tablet,
/// rests on the button, what was inside is out, everything is as at the beginning.
constexpr std::array<double, 7> kMoments{1.1, 4.4, 6.6, 7.7, 12.1, 15.4, 29.7};

/// A gallery's window of that size, led by a script of hands.
Result<ViewOptions> gallery_options(const std::string& script, int width, int height) {
  ViewOptions options;
  DUBSAR_ASSIGN(options.mapping, gallery_mapping());
  DUBSAR_ASSIGN(options.stage.shading, shading_preset("relief"));
  Screen& screen = options.stage.screen;
  screen.width_px = screen.window_w = width;
  screen.height_px = screen.window_h = height;
  screen.height_mm = screen.width_mm * height / width;
  options.stage.samples = 2;
  options.stage.room.gallery = true;
  options.inputs = {"scripted:path=" + script};
  options.around.notices = false;
  options.work.upright = true;
  return options;
}

/// Of a kiosk with one object.
KioskParts gallery_parts(const ViewOptions& options) {
  KioskParts parts;
  parts.profile.objects = {{.file = "tablet", .title = {{"en", "A sealed contract"}}}};
  parts.profile.pin = "90210735";
  parts.zone = {1e-3 * options.mapping.hands.zone_min_mm, 1e-3 * options.mapping.hands.zone_max_mm};
  parts.wall = [] { return WallTime{1'790'000'000, 720}; };
  return parts;
}

Result<std::vector<Image>> visit(const TriMesh& mesh, const std::string& script, const std::string& display, int width,
                                 int height) {
  DUBSAR_ASSIGN(ViewOptions options, gallery_options(script, width, height));
  DUBSAR_ASSIGN(options.stage.display, parse_sink_spec(display));
  options.time.fps = kFps;
  options.time.longest_s = kLongestSeconds;
  options.files.every = kEvery;
  KioskParts parts = gallery_parts(options);
  parts.profile.idle_reset_s = 8.0;
  parts.profile.attract_after_s = 2.0;
  KioskController guide(std::move(parts));
  options.guide = &guide;
  SilentProgress progress;
  std::vector<Image> out;
  Result<void> read;
  DUBSAR_TRY(run_view(mesh, options, progress, [&](const ViewMoment& moment) {
    const double at_s = (moment.frames - 1) * options.files.every / kFps;
    if (!moment.drawn || out.size() == kMoments.size() || at_s < kMoments[out.size()]) return;
    auto picture = moment.presenter.picture();
    if (picture)
      out.push_back(*std::move(picture));
    else
      read = tl::unexpected<Error>(picture.error());
  }));
  DUBSAR_TRY(read);
  return out;
}

/// Nobody is there; the tour is asked for as a finger on its button would.
class TourStarter final : public SessionController {
 public:
  explicit TourStarter(KioskController& kiosk) : kiosk_(kiosk) {}
  bool takes(const InputEvent& event, TimestampNs now) override { return kiosk_.takes(event, now); }
  void presented(TimestampNs now) override { kiosk_.presented(now); }
  Guidance lead(const SessionMoment& moment) override {
    Guidance out = kiosk_.lead(moment);
    for (const DwellButtonPicture& button : out.picture ? out.picture->buttons : std::vector<DwellButtonPicture>()) {
      if (button.button != DwellButton::kTour || began_ >= 0 || !moment.steered.hands.empty()) continue;
      InputEvent event;
      event.kind = EventKind::kButton;
      event.down = true;
      event.at = button.at * glm::dvec2(moment.window_mm.x / moment.window_mm.y, 1.0);
      kiosk_.takes(event, moment.now);
      began_ = moment.now;
    }
    since_s_ = began_ < 0 ? -1.0 : 1e-9 * static_cast<double>(moment.now - began_);
    return out;
  }
  double since_s() const noexcept { return since_s_; }  ///< of the tour; below 0: not yet

 private:
  KioskController& kiosk_;
  TimestampNs began_ = -1;
  double since_s_ = -1.0;
};

/// Pictures of the tour that a sealed tablet has, at these seconds of it.
Result<std::vector<Image>> tour(const TriMesh& mesh, const std::string& script, std::span<const double> moments,
                                int width, int height) {
  DUBSAR_ASSIGN(ViewOptions options, gallery_options(script, width, height));
  options.time.fps = 5.0;
  options.time.longest_s = 20.0 + moments.back();
  options.files.every = 5;
  KioskParts parts = gallery_parts(options);
  KioskController guide(std::move(parts));
  TourStarter starter(guide);
  options.guide = &starter;
  SilentProgress progress;
  std::vector<Image> out;
  Result<void> read;
  DUBSAR_TRY(run_view(mesh, options, progress, [&](const ViewMoment& moment) {
    if (!moment.drawn || out.size() == moments.size() || starter.since_s() < moments[out.size()]) return;
    auto picture = moment.presenter.picture();
    if (picture)
      out.push_back(*std::move(picture));
    else
      read = tl::unexpected<Error>(picture.error());
  }));
  DUBSAR_TRY(read);
  return out;
}

/// Its five steps, and the envelope going in six.
Result<void> make_tour(const TriMesh& mesh, const std::string& script, const std::string& folder) {
  constexpr std::array<double, 6> kSteps{6.0, 15.0, 31.0, 41.0, 46.0, 61.0}, kPeel{26.5, 29.0, 30.5, 32.0, 33.5, 37.0};
  std::vector<std::vector<Image>> rows(2);
  DUBSAR_ASSIGN(const auto steps, tour(mesh, script, kSteps, 960, 540));
  DUBSAR_ASSIGN(const auto peel, tour(mesh, script, kPeel, 960, 540));
  for (const Image& picture : steps) rows[0].push_back(testing::scaled(picture, 320, 180));
  for (const Image& picture : peel) rows[1].push_back(testing::scaled(picture, 320, 180));
  return write_png(folder + "/strip_tour.png", testing::sheet(rows));
}

Result<void> make(const std::string& surface, const std::string& script, const std::string& folder) {
  SilentProgress progress;
  DUBSAR_ASSIGN(const TriMesh mesh, load_mesh({surface, {}, true}, progress));
  DUBSAR_TRY(make_tour(mesh, (std::filesystem::path(script).parent_path() / "tour.json").string(), folder));
  std::vector<std::vector<Image>> rows(4);
  DUBSAR_ASSIGN(const auto flat, visit(mesh, script, "mono", 800, 600));
  DUBSAR_ASSIGN(const auto red_cyan, visit(mesh, script, "anaglyph", 800, 600));
  const std::string quilt = fmt::format("quilt:columns={},rows={},width={},height={},aspect={:.4f},cone=35", kColumns,
                                        kRows, kColumns * kTileWidth, kRows * kTileHeight, 4.0 / 3.0);
  DUBSAR_ASSIGN(const auto quilts, visit(mesh, script, quilt, 800, 600));
  for (const Image& picture : flat) rows[0].push_back(testing::scaled(picture, 240, 180));
  for (const Image& picture : red_cyan) rows[1].push_back(testing::scaled(picture, 240, 180));
  for (const Image& picture : quilts) {
    rows[2].push_back(testing::scaled(picture, 240, 180));
    rows[3].push_back(testing::scaled(testing::quilt_tile(picture, kColumns, kRows, kColumns * kRows / 2), 240, 180));
  }
  return write_png(folder + "/strip_gallery.png", testing::sheet(rows));
}

}  // namespace
}  // namespace dubsar::app::test

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: make_gallery_strips SURFACE SCRIPT FOLDER\n");
    return dubsar::exit_code(dubsar::ErrorKind::kUsage);
  }
  const auto done = dubsar::app::test::make(argv[1], argv[2], argv[3]);
  if (done) return 0;
  fmt::print(stderr, "{}\n", done.error().message);
  return dubsar::exit_code(done.error().kind);
}
