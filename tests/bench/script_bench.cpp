// Wedges found on phantoms, beside what was pressed: ./do bench script

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <string_view>

#include "core/exa/exa_file.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"
#include "core/script/find_wedges.h"
#include "core/script/marks/script_marks.h"
#include "tests/core/script/mark_score.h"
#include "tests/core/script/wedge_causes.h"
#include "tests/core/script/wedge_score.h"

namespace dubsar {
namespace {

constexpr std::string_view kHelp =
    "script_bench [--size XxYxZ] [--seed N] [--seeds COUNT] [--depth VOXELS] [--unwritten] [--unruled] [--pushed "
    "SHARE] [--envelope] [--scanner WORDS] "
    "[--keep DIR]\n"
    "             [--each] [--causes] [--marks] [--subdivide TIMES]\n"
    "  --depth     of a usual wedge (7)\n"
    "  --scanner   as an X-ray scanner shows it: words as phantom --scanner takes\n"
    "  --envelope  judges the envelope's outside instead of the tablet\n"
    "  --keep      surfaces are kept in this folder, and taken from there the next time\n"
    "  --subdivide each triangle becomes four, so many times: how cost grows with triangles alone\n"
    "  --each      says of each wedge drawn what was pressed there, and what was missed\n"
    "  --causes    counts what was missed and what was drawn falsely, by place and by cause\n"
    "  --marks     judges cracks and sealings, too\n";

struct ScriptArguments {
  Dims dims{320, 192, 304};
  std::uint64_t seed = 1;
  int seeds = 1, subdivide = 0;
  double depth = 7.0, pushed = 0.0;
  bool unwritten = false, unruled = false, envelope = false, each = false, causes = false, marks = false;
  std::string keep, scanner;
};

[[noreturn]] void script_usage() {
  fmt::print(stderr, "{}", kHelp);
  std::exit(64);
}

ScriptArguments parse_script(int argc, char** argv) {
  ScriptArguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--help") {
      fmt::print("{}", kHelp);
      std::exit(0);
    } else if (word == "--unwritten") {
      a.unwritten = true;
    } else if (word == "--unruled") {
      a.unruled = true;
    } else if (word == "--envelope") {
      a.envelope = true;
    } else if (word == "--causes") {
      a.causes = true;
    } else if (word == "--marks") {
      a.marks = true;
    } else if (word == "--each") {
      a.each = true;
    } else if (i + 1 == argc) {
      script_usage();
    } else if (const char* value = argv[++i]; word == "--seed") {
      a.seed = std::strtoull(value, nullptr, 10);
    } else if (word == "--seeds") {
      a.seeds = std::atoi(value);
    } else if (word == "--subdivide") {
      a.subdivide = std::atoi(value);
    } else if (word == "--depth") {
      a.depth = std::atof(value);
    } else if (word == "--pushed") {
      a.pushed = std::atof(value);
    } else if (word == "--scanner") {
      a.scanner = value;
    } else if (word == "--keep") {
      a.keep = value;
    } else if (word == "--size") {
      long x = 0, y = 0, z = 0;
      if (std::sscanf(value, "%ldx%ldx%ld", &x, &y, &z) != 3) script_usage();
      a.dims = {x, y, z};
    } else {
      script_usage();
    }
  }
  return a;
}

template <class T>
T script_value(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "script_bench: {}\n", result.error().message);
  std::exit(1);
}

SurfaceModel surface_of(const phantom::PhantomOptions& options, const std::string& keep, const std::string& scanner,
                        Progress& progress) {
  namespace fs = std::filesystem;
  const fs::path kept =
      fs::path(keep) / fmt::format("s{}_{}x{}x{}_d{:g}{}{}{}{}.exa", options.seed, options.dims.x, options.dims.y,
                                   options.dims.z, options.wedge_depth_vox, options.writing.written ? "" : "_unwritten",
                                   options.writing.ruled ? "" : "_unruled",
                                   options.writing.pushed > 0.0 ? "_pushed" : "", scanner);
  if (!keep.empty() && fs::exists(kept)) return script_value(read_exa(kept, progress));
  const fs::path scan = fs::temp_directory_path() / fmt::format("dubsar_script_{}.h5", ::getpid());
  script_value(phantom::write_phantom(scan, std::nullopt, options, progress));
  PipelineOptions pipeline;
  pipeline.import.path = scan;
  pipeline.occlusion.reset();
  auto result = run_pipeline(pipeline, progress);
  fs::remove(scan);
  SurfaceModel model = std::move(script_value(std::move(result)).model);
  if (!keep.empty()) script_value(write_exa(kept, model, progress));
  return model;
}

/// Each triangle as four, by the middles of its edges.
void subdivide(TriMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
      if (!mesh.evidence.empty()) mesh.evidence.push_back(std::max(mesh.evidence[a], mesh.evidence[b]));
    }
    return at->second;
  };
  std::vector<Triangle> fine;
  std::vector<std::uint8_t> inferred;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.insert(fine.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    if (!mesh.triangle_inferred.empty()) inferred.insert(inferred.end(), 4, mesh.triangle_inferred[t]);
  }
  mesh.triangles = std::move(fine);
  mesh.triangle_inferred = std::move(inferred);
}

void print_each(const phantom::Phantom& truth, const WedgesFound& found, const WedgeScore& score) {
  const double voxel = truth.options().voxel_mm;
  for (std::size_t f = 0; f < found.wedges.size(); ++f) {
    const ScriptWedge& w = found.wedges[f];
    const JudgedWedge& j = score.judged[f];
    const int t = j.truth >= 0 ? j.truth : j.near;
    fmt::print(
        "{} turn {} conf {:.3f} kind {:<12} {} line {:>2} pressed {:>2} depth {:.2f} width {:.2f} length {:.2f}  "
        "pressed {:<12} off {:.2f} turned {:.0f} "
        "depth {:.2f}\n",
        j.truth >= 0 ? "real " : "FALSE", found.sides.turned(w.side), w.confidence, name_in(kWedgeKinds, w.kind),
        name_in(kTextSides, w.side), w.line, t >= 0 ? truth.wedges()[static_cast<std::size_t>(t)].line : 0,
        w.depth_mm / voxel, w.width_mm / voxel, w.length_mm / voxel,
        t >= 0 ? name_in(phantom::kStrokeKinds, truth.wedges()[static_cast<std::size_t>(t)].kind) : "-", j.head_off,
        j.turned_deg, t >= 0 ? truth.wedges()[static_cast<std::size_t>(t)].depth : 0.0);
  }
  for (const int t : score.missed) {
    const phantom::Wedge& w = truth.wedges()[static_cast<std::size_t>(t)];
    double drawn = 1e9, pressed = 1e9;
    for (const ScriptWedge& f : found.wedges) drawn = std::min(drawn, glm::distance(f.tip_mm / voxel, w.position));
    for (const phantom::Wedge& o : truth.wedges())
      if (&o != &w && o.owner == w.owner) pressed = std::min(pressed, glm::distance(o.position, w.position));
    fmt::print(
        "MISSED {} {} depth {:.2f} length {:.1f} width {:.1f} state {} gap {:.1f}: next drawn tip {:.1f}, next pressed "
        "{:.1f}\n",
        phantom::kSideFrames.size() ? static_cast<int>(w.side) : 0, name_in(phantom::kStrokeKinds, w.kind), w.depth,
        w.length, 2 * w.head_half_width, name_in(phantom::kWedgeCases, w.state), truth.gap_width(w.position), drawn,
        pressed);
  }
}

int run_script(int argc, char** argv) {
  const ScriptArguments a = parse_script(argc, argv);
  SilentProgress progress;
  WedgeScore all;
  WedgeCauses causes;
  MarkScore marks;
  for (int k = 0; k < a.seeds; ++k) {
    phantom::PhantomOptions options;
    options.dims = a.dims;
    options.seed = a.seed + static_cast<std::uint64_t>(k);
    options.wedge_depth_vox = a.unwritten ? 0.0 : a.depth;
    options.writing.written = !a.unwritten;
    options.writing.ruled = !a.unruled;
    options.writing.pushed = a.pushed;
    if (!a.scanner.empty()) options.scanner = script_value(phantom::parse_scanner(a.scanner));
    const auto truth = script_value(phantom::Phantom::create(options));
    const SurfaceModel model = surface_of(options, a.keep, a.scanner, progress);
    TriMesh mesh = a.envelope ? script_value(make_tri_mesh(
                                    model, {.partition = model.partitions.find(PartitionKind::kEnvelopeOutside)->id}))
                              : script_value(make_tri_mesh(model, {.body = "tablet"}));
    for (int time = 0; time < a.subdivide; ++time) subdivide(mesh);
    const auto start = std::chrono::steady_clock::now();
    const WedgesFound found = script_value(find_wedges(mesh, {}, progress));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const WedgeScore score = judge_wedges(
        *truth, found.wedges,
        {.owner = a.envelope ? phantom::Owner::kEnvelope : phantom::Owner::kTablet, .grid_step = mesh.frame.scale.x});
    const double voxel = truth->options().voxel_mm;
    fmt::print(
        "seed {} width {:.2f} depth {:.2f} rounding {:.2f} voxels, misfit {:.3f} broad {:.2f}, {} places, {} vertices, "
        "{:.2f} s: {}\n",
        options.seed, found.scale.width_mm / voxel, found.scale.depth_mm / voxel,
        found.scale.rounding * found.scale.width_mm / voxel, found.scale.misfit, found.scale.fitted, found.places,
        mesh.positions.size(), seconds, score.text());
    for (const auto& [clear, right] : score.pair_clear)
      if (a.each) fmt::print("pair {:.4f} {}\n", clear, right);
    if (a.each) print_each(*truth, found, score);
    if (a.marks) {
      const ScriptMarks seen = find_marks(mesh, found.sides, found.wedges);
      const phantom::Owner owner = a.envelope ? phantom::Owner::kEnvelope : phantom::Owner::kTablet;
      const MarkScore of = judge_marks(*truth, mesh, found.sides, owner, seen.cracks, seen.sealings);
      fmt::print("seed {} {}{}\n", options.seed, truth->cracked() ? "(cracked) " : "", of.text());
      marks.add(of);
    }
    if (a.causes) {
      const WedgesFound every = script_value(find_wedges(mesh, {.least_confidence = 0.0}, progress));
      causes.add(*truth, mesh, found, every, score);
    }
    std::fflush(stdout);
    all.add(score);
  }
  if (a.seeds > 1) fmt::print("all: {}\n", all.text());
  if (a.marks && a.seeds > 1) fmt::print("all: {}\n", marks.text());
  if (a.causes) fmt::print("{}", causes.text());
  return 0;
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) { return dubsar::run_script(argc, argv); }
