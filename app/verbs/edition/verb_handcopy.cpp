// dubsar handcopy IN -o F.svg|pdf|dxf: the six sides of a tablet as a line drawing of their wedges, at true scale.

#include <fmt/format.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "app/cli/default_output.h"
#include "app/cli/verb.h"
#include "app/verbs/edition/script_request.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_suffix.h"
#include "core/base/system/log.h"
#include "core/edition/line_number.h"
#include "core/edition/text_passages.h"
#include "core/edition/typed_letters.h"
#include "core/script/copy_text.h"
#include "core/script/hand_copy.h"

namespace dubsar::app {
namespace {

struct HandCopyRequest {
  ScriptRequest script;
  HandCopyOptions copy;
  std::string side = "all", atf;
};

/// Sides of ATF that a hand copy has.
constexpr std::array<std::pair<std::string_view, TextSide>, 6> kAtfSides{{{"obverse", TextSide::kObverse},
                                                                          {"bottom", TextSide::kLowerEdge},
                                                                          {"reverse", TextSide::kReverse},
                                                                          {"top", TextSide::kUpperEdge},
                                                                          {"left", TextSide::kLeftEdge},
                                                                          {"right", TextSide::kRightEdge}}};

/// The lines of the text that belong on the sheet.
struct CopiedText {
  TabletRecord record;
  std::vector<CopyTextLine> lines;
};
Result<CopiedText> read_copied_text(const HandCopyRequest& request) {
  DUBSAR_ASSIGN(const std::string bytes, read_text_file(request.atf, std::int64_t{64} << 20));
  TabletRecord wanted;
  wanted.museum_number = request.copy.title;
  DUBSAR_ASSIGN(const AtfFile text, text_of_atf(read_atf(bytes), wanted, request.atf));
  for (const AtfFault& fault : check_atf(text))
    if (!fault.only_warning)
      log(LogLevel::kWarning,
          fmt::format("{}, line {} of the text, column {}: {}", request.atf, fault.line, fault.column, fault.message));
  CopiedText out{record_of(text), {}};
  const std::string object = request.script.part.starts_with("envelope") ? "envelope" : "tablet";
  const bool plain = lower_suffix(request.script.out) != ".svg";  // the faces of PDF and DXF have no such letters
  for (const TextPassage& passage : passages_of(text)) {
    if (passage.spot.object != object) continue;
    for (const auto& [name, side] : kAtfSides)
      if (passage.spot.surface == name && (request.copy.whole_plate || request.copy.side == side))
        out.lines.push_back(
            {side, (passage.spot.column > 0 ? roman_number(passage.spot.column) + " " : "") + passage.spot.number,
             plain ? ascii_letters(passage.text) : passage.text});
  }
  return out;
}

Result<VerbResult> run_handcopy(const HandCopyRequest& request, Progress& progress) {
  const std::string& out = request.script.out;
  const std::string suffix = lower_suffix(out);
  if (suffix != ".svg" && suffix != ".pdf" && suffix != ".dxf")
    return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .svg, .pdf or .dxf", out);
  HandCopyOptions copy = request.copy;
  copy.whole_plate = request.side == "all";
  for (const auto& side : kTextSides)
    if (side.name == request.side) copy.side = side.value;
  CopiedText text;
  if (!request.atf.empty()) {
    HandCopyRequest of_text = request;
    of_text.copy = copy;
    DUBSAR_ASSIGN(text, read_copied_text(of_text));
    if (copy.title.empty()) copy.title = name_of(text.record);
  }
  DUBSAR_ASSIGN(const ScriptSurface surface, read_script(request.script, progress));
  copy.marks = surface.marks;
  DUBSAR_ASSIGN(CopySheet sheet, hand_copy(surface.mesh, surface.found, copy));
  const std::vector<TextSide> differ = add_text(sheet, text.lines);
  DUBSAR_TRY(write_file_atomically(out, suffix == ".svg"   ? svg_of(sheet)
                                        : suffix == ".pdf" ? pdf_of(sheet)
                                                           : dxf_of(sheet)));
  VerbResult result;
  result.text = fmt::format("{}: {} wedges on {:.1f} x {:.1f} mm, scale 1:1\n", out, surface.found.wedges.size(),
                            sheet.width_mm, sheet.height_mm);
  if (surface.kept) result.text += kept_words(surface.found.wedges);
  for (const TextSide side : differ)
    result.text +=
        fmt::format("{}: the text has other lines than were found; numbers beside the drawing are those found\n",
                    name_in(kTextSides, side));
  if (!surface.found.sides.frame().sure()) result.text += surface.found.sides.frame().doubt() + "\n";
  result.json = {{"output", out},
                 {"wedges", surface.found.wedges.size()},
                 {"rulings", surface.marks.rulings.size()},
                 {"cracks", surface.marks.cracks.size()},
                 {"seals", surface.marks.sealings.size()},
                 {"kept", surface.kept},
                 {"width_mm", sheet.width_mm},
                 {"height_mm", sheet.height_mm},
                 {"text_lines", text.lines.size()},
                 {"up_probability", surface.found.sides.frame().up_probability}};
  return result;
}

}  // namespace

Verb add_handcopy_verb(Arguments program, KeptDocument kept) {
  auto request = std::make_shared<HandCopyRequest>();
  request->script.kept = std::move(kept);
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
  command.reads("--atf", request->atf,
                "transliteration (ATF), whose lines stand beside the drawing with their numbers");
  command.value("--title", request->copy.title, "stands above and in the file, e.g. \"AO 8295\"");
  command.footer(
      "Examples:\n"
      "  dubsar handcopy tablet.exa\n"
      "  dubsar handcopy tablet.exa -o ao8295.pdf --title \"AO 8295\" --style filled\n"
      "  dubsar handcopy tablet.exa -o obverse.svg --side obverse\n"
      "  dubsar handcopy tablet.exa -o ao8295.svg --atf ao8295.atf");
  return {command, [request](const CommonOptions&, Progress& progress) { return run_handcopy(*request, progress); },
          [request] {
            if (request->script.out.empty()) request->script.out = output_beside(request->script.in, "_handcopy.svg");
          }};
}

}  // namespace dubsar::app
