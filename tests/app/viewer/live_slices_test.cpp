// Slices of the scan in a window: by key, mouse and script.

#include <filesystem>
#include <fstream>

#include "app/panels/slice_panel.h"
#include "core/image_io/png_file.h"
#include "tests/app/viewer/live_fixture.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// A folder of its own, gone afterwards.
struct Folder {
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path path = fs::temp_directory_path() / fmt::format("dubsar_live_slices_{}", ::getpid());
};

/// 64 x 64 x 64 voxels of 1 mm from the origin on, whose value is their x.
fs::path ramp(const Folder& folder) {
  fs::path path = folder.path / "ramp.nrrd";
  std::ofstream out(path, std::ios::binary);
  out << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 64 64 64\nencoding: raw\nspacings: 1 1 1\n"
         "units: \"mm\" \"mm\" \"mm\"\n\n";
  std::string bytes(std::size_t{64} * 64 * 64, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i % 64);
  out << bytes;
  return path;
}

// The box is 40 mm wide around the origin: the scan shows its right upper part.
TEST_F(Live, ClicksInASliceMoveThePlaceAndTheKeyLaysThemThroughThePointersPlace) {
  const Folder folder;
  options_.around.panels = true;
  options_.window->width = 1000;
  options_.window->height = 640;
  options_.work.scan.emplace().path = ramp(folder);
  const auto rects = slice_rects(1000.0f, 640.0f, 0);
  const PanelRect z = rects[2];
  const auto at = [](float place) { return static_cast<int>(std::lround(place)); };
  ScanView clicked;
  const auto done = play({
      {[] {
         person_->hold("shift");
         person_->key("s");
         person_->let_go("shift");
       },
       [](const ViewMoment& m) { return m.viewer.ui().drawer == "slices" && m.viewer.slices().panes[2].ready(); }},
      {[&] {  // a quarter of the picture to the right of its middle, and up
         person_->point(kX + at(z.x + 0.75f * z.width), kY + at(z.y + 0.25f * z.height));
         person_->press(1);
         person_->release(1);
         person_->settle();
       },
       [&](const ViewMoment& m) {
         clicked = m.viewer.document().scan;
         return clicked.cursor_mm.x > 5 && m.viewer.slices().panes[2].ready() && m.viewer.slices().value.has_value();
       }},
      {[&] {
         person_->press(4);
         person_->release(4);
         person_->settle();
       },
       [&](const ViewMoment& m) { return m.viewer.document().scan.cursor_mm.z > clicked.cursor_mm.z + 0.05; }},
      {[&] {  // the surface stands in the middle of what is left beside the slices
         person_->point(kX + (82 + at(z.x)) / 2, kY + 320);
         person_->key("b");
       },
       [](const ViewMoment& m) {
         const ScanView& scan = m.viewer.document().scan;
         return glm::distance(scan.cursor_mm, scan.centre_mm) < 1e-9 && scan.free_up.z > 0.99;
       }},
      close_drawer(),
      end(),
  });
  ASSERT_TRUE(done) << done.error().message;
  // 1.1 times the longest edge of 40 mm is what the shorter side of the picture shows.
  const double mm_per_px = 44.0 / static_cast<double>(std::min(z.width, z.height));
  EXPECT_NEAR(clicked.cursor_mm.x, 0.25 * static_cast<double>(z.width) * mm_per_px, 1.0 * mm_per_px);
  EXPECT_NEAR(clicked.cursor_mm.y, 0.25 * static_cast<double>(z.height) * mm_per_px, 1.0 * mm_per_px);
  EXPECT_LT(std::abs(done->document.scan.cursor_mm.x), 3.0);
}

// What stands in the picture is the scan: black to white from left to right, and the outline where the box ends.
TEST_F(Live, TheSlicesPictureHasTheValuesOfTheScanAndTheOutline) {
  const Folder folder;
  options_.window.reset();
  options_.time.fps = 10;
  options_.time.longest_s = 1;
  options_.inputs.clear();
  options_.stage.screen.width_px = options_.stage.screen.window_w = 1000;
  options_.stage.screen.height_px = options_.stage.screen.window_h = 640;
  options_.stage.screen.height_mm = 0.64 * options_.stage.screen.width_mm;  // square pixels
  options_.files.frames = folder.path / "frames";
  options_.work.scan.emplace().path = ramp(folder);
  options_.steps = parse_steps(
                       "0 panels\n0.1 drawer slices\n0.1 slice_grey 0 40\n0.1 slice_at 5,5,1\n0.2 slice_large z\n"
                       "0.3 write_slice " +
                           (folder.path / "z.png").string() + " z\n",
                       "steps")
                       .value();
  SilentProgress silent;
  const auto done = run_view(testing::lettered_box(), options_, silent);
  ASSERT_TRUE(done) << done.error().message;
  const Image picture = read_png(folder.path / "frames" / "frame-00008.png").value();
  const PanelRect z = slice_rects(1000.0f, 640.0f, 3)[2];
  const SliceFrame frame = slice_frame(done->document.scan, 2, static_cast<int>(std::lround(z.width)),
                                       static_cast<int>(std::lround(z.height)), 44.0);
  for (const double x : {2.0, 7.5, 12.0, 17.0}) {
    const glm::dvec2 px = frame.px_at({x, 8.0, 1.0});
    const std::uint8_t* const found = picture.at(static_cast<int>(z.x + px.x), static_cast<int>(z.y + px.y));
    EXPECT_NEAR(found[0], 255.0 * x / 40.0, 2.5) << x;
    EXPECT_EQ(found[0], found[2]);
  }
  const glm::dvec2 edge = frame.px_at({20.0, 3.0, 1.0});  // amber within a pixel
  int amber = 0;
  for (int dx = -1; dx <= 1; ++dx) {
    const std::uint8_t* const p = picture.at(static_cast<int>(z.x + edge.x) + dx, static_cast<int>(z.y + edge.y));
    amber += p[0] > p[2] + 60 ? 1 : 0;
  }
  EXPECT_GE(amber, 1);
  const Image whole = read_png(folder.path / "z.png").value();
  ASSERT_NEAR(whole.width, 44, 1) << "a pixel for each voxel";
  const int middle = whole.width / 2;
  EXPECT_NEAR(whole.at(middle + 10, middle - 5)[0], 255.0 * (10.5 + middle - 0.5 * whole.width) / 40.0, 2.5);
}

}  // namespace
}  // namespace dubsar::app
