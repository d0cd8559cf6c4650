// Extraction on a sphere (few active cells) and on a noisy gyroid (4 % active cells, as a scan of a tablet). The
// argument is the number of threads; "voxels" and "vertices" are per second.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "core/base/system/parallel.h"
#include "core/extract/extract.h"
#include "core/extract/triangulate.h"
#include "core/mesh/mesh_check.h"

namespace dubsar {
namespace {

constexpr std::int64_t kSize = 384;

Volume<float> make_sphere() {
  Volume<float> volume({kSize, kSize, kSize});
  const float c = 0.5f * (kSize - 1);
  parallel_for(kSize * kSize, 1024, [&](std::int64_t r) {
    const float dy = static_cast<float>(r % kSize) - c, dz = static_cast<float>(r / kSize) - c;
    for (int x = 0; x < kSize; ++x) {
      const float dx = static_cast<float>(x) - c;
      volume.voxels[r * kSize + x] = 0.9f * c - std::sqrt(dx * dx + dy * dy + dz * dz);
    }
  });
  return volume;
}

Volume<float> make_gyroid() {
  Volume<float> volume({kSize, kSize, kSize});
  constexpr float kStep = 6.2831853f / 104.0f;
  parallel_for(kSize * kSize, 64, [&](std::int64_t r) {
    const float y = kStep * static_cast<float>(r % kSize), z = kStep * static_cast<float>(r / kSize);
    std::uint32_t noise = static_cast<std::uint32_t>(r) * 2654435761u + 1u;
    for (int i = 0; i < kSize; ++i) {
      const float x = kStep * static_cast<float>(i);
      noise = noise * 1664525u + 1013904223u;
      const float grain = static_cast<float>(noise >> 8) * 0x1p-24f - 0.5f;
      volume.voxels[r * kSize + i] =
          std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x) + 0.06f * grain;
    }
  });
  return volume;
}

const Volume<float>& volume(bool gyroid) {
  static const Volume<float> volumes[2] = {make_sphere(), make_gyroid()};
  return volumes[gyroid];
}

SurfaceSamples samples(bool gyroid) {
  VolumeSource source(volume(gyroid));
  SilentProgress progress;
  return *sample_surface(source, {}, progress);
}

QuadMesh mesh(bool gyroid) {
  SilentProgress progress;
  return *build_quad_mesh(samples(gyroid), progress);
}

void rate(benchmark::State& state, const char* name, std::int64_t items) {
  state.counters[name] = benchmark::Counter(static_cast<double>(items), benchmark::Counter::kIsIterationInvariantRate);
}

template <bool kGyroid>
void BM_Sample(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  VolumeSource source(volume(kGyroid));
  SilentProgress progress;
  for (auto _ : state) benchmark::DoNotOptimize(sample_surface(source, {}, progress));
  rate(state, "voxels", volume(kGyroid).dims.count());
}

template <bool kGyroid>
void BM_Build(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const SurfaceSamples input = samples(kGyroid);
  SilentProgress progress;
  std::int64_t vertices = 0;
  for (auto _ : state) vertices = build_quad_mesh(input, progress)->vertex_count();
  rate(state, "voxels", input.dims.count());
  rate(state, "vertices", vertices);
}

template <bool kGyroid>
void BM_Extract(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  VolumeSource source(volume(kGyroid));
  SilentProgress progress;
  std::int64_t vertices = 0;
  for (auto _ : state) {
    const auto input = sample_surface(source, {}, progress);
    vertices = build_quad_mesh(*input, progress)->vertex_count();
  }
  rate(state, "voxels", volume(kGyroid).dims.count());
  rate(state, "vertices", vertices);
  state.counters["active"] = static_cast<double>(vertices) / static_cast<double>(volume(kGyroid).dims.count());
}

void BM_BuildIncidence(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  QuadMesh quads = mesh(true);
  for (auto _ : state) quads.build_incidence();
  rate(state, "quads", quads.quad_count());
}

void BM_Triangulate(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const QuadMesh quads = mesh(true);
  for (auto _ : state) benchmark::DoNotOptimize(triangulate(quads, {}));
  rate(state, "quads", quads.quad_count());
}

void BM_CheckMesh(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const QuadMesh quads = mesh(true);
  const Triangulation cut = triangulate(quads, {});
  std::vector<glm::vec3> positions = quads.positions;
  positions.insert(positions.end(), cut.steiner.begin(), cut.steiner.end());
  for (auto _ : state) benchmark::DoNotOptimize(check_mesh(positions, cut.triangles));
  rate(state, "triangles", static_cast<std::int64_t>(cut.triangles.size()));
}

constexpr auto kUnit = benchmark::kMillisecond;
BENCHMARK(BM_Sample<false>)->Name("extract/sample/sphere")->Arg(1)->Unit(kUnit);
BENCHMARK(BM_Sample<true>)->Name("extract/sample/gyroid")->Arg(1)->Unit(kUnit);
BENCHMARK(BM_Build<false>)->Name("extract/build/sphere")->Arg(1)->Unit(kUnit);
BENCHMARK(BM_Build<true>)->Name("extract/build/gyroid")->Arg(1)->Unit(kUnit);
BENCHMARK(BM_Extract<false>)->Name("extract/all/sphere")->Arg(1)->Arg(2)->Unit(kUnit)->UseRealTime();
BENCHMARK(BM_Extract<true>)->Name("extract/all/gyroid")->Arg(1)->Arg(2)->Unit(kUnit)->UseRealTime();
BENCHMARK(BM_BuildIncidence)->Name("extract/incidence")->Arg(1)->Unit(kUnit);
BENCHMARK(BM_Triangulate)->Name("extract/triangulate")->Arg(1)->Unit(kUnit);
BENCHMARK(BM_CheckMesh)->Name("extract/check_mesh")->Arg(1)->Unit(kUnit);

}  // namespace
}  // namespace dubsar
