// dubsar show PICTURE --display NAME: quilts, side-by-side and top-bottom pictures that exist already, on any panel.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "app/cli/verb.h"
#include "app/verbs/display_picture.h"
#include "app/viewer/run_view.h"
#include "core/base/files/input_file.h"
#include "core/base/system/log.h"
#include "core/base/text/parse_number.h"
#include "core/image_io/jpeg_markers.h"
#include "core/image_io/picture_file.h"
#include "display/sinks/quilt.h"
#include "display/sinks/view_pictures.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

struct ShowRequest {
  std::string in, out, layout, size, monitor;
  double cone_deg = 40.0;
  bool swap = false, window = false, cone_given = false;
  DisplayRequest display;
};

std::string layout_words(const PictureLayout& layout) {
  switch (layout.kind) {
    case PictureLayout::Kind::kPlain:
      return "one view";
    case PictureLayout::Kind::kSideBySide:
      return fmt::format("side by side{}{}", layout.half ? ", half" : "", layout.right_first ? ", right first" : "");
    case PictureLayout::Kind::kTopBottom:
      return fmt::format("top and bottom{}{}", layout.half ? ", half" : "", layout.right_first ? ", right first" : "");
    case PictureLayout::Kind::kSeparate:
      return fmt::format("{} pictures of one file", layout.columns);
    case PictureLayout::Kind::kQuilt:
      return fmt::format("quilt of {} x {}", layout.columns, layout.rows);
  }
  return {};
}

Result<void> check(const ShowRequest& options) {
  if (options.display.display.empty())
    return fail(ErrorKind::kUsage, "--display is missing, expected the display to show {} on", options.in);
  if (options.window != options.out.empty())
    return fail(ErrorKind::kUsage, "{}, expected -o FILE or --window",
                options.window ? "--window found with -o" : "neither -o nor --window found");
  if (!options.window && !options.monitor.empty())
    return fail(ErrorKind::kUsage, "--monitor is for windows, expected --window too");
  if (options.window && !options.display.see_from.empty())
    return fail(ErrorKind::kUsage, "--see-from makes a file, expected no --window");
  if (!options.window) DUBSAR_TRY(picture_format_from_path(options.out));
  return {};
}

/// The views of a file that holds each as a picture (MPO); none: it is one picture.
Result<std::optional<ViewPictures>> read_separate_views(const ShowRequest& options, PictureLayout& layout) {
  int others = 0;
  DUBSAR_ASSIGN(std::vector<Image> views, read_jpeg_views(options.in, others));
  if (others > 0)
    log_warning("{} holds {} more picture{} that {} not shown", options.in, others, others == 1 ? "" : "s",
                others == 1 ? "is" : "are");
  if (views.empty()) return std::optional<ViewPictures>();
  layout.kind = PictureLayout::Kind::kSeparate;
  layout.columns = static_cast<int>(views.size());
  if (options.swap) std::reverse(views.begin(), views.end());
  ViewPictures out;
  out.aspect = static_cast<double>(views[0].width) / views[0].height;
  out.cone_deg = options.cone_deg;
  out.views = std::move(views);
  return std::optional(std::move(out));
}

/// What the file says of itself, or its name.
PictureLayout layout_of_file(const std::string& path) {
  const auto bytes = read_file_bytes(path);
  const auto pair =
      bytes ? read_jpeg_markers(std::as_bytes(std::span(bytes->data(), bytes->size()))).pair : std::nullopt;
  if (!pair) return layout_of_name(path);
  return {pair->top_bottom ? PictureLayout::Kind::kTopBottom : PictureLayout::Kind::kSideBySide, pair->half,
          pair->right_first};
}

Result<ViewPictures> read_views(const ShowRequest& options, PictureLayout& layout) {
  if (options.layout.empty()) {
    DUBSAR_ASSIGN(auto separate, read_separate_views(options, layout));
    if (separate) return *std::move(separate);
  }
  DUBSAR_ASSIGN(const Image picture, read_picture(options.in));
  layout = layout_of_file(options.in);
  if (!options.layout.empty()) {
    DUBSAR_ASSIGN(layout, parse_picture_layout(options.layout));
  }
  if (options.swap && layout.views() != 2)
    return fail(ErrorKind::kUsage, "--swap does nothing for {} ({}), expected a pair of pictures", options.in,
                layout_words(layout));
  if (options.cone_given && layout.views() < 3)
    return fail(ErrorKind::kUsage, "--cone does nothing for {} ({}), expected a quilt", options.in,
                layout_words(layout));
  if (options.swap) layout.right_first = !layout.right_first;
  auto views = split_picture(picture, layout);
  if (!views) return fail(views.error().kind, "{}: {}", options.in, views.error().message);
  views->cone_deg = options.cone_deg;
  return views;
}

Result<VerbResult> in_window(const ShowRequest& options, const SinkSpec& display, const DisplayOptions& shown,
                             ViewPictures pictures, Progress& progress) {
  DUBSAR_ASSIGN(const auto sink, shown.catalog->make(display));
  if (sink->traits().worn)
    return fail(ErrorKind::kUsage, "display {}: a picture that moves with the head helps nobody, expected a panel",
                sink->traits().name);
  ViewOptions view;
  view.window = WindowOptions();
  view.stage.display = display;
  view.stage.catalog = shown.catalog;
  view.stage.viewer = shown.viewer;
  view.stage.pictures = std::make_shared<const ViewPictures>(std::move(pictures));
  DUBSAR_ASSIGN(view.mapping, default_mapping());
  view.inputs = {"keyboard"};
  view.window->title = "dubsar: " + options.in;
  view.window->monitor = options.monitor;
  if (!options.size.empty()) {
    view.window->width = shown.screen.width_px;
    view.window->height = shown.screen.height_px;
    view.fullscreen = false;
  }
  DUBSAR_ASSIGN(const ViewResult done, run_view(TriMesh(), view, progress));
  VerbResult result;
  result.json = {{"display", done.display}, {"frames", done.frames}};
  result.text = fmt::format("{}: shown in a window, {} frames\n", done.display, done.frames);
  return result;
}

Result<VerbResult> run(const ShowRequest& options, Progress& progress) {
  DUBSAR_TRY(check(options));
  DisplayOptions shown;
  if (!options.size.empty()) {
    const auto size = parse_size(options.size);
    if (!size || (*size)[0] < 16 || (*size)[1] < 16)
      return fail(ErrorKind::kUsage, "--size \"{}\" not understood, expected WIDTHxHEIGHT such as 1600x1200",
                  options.size);
    shown.screen.width_px = (*size)[0];
    shown.screen.height_px = (*size)[1];
  }
  DUBSAR_ASSIGN(const SinkSpec display, read_display_options(options.display, shown));
  PictureLayout layout;
  DUBSAR_ASSIGN(ViewPictures pictures, read_views(options, layout));
  VerbResult result;
  if (options.window) {
    DUBSAR_ASSIGN(result, in_window(options, display, shown, std::move(pictures), progress));
  } else {
    DUBSAR_ASSIGN(const DisplayPicture picture, show_pictures(pictures, display, shown));
    const fs::path path =
        options.display.see_from.empty() ? name_with_suffix(options.out, picture.file_suffix) : fs::path(options.out);
    if (std::error_code error; fs::equivalent(path, options.in, error))
      return fail(ErrorKind::kUsage, "-o {} would replace the picture that is shown, expected another name",
                  path.string());
    DUBSAR_ASSIGN(result, write_display_picture(options.display, display, shown, picture, options.out));
  }
  result.json["input"] = options.in;
  result.json["layout"] = layout_words(layout);
  result.json["input_views"] = layout.views();
  result.text = fmt::format("{}: {}\n", options.in, layout_words(layout)) + result.text;
  return result;
}

}  // namespace

Verb add_show_verb(Arguments program) {
  auto options = std::make_shared<ShowRequest>();
  Arguments command =
      program.command("show", "show a quilt, a side-by-side or a top-bottom picture that exists already on a display");
  command.reads("IN", options->in, "PNG, TIFF or JPEG file").required();
  command.writes("-o,--output", options->out, FileFormat::kPicture, "PNG, TIFF or JPEG file to write");
  command.flag("--window", options->window, "in a window, until it is closed, instead of writing a file");
  command.value(
      "--layout", options->layout,
      "what is in IN: plain, sbs, lr, rl, tb, ou or bt, with half, or qs8x6a0.75; default: what its name says");
  command.flag("--swap", options->swap, "left and right of a pair exchanged");
  command.value("--cone", options->cone_deg, "degrees over all views of a quilt (40), for displays of two views")
      .range(1.0, 170.0);
  command.value("--size", options->size,
                "WIDTHxHEIGHT of the screen or window in pixels (1920x1080, or the panel's own)");
  command.value("--monitor", options->monitor, "with --window: part of the monitor's name");
  add_display_options(command, options->display, false);
  command.footer(
      "Names say what is in a picture: NAME_qs8x6a0.75 (a quilt of 8 x 6), NAME_sbs, NAME_tb, with _half where both\n"
      "views are squeezed into one picture.\n"
      "Examples:\n"
      "  dubsar show tablet_qs8x6a0.75.png --display lenticular:calibration=visual.json --window\n"
      "  dubsar show tablet_sbs.jpg -o anaglyph.png --display anaglyph\n"
      "  dubsar show tablet_qs5x9a1.78.png -o pair.png --display side_by_side:half --viewer 100,0,600");
  return {command, [options, command](const CommonOptions&, Progress& progress) {
            options->display.sized = command.given("--size") && !options->window;
            options->cone_given = command.given("--cone");
            return run(*options, progress);
          }};
}

}  // namespace dubsar::app
