// dubsar seal IN --at ... -o F: impressions of one seal, laid flat and averaged: the seal as nobody has seen it.

#include <fmt/format.h>

#include <array>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "app/cli/default_output.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/document/export_choice.h"
#include "app/verbs/edition/script_request.h"
#include "core/base/files/file_suffix.h"
#include "core/base/system/log.h"
#include "core/base/text/parse_number.h"
#include "core/image_io/picture_file.h"
#include "core/mesh_io/mesh_io.h"
#include "core/seals/seal_average.h"
#include "core/seals/seal_band.h"
#include "core/seals/seal_picture.h"

namespace dubsar::app {
namespace {

struct SealRequest {
  std::string in, out, part = "auto", unit, as = "impression", turn = "none";
  std::vector<std::string> at;
  double height_mm = 17.0, dpi = 600.0, step_mm = 0.0;
  bool no_hatch = false;
};

Result<TriMesh> sealed_part(const SealRequest& request, Progress& progress) {
  TriMesh mesh;
  Result<TriMesh> envelope = fail(ErrorKind::kUsage, "not asked for");
  if (request.part == "auto" && is_exa_file(request.in))
    envelope = load_written_part(request.in, "envelope outside", request.unit, progress);
  if (envelope) {
    mesh = std::move(*envelope);
  } else {
    DUBSAR_ASSIGN(mesh,
                  load_written_part(request.in, request.part == "auto" ? "all" : request.part, request.unit, progress));
  }
  DUBSAR_TRY(expect_units(mesh, request.in));
  return mesh;
}

Result<std::vector<SealStrip>> strips_of(const SealRequest& request) {
  std::vector<SealStrip> out;
  for (const std::string& word : request.at) {
    const auto numbers = parse_numbers<6>(word);
    if (!numbers)
      return fail(ErrorKind::kUsage,
                  "--at {} found; expected six numbers with commas between, mm: the two ends of the middle line of an "
                  "impression, as x,y,z,x,y,z",
                  word);
    const auto& n = *numbers;
    out.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, request.height_mm});
  }
  return out;
}

Result<VerbResult> run_seal(const SealRequest& request, Progress& progress) {
  const std::string suffix = lower_suffix(request.out);
  const bool surface = suffix == ".ply" || suffix == ".stl" || suffix == ".obj" || suffix == ".glb";
  if (!surface) DUBSAR_TRY(picture_format_from_path(request.out));
  AverageOptions options;
  if (request.turn != "find") {
    const auto turn = request.turn == "none" ? std::optional<double>(-1.0) : parse_number(request.turn);
    if (!turn || (*turn <= 0.0 && request.turn != "none"))
      return fail(ErrorKind::kUsage, "--turn {} found; expected find, none, or the seal's circumference in mm",
                  request.turn);
    options.turn_mm = *turn;
  }
  DUBSAR_ASSIGN(const std::vector<SealStrip> strips, strips_of(request));
  DUBSAR_ASSIGN(const TriMesh mesh, sealed_part(request, progress));
  UnrollOptions unrolling;
  unrolling.step_mm = request.step_mm;
  std::vector<SealImpression> impressions;
  VerbResult result;
  double flattest = 1e9;
  for (std::size_t k = 0; k < strips.size(); ++k) {
    DUBSAR_ASSIGN(const UnrolledBand band, unroll(mesh, strips[k], unrolling));
    unrolling.step_mm = band.relief.step_mm;  // the same for all
    if (band.distortion.length_95 < flattest) {
      flattest = band.distortion.length_95;
      options.first = k;
    }
    impressions.push_back(level_impression(band.relief));
    const double wide = band.relief.width * band.relief.step_mm, high = band.relief.height * band.relief.step_mm;
    result.text += fmt::format(
        "impression {}: {:.1f} x {:.1f} mm, laid flat with lengths off by {:.2f} % and angles by {:.2f} degrees at "
        "most on "
        "95 % of it ({:.1f} % anywhere)\n",
        k + 1, wide, high, 100 * band.distortion.length_95, band.distortion.angle_95_deg,
        100 * band.distortion.length_most);
    result.json["impressions"].push_back({{"width_mm", wide},
                                          {"height_mm", high},
                                          {"length_off_95", band.distortion.length_95},
                                          {"length_off_most", band.distortion.length_most},
                                          {"angle_off_95_deg", band.distortion.angle_95_deg}});
  }
  const SealAverage average = average_seal(impressions, options);
  const bool as_stone = request.as == "stone";
  if (surface) {
    DUBSAR_TRY(write_mesh(request.out, seal_surface(average.relief, as_stone), {}, progress));
  } else {
    PictureOptions picture;
    picture.dpi = request.dpi;
    picture.description = fmt::format("seal, {}, average of {} impressions, 1:1", request.as, impressions.size());
    DUBSAR_TRY(
        write_picture(request.out, draw_seal(average.relief, {request.dpi, as_stone, !request.no_hatch}), picture));
  }
  std::size_t shown = 0, used = 0, twice = 0;
  for (std::size_t k = 0; k < average.relief.shown.size(); ++k) {
    shown += average.relief.shown[k] > 0.3f ? 1 : 0;
    twice += average.seen_by[k] > 1.5f ? 1 : 0;
  }
  for (std::size_t k = 0; k < impressions.size(); ++k) {
    used += average.used[k];
    result.json["impressions"][k]["used"] = average.used[k] != 0;
    result.json["impressions"][k]["likeness"] = average.placing.likeness[k];
    if (!average.used[k])
      result.text += fmt::format("impression {} is like none of the others and was left out\n", k + 1);
  }
  const double all = static_cast<double>(std::max<std::size_t>(average.relief.shown.size(), 1));
  const double wide = average.relief.width * average.relief.step_mm,
               high = average.relief.height * average.relief.step_mm;
  result.text +=
      fmt::format("{}: {:.1f} x {:.1f} mm of {} impressions, {:.0f} % shown, {:.0f} % by two or more\n", request.out,
                  wide, high, used, 100.0 * static_cast<double>(shown) / all, 100.0 * static_cast<double>(twice) / all);
  if (average.placing.turn_mm > 0.0)
    result.text += fmt::format("one turn of the seal is {:.1f} mm, its diameter {:.1f} mm\n", average.placing.turn_mm,
                               average.placing.turn_mm / std::numbers::pi);
  else if (options.turn_mm == 0.0)
    result.text += "how long one turn of the seal is was not found; --turn says it\n";
  result.json["output"] = request.out;
  result.json["width_mm"] = wide;
  result.json["height_mm"] = high;
  result.json["shown"] = static_cast<double>(shown) / all;
  result.json["turn_mm"] = average.placing.turn_mm > 0.0 ? nlohmann::json(average.placing.turn_mm) : nlohmann::json();
  return result;
}

}  // namespace

Verb add_seal_verb(Arguments program) {
  auto request = std::make_shared<SealRequest>();
  Arguments command = program.command("seal", "lay impressions of one seal flat, and make one of all of them");
  command.reads("IN", request->in, "EXA, PLY, OBJ, STL or GLB file").required();
  command
      .value(
          "--at", request->at,
          "an impression: x,y,z,x,y,z in mm, the two ends of its middle line on the surface; once for each impression")
      .required()
      .called("PLACES")
      .one_word_each_time();
  command.value("--height", request->height_mm, "height of the impressions, across the rolling, mm (17)").positive();
  command.value("--turn", request->turn,
                "circumference of the seal in mm; none (default); find: where impressions tell it");
  command.value("--as", request->as, "as its impression is (default), or as the stone: mirrored, and sunk")
      .one_of({"impression", "stone"});
  command.value("--step", request->step_mm, "of the raster, mm (half of the surface's usual edge, .05 to .25)")
      .not_negative();
  command.value("--dpi", request->dpi, "of a picture, which is at true scale (600)")
      .range(kPlateDpi.least, kPlateDpi.most);
  command.flag("--no-hatch", request->no_hatch, "what no impression shows stays gray");
  command.value("--part", request->part,
                "which part: the envelope's outside where there is one (auto), tablet, all, ...");
  command.value("--unit", request->unit, kUnitHelp);
  command.writes("-o,--output", request->out, FileFormat::kPictureOrMesh,
                 "PNG, TIFF or JPEG picture, or PLY, STL, OBJ or GLB surface. Unless given: beside IN, NAME_seal.png");
  command.footer(
      "Places are what the window shows for a point of the surface.\n"
      "Examples:\n"
      "  dubsar seal envelope.exa --at 5.1,8.0,60.2,64.0,8.1,60.5 --at 5.2,8.1,12.0,64.1,8.0,12.3 -o seal.tif\n"
      "  dubsar seal envelope.exa --at 5.1,8.0,60.2,64.0,8.1,60.5 --height 21 --turn 38.2 --as stone -o seal.stl");
  return {command, [request](const CommonOptions&, Progress& progress) { return run_seal(*request, progress); },
          [request] {
            if (request->out.empty()) request->out = output_beside(request->in, "_seal.png");
          }};
}

}  // namespace dubsar::app
