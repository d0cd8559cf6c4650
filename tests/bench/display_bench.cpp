// Milliseconds a frame for many views, without a GPU unless there is one: `dubsar_bench --benchmark_filter=Display`.
// Arguments: views, thousands of triangles. Naive: a loop over the views, all triangles, one sample a pixel.

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "display/optics/off_axis.h"
#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/multi_view.h"
#include "tests/display/render/grown_mesh.h"

namespace dubsar {
namespace {

constexpr int kWidth = 420, kHeight = 560;  // a tile of a Looking Glass Portrait
constexpr double kWidthMm = 90, kHeightMm = 120, kConeRad = 40 * std::numbers::pi / 180, kDistanceMm = 490;

/// A pillow of about `triangles` triangles with signs pressed into it: 80 x 60 x 25 mm, like a tablet.
const PackedMesh& tablet(std::int64_t triangles) {
  static std::map<std::int64_t, PackedMesh> made;
  if (const auto found = made.find(triangles); found != made.end()) return found->second;
  TriMesh mesh;
  const int rings = static_cast<int>(std::sqrt(static_cast<double>(triangles) / 4.0)), segments = 2 * rings;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double theta = std::numbers::pi * (r + 0.5) / (rings + 1), phi = 2 * std::numbers::pi * s / segments;
      const auto rounded = [](double x) { return std::copysign(std::pow(std::abs(x), 0.5), x); };
      const double signs = 1.0 - 0.02 * std::max(0.0, std::sin(40 * theta) * std::sin(60 * phi));
      mesh.positions.emplace_back(glm::dvec3(30 * rounded(std::sin(theta)) * rounded(std::cos(phi)),
                                             40 * rounded(std::cos(theta)),
                                             12 * rounded(std::sin(theta)) * rounded(std::sin(phi))) *
                                  signs);
    }
  const auto id = [&](int r, int s) { return static_cast<std::uint32_t>(r * segments + s % segments); };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      mesh.triangles.push_back({id(r, s), id(r, s + 1), id(r + 1, s)});
      mesh.triangles.push_back({id(r, s + 1), id(r + 1, s + 1), id(r + 1, s)});
    }
  return made[triangles] = pack_mesh(mesh).value();
}

std::vector<View> views_of_panel(int count) {
  const Screen screen{.width_mm = kWidthMm,
                      .height_mm = kHeightMm,
                      .width_px = kWidth,
                      .height_px = kHeight,
                      .window_w = kWidth,
                      .window_h = kHeight};
  std::vector<View> views;
  for (const glm::dvec3& eye : cone_eyes(count, kConeRad, kDistanceMm))
    views.push_back(viewer_view(screen.window_rect(), Observer(), eye));
  return views;
}

void naive(benchmark::State& state) {
  const auto context = EglContext::create().value();
  const LodMesh mesh = LodMesh::exact(tablet(state.range(1) * 1000)).value();
  const MeshScene scene(mesh, Shading());
  auto renderer = Renderer::create().value();
  const auto views = views_of_panel(static_cast<int>(state.range(0)));
  auto array = ViewArray::create(kWidth, kHeight, static_cast<int>(views.size())).value();
  if (!renderer.render(scene, std::span(views).first(1), 1, array)) state.SkipWithError("drawing failed");  // shaders
  glFinish();
  for (auto _ : state) {
    if (!renderer.render(scene, views, 1, array)) state.SkipWithError("drawing failed");
    glFinish();
  }
}

double psnr_db(const Image& a, const Image& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (i % 4 != 3) squares += std::pow(int{a.pixels[i]} - int{b.pixels[i]}, 2);
  return 10 * std::log10(255.0 * 255.0 * 0.75 * static_cast<double>(a.pixels.size()) / std::max(squares, 1e-9));
}

void with_options(benchmark::State& state, const MultiViewOptions& options) {
  const auto context = EglContext::create().value();
  const LodMesh mesh = testing::grown_mesh(tablet(state.range(1) * 1000));
  const MeshScene scene(mesh, Shading());
  auto multi = MultiView::create(options).value();
  const auto views = views_of_panel(static_cast<int>(state.range(0)));
  auto array = ViewArray::create(kWidth, kHeight, static_cast<int>(views.size())).value();
  if (!multi.draw_moving(scene, views, array)) state.SkipWithError("drawing failed");  // compiles shaders
  glFinish();
  for (auto _ : state) {
    if (!multi.draw_moving(scene, views, array)) state.SkipWithError("drawing failed");
    glFinish();
  }
  if (views.size() > 2) {  // how far a view that was not drawn is from the exact one
    auto exact = ViewArray::create(kWidth, kHeight, 1).value();
    auto renderer = Renderer::create().value();
    const std::size_t middle = views.size() / 2;
    if (!renderer.render(scene, std::span(&views[middle], 1), 1, exact)) state.SkipWithError("drawing failed");
    const Image truth = exact.read_layer(0).value();
    const auto of_layer = [&](std::size_t layer) {
      return psnr_db(array.read_layer(static_cast<int>(layer)).value(), truth);
    };
    state.counters["psnr_db"] = of_layer(middle);
    std::size_t nearest = 0;  // drawn view: what a copy of it would be
    for (const int key : key_views(static_cast<int>(views.size()), options.key_views))
      if (std::abs(key - static_cast<int>(middle)) < std::abs(static_cast<int>(nearest) - static_cast<int>(middle)))
        nearest = static_cast<std::size_t>(key);
    state.counters["copy_psnr_db"] = of_layer(nearest);
  }
  state.counters["triangles"] = static_cast<double>(mesh.triangles(
      options.cell_px > 0 ? mesh.level_for(options.cell_px * mm_per_pixel_at(views[0], {0, 0, 0}, kWidth)) : 0));
}

void DisplayNaive(benchmark::State& state) { naive(state); }
/// As the program draws while things move.
void DisplayMoving(benchmark::State& state) { with_options(state, {}); }
/// All views drawn, with level of detail.
void DisplayEveryViewCoarse(benchmark::State& state) { with_options(state, {.key_views = 0}); }
/// All views and all triangles in one instanced draw.
void DisplayEveryViewInstanced(benchmark::State& state) { with_options(state, {.cell_px = 0, .key_views = 0}); }

void DisplayMakeLevels(benchmark::State& state) {
  const auto context = EglContext::create().value();
  const PackedMesh& mesh = tablet(state.range(0) * 1000);
  for (auto _ : state) benchmark::DoNotOptimize(testing::grown_mesh(mesh));
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const int thousands : {100, 1000, 10000})
    for (const int views : {1, 2, 48, 100}) bench->Args({views, thousands});
  bench->ArgNames({"views", "thousands"})
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->MinTime(0.05);
}

BENCHMARK(DisplayNaive)->Apply(sizes);
BENCHMARK(DisplayMoving)->Apply(sizes);
BENCHMARK(DisplayEveryViewCoarse)->Apply(sizes);
BENCHMARK(DisplayEveryViewInstanced)->Apply(sizes);
BENCHMARK(DisplayMakeLevels)->Arg(1000)->ArgName("thousands")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dubsar
