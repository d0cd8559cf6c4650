#include "app/verbs/edition/script_request.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/document/document_file.h"
#include "core/base/numbers/median.h"
#include "core/base/system/log.h"
#include "core/script/correction/wedge_edits.h"

namespace dubsar::app {
namespace {

/// The wedges of the part that is asked for, as a session has them; none: nobody has looked for them.
Result<std::vector<ScriptWedge>> kept_wedges(const ScriptRequest& request, const TriMesh& mesh) {
  std::vector<ScriptWedge> out;
  if (request.found_alone) return out;
  Document document;
  if (!request.work.empty()) {
    DUBSAR_ASSIGN(Work work, load_work(request.work));
    document = std::move(work.document);
  } else if (request.kept && request.unit.empty()) {  // in another unit they lie elsewhere
    document = request.kept(request.in, mesh).value_or(Document());
  }
  const bool all = request.part == "all";
  const std::string part = request.part == "auto" ? "tablet" : request.part;
  for (const MarkedWedge& marked : document.edition.wedges)
    if (!marked.deleted && (all || marked.part.empty() || marked.part == part)) out.push_back(marked.wedge);
  number_in_order(out);
  return out;
}

}  // namespace

std::string kept_words(const std::vector<ScriptWedge>& wedges) {
  const auto machine =
      std::count_if(wedges.begin(), wedges.end(), [](const ScriptWedge& w) { return w.by == WedgeBy::kMachine; });
  return fmt::format("as a session kept them: {} found by the program, {} by people\n", machine,
                     static_cast<std::ptrdiff_t>(wedges.size()) - machine);
}

void add_script_options(Arguments& command, ScriptRequest& request) {
  command.reads("IN", request.in, "EXA, PLY, OBJ, STL or GLB file").required();
  command.value("--part", request.part, "which part: tablet where there is one (auto), all, envelope outside, ...");
  command.value("--unit", request.unit, kUnitHelp);
  command
      .value("--width", request.width_mm, "usual width of a head in mm, where the one found (see the result) is wrong")
      .not_negative();
  command.value("--confidence", request.confidence, "least confidence of a wedge, 0 to 1 (0.5)").range(0.0, 1.0);
  command.reads(
      "--work", request.work,
      "session (what `save_copy` wrote) whose wedges, as people corrected them, are taken; unless given: those "
      "that were kept when the surface was viewed");
  command.flag("--found", request.found_alone, "the wedges as the program finds them, whatever was kept");
}

Result<void> expect_units(const TriMesh& mesh, const std::string& in) {
  if (!mesh.frame.input_voxel.known()) {
    if (is_exa_file(in))
      return fail(ErrorKind::kUsage,
                  "{} does not say how large its voxels are, so there are no mm; process the scan again with "
                  "--voxel-size, e.g. 38um",
                  in);
    log(LogLevel::kWarning, fmt::format("{} does not state its units; taken as millimetres", in));
  }
  return {};
}

Result<ScriptSurface> read_script(const ScriptRequest& request, Progress& progress) {
  ScriptSurface out;
  DUBSAR_ASSIGN(out.mesh, load_written_part(request.in, request.part, request.unit, progress));
  DUBSAR_TRY(expect_units(out.mesh, request.in));
  WedgeSearch search;
  search.width_mm = request.width_mm;
  search.least_confidence = request.confidence;
  DUBSAR_ASSIGN(std::vector<ScriptWedge> kept, kept_wedges(request, out.mesh));
  if (kept.empty()) {
    DUBSAR_ASSIGN(out.found, find_wedges(out.mesh, search, progress));
  } else {
    out.kept = true;
    std::vector<double> widths;
    for (const ScriptWedge& w : kept) widths.push_back(w.width_mm);
    DUBSAR_ASSIGN(const TabletFrame frame, find_tablet_frame(out.mesh));
    out.found.scale.width_mm = median(widths);
    out.found.sides = TextSides(frame);
    out.found.wedges = std::move(kept);
  }
  out.marks = find_marks(out.mesh, out.found.sides, out.found.wedges);
  return out;
}

}  // namespace dubsar::app
