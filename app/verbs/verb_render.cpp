// dubsar render IN -o OUT.png: a picture in a file, or of a display in a window.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/cli/default_output.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/verbs/display_picture.h"
#include "app/verbs/figure_options.h"
#include "app/verbs/look_options.h"
#include "app/verbs/told_session.h"
#include "app/verbs/work_of_surface.h"
#include "app/viewer/first_document.h"
#include "app/viewer/run_view.h"
#include "core/base/text/parse_number.h"
#include "core/image_io/picture_file.h"
#include "core/mesh/tablet_frame.h"
#include "display/render/images/render_image.h"
#include "display/render/scene.h"

namespace dubsar::app {
namespace {
/// How the surface looks, and what of it is seen.
struct Look {
  std::string style = "relief", light;
  bool colour_parts = false, transparent = false, shadows = false, unmarked = false;
  std::vector<std::string> opacity, cut;
  double unpack = 0.0, fog = 0.0;  ///< percent
  FigureOptions figure;
};

struct RenderRequest {
  std::string in, out, view = "front", size, unit;
  std::vector<std::string> partitions, hide, told;
  double mm_per_pixel = 0.0;
  int samples = 0;  ///< 0: enough for one picture, fewer for the many of a display
  DisplayRequest display;
  bool perspective = false, window = false;
  Look look;
  LookOptions shade;
};

Result<void> read_size(const std::string& text, CameraOptions& camera) {
  const auto [width, height] = parse_size(text).value_or(std::array{0, 0});
  if (width < 1 || height < 1)
    return fail(ErrorKind::kUsage, "--size \"{}\" not understood, expected WIDTHxHEIGHT such as 1600x1200", text);
  camera.width = width;
  camera.height = height;
  return {};
}

Result<void> parse_light(const std::string& text, Shading& shading) {
  const auto light = parse_numbers<2>(text);
  if (!light || std::abs((*light)[0]) > 360.0 || (*light)[1] < 0.0 || (*light)[1] > 90.0)
    return fail(
        ErrorKind::kUsage,
        "--light \"{}\" not understood, expected AZIMUTH,ELEVATION in degrees, -360 to 360 and 0 to 90, such as "
        "315,25",
        text);
  shading.light.azimuth_deg = (*light)[0];
  shading.light.elevation_deg = (*light)[1];
  return {};
}

Result<void> hide_partitions(const std::vector<std::string>& names, const TriMesh& mesh, Shading& shading) {
  for (const std::string& name : names) {
    bool found = false;
    for (const Partition& p : mesh.partitions)
      if (p.name == name || p.body == name || std::to_string(p.id) == name) {
        show_partitions(shading.parts, static_cast<std::uint8_t>(visible_partitions(shading.parts) & ~(1 << p.id)));
        found = true;
      }
    if (!found) return fail(ErrorKind::kUsage, "--hide {}: there is no such partition in the file", name);
  }
  return {};
}

/// "NAME=NUMBER" or "NAME:NUMBER".
Result<std::pair<std::string, double>> named_number(const std::string& option, const std::string& text, char between) {
  const std::size_t at = text.rfind(between);
  double value = 0.0;
  if (at != std::string::npos && at > 0) {
    const auto [end, error] = std::from_chars(text.data() + at + 1, text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size()) return std::pair{text.substr(0, at), value};
  }
  return fail(ErrorKind::kUsage, "{} \"{}\" not understood, expected NAME{}NUMBER", option, text, between);
}

/// What the options say about the parts of this surface.
Result<void> dress_parts(const RenderRequest& options, const TriMesh& mesh, Shading& shading) {
  const Box box = surface_box(mesh);
  for (const std::string& text : options.look.opacity) {
    DUBSAR_ASSIGN(const auto wanted, named_number("--opacity", text, '='));
    bool found = false;
    for (const Partition& p : mesh.partitions)
      if (p.name == wanted.first || p.body_name() == wanted.first || std::to_string(p.id) == wanted.first) {
        shading.parts[static_cast<std::size_t>(p.id)].opacity = wanted.second;
        found = true;
      }
    if (!found) return fail(ErrorKind::kUsage, "--opacity {}: there is no such part in the file", wanted.first);
    if (!(wanted.second >= 0 && wanted.second <= 1))
      return fail(ErrorKind::kUsage, "--opacity {} found, expected 0 to 1", wanted.second);
  }
  for (const std::string& text : options.look.cut) {
    DUBSAR_ASSIGN(const auto wanted, named_number("--cut", text, ':'));
    DUBSAR_ASSIGN(const ClipPlane cut, cut_from_side(box, wanted.first, wanted.second / 100.0));
    shading.clips.push_back(cut);
  }
  ViewOptions first;
  first.work.document.unpack = 0.01 * options.look.unpack;
  const Document document = first_document(first, mesh).document;
  if (document.unpack > 0 && !can_unpack(document))
    return fail(ErrorKind::kUsage, "--unpack: there is no envelope in the file that could be lifted from something");
  shading.parts = laid_out(document, shading.parts, box);
  shading.fog.strength = options.look.fog / 100.0;
  shading.style.mark_inferred = !options.look.unmarked;
  shading.light.shadows = shading.light.shadows || options.look.shadows;
  return {};
}

/// Options that make no sense together; said before any work.
Result<void> check_display_options(const RenderRequest& options) {
  const DisplayRequest& request = options.display;
  if (request.display.empty()) {
    if (request.pattern || !request.see_from.empty() || !request.viewer.empty() || !request.screen_mm.empty() ||
        request.magnification > 0)
      return fail(ErrorKind::kUsage,
                  "--pattern, --see-from, --viewer, --screen-mm and --magnification are for displays, expected "
                  "--display NAME too");
    if (options.in.empty()) return fail(ErrorKind::kUsage, "IN is missing, expected a surface to draw");
    return {};
  }
  if (options.perspective || options.mm_per_pixel > 0 || options.look.transparent)
    return fail(ErrorKind::kUsage,
                "--perspective, --mm-per-pixel and --transparent are not for displays: the viewer's place and "
                "--magnification say how large things are");
  if (options.in.empty() != request.pattern)
    return fail(ErrorKind::kUsage, "{} found with --display, expected a surface or --pattern",
                request.pattern ? "both IN and --pattern" : "neither IN nor --pattern");
  return {};
}

/// What a session begins with that shows the display as the options want it.
ViewOptions session_of(const RenderRequest& options, const SinkSpec& display, const DisplayOptions& shown) {
  ViewOptions view;
  view.stage.display = display;
  view.stage.catalog = shown.catalog;
  view.stage.screen = shown.screen;
  view.stage.viewer = shown.viewer;
  view.stage.shading = shown.shading;
  for (PartLook& part : view.stage.shading.parts) part.offset_mm = {};  // the session's document says it
  view.work.document.style.name = view.stage.style = options.look.style;
  view.work.document.unpack = 0.01 * options.look.unpack;
  view.stage.direction = shown.direction;
  view.stage.magnification = shown.magnification;
  view.stage.samples = shown.samples;
  if (options.display.pattern) view.stage.subject = Subject::kPattern;
  return view;
}

/// Options that say what a window does not.
Result<void> check_told_picture(const RenderRequest& options) {
  if (options.told.empty()) return {};
  if (options.perspective || options.mm_per_pixel > 0 || options.look.transparent || options.shade.legend ||
      options.look.figure.asked() || options.display.pattern || !options.look.cut.empty())
    return fail(
        ErrorKind::kUsage,
        "--do draws what a window shows, expected none of --perspective, --mm-per-pixel, --transparent, "
        "--legend, --dpi, --width-mm, --ground, --scale-bar, --labels, --cut (there is a command) and --pattern "
        "with it");
  return check_told(options.told);
}

/// The display's picture in a window, until it is closed; mouse and keyboard turn it.
Result<VerbResult> show_in_window(const RenderRequest& options, const SinkSpec& display, const DisplayOptions& shown,
                                  const TriMesh& mesh, Progress& progress) {
  const DisplayRequest& request = options.display;
  if (!request.see_from.empty()) return fail(ErrorKind::kUsage, "--see-from makes a file, expected no --window");
  ViewOptions view = session_of(options, display, shown);
  view.stage.room.margin = shown.margin;
  view.window = WindowOptions();
  view.steps = steps_of(options.told);
  DUBSAR_ASSIGN(view.mapping, default_mapping());
  view.inputs = {"mouse", "keyboard"};
  view.window->title = "dubsar: " + (request.pattern ? request.display : options.in);
  if (!options.size.empty()) {
    view.window->width = shown.screen.width_px;
    view.window->height = shown.screen.height_px;
    view.fullscreen = false;
  }
  DUBSAR_ASSIGN(const ViewResult done, run_view(mesh, view, progress));
  VerbResult result;
  result.json = {{"display", done.display}, {"frames", done.frames}, {"pattern", request.pattern}};
  result.text = fmt::format("{}: shown in a window, {} frames\n", done.display, done.frames);
  return result;
}

/// What a window shows after its commands were said, as a picture.
Result<VerbResult> write_told(const RenderRequest& options, const SinkSpec& display, const DisplayOptions& shown,
                              const TriMesh& mesh, Progress& progress) {
  ViewOptions view = session_of(options, display, shown);
  view.work.upright = options.view == "front";
  view.around.title = std::filesystem::path(options.in).filename().string();
  DUBSAR_ASSIGN(const ToldSession told, tell_session(mesh, view, options.told, ToldPart::kPicture, progress));
  return write_display_picture(options.display, display, shown, told.seen, options.out);
}

/// Beside the surface, named after what is seen: tablet_front.png.
void name_output(RenderRequest& options) {
  if (options.window || !options.out.empty() || options.in.empty()) return;
  std::string what = options.view;
  std::replace_if(
      what.begin(), what.end(), [](char c) { return c == ':' || c == ',' || c == '/'; }, '-');
  options.out = output_beside(options.in, "_" + what + ".png");
}

/// Of all options that name parts.
Result<void> check_part_names(const RenderRequest& options) {
  std::vector<std::string> names = options.hide;
  for (const std::string& text : options.look.opacity) names.push_back(text.substr(0, text.rfind('=')));
  return check_parts(options.in, names);
}

Result<void> check_output(const RenderRequest& options) {
  if (options.window && (!options.out.empty() || options.display.display.empty()))
    return fail(ErrorKind::kUsage, "--window found {}",
                options.out.empty() ? "without --display NAME" : "with -o, expected one of them");
  if (options.window) return {};
  if (options.out.empty())
    return fail(ErrorKind::kUsage, "-o is missing, expected a file to write, or --display NAME --window");
  return picture_format_from_path(options.out).map([](PictureFormat) {});
}

Result<VerbResult> run(const RenderRequest& options, Progress& progress) {
  DUBSAR_TRY(check_output(options));
  DUBSAR_TRY(check_display_options(options));
  DUBSAR_TRY(check_told_picture(options));
  RenderOptions render;
  DUBSAR_ASSIGN(render.shading, shading_preset(options.look.style));
  DUBSAR_ASSIGN(render.camera.direction, parse_view_direction(options.view == "orbit" ? "orbit:35,25" : options.view));
  if (!options.size.empty()) DUBSAR_TRY(read_size(options.size, render.camera));
  if (!options.look.light.empty()) DUBSAR_TRY(parse_light(options.look.light, render.shading));
  DUBSAR_TRY(apply(options.shade, render.shading));
  render.camera.perspective = options.perspective;
  render.camera.mm_per_pixel = options.mm_per_pixel;
  render.camera.whole = true;
  DUBSAR_TRY(check_figure(options.look.figure, render.camera, !options.size.empty(), options.look.transparent));
  if (options.size.empty() && options.mm_per_pixel > 0) render.camera.width = render.camera.height = 0;
  if (options.samples > 0) render.samples = options.samples;
  render.shading.background.transparent = options.look.transparent;
  if (options.look.colour_parts) color_partitions(render.shading.parts, distinct_partition_colors());
  const bool on_display = !options.display.display.empty();
  DisplayOptions shown;
  SinkSpec display("mono");
  if (!on_display) {  // for --do: as large as the picture would be, and as sharp
    shown.screen = screen_of(render.camera.width, render.camera.height);
    shown.samples = render.samples;
  } else {
    if (!options.size.empty()) {
      shown.screen.width_px = render.camera.width;
      shown.screen.height_px = render.camera.height;
    }
    DUBSAR_ASSIGN(display, read_display_options(options.display, shown));
  }
  DUBSAR_ASSIGN(const double unit_mm, mesh_unit_mm(options.unit));
  TriMesh mesh;
  if (!options.in.empty()) {
    DUBSAR_TRY(check_part_names(options));
    DUBSAR_ASSIGN(mesh, load_mesh({options.in, options.partitions, true, {unit_mm, true}, true}, progress));
  }
  // In its own axes the obverse is the front of the box (object_frame()), for cuts and displays, too.
  TabletFrame way;
  if (!mesh.triangles.empty()) {
    DUBSAR_ASSIGN(way, find_tablet_frame(mesh));
  }
  const bool upright = way.up_probability >= kSureOfTheWay;
  if (upright && (options.told.empty() || options.window)) {
    mesh = in_tablet_frame(std::move(mesh), way);
    render.camera.object = ObjectFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  }
  DUBSAR_TRY(hide_partitions(options.hide, mesh, render.shading));
  DUBSAR_TRY(dress_parts(options, mesh, render.shading));
  if (on_display || !options.told.empty()) {
    shown.direction = render.camera.direction;
    shown.shading = render.shading;
    if (options.samples > 0) shown.samples = options.samples;
    if (options.window) return show_in_window(options, display, shown, mesh, progress);
    if (!options.told.empty()) return write_told(options, display, shown, mesh, progress);
    return render_to_display(options.display, display, shown, mesh, options.out, progress);
  }
  DUBSAR_TRY(apply_figure(options.look.figure, mesh, render));
  DUBSAR_ASSIGN(Picture picture, render_picture(mesh, render, progress));
  DUBSAR_TRY(add_legend(options.shade, render.shading.style, picture.image));
  const Document kept = kept_work(options.in, mesh).value_or(Document());
  const FigureWords words = figure_words(options.in, options.view, kept, upright ? &way : nullptr);
  DUBSAR_TRY(finish_figure(options.look.figure, words, render.shading, picture));
  const PictureOptions file = figure_file(options.look.figure, picture, kept.edition.record);
  DUBSAR_TRY(write_picture(options.out, picture.image, file));
  VerbResult result;
  result.json = {{"output", options.out},
                 {"width", picture.image.width},
                 {"height", picture.image.height},
                 {"mm_per_pixel", picture.mm_per_pixel},
                 {"dpi", file.dpi},
                 {"bar_mm", picture.bar_mm},
                 {"bar_px", picture.bar_px},
                 {"triangles", mesh.triangles.size()},
                 {"view", options.view},
                 {"upright", upright},
                 {"up_probability", way.up_probability},
                 {"obverse_probability", way.obverse_probability},
                 {"style", options.look.style}};
  result.text = fmt::format("{}: {}x{} pixels, {:.4g} mm a pixel\n", options.out, picture.image.width,
                            picture.image.height, picture.mm_per_pixel);
  if (upright && !way.sure()) result.text += way.doubt() + "; if it is the other one, give --view orbit:180,0,180\n";
  return result;
}
}  // namespace

Verb add_render_verb(Arguments program) {
  auto options = std::make_shared<RenderRequest>();
  Arguments command = program.command("render", "make a picture of a surface, or show what a display's panel shows");
  command.reads("IN", options->in, "EXA, PLY, OBJ, STL or GLB file");
  command.writes("-o,--output", options->out, FileFormat::kPicture,
                 "PNG, TIFF or JPEG file to write; unless given: beside IN, NAME_front.png and the like");
  command.flag("--window", options->window, "show the display's picture in a window instead of writing it");
  command.value("--view", options->view,
                "front, back, left, right, top, bottom, orbit or orbit:AZIMUTH,ELEVATION[,ROLL]");
  command.value("--unit", options->unit, kUnitHelp);
  command.value("--size", options->size,
                "WIDTHxHEIGHT in pixels (1200x1200; with --mm-per-pixel what the object takes; of a display 1920x1080, "
                "or the panel's own)");
  std::string styles;
  for (const std::string_view name : shading_preset_names()) styles += (styles.empty() ? "" : ", ") + std::string(name);
  command.value("--style", options->look.style, "shading: " + styles);
  command.value("--partition", options->partitions, "only these parts: names or ids, e.g. tablet").separated_by(',');
  command.value("--hide", options->hide, "not these parts").separated_by(',');
  command.flag("--colour-parts,--color-parts", options->look.colour_parts, "each part in a colour of its own");
  command.value("--light", options->look.light,
                "AZIMUTH,ELEVATION of the light in degrees; 315,20 rakes from the upper left");
  add_look_options(command, options->shade);
  command.flag("--shadows", options->look.shadows,
               "what stands before the light casts shadows (--style raking: always)");
  command.flag("--unmarked", options->look.unmarked, "surface that the scan does not show is not hatched");
  command.value("--opacity", options->look.opacity, "NAME=0..1: parts that are seen through, e.g. envelope=0.3")
      .separated_by(',');
  command.value("--unpack", options->look.unpack, "lifts the envelope off the tablet, 0 to 100 percent").range(0, 100);
  command.value("--cut", options->look.cut, "SIDE:PERCENT cut away, e.g. front:50; also back, left, right, top, bottom")
      .separated_by(',');
  command.value("--fog", options->look.fog, "0 to 100 percent: how much of the background the farthest point takes on")
      .range(0, 100);
  command.value("--mm-per-pixel", options->mm_per_pixel, "exact scale (orthographic), instead of fitting the picture")
      .positive();
  command.flag("--perspective", options->perspective, "perspective instead of orthographic");
  command.flag("--transparent", options->look.transparent, "no background");
  command.value("--samples", options->samples, "samples per pixel side (3; of displays 2)").range(1, 8);
  add_figure_options(command, options->look.figure);
  add_do_option(command, options->told);
  add_display_options(command, options->display);
  command.footer(
      "Examples:\n"
      "  dubsar render tablet.exa -o tablet.png --partition tablet\n"
      "  dubsar render tablet.exa -o back.tif --view back --light 315,15 --mm-per-pixel 0.0423\n"
      "  dubsar render tablet.exa -o figure.tif --width-mm 85 --ground white --scale-bar --labels\n"
      "  dubsar render tablet.exa -o lines.png --style raking --light 315,15\n"
      "  dubsar render tablet.exa -o both.png --opacity envelope=0.3\n"
      "  dubsar render tablet.exa -o lifted.png --do \"unpack 100\" --do \"side reverse\"\n"
      "  dubsar render bust.obj -o bust.png --style ao --view orbit:30,10\n"
      "  dubsar render tablet.exa -o anaglyph.png --display anaglyph --size 1280x800\n"
      "  dubsar render tablet.exa -o go.png --display lenticular:looking-glass-go\n"
      "  dubsar render tablet.exa -o seen.png --display lenticular:spatiallabs-15.6 --see-from 31.5,0,600\n"
      "  dubsar render --pattern -o pattern.png --display lenticular:calibration=visual.json");
  return {command,
          [options, command](const CommonOptions&, Progress& progress) {
            options->display.sized = command.given("--size") && !options->window;
            for (const char* name : {"--view", "--style", "--partition", "--hide", "--colour-parts", "--light",
                                     "--shadows", "--unmarked", "--opacity", "--unpack", "--cut", "--fog", "--samples"})
              if (command.given(name)) options->display.of_surfaces = name;
            return run(*options, progress);
          },
          [options] { name_output(*options); }};
}

}  // namespace dubsar::app
