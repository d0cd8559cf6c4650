// dubsar fatcross IN -o OUT.tif: all six sides of a tablet in one picture at one scale, for publication.

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/default_output.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/document/export_choice.h"
#include "app/panels/panel_font.h"
#include "app/publish/fat_cross.h"
#include "app/publish/xmp.h"
#include "app/tools/surface_tools.h"
#include "app/verbs/told_session.h"
#include "app/verbs/work_of_surface.h"
#include "core/image_io/picture_file.h"
#include "core/image_io/tiff_file.h"
#include "display/render/mesh/surface_field.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// How the sides look: one style or one for each layer, and what was done to it with --do.
struct SheetLook {
  std::string style = "raking";
  bool usual = true;  ///< nobody chose a style: raking light as plates have it
  std::vector<std::string> layers, told;
};

struct FatCrossRequest {
  std::string in, out, unit, part = "auto";
  SheetLook look;
  double dpi = 600.0;
  int samples = 3;
  Rgb8 ground{0, 0, 0};
  FrameTurn turn = FrameTurn::kNone;
  bool over = false, no_sides = false, no_legend = false, apart = false, text = false;
  Publication publication;
};

/// Of a plate: low light from the upper left, in which hollows keep their light.
Shading plate_shading(Shading raking) {
  raking.light.azimuth_deg = 315.0;
  raking.light.elevation_deg = 25.0;
  raking.style.ambient_occlusion = true;
  raking.style.occlusion_power = 0.3;
  return raking;
}

constexpr std::array<const char*, kTabletSides.size()> kSideSuffix{"_01", "_02", "_03", "_04", "_05", "_06"};

fs::path with_suffix(const fs::path& path, const std::string& suffix) {
  return path.parent_path() / (path.stem().string() + suffix + path.extension().string());
}

PictureOptions file_of(const FatCrossRequest& options) {
  PictureOptions out;
  out.dpi = options.dpi;
  out.description = options.publication.title;
  out.copyright = options.publication.rights;
  out.xmp = xmp_packet(options.publication);
  return out;
}

Result<void> write_sides(const FatCrossRequest& options, const FatCross& cross, const fs::path& out) {
  for (std::size_t k = 0; !options.no_sides && k < cross.sides.size(); ++k)
    DUBSAR_TRY(write_picture(with_suffix(out, kSideSuffix[k]), cross.sides[k], file_of(options)));
  return {};
}

fs::path styled(const FatCrossRequest& options, const std::string& style) {
  return with_suffix(options.out, "_" + style);
}

/// The files that nobody named, before any work.
Result<void> check_besides(const FatCrossRequest& options, const std::vector<std::string>& styles) {
  for (const char* side : kSideSuffix)
    if (!options.no_sides) DUBSAR_TRY(check_made("-o", with_suffix(options.out, side), FileFormat::kPicture));
  for (const std::string& style : styles)
    if (options.apart && styles.size() > 1) DUBSAR_TRY(check_made("-o", styled(options, style), FileFormat::kPicture));
  return {};
}

/// Draws the cross in each of the styles: as one file with a page for each, or a file for each.
class CrossFiles {
 public:
  CrossFiles(const FatCrossRequest& options, const std::vector<std::string>& styles, const TriMesh& upright,
             std::vector<std::string> text, Progress& progress)
      : options_(options), styles_(styles), upright_(upright), text_(std::move(text)), progress_(progress) {}

  Result<void> write(VerbResult& result) {
    DUBSAR_TRY(find_legend());
    result.json["files"] = nlohmann::json::array();
    const int count = static_cast<int>(styles_.size());
    if (count > 1 && !options_.apart) {
      const PictureOptions file = file_of(options_);
      DUBSAR_TRY(write_tiff_layers(options_.out, count,
                                   [&](int k) -> Result<TiffLayer> {
                                     DUBSAR_ASSIGN(FatCross cross, draw(k));
                                     return TiffLayer{std::move(cross.whole), styles_[static_cast<std::size_t>(k)]};
                                   },
                                   options_.dpi, {file.description, file.copyright, file.xmp}));
      tell(options_.out, result);
      result.json["layers"] = styles_;
      return {};
    }
    for (int k = 0; k < count; ++k) {
      const fs::path out = count == 1 ? fs::path(options_.out) : styled(options_, styles_[static_cast<std::size_t>(k)]);
      DUBSAR_ASSIGN(const FatCross cross, draw(k));
      DUBSAR_TRY(write_picture(out, cross.whole, file_of(options_)));
      tell(out, result);
    }
    return {};
  }

 private:
  Result<void> find_legend() {
    DUBSAR_ASSIGN(font_, LabelFont::create(panel_font()));
    if (options_.no_legend) return {};
    const EvidenceShares shares = SurfaceEvidence(upright_).of(0xff);
    const double all = shares.measured_mm2 + shares.inferred_mm2;
    legend_ = {font_.get(), shares.inferred_mm2, all > 0 ? shares.inferred_mm2 / all : 0.0, false};
    for (const std::string& style : styles_)
      if (const auto preset = shading_preset(style); preset && styles_.size() > 1 && !options_.apart)
        legend_.figure_room = legend_.figure_room || is_field(preset->style.map);
    return {};
  }
  /// The first of them gives the six sides, too.
  Result<FatCross> draw(int k) {
    FatCrossOptions draw;
    draw.dpi = options_.dpi;
    draw.ground = options_.ground;
    draw.samples = options_.samples;
    draw.legend = legend_;
    const std::string& style = styles_[static_cast<std::size_t>(k)];
    draw.font = font_.get();
    draw.text = text_;
    DUBSAR_ASSIGN(draw.shading, shading_preset(style));
    if (options_.look.usual) draw.shading = plate_shading(draw.shading);
    DUBSAR_TRY(dress_as_told(upright_, style, options_.look.told, draw.shading, progress_));
    DUBSAR_ASSIGN(FatCross cross, draw_fat_cross(upright_, draw, progress_));
    if (k == 0) DUBSAR_TRY(write_sides(options_, cross, options_.out));
    size_ = {cross.whole.width, cross.whole.height};
    ruler_ = {cross.ruler_mm, cross.ruler_px};
    return cross;
  }
  void tell(const fs::path& out, VerbResult& result) const {
    result.json["files"].push_back(out.string());
    result.json["width"] = size_.width;
    result.json["height"] = size_.height;
    result.json["ruler_mm"] = ruler_.width;
    result.json["ruler_px"] = ruler_.height;
    result.text += fmt::format("{}: {}x{} pixels, {:g} dots an inch, ruler {} mm\n", out.string(), size_.width,
                               size_.height, options_.dpi, ruler_.width);
  }

  const FatCrossRequest& options_;
  const std::vector<std::string>& styles_;
  const TriMesh& upright_;
  std::vector<std::string> text_;  ///< of the tablet, beside the cross
  Progress& progress_;
  std::unique_ptr<LabelFont> font_;
  SheetLegend legend_;
  PixelExtent size_, ruler_;  // ruler: mm and pixels
};

Result<VerbResult> run(const FatCrossRequest& given, Progress& progress) {
  FatCrossRequest options = given;
  const std::string suffix = fs::path(options.out).extension().string();
  const bool tiff = suffix == ".tif" || suffix == ".tiff";
  if (!tiff && suffix != ".png")
    return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .tif, .tiff or .png", options.out);
  if (!tiff && options.look.layers.size() > 1 && !options.apart)
    return fail(ErrorKind::kUsage, "--layers are pages of one TIFF, and {} is none; expected .tif, or --apart",
                options.out);
  std::vector<std::string> styles = options.look.layers;
  if (styles.empty()) styles = {options.look.style};
  for (const std::string& style : styles) DUBSAR_TRY(shading_preset(style));
  DUBSAR_TRY(check_told(options.look.told));
  DUBSAR_TRY(check_besides(options, styles));
  DUBSAR_ASSIGN(const TriMesh mesh, load_written_part(options.in, options.part, options.unit, progress, true));
  if (!mesh.frame.input_voxel.known() && !is_exa_file(options.in))
    log(LogLevel::kWarning, fmt::format("{} does not state its units; taken as millimetres", options.in));
  if (!mesh.frame.input_voxel.known() && is_exa_file(options.in))
    return fail(
        ErrorKind::kUsage,
        "{} does not say how large its voxels are, so {} dots an inch mean nothing; process the scan again with "
        "--voxel-size, e.g. 38um",
        options.in, options.dpi);
  DUBSAR_ASSIGN(TabletFrame frame, find_tablet_frame(mesh));
  frame = turned(frame, options.turn);
  if (options.over) frame = turned(frame, FrameTurn::kOver);
  const TriMesh upright = in_tablet_frame(mesh, frame);

  const Document kept = kept_work(options.in, mesh).value_or(Document());
  const TabletRecord& record = kept.edition.record;
  if (options.publication.title.empty()) options.publication.title = name_of(record);
  if (options.publication.rights.empty()) options.publication.rights = record.rights;
  if (options.publication.institution.empty()) options.publication.institution = record.institution;
  VerbResult result;
  const std::vector<std::string> text = options.text ? text_rows(kept) : std::vector<std::string>();
  if (options.text && text.empty()) result.text += "no lines are kept of this surface, so none stand beside it\n";
  DUBSAR_TRY(CrossFiles(options, styles, upright, text, progress).write(result));
  result.json["dpi"] = options.dpi;
  result.json["up_probability"] = frame.up_probability;
  result.json["obverse_probability"] = frame.obverse_probability;
  result.json["mirrored_probability"] = frame.mirrored_probability;
  const auto rows = frame.tablet_from_model();
  for (int r = 0; r < 3; ++r) result.json["tablet_from_model"].push_back({rows[0][r], rows[1][r], rows[2][r]});
  const bool told = options.turn != FrameTurn::kNone || options.over;  // somebody has looked
  if (!told && !frame.sure())
    result.text += frame.doubt() + (frame.up_probability < kSureOfTheWay
                                        ? "; if the text does not stand upright, give --turn half, left or right\n"
                                        : "; if it is the other one, give --over\n");
  return result;
}

}  // namespace

Verb add_fatcross_verb(Arguments program) {
  auto options = std::make_shared<FatCrossRequest>();
  options->publication.made_by = "dubsar " DUBSAR_VERSION;
  Arguments command =
      program.command("fatcross", "all six sides of a tablet in one picture at one scale, for publication");
  command.reads("IN", options->in, "EXA, PLY, OBJ, STL or GLB file").required();
  command.writes(
      "-o,--output", options->out, FileFormat::kPicture,
      "TIFF or PNG file to write; the six sides go beside it as NAME_01 (obverse), _02 (reverse), _03 (top), _04 "
      "(bottom), _05 (left), _06 (right). Unless given: beside IN, NAME_fatcross.tif");
  command.value("--unit", options->unit, kUnitHelp);
  command.value("--part", options->part, "which part: tablet where there is one (auto), all, envelope, ...");
  command.value("--dpi", options->dpi, "dots an inch at life size").range(kPlateDpi.least, kPlateDpi.most);
  command.choice<Rgb8>("--ground", options->ground,
                       {{"black", {0, 0, 0}}, {"white", {255, 255, 255}}, {"grey", {128, 128, 128}}},
                       "colour around the tablet (black)");
  command.choice<FrameTurn>("--turn", options->turn,
                            {{"none", FrameTurn::kNone},
                             {"half", FrameTurn::kHalf},
                             {"left", FrameTurn::kLeft},
                             {"right", FrameTurn::kRight}},
                            "turn the found orientation in the picture, where the text does not stand upright");
  command.flag("--over", options->over, "the found obverse is the reverse");
  command.value("--style", options->look.style, "shading, as of render (raking light from 315,25 with some occlusion)");
  add_do_option(command, options->look.told);
  command.value("--layers", options->look.layers, "several shadings of the same picture, as named pages of one TIFF")
      .separated_by(',');
  command.flag("--apart", options->apart, "each of --layers in a file of its own, NAME_style.tif");
  command.value("--samples", options->samples, "samples per pixel side").range(1, 8);
  command.flag(
      "--no-legend", options->no_legend,
      "without the scale of colours that tell a figure and what the hatch means, which else stand below the ruler");
  command.flag("--no-sides", options->no_sides, "only the cross, not the six sides");
  command.flag("--text", options->text, "the lines of text that were kept stand beside the cross");
  command.value("--title", options->publication.title, "goes into the file, e.g. \"AO 8295\"");
  command.value("--rights", options->publication.rights, "goes into the file");
  command.value("--institution", options->publication.institution, "goes into the file");
  command.footer(
      "Examples:\n"
      "  dubsar fatcross tablet.exa\n"
      "  dubsar fatcross tablet.exa -o ao8295.tif --ground white --title \"AO 8295\" --institution \"Musee du "
      "Louvre\"");
  return {command,
          [options, command](const CommonOptions&, Progress& progress) {
            options->look.usual = !command.given("--style") && !command.given("--layers");
            return run(*options, progress);
          },
          [options] {
            if (options->out.empty()) options->out = output_beside(options->in, "_fatcross.tif");
          }};
}

}  // namespace dubsar::app
