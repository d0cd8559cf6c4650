// make_gallery_strips SURFACE SCRIPT FOLDER: a visit to the kiosk as strips of the documentation, on a flat panel, for
// red and cyan glasses, and as a quilt. `./do strips gallery` runs it.

#include <fmt/format.h>

#include <array>
#include <cstdio>

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

Result<std::vector<Image>> visit(const TriMesh& mesh, const std::string& script, const std::string& display, int width,
                                 int height) {
  ViewOptions options;
  DUBSAR_ASSIGN(options.mapping, gallery_mapping());
  DUBSAR_ASSIGN(options.stage.shading, shading_preset("relief"));
  DUBSAR_ASSIGN(options.stage.display, parse_sink_spec(display));
  Screen& screen = options.stage.screen;
  screen.width_px = screen.window_w = width;
  screen.height_px = screen.window_h = height;
  screen.height_mm = screen.width_mm * height / width;
  options.stage.samples = 2;
  options.inputs = {"scripted:path=" + script};
  options.around.notices = false;
  options.work.upright = true;
  options.time.fps = kFps;
  options.time.longest_s = kLongestSeconds;
  options.files.every = kEvery;
  KioskParts parts;
  parts.profile.objects = {{.file = "tablet", .title = {{"en", "A sealed contract"}}}};
  parts.profile.pin = "90210735";
  parts.profile.idle_reset_s = 8.0;
  parts.profile.attract_after_s = 2.0;
  parts.zone = {1e-3 * options.mapping.hands.zone_min_mm, 1e-3 * options.mapping.hands.zone_max_mm};
  parts.wall = [] { return WallTime{1'790'000'000, 720}; };
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

Result<void> make(const std::string& surface, const std::string& script, const std::string& folder) {
  SilentProgress progress;
  DUBSAR_ASSIGN(const TriMesh mesh, load_mesh({surface, {}, true}, progress));
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
