#include "app/verbs/display_picture.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/calibration/display_choice.h"
#include "core/base/numbers/inch.h"
#include "core/base/text/parse_number.h"
#include "core/image_io/picture_file.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/quilt.h"

namespace dubsar::app {
namespace fs = std::filesystem;

namespace {

constexpr double kEyeDistanceMm = 63.0;

Result<glm::dvec3> parse_place(const std::string& text, const char* option) {
  const auto place = parse_numbers<3>(text);
  if (!place)
    return fail(ErrorKind::kUsage,
                "{} \"{}\" not understood, expected X,Y,Z in mm from the middle of the panel: right, up, towards the "
                "viewer, such as 30,0,600",
                option, text);
  if (!((*place)[2] > 0.0))
    return fail(ErrorKind::kUsage, "{} \"{}\" is behind the panel, expected a Z of {} mm or more", option, text,
                kNearestEyeMm);
  if (!((*place)[2] >= kNearestEyeMm))
    return fail(ErrorKind::kUsage, "{} \"{}\" is too near to the panel, expected a Z of {} mm or more", option, text,
                kNearestEyeMm);
  return glm::dvec3((*place)[0], (*place)[1], (*place)[2]);
}

/// An option that would change nothing is a mistake that its owner should hear of.
Result<void> refuse_ignored(const DisplayRequest& request, const SinkTraits& traits) {
  const auto refuse = [&](std::string_view option, std::string_view why) {
    return fail(ErrorKind::kUsage, "{} does nothing for display {}: {}", option, traits.name, why);
  };
  if (traits.own_pixels && request.sized) return refuse("--size", "its pixels are those of its panel or its layout");
  if (traits.own_size && !request.screen_mm.empty()) return refuse("--screen-mm", "its panel brings its own size");
  const std::string_view why =
      traits.worn ? "its eyes are the wearer's" : "its views are made for all places before the panel";
  if (!traits.tracked && !request.viewer.empty()) return refuse("--viewer", why);
  if (!traits.tracked && request.eye_distance_mm) return refuse("--eye-distance", why);
  if (traits.views == 1 && request.eye_distance_mm) return refuse("--eye-distance", "it has one view");
  if (!request.pattern) return {};
  if (request.magnification > 0) return refuse("--magnification", "--pattern fills the panel");
  if (!request.of_surfaces.empty()) return refuse(request.of_surfaces, "--pattern shows no surface");
  return {};
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

/// Of a picture that is shown pixel by pixel; 0 for those that are files of several pictures.
double dots_an_inch(const DisplayPicture& picture, const Screen& screen) {
  if (picture.light) return kMmPerInch / picture.light->panel.lens.pixel_mm.x;
  const bool of_screen = picture.image.width == screen.window_w && picture.image.height == screen.window_h;
  return of_screen ? kMmPerInch * screen.width_px / screen.width_mm : 0.0;
}

}  // namespace

void add_display_options(Arguments command, DisplayRequest& request, bool surfaces) {
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
  if (surfaces)
    group.value("--magnification", request.magnification, "1 for life size; default: as large as fits").positive();
  group.value("--plugin", request.plugins, "a display from a shared library; loading it runs its code")
      .called("FILE.so");
  group
      .value("--bridge-port", request.bridge_port,
             "for panel auto: port of Looking Glass Bridge on this machine (33334); 0: leave it alone")
      .range(0, 65535);
  if (surfaces) group.flag("--pattern", request.pattern, "numbered views instead of a surface (no IN)");
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
  const glm::dvec3 half(0.5 * request.eye_distance_mm.value_or(kEyeDistanceMm), 0.0, 0.0);
  options.viewer.left_mm = between - half;
  options.viewer.right_mm = between + half;
  options.magnification = request.magnification;
  DUBSAR_ASSIGN(const DisplayChoice choice, choose_display(request.display, request.plugins, request.bridge_port));
  options.catalog = choice.catalog;
  DUBSAR_ASSIGN(const auto sink, options.catalog->make(choice.display));
  DUBSAR_TRY(sink->configure(screen));
  DUBSAR_TRY(refuse_ignored(request, sink->traits()));
  return choice.display;
}

Result<Image> seen_picture(const DisplayRequest& request, const DisplayPicture& picture) {
  if (request.see_from.empty()) return picture.image;
  DUBSAR_ASSIGN(const glm::dvec3 eye, parse_place(request.see_from, "--see-from"));
  return see_display(picture, eye);
}

Result<VerbResult> write_display_picture(const DisplayRequest& request, const SinkSpec& display,
                                         const DisplayOptions& options, const DisplayPicture& picture,
                                         const fs::path& out) {
  VerbResult result;
  Image image = picture.image;
  if (!request.see_from.empty()) {
    DUBSAR_ASSIGN(const glm::dvec3 eye, parse_place(request.see_from, "--see-from"));
    DUBSAR_TRY(add_sight(picture, eye, image, result));
  }
  const fs::path path = request.see_from.empty() ? name_with_suffix(out, picture.file_suffix) : out;
  DUBSAR_TRY(check_made("-o", path, FileFormat::kPicture));
  DUBSAR_TRY(write_picture(path, image, {.dpi = dots_an_inch(picture, options.screen)}));
  result.json.update({{"output", path.string()},
                      {"width", image.width},
                      {"height", image.height},
                      {"display", display.text()},
                      {"views", picture.views}});
  result.text = fmt::format("{}: {}x{} pixels, {} view{}\n", path.string(), image.width, image.height, picture.views,
                            picture.views == 1 ? "" : "s") +
                result.text;
  return result;
}

Result<VerbResult> render_to_display(const DisplayRequest& request, const SinkSpec& display,
                                     const DisplayOptions& options, const TriMesh& mesh, const fs::path& out,
                                     Progress& progress) {
  if (!request.see_from.empty()) DUBSAR_TRY(parse_place(request.see_from, "--see-from"));  // before the work
  DUBSAR_ASSIGN(const auto sink, options.catalog->make(display));
  if (const std::string suffix = sink->traits().file_suffix; !suffix.empty() && request.see_from.empty())
    DUBSAR_TRY(check_made("-o", name_with_suffix(out, suffix), FileFormat::kPicture));
  DisplayPicture picture;
  if (request.pattern) {
    DUBSAR_ASSIGN(picture, render_pattern(display, options));
  } else {
    DUBSAR_ASSIGN(picture, render_display(mesh, display, options, progress));
  }
  DUBSAR_ASSIGN(VerbResult result, write_display_picture(request, display, options, picture, out));
  result.json.update({{"magnification", picture.magnification}, {"pattern", request.pattern}});
  if (!request.pattern) result.text += fmt::format("magnification {:.4g}\n", picture.magnification);
  return result;
}

}  // namespace dubsar::app
