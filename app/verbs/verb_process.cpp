// dubsar process IN -o OUT.exa: the whole way from a scan to separated surfaces, unattended.

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/input_options.h"
#include "app/cli/verb.h"
#include "core/pipeline/pipeline.h"

namespace dubsar::app {
namespace {

struct Options {
  std::string in, out;
  InputOptionTexts input;
  PipelineOptions pipeline;
  double threshold = 0.0, sharpen = 1.0, radius = 64.0;
  int rays = 160;
  bool no_resample = false, no_holes = false, no_ao = false, open_boundary = false;
};

void add_filter_options(Arguments command, Options& options) {
  PipelineOptions& p = options.pipeline;
  Arguments group = command.group("Filters and threshold");
  group.flag("--no-resample", options.no_resample, "skip Gauss 3x3x3 and 2:1 resampling");
  group.choice<DenoiseMethod>("--denoise", p.denoise.method, choices_of(kDenoiseMethods),
                              "denoising filter (default joint)");
  group.choice<RangeWeight>("--range-weight", p.denoise.range, choices_of(kRangeWeights),
                            "range weight of the bilateral filters (default tukey)");
  group.value("--window", p.denoise.window, "window of the filter in voxels").one_of({"3", "5", "7"});
  group.value("--iterations", p.denoise.iterations, "passes of the filter, 0: none").range(0, 32);
  group.value("--sigma", p.denoise.sigma, "noise in grey values (default: estimated before each pass)").positive();
  group.value("--sharpen", options.sharpen, "give edges back what 2:1 took: 0 off, 1 default where the noise allows it")
      .range(0.0, 4.0);
  group.value("--threshold", options.threshold, "isovalue in grey values (default: estimated)");
  group.choice<ThresholdMethod>("--threshold-method", p.estimate.method, choices_of(kThresholdMethods),
                                "how the isovalue is estimated (default auto)");
  group.value("--threshold-factor", p.estimate.factor, "the paper's f (default 2 for valley, 3 for sigmas)").positive();
}

void add_surface_options(Arguments command, Options& options) {
  PipelineOptions& p = options.pipeline;
  Arguments group = command.group("Surface");
  group.value("--offset-bits", p.sample.offset_bits, "bits per edge crossing, N").range(1, 16);
  group.flag("--open-boundary", options.open_boundary, "leave the surface open at the border of the volume");
  group.value("--smooth", p.smooth.normals.iterations, "iterations of the normal filter").range(0, 1000);
  group.value("--vertex-iterations", p.smooth.vertex_iterations, "iterations of the vertex update").range(0, 1000);
  group.choice<CurvatureMethod>("--curvature", p.curvature,
                                {{"fit", CurvatureMethod::kFit}, {"pairs", CurvatureMethod::kPairs}},
                                "curvature estimate: fit (default) or the paper's opposite pairs");
  group
      .value("--max-error", p.settle.max_error,
             "largest distance of a stored vertex from the smoothed surface in grid steps (default 1/16)")
      .positive();
  group.flag("--exact-normals", p.settle.exact_normals, "store normals and curvatures to the last bit");
  group.choice<SegmentMethod>(
      "--segment", p.segment.method, choices_of(kSegmentMethods),
      "how parts are separated: nested (default), the paper's concavity threshold, closed bodies, or none");
  group.value("--concavity", p.segment.concavity, "k_min per grid step below which --segment concavity cuts");
  group.flag("--no-fill-holes", options.no_holes, "leave the holes that segmentation cuts");
  group.flag("--no-ao", options.no_ao, "skip ambient occlusion");
  group.value("--ao-rays", options.rays, "rays per vertex").range(1, 65536);
  group.value("--ao-radius", options.radius, "reach of the rays in grid steps").positive();
}

/// The surface beside the scan: tablet.h5:/entry/data -> tablet.exa, a folder of slices -> its name and .exa.
void settle(Options& options) {
  if (!options.out.empty()) return;
  std::error_code ignored;
  const auto colon = options.in.rfind(":/");
  const bool dataset = colon != std::string::npos && !std::filesystem::exists(options.in, ignored);
  std::filesystem::path in(dataset ? options.in.substr(0, colon) : options.in);
  if (!in.has_filename()) in = in.parent_path();
  options.out = in.replace_extension(".exa").string();
}

Result<VerbResult> run(Options options, const Arguments command, const CommonOptions&, Progress& progress) {
  PipelineOptions& p = options.pipeline;
  DUBSAR_ASSIGN(p.import, parse_input_options(options.in, options.input));
  p.resample = !options.no_resample;
  p.sample.closed = !options.open_boundary;
  p.fill_holes = !options.no_holes;
  if (options.no_ao)
    p.occlusion.reset();
  else
    p.occlusion = OcclusionOptions{.rays = options.rays, .radius_vox = static_cast<float>(options.radius)};
  if (command.given("--sharpen")) p.sample.sharpen = static_cast<float>(options.sharpen);
  if (command.given("--threshold")) p.threshold = static_cast<float>(options.threshold);
  Result<PipelineResult> made = run_pipeline(p, progress);
  if (!made && made.error().kind == ErrorKind::kTryAgain)
    made.error().message += "; take a part of the scan with --crop, or fewer voxels with --stride";
  DUBSAR_ASSIGN(PipelineResult result, std::move(made));
  DUBSAR_TRY(write_product(options.out, result, progress));
  VerbResult out;
  out.json = report_json(result.report, p);
  out.json["output"] = options.out;
  out.text = report_text(result.report) + options.out + "\n";
  return out;
}

}  // namespace

Verb add_process_verb(Arguments program) {
  auto options = std::make_shared<Options>();
  Arguments command = program.command("process", "turn a CT scan into separated, watertight surfaces (EXA)");
  command.reads("IN", options->in, "HDF5, NRRD, TIFF (file or folder) or raw volume").required();
  command.writes("-o,--output", options->out, FileFormat::kExa,
                 "EXA file to write (default: beside IN, with the suffix .exa)");
  add_input_options(command, options->input);
  add_filter_options(command, *options);
  add_surface_options(command, *options);
  command.footer(
      "Examples:\n"
      "  dubsar process scan.h5 -o tablet.exa\n"
      "  dubsar process scan.h5 -o part.exa --crop 0:512,0:512,0:512 --no-ao\n"
      "  dubsar process scan.raw --dims 512x512x300 --type uint16 --voxel-size 38um -o tablet.exa\n"
      "  dubsar process scan.h5 -o tablet.exa --json report.json");
  return {command,
          [options, command](const CommonOptions& common, Progress& progress) {
            return run(*options, command, common, progress);
          },
          [options] { settle(*options); }};
}

}  // namespace dubsar::app
