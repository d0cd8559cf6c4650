// Every stage on one core, on a volume that is also written for other programs: stage_bench FOLDER [SIZE] [RUNS].
// Writes FOLDER/volume.raw (SIZE^3 floats, x first), FOLDER/mesh.ply, and prints a JSON document: the machine's
// bandwidth and arithmetic, and of each stage the seconds of a core (the least of some runs), its work, and what of
// memory and arithmetic it cannot do without. ./do bench stages puts the peers beside it.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/system/clock.h"
#include "core/base/system/large_blocks.h"
#include "core/base/system/parallel.h"
#include "core/exa/offsets/settle.h"
#include "core/extract/extract.h"
#include "core/extract/triangulate.h"
#include "core/filter/denoise.h"
#include "core/filter/resample.h"
#include "core/mesh_io/mesh_io.h"
#include "core/parts/segment.h"
#include "core/relief/curvature/curvature.h"
#include "core/relief/occlusion/occlusion.h"
#include "core/relief/smoothing/face_neighbours.h"
#include "core/relief/smoothing/smooth.h"

namespace dubsar {
namespace {

using nlohmann::json;

constexpr float kNoise = 0.06f;
constexpr float kPeriod = 178.0f;  // voxels: 2.9 million vertices in 512^3
constexpr float kAir = 9.0f;       // voxels between the ball and the border

/// A ball of a gyroid with noise: as in a scan of a tablet there is air around it, and some per cent of the cells have
/// surface.
Volume<float> make_volume(std::int64_t size) {
  Volume<float> volume({size, size, size});
  constexpr float kStep = 6.2831853f / kPeriod;
  const float middle = 0.5f * static_cast<float>(size - 1), radius = 0.5f * static_cast<float>(size) - kAir;
  parallel_for(size * size, 64, [&](std::int64_t r) {
    const float y = kStep * static_cast<float>(r % size), z = kStep * static_cast<float>(r / size);
    std::uint32_t noise = static_cast<std::uint32_t>(r) * 2654435761u + 1u;
    for (std::int64_t i = 0; i < size; ++i) {
      const float x = kStep * static_cast<float>(i);
      noise = noise * 1664525u + 1013904223u;
      const float gyroid = std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
      const float inside = radius - std::hypot(static_cast<float>(i) - middle, static_cast<float>(r % size) - middle,
                                               static_cast<float>(r / size) - middle);
      volume.voxels[r * size + i] =
          std::min(gyroid, kStep * inside) + kNoise * (static_cast<float>(noise >> 8) * 0x1p-24f - 0.5f);
    }
  });
  return volume;
}

class Bench {
 public:
  explicit Bench(int runs) : runs_(runs) {}

  /// The least seconds of a core that body() took. `prepare` is not counted.
  double least(const std::function<void()>& body, const std::function<void()>& prepare = {}) const {
    double best = 1e30;
    for (int run = 0; run < runs_; ++run) {
      if (prepare) prepare();
      const double before = process_cpu_seconds();
      body();
      best = std::min(best, process_cpu_seconds() - before);
    }
    return best;
  }
  /// `bytes` and `operations` are those that no way of doing it could do without.
  void stage(const std::string& name, double seconds, double work, const std::string& unit, double bytes,
             double operations) {
    std::fprintf(stderr, "%-12s %8.3f s\n", name.c_str(), seconds);
    stages_.push_back({{"name", name},
                       {"core_s", seconds},
                       {"work", work},
                       {"unit", unit},
                       {"bytes", bytes},
                       {"operations", operations}});
  }
  const json& stages() const { return stages_; }

 private:
  int runs_;
  json stages_ = json::array();
};

/// Reading and writing 256 MiB, and eight chains of multiplications and additions in the widest vectors there are.
json measure_machine(const Bench& bench) {
  std::vector<float> from(1 << 26, 1.0f), to(1 << 26, 2.0f);
  const double copying = bench.least([&] { std::copy(from.begin(), from.end(), to.begin()); });
  constexpr int kChains = 64, kSteps = 1 << 20;
  std::array<float, kChains> sum{};
  const double arithmetic = bench.least([&] {
    for (int step = 0; step < kSteps; ++step)
      for (int i = 0; i < kChains; ++i)
        sum[static_cast<std::size_t>(i)] = sum[static_cast<std::size_t>(i)] * 0.999f + 0.5f;
  });
  const double check = static_cast<double>(sum[0] + to[1]);
  return {{"bytes_per_s", 2.0 * 4.0 * static_cast<double>(from.size()) / copying},
          {"operations_per_s", 2.0 * kChains * kSteps / arithmetic},
          {"check", check}};
}

void read_through(SlabSource& source) {
  const Dims dims = source.dims();
  constexpr std::int64_t kSlab = 8;
  Buffer<float> out(dims.slice() * kSlab);
  for (std::int64_t z = 0; z < dims.z; z += kSlab)
    DUBSAR_CHECK(source.read(z, std::min(dims.z, z + kSlab), out.span()).has_value());
}

template <class T>
T value_of(Result<T> result) {
  if (!result) fmt::print(stderr, "error: {}\n", result.error().message);
  DUBSAR_CHECK(result.has_value());
  return std::move(*result);
}

void volume_stages(Bench& bench, const Volume<float>& volume) {
  const auto voxels = static_cast<double>(volume.dims.count());
  bench.stage("resample", bench.least([&] {
    VolumeSource source(volume);
    HalfResolutionSource half(source);
    read_through(half);
  }),
              voxels, "voxel", 4.5 * voxels, 1.5 * voxels);
  // Of a neighbour: difference, square, weight, product, two sums; 26 of them, the guide and the quotient.
  bench.stage("denoise", bench.least([&] {
    VolumeSource source(volume);
    read_through(*value_of(make_denoised(source, {.iterations = 1, .sigma = 0.1})));
  }),
              voxels, "voxel", 8.0 * voxels, 200.0 * voxels);
}

SurfaceModel surface_stages(Bench& bench, const Volume<float>& volume) {
  SilentProgress silent;
  SurfaceModel model;
  const double voxels = static_cast<double>(volume.dims.count());
  const double extracting = bench.least(
      [&] {
        VolumeSource source(volume);
        model.samples = value_of(sample_surface(source, {}, silent));
        model.mesh = value_of(build_quad_mesh(model.samples, silent));
      },
      [&] { model = {}; });
  const auto vertices = static_cast<double>(model.mesh.vertex_count());
  bench.stage("extract", extracting, voxels, "voxel", 4.0 * voxels + 48.0 * vertices, voxels);
  bench.stage("triangulate", bench.least([&] { triangulate(model.mesh, {}); }), vertices, "vertex", 76.0 * vertices,
              60.0 * vertices);

  NormalFilterOptions filter;
  const FaceNeighbours neighbours = value_of(FaceNeighbours::build(model.mesh, silent));
  const std::vector<glm::vec4> faces = face_normals(model.mesh);
  std::vector<glm::vec4> filtered;
  const double face_steps = vertices * filter.iterations;
  // Of each of about nine normals: difference, length, quotient, three sums; and its own is normalised.
  bench.stage("normals",
              bench.least([&] { DUBSAR_CHECK(filter_normals(neighbours, filter, filtered, silent).has_value()); },
                          [&] { filtered = faces; }),
              face_steps, "face step", 68.0 * face_steps, 180.0 * face_steps);
  QuadMesh mesh;
  std::vector<glm::vec3> normals;
  bench.stage("smooth", bench.least([&] { value_of(smooth(mesh, normals, {}, silent)); }, [&] { mesh = model.mesh; }),
              vertices, "vertex", (68.0 * 32 + 60.0 * 8 + 100.0) * vertices, (180.0 * 32 + 60.0 * 8) * vertices);
  model.mesh.positions = mesh.positions;
  model.attributes.normals = normals;
  bench.stage("curvature",
              bench.least([&] { value_of(principal_curvatures(mesh, normals, CurvatureMethod::kFit, silent)); }),
              vertices, "vertex", 80.0 * vertices, 600.0 * vertices);
  bench.stage("components", bench.least([&] { value_of(segment(model, {.method = SegmentMethod::kBodies}, silent)); }),
              vertices, "vertex", 60.0 * vertices, 0.0);
  return model;
}

void light_and_files(Bench& bench, SurfaceModel& model, const std::string& folder) {
  SilentProgress silent;
  const TriMesh mesh = value_of(make_tri_mesh(model));
  const auto vertices = static_cast<double>(mesh.positions.size());
  OcclusionOptions options;
  options.rays = 16;
  const double rays = vertices * options.rays;
  const LitSurface surface{mesh.positions, mesh.normals, mesh.triangles};
  bench.stage("light", bench.least([&] { value_of(ambient_light(surface, options, silent)); }), rays, "ray", 0.0,
              9.0 * 30.0 * rays);  // about nine steps through distances
  options.engine = OcclusionEngine::kTriangles;
  bench.stage("light by Embree", bench.least([&] { value_of(ambient_light(surface, options, silent)); }), rays, "ray",
              0.0, 0.0);
  TriMesh bare;
  bare.positions = mesh.positions;
  bare.triangles = mesh.triangles;
  const double bytes = 12.0 * vertices + 13.0 * static_cast<double>(mesh.triangles.size());
  bench.stage("write PLY",
              bench.least([&] { DUBSAR_CHECK(write_mesh(folder + "/mesh.ply", bare, {}, silent).has_value()); }), bytes,
              "byte", 2.0 * bytes, 0.0);
}

int run(const std::string& folder, std::int64_t size, int runs) {
  set_thread_count(1);
  Bench bench(runs);
  json out{{"size", size}, {"machine", measure_machine(bench)}};
  const Volume<float> volume = make_volume(size);
  std::ofstream(folder + "/volume.raw", std::ios::binary)
      .write(reinterpret_cast<const char*>(volume.voxels.data()), 4 * volume.dims.count());
  volume_stages(bench, volume);
  SurfaceModel model = surface_stages(bench, volume);
  light_and_files(bench, model, folder);
  out["vertices"] = model.mesh.vertex_count();
  out["stages"] = bench.stages();
  fmt::print("{}\n", out.dump());
  return 0;
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("use: stage_bench FOLDER [SIZE] [RUNS]\n", stderr);
    return 64;
  }
  dubsar::keep_large_blocks();  // as `dubsar process` does
  return dubsar::run(argv[1], argc > 2 ? std::atoll(argv[2]) : 512, argc > 3 ? std::atoi(argv[3]) : 3);
}
