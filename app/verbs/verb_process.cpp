// dubsar process IN -o OUT.exa: the whole way from a scan to separated surfaces, unattended.

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/default_output.h"
#include "app/cli/input_options.h"
#include "app/cli/verb.h"
#include "app/publish/surface_facts.h"
#include "app/verbs/process_batch.h"
#include "core/base/numbers/units.h"
#include "core/base/system/budget.h"
#include "core/base/system/large_blocks.h"
#include "core/mesh_io/mesh_io.h"
#include "core/pipeline/pipeline.h"
#include "core/pipeline/report.h"

namespace dubsar::app {
namespace {

constexpr const char* kContactLabels = "labels";

/// Steps that are left out.
struct Without {
  bool resample = false, holes = false, contact = false, ao = false, cap = false;
};

/// What the machine is to give.
struct Room {
  std::string memory, scratch;
};

/// Ambient light.
struct LightRequest {
  OcclusionEngine engine = OcclusionEngine::kBricks;
  int rays = 160;
  double radius = 64.0;  ///< grid steps
};

struct ProcessRequest {
  std::vector<std::string> inputs;
  std::string in, out;  ///< of one scan
  std::string target;   ///< of many: their folder, or the surface of a run that may be resumed
  bool resume = false, many = false;
  InputOptionTexts input;
  PipelineOptions pipeline;
  double threshold = 0.0, sharpen = 1.0;
  LightRequest light;
  std::string contact = kContactLabels;  ///< how parts are closed where they touch
  Without without;
  Room room;
};

void add_filter_options(Arguments command, ProcessRequest& options) {
  PipelineOptions& p = options.pipeline;
  Arguments group = command.group("Filters and threshold");
  group.choice<Detail>(
      "--detail", p.detail, choices_of(kDetails),
      "grid of the surface: scan (all the scan has), half (Gauss 3x3x3 and 2:1, as in the paper), auto (default: scan "
      "where time and memory allow)");
  group.flag("--no-resample", options.without.resample, "the same as --detail scan");
  group.choice<Artefacts>("--artefacts", p.artefacts, choices_of(kArtefacts),
                          "what scatter and hardening took from the scan: auto (default: given back where it is "
                          "significant), off (the scan as it is)");
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
  group.choice<Levels>("--levels", p.sample.levels, choices_of(kLevels),
                       "of air and clay: local (default), the surface lies half way between those beside it where they "
                       "vary, or global, one threshold");
  group.value("--threshold-factor", p.estimate.factor, "the paper's f (default 2 for valley, 3 for sigmas)").positive();
}

void add_surface_options(Arguments command, ProcessRequest& options) {
  PipelineOptions& p = options.pipeline;
  Arguments group = command.group("Surface");
  group.value("--offset-bits", p.sample.offset_bits, "bits per edge crossing, N").range(1, 16);
  group.flag("--open-boundary", options.without.cap, "leave the surface open at the border of the volume");
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
  group.flag("--no-fill-holes", options.without.holes, "leave the holes that segmentation cuts");
  group.flag("--no-contact", options.without.contact, "close tablet and envelope smoothly where they touch");
  group
      .value("--contact", options.contact,
             "how parts are closed where they touch: labels, one mesh of all parts that crosses itself nowhere")
      .one_of({kContactLabels});
  group.flag("--no-ao", options.without.ao, "skip ambient occlusion");
  group.choice<OcclusionEngine>("--ao-by", options.light.engine, choices_of(kOcclusionEngines),
                                "what rays of ambient occlusion meet: march (default), distances on the grid, or "
                                "triangles, exact and slower");
  group.value("--ao-rays", options.light.rays, "rays per vertex").range(1, 65536);
  group.value("--ao-radius", options.light.radius, "reach of the rays in grid steps").positive();
}

void add_resource_options(Arguments command, ProcessRequest& options) {
  Arguments group = command.group("Memory and disk");
  group
      .value("--memory", options.room.memory,
             "most memory the program may take, such as 6G (default: what the machine has left); a grid that does not "
             "fit goes to the disk")
      .called("SIZE");
  group.value("--scratch", options.room.scratch, "folder on a disk for that (default /var/tmp)").called("FOLDER");
}

/// The phases of the run's plan, with their shares for a scan of the size of `--preset demo`.
std::vector<PlannedStage> plan_of(const ProcessRequest& options) {
  RunShape run;
  run.scan = {512, 272, 472};
  run.half = options.pipeline.detail == Detail::kHalf;
  run.vertices = usual_vertices(grid_of(run.scan, run.half));
  run.artefacts = options.pipeline.artefacts == Artefacts::kAuto;
  run.fill_holes = !options.without.holes;
  run.contact = !options.without.contact;
  run.noise.passes = options.pipeline.denoise.iterations;
  run.rays =
      options.without.ao ? 0.0 : options.light.rays * (options.light.engine == OcclusionEngine::kBricks ? 1.0 : 2.4);
  std::vector<PlannedStage> plan;
  for (const StagePlan& stage : kRunPlan)
    for (const StagePhase& phase : stage.phases)
      if (phase.name != nullptr && stage.wanted(run))
        plan.push_back({phase.name, phase.share * stage.core_s(run), stage.surface});
  return plan;
}

/// What was found, in words, and what can be done with it.
std::string summary(const std::string& out, const SurfaceFacts& facts, const PipelineReport& report) {
  const DetailChoice& detail = report.detail;
  std::string text = fmt::format("{}: {}\n\n{}", out, what_it_is(facts), facts_text(facts));
  text += fmt::format("\nDetail: {}; {}\n", detail.resample() ? "half of the scan's" : "that of the scan", detail.why);
  if (report.scan.rays && report.scan.rays->bent)
    text += fmt::format("\nThe scanner: {}\n{}\n", rays_text(*report.scan.rays, report.scan.frame), kAdviceForBentRays);
  if (report.scan.holder)
    text += fmt::format("\nThe scan: {}\n", describe(*report.scan.holder, report.scan.frame.input_voxel));
  if (report.scan.rings) text += fmt::format("\nThe scanner: {}\n", describe(*report.scan.rings));
  if (!facts.millimetres) text += "\nThe scan does not say how large its voxels are: give --voxel-size.\n";
  text += "\nNext:\n";
#ifdef DUBSAR_CORE_PROGRAM
  constexpr std::array kNext{"info", "exa verify"};
#else
  constexpr std::array kNext{"view", "fatcross", "report"};
#endif
  for (const char* const verb : kNext) text += fmt::format("  dubsar {} {}\n", verb, quoted(out));
  return text;
}

Result<VerbResult> run(ProcessRequest options, const Arguments& command, const CommonOptions& common,
                       Progress& progress) {
  PipelineOptions& p = options.pipeline;
  DUBSAR_ASSIGN(p.import, parse_input_options(options.in, options.input));
  if (options.room.memory.empty()) {
    keep_large_blocks();
  } else {
    DUBSAR_ASSIGN(const std::uint64_t bytes, parse_bytes(options.room.memory));
    set_memory_limit(bytes);
    share_heaps();
  }
  if (!options.room.scratch.empty()) p.import.budget.scratch_folder = options.room.scratch;
  if (options.without.resample) p.detail = Detail::kScan;
  if (options.without.contact) p.contact.reset();
  p.sample.closed = !options.without.cap;
  p.fill_holes = !options.without.holes;
  if (options.without.ao)
    p.occlusion.reset();
  else
    p.occlusion = OcclusionOptions{.engine = options.light.engine,
                                   .rays = options.light.rays,
                                   .radius_vox = static_cast<float>(options.light.radius)};
  if (command.given("--sharpen")) p.sample.sharpen = static_cast<float>(options.sharpen);
  if (command.given("--threshold")) p.threshold = static_cast<float>(options.threshold);
  Result<PipelineResult> made = run_pipeline(p, progress);
  if (!made && made.error().kind == ErrorKind::kTryAgain)
    made.error().message +=
        "; allow more with --memory, take --detail half where it is not taken yet, a part of the scan with --crop, or "
        "fewer voxels with --stride";
  DUBSAR_ASSIGN(PipelineResult result, std::move(made));
  DUBSAR_ASSIGN(const SurfaceFacts facts, surface_facts(result.mesh, result.report.mesh.watertight()));
  result.mesh = {};  // a file holds no triangles
  result.model.drawing.reset();
  DUBSAR_TRY(write_product(options.out, result, progress));
  VerbResult out;
  out.json = report_json(result.report, p);
  out.json["output"] = options.out;
  out.json["facts"] = facts_json(facts);
  out.text =
      (common.console.verbose ? report_text(result.report) + "\n" : "") + summary(options.out, facts, result.report);
  return out;
}

Result<VerbResult> run_many(const ProcessRequest& options, const Arguments& command, const CommonOptions& common,
                            Progress& progress) {
  ScanBatch batch;
  batch.resume = options.resume;
  batch.options = options_for_each(command.words(), options.inputs);
  if (!options.in.empty()) {
    batch.items = {{options.in, options.target}};
  } else {
    DUBSAR_ASSIGN(batch.items, batch_items(options.inputs, options.target));
  }
  DUBSAR_TRY(check_report(batch, common.json_path));
  return process_batch(batch, progress);
}

/// What is one scan, and what many: a run that may be resumed is a batch of one.
void settle(ProcessRequest& options) {
  const bool one = options.inputs.size() == 1 && !is_scan_folder(options.inputs[0]);
  options.many = !one || options.resume;
  if (one) {
    options.in = options.inputs[0];
    if (options.out.empty()) options.out = output_beside(options.in, ".exa");
  }
  if (options.many) options.target = std::exchange(options.out, {});
}

}  // namespace

Verb add_process_verb(Arguments program) {
  auto options = std::make_shared<ProcessRequest>();
  Arguments command = program.command("process", "turn a CT scan into separated, watertight surfaces (EXA)");
  command
      .reads("IN", options->inputs,
             "HDF5, NRRD, TIFF (file or folder) or raw volume; several, or a folder of scans: one after another")
      .required();
  command.writes("-o,--output", options->out, FileFormat::kExa,
                 "EXA file to write, or the folder for those of several scans (default: beside IN, suffix .exa)");
  command.flag("--resume", options->resume,
               "keep surfaces that an earlier run of the same command made, and make the rest");
  add_input_options(command, options->input);
  add_filter_options(command, *options);
  add_surface_options(command, *options);
  add_resource_options(command, *options);
  command.footer(
      "Examples:\n"
      "  dubsar process scan.h5\n"
      "  dubsar process scan.h5 -o tablet.exa --verbose\n"
      "  dubsar process scans/ -o surfaces/ --resume\n"
      "  dubsar process scan.h5 -o part.exa --crop 0:512,0:512,0:512 --no-ao\n"
      "  dubsar process scan.h5 --memory 6G --scratch /data/tmp\n"
      "  dubsar process scan.raw --dims 512x512x300 --type uint16 --voxel-size 38um -o tablet.exa\n"
      "  dubsar process scan.h5 -o tablet.exa --json report.json");
  return {command,
          [options, command](const CommonOptions& common, Progress& progress) {
            return options->many ? run_many(*options, command, common, progress)
                                 : run(*options, command, common, progress);
          },
          [options] { settle(*options); }, [options] { return plan_of(*options); }};
}

}  // namespace dubsar::app
