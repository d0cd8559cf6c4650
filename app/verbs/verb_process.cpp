// dubsar process IN -o OUT.exa: the whole way from a scan to separated surfaces, unattended.

#include <fmt/format.h>

#include <map>
#include <memory>

#include "app/cli/input_options.h"
#include "app/cli/verb.h"
#include "core/pipeline/report.h"

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

template <class T>
CLI::Option* add_choice(CLI::App& group, const std::string& name, T& target, const std::map<std::string, T>& choices,
                        const std::string& help) {
  std::string names;
  for (const auto& [text, value] : choices) names += (names.empty() ? "" : "|") + text;
  return group.add_option(name, target, help)->transform(CLI::CheckedTransformer(choices))->option_text(names);
}

void add_filter_options(CLI::App& command, Options& options) {
  PipelineOptions& p = options.pipeline;
  auto* const group = command.add_option_group("Filters and threshold");
  group->add_flag("--no-resample", options.no_resample, "skip Gauss 3x3x3 and 2:1 resampling");
  add_choice<DenoiseMethod>(*group, "--denoise", p.denoise.method,
                            {{"median", DenoiseMethod::kMedian},
                             {"gauss", DenoiseMethod::kGauss},
                             {"bilateral", DenoiseMethod::kBilateral},
                             {"joint", DenoiseMethod::kJointBilateral}},
                            "denoising filter (default joint)");
  add_choice<RangeWeight>(*group, "--range-weight", p.denoise.range,
                          {{"tukey", RangeWeight::kTukey}, {"gauss", RangeWeight::kGauss}},
                          "range weight of the bilateral filters (default tukey)");
  group->add_option("--window", p.denoise.window, "window of the filter in voxels")->check(CLI::IsMember({3, 5, 7}));
  group->add_option("--iterations", p.denoise.iterations, "passes of the filter, 0: none")->check(CLI::Range(0, 32));
  group->add_option("--sigma", p.denoise.sigma, "noise in grey values (default: estimated before each pass)")
      ->check(CLI::PositiveNumber);
  group
      ->add_option("--sharpen", options.sharpen,
                   "give edges back what 2:1 took: 0 off, 1 default where the noise allows it")
      ->check(CLI::Range(0.0, 4.0));
  group->add_option("--threshold", options.threshold, "isovalue in grey values (default: estimated)");
  add_choice<ThresholdMethod>(*group, "--threshold-method", p.estimate.method,
                              {{"auto", ThresholdMethod::kAuto},
                               {"valley", ThresholdMethod::kValley},
                               {"sigmas", ThresholdMethod::kSigmas},
                               {"half", ThresholdMethod::kHalf},
                               {"otsu", ThresholdMethod::kOtsu},
                               {"mixture", ThresholdMethod::kMixture}},
                              "how the isovalue is estimated (default auto)");
  group->add_option("--threshold-factor", p.estimate.factor, "the paper's f (default 2 for valley, 3 for sigmas)")
      ->check(CLI::PositiveNumber);
}

void add_surface_options(CLI::App& command, Options& options) {
  PipelineOptions& p = options.pipeline;
  auto* const group = command.add_option_group("Surface");
  group->add_option("--offset-bits", p.offset_bits, "bits per edge crossing, N")->check(CLI::Range(1, 16));
  group->add_flag("--open-boundary", options.open_boundary, "leave the surface open at the border of the volume");
  group->add_option("--smooth", p.smooth.normals.iterations, "iterations of the normal filter")
      ->check(CLI::Range(0, 1000));
  group->add_option("--vertex-iterations", p.smooth.vertex_iterations, "iterations of the vertex update")
      ->check(CLI::Range(0, 1000));
  add_choice<CurvatureMethod>(*group, "--curvature", p.curvature,
                              {{"fit", CurvatureMethod::kFit}, {"pairs", CurvatureMethod::kPairs}},
                              "curvature estimate: fit (default) or the paper's opposite pairs");
  add_choice<SegmentMethod>(
      *group, "--segment", p.segment.method,
      {{"nested", SegmentMethod::kNested},
       {"concavity", SegmentMethod::kConcavity},
       {"bodies", SegmentMethod::kBodies},
       {"none", SegmentMethod::kNone}},
      "how parts are separated: nested (default), the paper's concavity threshold, closed bodies, or none");
  group->add_option("--concavity", p.segment.concavity, "k_min per grid step below which --segment concavity cuts");
  group->add_flag("--no-fill-holes", options.no_holes, "leave the holes that segmentation cuts");
  group->add_flag("--no-ao", options.no_ao, "skip ambient occlusion");
  group->add_option("--ao-rays", options.rays, "rays per vertex")->check(CLI::Range(1, 65536));
  group->add_option("--ao-radius", options.radius, "reach of the rays in grid steps")->check(CLI::PositiveNumber);
}

Result<VerbResult> run(Options options, const CLI::App& command, const CommonOptions&, Progress& progress) {
  PipelineOptions& p = options.pipeline;
  DUBSAR_ASSIGN(p.import, parse_input_options(options.in, options.input));
  DUBSAR_TRY(check_output_path(options.out));
  p.resample = !options.no_resample;
  p.closed_boundary = !options.open_boundary;
  p.fill_holes = !options.no_holes;
  p.occlusion = !options.no_ao;
  p.occlusion_options.rays = options.rays;
  p.occlusion_options.radius_vox = static_cast<float>(options.radius);
  if (command.count("--sharpen") > 0) p.sharpen = static_cast<float>(options.sharpen);
  if (command.count("--threshold") > 0) p.threshold = static_cast<float>(options.threshold);
  DUBSAR_ASSIGN(PipelineResult result, run_pipeline(p, progress));
  DUBSAR_TRY(write_product(options.out, result, progress));
  VerbResult out;
  out.json = report_json(result.report, p);
  out.json["output"] = options.out;
  out.text = report_text(result.report) + options.out + "\n";
  return out;
}

}  // namespace

Verb add_process_verb(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("process", "turn a CT scan into separated, watertight surfaces (EXA)");
  command->add_option("IN", options->in, "HDF5, NRRD, TIFF (file or folder) or raw volume")->required();
  command->add_option("-o,--output", options->out, "EXA file to write")->required();
  add_input_options(*command, options->input);
  add_filter_options(*command, *options);
  add_surface_options(*command, *options);
  command->footer(
      "Examples:\n"
      "  dubsar process scan.h5 -o tablet.exa\n"
      "  dubsar process scan.h5 -o part.exa --crop 0:512,0:512,0:512 --no-ao\n"
      "  dubsar process scan.raw --dims 512x512x300 --type uint16 --voxel-size 38um -o tablet.exa\n"
      "  dubsar process scan.h5 -o tablet.exa --json report.json");
  return {command, [options, command](const CommonOptions& common, Progress& progress) {
            return run(*options, *command, common, progress);
          }};
}

}  // namespace dubsar::app
