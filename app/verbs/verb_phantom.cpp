// dubsar phantom OUT.h5: the scan of an enclosed tablet that never was, and the truth about it.

#include <fmt/format.h>

#include <memory>

#include "app/cli/verb.h"
#include "core/phantom/write_phantom.h"
#include "core/volume/import_options.h"

namespace dubsar::app {
namespace {
struct Options {
  std::string out, size, preset = "demo", truth;
  std::uint64_t seed = 1;
  double snr_db = 17.0;
};

Result<VerbResult> run(const Options& options, Progress& progress) {
  DUBSAR_ASSIGN(phantom::PhantomOptions wanted, phantom::parse_preset(options.preset));
  if (!options.size.empty()) {
    DUBSAR_ASSIGN(const auto dims, parse_dims(options.size));
    wanted.dims = {dims[0], dims[1], dims[2]};
    wanted.voxel_mm = 0.0;
  }
  wanted.seed = options.seed;
  wanted.snr_db = options.snr_db;
  std::optional<std::filesystem::path> truth;
  if (!options.truth.empty()) truth = options.truth;
  DUBSAR_ASSIGN(const phantom::PhantomReport report, phantom::write_phantom(options.out, truth, wanted, progress));
  const phantom::PhantomOptions& made = report.options;
  VerbResult result;
  result.text = fmt::format(
      "{}: {}x{}x{} voxels of {:.4f} mm, seed {}, SNR {:.1f} dB\n{} wedges on the tablet, {} on the envelope, {} "
      "pores, "
      "glued over {:.1f} % of the tablet{}\n",
      options.out, made.dims.x, made.dims.y, made.dims.z, made.voxel_mm, made.seed, made.snr_db, report.tablet_wedges,
      report.envelope_wedges, report.pores, 100.0 * report.glued_fraction, report.cracked ? ", envelope cracked" : "");
  if (truth) result.text += fmt::format("{}: labels, distances, wedges\n", options.truth);
  result.json = {{"output", options.out},
                 {"dims", {made.dims.x, made.dims.y, made.dims.z}},
                 {"voxel_size_mm", made.voxel_mm},
                 {"seed", made.seed},
                 {"snr_db", made.snr_db},
                 {"sigma", report.sigma},
                 {"glued_fraction", report.glued_fraction},
                 {"cracked", report.cracked},
                 {"tablet_wedges", report.tablet_wedges},
                 {"envelope_wedges", report.envelope_wedges},
                 {"pores", report.pores}};
  if (truth) result.json["truth"] = options.truth;
  return result;
}
}  // namespace

Verb add_phantom_verb(Arguments program) {
  auto options = std::make_shared<Options>();
  Arguments command = program.command("phantom", "make the scan of an enclosed tablet with known truth");
  command.writes("OUT", options->out, FileFormat::kPhantom, "HDF5 file to write").required();
  command.value("--preset", options->preset, "size: tiny, demo (512x272x472) or paper (1871x999x1723)")
      .one_of({"tiny", "demo", "paper"});
  command.value("--size", options->size, "size NXxNYxNZ in voxels, instead of a preset");
  command.value("--seed", options->seed, "another number, another tablet");
  command.value("--snr", options->snr_db, "signal-to-noise ratio of the raw scan in dB").range(0.0, 120.0);
  command.writes("--truth", options->truth, FileFormat::kPhantom,
                 "HDF5 file for labels, signed distances and the table of wedges");
  command.footer(
      "Examples:\n  dubsar phantom scan.h5 --preset demo\n  dubsar phantom scan.h5 --size 512x512x512 --seed 7 --truth "
      "truth.h5");
  return {command, [options](const CommonOptions&, Progress& progress) { return run(*options, progress); }};
}

}  // namespace dubsar::app
