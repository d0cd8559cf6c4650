// dubsar report IN.exa -o report.html: a page about a surface that a colleague opens in a browser.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <numbers>

#include "app/cli/default_output.h"
#include "app/cli/mesh_input.h"
#include "app/cli/verb.h"
#include "app/document/text_lines.h"
#include "app/publish/fat_cross.h"
#include "app/publish/report_page.h"
#include "app/publish/seen_colors.h"
#include "app/verbs/told_session.h"
#include "app/verbs/work_of_surface.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/input_file.h"
#include "core/edition/line_label.h"
#include "core/image_io/jpeg_file.h"
#include "core/mesh/simplify.h"
#include "core/mesh/tablet_frame.h"
#include "core/mesh_io/mesh_io.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

struct ReportRequest {
  std::string in, out, title, style = "raking", institution, rights;
  std::vector<std::string> told;
  double dpi = 150.0;
  std::int64_t triangles = 300000;
};

constexpr std::array<const char*, kTabletSides.size()> kSideNames{"obverse",    "reverse",   "upper edge",
                                                                  "lower edge", "left edge", "right edge"};

/// The surface as the page shows it, in the tablet's own axes: its GLB, made beside the page, where there is room.
Result<std::string> glb_bytes(const fs::path& page, TriMesh mesh, const Shading& look, Progress& progress) {
  color_as_seen(mesh, look.style);
  fs::path file = page;
  file += ".tmp-surface.glb";
  const auto written = write_mesh(file, mesh, {}, progress);
  Result<std::string> bytes = written ? read_file_bytes(file) : Result<std::string>(tl::unexpect, written.error());
  std::error_code ignored;
  fs::remove(file, ignored);
  return bytes;
}

Result<std::string> jpeg_bytes(const Image& image, double dpi) {
  JpegOptions options;
  options.dpi = dpi;
  options.quality = 88;
  return encode_jpeg(image, options);
}

/// The sides of what was written on: the tablet where there is one.
Result<std::vector<ReportPicture>> pictures_of(const ReportRequest& options, const TriMesh& upright,
                                               const Shading& look, Progress& progress) {
  FatCrossOptions draw;
  draw.dpi = options.dpi;
  draw.shading = look;
  DUBSAR_TRY(dress_as_told(upright, options.style, options.told, draw.shading, progress));
  draw.ground = {16, 17, 19};
  DUBSAR_ASSIGN(const FatCross cross, draw_fat_cross(upright, draw, progress));
  std::vector<ReportPicture> pictures;
  for (std::size_t k = 0; k < cross.sides.size(); ++k) {
    DUBSAR_ASSIGN(std::string jpeg, jpeg_bytes(cross.sides[k], options.dpi));
    pictures.push_back({kSideNames[k], std::move(jpeg)});
  }
  return pictures;
}

/// Record, lines as they are read, pins and measures of a document.
ReportWork report_work(const Document& kept, const TabletFrame& way) {
  ReportWork out;
  const TabletRecord& r = kept.edition.record;
  const std::array<std::pair<const char*, const std::string*>, 6> said{{{"museum number", &r.museum_number},
                                                                        {"CDLI", &r.p_number},
                                                                        {"title", &r.title},
                                                                        {"kept at", &r.institution},
                                                                        {"language", &r.language},
                                                                        {"edition by", &r.creator}}};
  for (const auto& [name, value] : said)
    if (!value->empty()) out.record.push_back({name, *value, {}});
  for (const TextPassage& line : passages_of(kept))
    out.lines.push_back({(line.spot.object == "tablet" ? "" : line.spot.object + " ") + line_label(line.spot),
                         line.text, line.translation});
  for (const Note& note : kept.notes)
    if (!is_text_line(note) || !spot_of(note)) out.notes.push_back({note.label, note.text, note.part});
  const glm::dmat3 turn = way.tablet_from_model();
  for (const Note& note : kept.notes)
    out.pins.push_back(
        {note.label, note.text, turn * note.at_mm, turn * note.normal, note.part.starts_with("envelope")});
  for (const Measure& measure : kept.measures)
    out.measures.push_back({measure.name, figures_text(measure), measure.part});
  return out;
}

Result<VerbResult> run(const ReportRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(const Shading look, shading_preset(options.style));
  DUBSAR_TRY(check_told(options.told));
  DUBSAR_ASSIGN(const Shading relief, shading_preset("relief"));
  DUBSAR_ASSIGN(TriMesh mesh, load_mesh({options.in, {}, true}, progress));
  ReportContent content;
  DUBSAR_ASSIGN(content.facts, surface_facts(mesh));
  const Document kept = kept_work(options.in, mesh).value_or(Document());
  const TabletRecord& record = kept.edition.record;
  content.title = !options.title.empty() ? options.title : name_of(record);
  if (content.title.empty()) content.title = fs::path(options.in).stem().string();
  content.made_by = "dubsar " DUBSAR_VERSION;
  content.institution = options.institution.empty() ? record.institution : options.institution;
  content.rights = options.rights.empty() ? record.rights : options.rights;
  content.work = report_work(kept, content.facts.way);
  content.provenance = mesh.provenance;
  TriMesh written = mesh;
  if (mesh.partitions.find(PartitionKind::kTablet) != nullptr) {
    DUBSAR_ASSIGN(written, load_mesh({options.in, {"tablet"}, true}, progress));
  }
  const TabletFrame& way = content.facts.way;
  DUBSAR_ASSIGN(content.pictures, pictures_of(options, in_tablet_frame(std::move(written), way), look, progress));
  TriMesh shown = in_tablet_frame(std::move(mesh), way);
  const auto most = static_cast<std::size_t>(options.triangles);
  // Coarser until it fits; the last step is taken as it comes, because borders of parts always stay.
  for (double distance_mm = 0.02; shown.triangles.size() > most && distance_mm < 0.2; distance_mm *= 2.5) {
    DUBSAR_ASSIGN(shown, simplify(shown, {30.0 * std::numbers::pi / 180.0, distance_mm}, progress));
    content.simplified = true;
  }
  const std::size_t triangles = shown.triangles.size();
  DUBSAR_ASSIGN(content.glb, glb_bytes(options.out, std::move(shown), relief, progress));
  const std::string page = report_page(content);
  DUBSAR_TRY(write_file_atomically(options.out, page));
  VerbResult result;
  result.json = {{"output", options.out},
                 {"bytes", page.size()},
                 {"glb_bytes", content.glb.size()},
                 {"triangles", triangles},
                 {"lines", content.work.lines.size()},
                 {"notes", content.work.notes.size()},
                 {"measures", content.work.measures.size()},
                 {"facts", facts_json(content.facts)}};
  result.text = fmt::format("{}: {:.1f} MB, opens in any browser, needs no network\n", options.out,
                            1e-6 * static_cast<double>(page.size()));
  if (!way.sure()) result.text += way.doubt() + ": look at the sides\n";
  return result;
}

}  // namespace

Verb add_report_verb(Arguments program) {
  auto options = std::make_shared<ReportRequest>();
  Arguments command =
      program.command("report", "a page to send to a colleague: figures, six sides, the surface to turn in a browser");
  command.reads("IN", options->in, "EXA, PLY, OBJ, STL or GLB file").required();
  command.writes("-o,--output", options->out, FileFormat::kOther,
                 "HTML file to write; unless given: beside IN, NAME_report.html");
  command.value("--title", options->title, "of the page, e.g. \"AO 8295\"; else the file's name");
  command.value("--institution", options->institution, "where the tablet is");
  command.value("--rights", options->rights, "who may do what with the page");
  command.value("--style", options->style, "shading of the six sides, as of render (raking)");
  add_do_option(command, options->told);
  command.value("--dpi", options->dpi, "dots an inch of the six sides (150)").range(50.0, 1200.0);
  command.value("--triangles", options->triangles, "most triangles of the surface in the page (300000), about");
  command.footer(
      "Examples:\n  dubsar report tablet.exa\n  dubsar report tablet.exa -o ao8295.html --title \"AO 8295\"");
  return {command, [options](const CommonOptions&, Progress& progress) { return run(*options, progress); },
          [options] {
            if (options->out.empty()) options->out = output_beside(options->in, "_report.html");
          }};
}

}  // namespace dubsar::app
