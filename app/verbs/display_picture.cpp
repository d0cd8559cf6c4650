#include "app/verbs/display_picture.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/calibration/display_choice.h"
#include "core/base/parse_number.h"
#include "core/image_io/png_file.h"
#include "core/image_io/tiff_file.h"
#include "display/sinks/sink_catalog.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

constexpr double kMmPerInch = 25.4;

Result<glm::dvec3> parse_place(const std::string& text, const char* option) {
  const auto place = parse_numbers<3>(text);
  if (!place)
    return fail(ErrorKind::kUsage,
                "{} \"{}\" not understood, expected X,Y,Z in mm from the middle of the panel: right, up, towards the "
                "viewer, such as 30,0,600",
                option, text);
  if (!((*place)[2] > 0.0))
    return fail(ErrorKind::kUsage, "{} \"{}\" is behind the panel, expected a Z of more than 0 mm", option, text);
  return glm::dvec3((*place)[0], (*place)[1], (*place)[2]);
}

Result<void> write_picture(const fs::path& path, const Image& image, double dpi) {
  if (path.extension() != ".png") return write_tiff(path.string(), image, dpi);
  PngOptions png;
  png.dpi = dpi;
  return write_png(path.string(), image, png);
}

/// The eye's picture goes where the panel's would have gone.
Result<void> add_sight(const DisplayPicture& picture, const glm::dvec3& eye, Image& image, VerbResult& result) {
  DUBSAR_ASSIGN(image, see_display(picture, eye));
  const EyeLight light = light_at(*picture.light, eye);
  result.json["see_from_mm"] = {eye.x, eye.y, eye.z};
  result.json["main_view"] = light.main_view;
  result.json["crosstalk_percent"] = 100.0 * light.crosstalk;
  nlohmann::json shares = nlohmann::json::array();
  for (const double share : light.shares) shares.push_back(100.0 * share);
  result.json["view_percent"] = std::move(shares);
  result.text +=
      fmt::format("an eye at {:g}, {:g}, {:g} mm sees view {} of {} ({:.1f} % of its light), crosstalk {:.2f} %\n",
                  eye.x, eye.y, eye.z, light.main_view, picture.views,
                  100.0 * light.shares[static_cast<std::size_t>(light.main_view)], 100.0 * light.crosstalk);
  return {};
}

}  // namespace

void add_display_options(Arguments command, DisplayRequest& request) {
  std::string names;
  for (const SinkBackend& backend : output_sinks()) names += (names.empty() ? "" : ", ") + std::string(backend.name);
  Arguments group = command.group("Displays");
  group.value("--display", request.display,
              "the picture that a display's panel shows: NAME[:options]; `dubsar displays` explains " + names);
  group.value("--see-from", request.see_from,
              "X,Y,Z of an eye in mm: write what it sees of a panel with lenses, and how much crosstalk");
  group.value("--viewer", request.viewer, "X,Y,Z in mm of the point between the viewer's eyes (0,0,600)");
  group.value("--eye-distance", request.eye_distance_mm, "distance of the viewer's eyes in mm").range(0.0, 100.0);
  group.value("--screen-mm", request.screen_mm, "WIDTHxHEIGHT of the screen in mm; panel profiles bring their own");
  group.value("--magnification", request.magnification, "1 for life size; default: as large as fits").positive();
  group.value("--plugin", request.plugins, "a display from a shared library; loading it runs its code")
      .called("FILE.so");
  group
      .value("--bridge-port", request.bridge_port,
             "for panel auto: port of Looking Glass Bridge on this machine (33334); 0: leave it alone")
      .range(0, 65535);
  group.flag("--pattern", request.pattern, "numbered views instead of a surface (no IN)");
}

Result<SinkSpec> read_display_options(const DisplayRequest& request, DisplayOptions& options) {
  Screen& screen = options.screen;
  screen.window_w = screen.width_px;
  screen.window_h = screen.height_px;
  screen.height_mm = screen.width_mm * screen.height_px / screen.width_px;
  if (!request.screen_mm.empty()) {
    const auto size = parse_numbers<2>(request.screen_mm, 'x');
    if (!size || !((*size)[0] > 0) || !((*size)[1] > 0))
      return fail(ErrorKind::kUsage, "--screen-mm \"{}\" not understood, expected WIDTHxHEIGHT such as 344x194",
                  request.screen_mm);
    screen.width_mm = (*size)[0];
    screen.height_mm = (*size)[1];
  }
  glm::dvec3 between = options.viewer.nominal_mm;
  if (!request.viewer.empty()) {
    DUBSAR_ASSIGN(between, parse_place(request.viewer, "--viewer"));
  }
  const glm::dvec3 half(0.5 * request.eye_distance_mm, 0.0, 0.0);
  options.viewer.left_mm = between - half;
  options.viewer.right_mm = between + half;
  options.magnification = request.magnification;
  DUBSAR_ASSIGN(const DisplayChoice choice, choose_display(request.display, request.plugins, request.bridge_port));
  options.catalog = choice.catalog;
  return choice.display;
}

Result<VerbResult> render_to_display(const DisplayRequest& request, const SinkSpec& display,
                                     const DisplayOptions& options, const TriMesh& mesh, const fs::path& out,
                                     Progress& progress) {
  glm::dvec3 eye(0.0);
  if (!request.see_from.empty()) {
    DUBSAR_ASSIGN(eye, parse_place(request.see_from, "--see-from"));
  }
  DisplayPicture picture;
  if (request.pattern) {
    DUBSAR_ASSIGN(picture, render_pattern(display, options));
  } else {
    DUBSAR_ASSIGN(picture, render_display(mesh, display, options, progress));
  }
  VerbResult result;
  Image image = picture.image;
  if (!request.see_from.empty()) DUBSAR_TRY(add_sight(picture, eye, image, result));
  fs::path path = out;
  const std::string stem = out.stem().string();
  if (request.see_from.empty() && !stem.ends_with(picture.file_suffix))
    path.replace_filename(stem + picture.file_suffix + out.extension().string());
  const double dpi = picture.light ? kMmPerInch / picture.light->panel.lens.pixel_mm.x : 0.0;
  DUBSAR_TRY(write_picture(path, image, dpi));
  result.json.update({{"output", path.string()},
                      {"width", image.width},
                      {"height", image.height},
                      {"display", display.text()},
                      {"views", picture.views},
                      {"magnification", picture.magnification},
                      {"pattern", request.pattern}});
  result.text = fmt::format("{}: {}x{} pixels, {} view{}{}\n", path.string(), image.width, image.height, picture.views,
                            picture.views == 1 ? "" : "s",
                            request.pattern ? "" : fmt::format(", magnification {:.4g}", picture.magnification)) +
                result.text;
  return result;
}

}  // namespace dubsar::app
