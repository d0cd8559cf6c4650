#include "app/verbs/look_options.h"

#include <algorithm>
#include <charconv>

#include "app/panels/panel_font.h"
#include "display/render/images/legend_image.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar::app {
namespace {

constexpr int kLeastLetters = 14, kLettersOf = 55;  // pixels; of the picture's height

}  // namespace

void add_look_options(Arguments& command, LookOptions& options) {
  command.value("--blend", options.blend, "STYLE=0..1: mixed with another style, e.g. raking=0.4");
  command.value("--radiance", options.radiance, "0 to 200 percent: ridges are lifted out of hollows (radiance scaling)")
      .range(0, 200);
  command.value("--strength", options.strength, "0 to 200 percent: contrast of a style's colours").range(0, 200);
  command.choice<FieldColors>("--colours", options.colours,
                              {{"designed", FieldColors::kDesigned},
                               {"blue-orange", FieldColors::kBlueOrange},
                               {"cividis", FieldColors::kCividis},
                               {"grey", FieldColors::kGrey}},
                              "colours of msii and of the curvatures (designed)");
  command.choice<Hatch>("--hatch", options.hatch, {{"sepia", kSepiaHatch}, {"blue", kBlueHatch}},
                        "what the scan does not show is hatched in (sepia)");
  command.flag("--section", options.section, "what --cut goes through is filled, as solid clay is");
  command.flag("--legend", options.legend, "a legend with numbers, of msii and of the curvatures");
}

Result<void> apply(const LookOptions& options, Shading& shading) {
  shading.style.contrast *= 0.01 * options.strength;
  shading.style.field_colors = options.colours;
  shading.style.hatch = options.hatch;
  shading.style.section = options.section;
  shading.style.radiance = std::max(shading.style.radiance, 0.01 * options.radiance);
  if (options.legend && !is_field(shading.style.map))
    return fail(ErrorKind::kUsage,
                "--legend found with a style whose colours tell no figure, expected msii, mean-curvature, "
                "gaussian-curvature, shape-index or curvedness");
  if (options.blend.empty()) return {};
  const std::size_t at = options.blend.rfind('=');
  double share = -1.0;
  if (at != std::string::npos) {
    const char* const end = options.blend.data() + options.blend.size();
    const auto read = std::from_chars(options.blend.data() + at + 1, end, share);
    if (read.ec != std::errc() || read.ptr != end) share = -1.0;
  }
  if (!(share >= 0 && share <= 1))
    return fail(ErrorKind::kUsage, "--blend \"{}\" not understood, expected STYLE=SHARE such as raking=0.4",
                options.blend);
  DUBSAR_ASSIGN(const Shading other, shading_preset(options.blend.substr(0, at)));
  shading.other = {other.style, other.light, share};
  shading.other.style.hatch = options.hatch;
  shading.other.style.field_colors = options.colours;
  shading.other.style.radiance = shading.style.radiance;
  shading.other.style.mark_inferred = shading.style.mark_inferred;
  return {};
}

Result<void> add_legend(const LookOptions& options, const Style& style, Image& picture) {
  if (!options.legend) return {};
  DUBSAR_ASSIGN(const auto font, LabelFont::create(panel_font()));
  const int letters = std::max(kLeastLetters, picture.height / kLettersOf);
  DUBSAR_ASSIGN(const Image legend, legend_image(style, *font, letters));
  put_into_corner(legend, picture, letters);
  return {};
}

}  // namespace dubsar::app
