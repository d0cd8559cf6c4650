// dubsar phantom OUT.h5: the scan of an enclosed tablet that never was, and the truth about it.

#include <fmt/format.h>

#include <memory>

#include "app/cli/verb.h"
#include "core/phantom/write_phantom.h"
#include "core/volume/formats/import_options.h"

namespace dubsar::app {
namespace {
struct PhantomRequest {
  std::string out, size, preset = "demo", truth, scanner;
  bool scanned = false, recipe = false;  ///< a simulated scanner; options of the recipe that it replaces
  std::uint64_t seed = 1;
  phantom::PhantomOptions model;
  bool unwritten = false;
};

std::string scanner_text(const phantom::ScannerReport& scan) {
  const phantom::ScanGeometry& g = scan.geometry;
  std::string text =
      fmt::format("{} views over {} turn, {}x{} pixels, {}\n", g.views, g.full ? "a full" : "half a", g.columns, g.rows,
                  g.cone() ? fmt::format("source {:.0f} mm from the axis", g.source * g.voxel_mm) : "parallel rays");
  text += fmt::format("the longest ray passes {:.0f} mm of clay ({:.3f} a millimetre) and keeps {:.2g} % of its light",
                      scan.longest_mm, scan.clay_per_mm, 100.0 * scan.least_light);
  if (scan.stray_light > 0.0)
    text += fmt::format("; scatter adds {:.2g} %, so that a detail has {:.0f} % of its contrast there",
                        100.0 * scan.stray_light, 100.0 * scan.least_light / (scan.least_light + scan.stray_light));
  return text + "\n";
}

nlohmann::json scanner_json(const phantom::ScannerReport& scan) {
  const phantom::ScanGeometry& g = scan.geometry;
  return {{"views", g.views},
          {"full_turn", g.full},
          {"columns", g.columns},
          {"rows", g.rows},
          {"source_mm", g.cone() ? nlohmann::json(g.source * g.voxel_mm) : nlohmann::json()},
          {"longest_mm", scan.longest_mm},
          {"least_light", scan.least_light},
          {"stray_light", scan.stray_light},
          {"clay_per_mm", scan.clay_per_mm}};
}

Result<VerbResult> run(const PhantomRequest& options, Progress& progress) {
  DUBSAR_ASSIGN(phantom::PhantomOptions wanted, phantom::parse_preset(options.preset));
  if (!options.size.empty()) {
    DUBSAR_ASSIGN(const auto dims, parse_dims(options.size));
    wanted.dims = {dims[0], dims[1], dims[2]};
    wanted.voxel_mm = 0.0;
  }
  wanted.seed = options.seed;
  const phantom::PhantomOptions& model = options.model;
  wanted.snr_db = model.snr_db;
  wanted.contact = model.contact;
  wanted.film_vox = model.film_vox;
  wanted.contact_share = model.contact_share;
  wanted.gap_vox = model.gap_vox;
  wanted.wedge_depth_vox = model.wedge_depth_vox;
  wanted.envelope_density = model.envelope_density;
  wanted.rings = model.rings;
  wanted.blur_vox = model.blur_vox;
  wanted.artefacts = model.artefacts;
  wanted.writing.written = !options.unwritten;
  wanted.writing.seals_lost = model.writing.seals_lost;
  if (options.scanned) {
    if (options.recipe)
      return fail(
          ErrorKind::kUsage,
          "phantom: --snr, --blur and --rings, --cupping and --streaks belong to the recipe without a scanner; with "
          "--scanner say photons=, blur=, rings= and scatter= in its list");
    DUBSAR_ASSIGN(wanted.scanner, phantom::parse_scanner(options.scanner));
  }
  std::optional<std::filesystem::path> truth;
  if (!options.truth.empty()) truth = options.truth;
  DUBSAR_ASSIGN(const phantom::PhantomReport report, phantom::write_phantom(options.out, truth, wanted, progress));
  const phantom::PhantomOptions& made = report.options;
  VerbResult result;
  result.text =
      fmt::format("{}: {}x{}x{} voxels of {:.4f} mm, seed {}, {}\n", options.out, made.dims.x, made.dims.y, made.dims.z,
                  made.voxel_mm, made.seed, report.scanner ? "scanned" : fmt::format("SNR {:.1f} dB", made.snr_db));
  if (report.scanner) result.text += scanner_text(*report.scanner);
  result.text += fmt::format(
      "{} wedges on the tablet, {} on the envelope, {} "
      "pores, "
      "glued over {:.1f} % of the tablet{}\n",
      report.tablet_wedges, report.envelope_wedges, report.pores, 100.0 * report.glued_fraction,
      report.cracked ? ", envelope cracked" : "");
  const auto& cases = report.wedges_by_case;
  result.text += fmt::format("contact {}: wedges {} free, {} pockets, {} under a film, {} filled\n",
                             name_in(phantom::kContacts, made.contact), cases[0], cases[1], cases[2], cases[3]);
  if (truth) result.text += fmt::format("{}: labels, distances, interface, wedges\n", options.truth);
  result.json = {{"output", options.out},
                 {"dims", {made.dims.x, made.dims.y, made.dims.z}},
                 {"voxel_size_mm", made.voxel_mm},
                 {"seed", made.seed},
                 {"glued_fraction", report.glued_fraction},
                 {"cracked", report.cracked},
                 {"tablet_wedges", report.tablet_wedges},
                 {"envelope_wedges", report.envelope_wedges},
                 {"contact", name_in(phantom::kContacts, made.contact)},
                 {"pores", report.pores}};
  if (report.scanner) {
    result.json["scanner"] = scanner_json(*report.scanner);
  } else {
    result.json["snr_db"] = made.snr_db;
    result.json["blur_vox"] = made.blur_vox;
    result.json["sigma"] = report.sigma;
  }
  if (made.contact == phantom::Contact::kFilm) result.json["film_vox"] = made.film_vox;
  for (const auto& state : phantom::kWedgeCases)
    result.json["wedges"][std::string(state.name)] = cases[static_cast<std::size_t>(state.value)];
  if (truth) result.json["truth"] = options.truth;
  return result;
}
}  // namespace

Verb add_phantom_verb(Arguments program) {
  auto options = std::make_shared<PhantomRequest>();
  Arguments command = program.command("phantom", "make the scan of an enclosed tablet with known truth");
  command.writes("OUT", options->out, FileFormat::kPhantom, "HDF5 file to write").required();
  command.value("--preset", options->preset, "size: tiny, demo (512x272x472) or paper (1871x999x1723)")
      .one_of({"tiny", "demo", "paper"});
  command.value("--size", options->size, "size NXxNYxNZ in voxels, instead of a preset");
  command.value("--seed", options->seed, "another number, another tablet");
  phantom::PhantomOptions& model = options->model;
  command.value("--snr", model.snr_db, "signal-to-noise ratio of the raw scan in dB").range(0.0, 120.0);
  command.value("--blur", model.blur_vox, "standard deviation of the point spread in voxels (default 0.577)")
      .range(0.3, 1.1);
  command.writes("--truth", options->truth, FileFormat::kPhantom,
                 "HDF5 file for labels, signed distances, the true interface and the table of wedges");
  Arguments contact = command.group("Tablet and envelope");
  contact.choice<phantom::Contact>(
      "--contact", model.contact, choices_of(phantom::kContacts),
      "where they touch: pressed into each other (default), pockets (wedges stay full of air), filled (no air), film");
  contact.value("--film", model.film_vox, "thickness of the film of --contact film in voxels (default 0.5)")
      .range(0.05, 2.0);
  contact
      .value("--contact-share", model.contact_share, "share of the tablet that touches (default: 0.08 to 0.26, drawn)")
      .range(0.01, 0.6);
  contact.value("--gap", model.gap_vox, "gap elsewhere in voxels (default: 0.3 mm)").range(1.0, 64.0);
  contact.value("--wedge-depth", model.wedge_depth_vox, "depth of a usual wedge in voxels (default 7, or 0.45 mm)")
      .range(2.0, 64.0);
  contact.flag("--unwritten", options->unwritten, "nobody wrote on the tablet");
  contact
      .value("--seals-lost", model.writing.seals_lost,
             "share of each impression of the seal on the envelope that is worn or broken away")
      .range(0.0, 0.9);
  contact.value("--envelope-density", model.envelope_density, "of its clay, relative to the tablet's").range(0.5, 1.5);
  contact.value("--rings", model.rings, "ring artefacts: standard deviation relative to clay").range(0.0, 1.0);
  contact.value("--cupping", model.artefacts.cupping, "how much less clay counts at the axis of rotation, share")
      .range(0.0, 0.5);
  contact
      .value("--streaks", model.artefacts.streaks, "streaks between dense points: standard deviation relative to clay")
      .range(0.0, 0.3);
  contact
      .value("--holder", model.artefacts.holder, "density of a holder that the lower end stands in, relative to clay")
      .range(0.02, 3.0);
  command
      .value("--scanner", options->scanner,
             "scans it as an X-ray scanner does, instead of the recipe of --snr, --blur and --rings: good (default), "
             "mild, medium, strong or ideal, then key=value, all with commas between: kv, filter, mono, clay, lime, "
             "photons, electronic, scatter, spread, glare, rings, bad, blur, turn=half|full, views, cone, axis, start, "
             "window=none|shepp|cosine|hann, file=float|uint16|hu, pad=none|min|nan|NUMBER, blank (docs/scans.md)")
      .words(0, 1);
  command.footer(
      "Examples:\n  dubsar phantom scan.h5 --preset demo\n  dubsar phantom scan.h5 --size 512x512x512 --seed 7 --truth "
      "truth.h5\n  dubsar phantom scan.h5 --contact film --film 0.3 --wedge-depth 10 --truth truth.h5\n  "
      "dubsar phantom scan.h5 --size 256x160x240 --scanner medium,turn=half,cone=0 --truth truth.h5");
  return {command, [options, command](const CommonOptions&, Progress& progress) {
            options->scanned = command.given("--scanner");
            options->recipe = command.given("--snr") || command.given("--blur") || command.given("--rings") ||
                              command.given("--cupping") || command.given("--streaks");
            return run(*options, progress);
          }};
}

}  // namespace dubsar::app
