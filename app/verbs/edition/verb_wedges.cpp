// dubsar wedges IN -o F.csv|json: every wedge of a tablet as a row of a table.

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/default_output.h"
#include "app/cli/verb.h"
#include "app/verbs/edition/script_request.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_suffix.h"
#include "core/script/wedge_table.h"

namespace dubsar::app {
namespace {

Result<VerbResult> run_wedges(const ScriptRequest& request, Progress& progress) {
  const std::string suffix = lower_suffix(request.out);
  if (suffix != ".csv" && suffix != ".json")
    return fail(ErrorKind::kUsage, "cannot write {}: expected a name that ends in .csv or .json", request.out);
  DUBSAR_ASSIGN(const ScriptSurface surface, read_script(request, progress));
  const WedgesFound& found = surface.found;
  DUBSAR_TRY(write_file_atomically(request.out, suffix == ".csv"
                                                    ? wedges_csv(found.wedges)
                                                    : wedges_json(found, "dubsar " DUBSAR_VERSION, surface.marks)));
  VerbResult result;
  std::array<int, kWedgeKindCount> kinds{};
  for (const ScriptWedge& w : found.wedges) ++kinds[static_cast<std::size_t>(w.kind)];
  result.text = fmt::format("{}: {} wedges, heads usually {:.2f} mm wide\n", request.out, found.wedges.size(),
                            found.scale.width_mm);
  if (surface.kept) result.text += kept_words(found.wedges);
  result.json = {{"output", request.out},
                 {"wedges", found.wedges.size()},
                 {"usual_width_mm", found.scale.width_mm},
                 {"kept", surface.kept}};
  const ScriptMarks& marks = surface.marks;
  for (const auto& [name, count] :
       {std::pair("rulings", marks.rulings.size()), std::pair("cracks", marks.cracks.size()),
        std::pair("seals", marks.sealings.size())}) {
    if (count > 0) result.text += fmt::format("{} {}\n", count, name);
    result.json[name] = count;
  }
  for (std::size_t k = 0; k < kWedgeKindCount; ++k) {
    const auto name = name_in(kWedgeKinds, static_cast<WedgeKind>(k));
    result.json["kinds"][std::string(name)] = kinds[k];
    if (kinds[k] > 0) result.text += fmt::format("  {:<13}{}\n", name, kinds[k]);
  }
  if (!found.wedges.empty() && !found.sides.frame().sure()) result.text += found.sides.frame().doubt() + "\n";
  return result;
}

}  // namespace

Verb add_wedges_verb(Arguments program, KeptDocument kept) {
  auto request = std::make_shared<ScriptRequest>();
  request->kept = std::move(kept);
  Arguments command = program.command("wedges", "find the wedges of a tablet and write them as a table");
  add_script_options(command, *request);
  command.writes("-o,--output", request->out, FileFormat::kEdition,
                 "CSV or JSON file to write. Unless given: beside IN, NAME_wedges.csv");
  command.footer("Examples:\n  dubsar wedges tablet.exa\n  dubsar wedges tablet.exa -o ao8295.json --part tablet");
  return {command, [request](const CommonOptions&, Progress& progress) { return run_wedges(*request, progress); },
          [request] {
            if (request->out.empty()) request->out = output_beside(request->in, "_wedges.csv");
          }};
}

}  // namespace dubsar::app
