#include "core/pipeline/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/numbers/units.h"

namespace dubsar {
namespace {

// Seconds are of one core of the machine of docs/speed.md, at the paper's size, serial parts what one and two of its
// threads took; bytes are the most of phantoms of 3 to 80 million voxels with 4 to 40 % of contact (plan_test.cpp).

/// Phantoms from 96x64x96 to 1871x999x1723 have 7 to 10 vertices for each voxel of a side of a cube as large.
constexpr double kVerticesPerArea = 10.0;
/// Points of the bricks near the surface for each vertex; what filtering one costs, since passes see beyond bricks.
constexpr double kBandPoints = 14.0, kBandEffort = 1.8;
/// Slices that are filtered in whole at the scan's resolution, and voxels of more than 36 (refine_stage.cpp).
constexpr double kPlanSampleSlices = 96.0, kPlanLeastSlices = 36.0, kPlanMostSampled = 150e6;
/// Triangles of patches for each vertex: .03 to .06, and .15 where 40 % of the tablet is glued.
constexpr double kUsualPatches = 0.05;
/// Whatever the scan and the surface: slabs, the file's caches; for each thread counts of values and rows of filters.
constexpr double kForVoxels = 42e6, kForVoxelsAThread = 5e6, kForSurfaces = 11e6, kForSurfacesAThread = 1e6;
constexpr double kPage = 20e6;  ///< of a grid that lies on the disk

double scan_points(const RunShape& r) { return static_cast<double>(r.scan.count()); }
double half_points(const RunShape& r) { return static_cast<double>(grid_of(r.scan, true).count()); }
double grid_points(const RunShape& r) { return r.half ? half_points(r) : scan_points(r); }
double sign_bytes(const RunShape& r) { return grid_points(r) / 8.0; }
double patch_count(const RunShape& r) { return r.patches >= 0.0 ? r.patches : kUsualPatches * r.vertices; }
double band_points(const RunShape& r) { return std::min(grid_points(r), kBandPoints * r.vertices); }
double sampled(const RunShape& r) {
  const auto slice = static_cast<double>(r.scan.slice());
  return std::min({kPlanSampleSlices * slice, std::max(kPlanMostSampled, kPlanLeastSlices * slice), scan_points(r)});
}
double stored(double points, GridPlace place) {
  return place == GridPlace::kMemory ? 4.0 * points : std::min(4.0 * points, kPage);
}

bool always(const RunShape&) { return true; }
template <int kBytes>
double bytes_a_vertex(const RunShape& r) {
  return kBytes * r.vertices;
}
template <int kNanoseconds>
double a_vertex(const RunShape& r) {
  return 1e-9 * kNanoseconds * r.vertices;
}

constexpr Values kNothing = {};
constexpr Values kSurfaceSoFar = kNothing | Value::kSamples | Value::kMesh | Value::kAttributes;
constexpr Values kModel = kSurfaceSoFar | Value::kParts;

/// Pictures and sinograms of 16 planes, two of those where the axis is moved, and at half resolution a copy.
double bytes_to_straighten(const RunShape& r) {
  const Dims d = grid_of(r.scan, r.half);
  const auto widest = static_cast<double>(std::max({d.x, d.y, d.z}));
  return r.straight ? 256.0 * widest * widest + (r.half ? stored(half_points(r), r.half_place) : 0.0) : 0.0;
}

/// A mesh and moves of its vertices; then its places, moves and the first samples, while there are new ones. Whether it
/// is needed is known when the noise is: memory is kept for it.
double bytes_to_make_fair(const RunShape& r) {
  return r.noise.passes > 0 ? std::max(92.0 * r.vertices, 28.0 * r.vertices + bytes_of(Value::kSamples, r)) : 0.0;
}

/// Local levels are sums in cells of 8^3 and slabs of 24 slices. The halved grid is gone before the bricks near the
/// surface are there.
double bytes_to_find(const RunShape& r) {
  const double levels = 0.25 * grid_points(r) + 96.0 * static_cast<double>(grid_of(r.scan, r.half).slice());
  if (r.half) return levels;
  return std::max(4.0 * sampled(r),
                  4.0 * band_points(r) + std::max(levels, bytes_to_make_fair(r)) - bytes_of(Value::kHalf, r));
}
double seconds_to_find(const RunShape& r) {
  if (r.half) return 4e-9 * half_points(r);
  const double filtered = kBandEffort * band_points(r) + sampled(r);
  const double fair = r.noise.made_fair ? 1.7e-6 * r.vertices + 4e-9 * band_points(r) : 0.0;
  return scan_points(r) * r.read_s + 4e-9 * (half_points(r) + r.noise.passes * filtered + band_points(r)) + fair;
}

double bytes_to_separate(const RunShape& r) { return 5.5 * sign_bytes(r) + 137.0 * r.vertices; }

/// Along the patches, as deep as wedges are: on the halved grid a patch triangle stands for more of it. Phantoms of 66
/// and 222 million voxels, 9 and 20 % in contact: 2,800 and 2,000 a patch triangle, halved 7,500 (the first); where the
/// scan is not asked 800 to 1,000, in a quarter of the time.
double bytes_to_close(const RunShape& r) {
  return 87.0 * r.vertices + (!r.contact ? 1100.0 : r.half ? 7700.0 : 4000.0) * patch_count(r);
}
double seconds_to_close(const RunShape& r) { return (r.contact ? 3.0e-6 : 1.2e-6) * r.vertices; }

double seconds_to_light(const RunShape& r) {
  return r.vertices * (0.5e-6 + 75e-9 * r.rays / sharers_of_rays(r.half, r.vertices));
}

double nothing(const RunShape&) { return 0.0; }

}  // namespace

// A row for people to read: stage, when; reads, writes; surface, serial, wanted; bytes, seconds; phases.
// clang-format off
constexpr std::array<StagePlan, kStages> kRunPlan = {{
    {RunStage::kImport, "while the scan is read", kNothing | Value::kScan, kNothing | Value::kHalf, false, 0.1, always,
     nothing, [](const RunShape& r) { return scan_points(r) * (r.read_s + 2.4e-9); },
     {{{"estimate_raw", 0.2}, {"import", 0.8}}}},
    {RunStage::kRays, "while rays are straightened", kNothing | Value::kScan | Value::kHalf,
     kNothing | Value::kStraight, false, 0.1, [](const RunShape& r) { return r.artefacts; },
     bytes_to_straighten, [](const RunShape& r) { return 0.2 + (r.straight ? r.straight->core_s : 0.0); },
     {{{"rays", 0.2}, {"rings", 0.1}, {"straighten", 0.7}}}},
    {RunStage::kDenoise, "while noise is filtered", kNothing | Value::kHalf, kNothing | Value::kHalf, false, 0.1, always,
     nothing, [](const RunShape& r) { return 4e-9 * r.noise.passes * half_points(r); },
     {{{"estimate", 0.1}, {"denoise", 0.35}, {"estimate", 0.1}, {"denoise", 0.35}, {"estimate", 0.1}}}},
    {RunStage::kSurface, "while the surface is found", kNothing | Value::kScan | Value::kHalf | Value::kStraight,
     kNothing | Value::kSamples, false, 0.1, always, bytes_to_find, seconds_to_find,
     {{{"import", 0.1}, {"estimate", 0.03}, {"denoise", 0.1}, {"estimate", 0.03}, {"denoise", 0.1}, {"estimate", 0.03},
       {"band", 0.05}, {"band", 0.46}, {"extract", 0.1}}}},
    {RunStage::kMesh, "while the surface is meshed", kNothing | Value::kSamples, kNothing | Value::kMesh, true, 0.1,
     always, bytes_a_vertex<15>, a_vertex<150>, {{{"mesh", 1.0}}}},
    {RunStage::kSmooth, "while the surface is smoothed", kNothing | Value::kMesh,
     kNothing | Value::kMesh | Value::kAttributes, true, 0.1, always, bytes_a_vertex<70>, a_vertex<800>,
     {{{"smooth", 0.85}, {"curvature", 0.15}}}},
    {RunStage::kSettle, "while vertices are quantised", kSurfaceSoFar, kSurfaceSoFar, true, 0.1, always,
     bytes_a_vertex<115>, a_vertex<1200>, {{{"settle", 0.9}, {"curvature", 0.1}}}},
    {RunStage::kParts, "while parts are separated", kSurfaceSoFar, kNothing | Value::kParts, true, 0.15, always,
     bytes_to_separate, a_vertex<2000>, {{{"segment", 0.5}, {"fill holes", 0.5}}}},
    {RunStage::kContact, "while the contact is traced", kModel | Value::kScan | Value::kStraight,
     kNothing | Value::kParts, true, 0.24, [](const RunShape& r) { return r.fill_holes; },
     bytes_to_close, seconds_to_close, {{{"contact", 1.0}}}},
    {RunStage::kLight, "while light is worked out", kModel, kNothing | Value::kAttributes, true, 0.05,
     [](const RunShape& r) { return r.rays > 0.0; }, bytes_a_vertex<130>, seconds_to_light,
     {{{"ambient occlusion", 1.0}}}},
    {RunStage::kCheck, "while the surface is checked", kModel, kNothing | Value::kChecked, true, 0.2, always,
     bytes_a_vertex<55>, a_vertex<300>, {}},
    {RunStage::kWrite, "while the surface is written", kModel, kNothing, true, 0.2, always,
     bytes_a_vertex<70>, a_vertex<500>, {{{"encode signs", 0.5}, {"encode offsets", 0.5}}}},
}};

double bytes_of(Value value, const RunShape& run) {
  switch (value) {
    case Value::kScan: return run.layer_bytes;
    case Value::kHalf: return stored(half_points(run), run.half_place);
    case Value::kStraight: return run.straight ? stored(grid_points(run), run.straight->place) : 0.0;
    case Value::kSamples: return 1.1 * sign_bytes(run) + 4.0 * run.vertices;
    case Value::kMesh: return 44.0 * run.vertices;
    case Value::kAttributes: return 24.0 * run.vertices;
    case Value::kParts: return 34.0 * run.vertices + 200.0 * patch_count(run);  // with the triangles of labels
    case Value::kChecked: return 41.0 * run.vertices;
  }
  return 0.0;
}
// clang-format on

double bytes_while(const StagePlan& stage, const RunShape& run) {
  double bytes = stage.work_bytes(run) + (stage.surface ? kForSurfaces + kForSurfacesAThread * run.threads
                                                        : kForVoxels + kForVoxelsAThread * run.threads);
  for (std::size_t v = 0; v < kValues; ++v) {
    const auto value = static_cast<Value>(v);
    bool made = false, needed = false;
    for (const StagePlan& other : kRunPlan) {
      if (!other.wanted(run)) continue;
      made |= other.stage <= stage.stage && other.writes.has(value);
      needed |= other.stage >= stage.stage &&
                (other.reads.has(value) || (other.stage == stage.stage && other.writes.has(value)));
    }
    if (made && needed) bytes += bytes_of(value, run);
  }
  return bytes;
}

RunCost cost_of(const RunShape& run, RunStage first) {
  RunCost cost;
  for (const StagePlan& stage : kRunPlan) {
    if (stage.stage < first || !stage.wanted(run)) continue;
    const double core_s = run.slowness * stage.core_s(run);
    cost.core_s += core_s;
    cost.wall_s += core_s * (stage.serial + (1.0 - stage.serial) / run.threads);
    const double bytes = bytes_while(stage, run);
    if (bytes > cost.bytes) {
      cost.bytes = bytes;
      cost.when = stage.when;
    }
  }
  if (run.half_place == GridPlace::kScratch) cost.scratch_bytes += 4.0 * half_points(run);
  if (run.straight && run.straight->place == GridPlace::kScratch) cost.scratch_bytes += 4.0 * grid_points(run);
  return cost;
}

Result<void> check_fits(const RunShape& run, std::uint64_t room, RunStage first) {
  const RunCost cost = cost_of(run, first);
  if (cost.bytes <= static_cast<double>(room)) return {};
  const Dims grid = grid_of(run.scan, run.half);
  return fail(ErrorKind::kTryAgain,
              "a surface of about {:.2f} million vertices on a grid of {} x {} x {}, {}, needs {} of memory {}, and "
              "{} are left",
              run.vertices * 1e-6, grid.x, grid.y, grid.z, run.half ? "half the scan's resolution" : "the scan's own",
              memory_text(cost.bytes), cost.when, memory_text(static_cast<double>(room)));
}

double product_bytes(const RunShape& run) {
  return run.vertices * (0.45 + (run.rays > 0.0 ? 0.07 : 0.0) + (run.contact ? 0.3 : 0.0));
}

Dims grid_of(const Dims& scan, bool half) {
  const auto halved = [&](std::int64_t n) { return half && n > 1 ? n / 2 : n; };
  return {halved(scan.x), halved(scan.y), halved(scan.z)};
}

double usual_vertices(const Dims& grid) {
  return kVerticesPerArea * std::pow(static_cast<double>(grid.count()), 2.0 / 3.0);
}

int sharers_of_rays(bool half, double vertices) {
  constexpr double kLarge = 1e6;
  constexpr int kSharers = 19;
  return !half && vertices >= kLarge ? kSharers : 1;
}

}  // namespace dubsar
