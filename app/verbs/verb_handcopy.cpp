// dubsar handcopy IN -o F.svg|pdf|dxf: the six sides of a tablet as a line drawing of their wedges, at true scale.

#include <fmt/format.h>

#include <memory>

#include "app/cli/default_output.h"
#include "app/cli/verb.h"
#include "app/verbs/script_request.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_suffix.h"
#include "core/script/hand_copy.h"

namespace dubsar::app {
namespace {

struct HandCopyRequest {
  ScriptRequest script;
  HandCopyOptions copy;
  std::string side = "all";
};

Result<VerbResult> run_handcopy(const HandCopyRequest& request, Progress& progress) {
  const std::string& out = request.script.out;
  const std::string suffix = lower_suffix(out);
  if (suffix != ".svg" && suffix != ".pdf" && suffix != ".dxf")
    return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .svg, .pdf or .dxf", out);
  HandCopyOptions copy = request.copy;
  copy.whole_plate = request.side == "all";
  for (const auto& side : kTextSides)
    if (side.name == request.side) copy.side = side.value;
  DUBSAR_ASSIGN(const ScriptSurface surface, read_script(request.script, progress));
  DUBSAR_ASSIGN(const CopySheet sheet, hand_copy(surface.mesh, surface.found, copy));
  DUBSAR_TRY(write_file_atomically(out, suffix == ".svg"   ? svg_of(sheet)
                                        : suffix == ".pdf" ? pdf_of(sheet)
                                                           : dxf_of(sheet)));
  VerbResult result;
  result.text = fmt::format("{}: {} wedges on {:.1f} x {:.1f} mm, scale 1:1\n", out, surface.found.wedges.size(),
                            sheet.width_mm, sheet.height_mm);
  if (!surface.found.sides.frame().sure()) result.text += surface.found.sides.frame().doubt() + "\n";
  result.json = {{"output", out},
                 {"wedges", surface.found.wedges.size()},
                 {"width_mm", sheet.width_mm},
                 {"height_mm", sheet.height_mm},
                 {"up_probability", surface.found.sides.frame().up_probability}};
  return result;
}

}  // namespace

Verb add_handcopy_verb(Arguments program) {
  auto request = std::make_shared<HandCopyRequest>();
  request->copy.made_by = "dubsar " DUBSAR_VERSION;
  Arguments command = program.command("handcopy", "draw the wedges of a tablet at true scale, as a hand copy");
  add_script_options(command, request->script);
  command.writes("-o,--output", request->script.out, FileFormat::kEdition,
                 "SVG, PDF or DXF file to write. Unless given: beside IN, NAME_handcopy.svg");
  std::vector<std::string> sides{"all"};
  for (const auto& side : kTextSides) sides.emplace_back(side.name);
  command
      .value("--side", request->side, "one side alone: obverse, lower-edge, reverse, upper-edge, left-edge, right-edge")
      .one_of(sides);
  command.choice<CopyStyle>("--style", request->copy.style, choices_of(kCopyStyles),
                            "heads outlined, filled, or with lines weighted by depth (outlined, filled, weighted)");
  command.value("--title", request->copy.title, "stands above and in the file, e.g. \"AO 8295\"");
  command.footer(
      "Examples:\n"
      "  dubsar handcopy tablet.exa\n"
      "  dubsar handcopy tablet.exa -o ao8295.pdf --title \"AO 8295\" --style filled\n"
      "  dubsar handcopy tablet.exa -o obverse.svg --side obverse");
  return {command, [request](const CommonOptions&, Progress& progress) { return run_handcopy(*request, progress); },
          [request] {
            if (request->script.out.empty()) request->script.out = output_beside(request->script.in, "_handcopy.svg");
          }};
}

}  // namespace dubsar::app
