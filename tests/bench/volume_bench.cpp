// Speed of resampling and denoising per core: `dubsar_bench --benchmark_filter=Volume`. items = input voxels.

#include <benchmark/benchmark.h>

#include <cstdint>

#include "core/base/system/parallel.h"
#include "core/filter/denoise.h"
#include "core/filter/resample.h"
#include "core/volume/volume.h"

namespace dubsar {
namespace {

constexpr Dims kDims{468, 256, 128};

Volume<float> noisy_step() {
  Volume<float> volume(kDims);
  std::uint32_t state = 1;
  for (std::int64_t i = 0; i < kDims.count(); ++i) {
    state = state * 1664525U + 1013904223U;
    volume.voxels[i] = static_cast<float>(state >> 8) * 0x1p-24F + (i % kDims.x > 200 ? 4.0F : 0.0F);
  }
  return volume;
}

void read_through(benchmark::State& state, SlabSource& source, std::int64_t input_voxels) {
  const Dims dims = source.dims();
  constexpr std::int64_t kSlab = 8;
  Buffer<float> out(dims.slice() * kSlab);
  for (auto _ : state) {
    for (std::int64_t z = 0; z < dims.z; z += kSlab) {
      if (!source.read(z, std::min(dims.z, z + kSlab), out.span())) state.SkipWithError("read failed");
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * input_voxels);
}

void VolumeGaussHalf(benchmark::State& state) {
  set_thread_count(1);
  const Volume<float> volume = noisy_step();
  VolumeSource source(volume);
  HalfResolutionSource half(source);
  read_through(state, half, kDims.count());
}
BENCHMARK(VolumeGaussHalf)->Unit(benchmark::kMillisecond);

void VolumeDenoise(benchmark::State& state, DenoiseMethod method, RangeWeight range, int window) {
  set_thread_count(1);
  const Volume<float> volume = noisy_step();
  VolumeSource source(volume);
  auto filter = make_denoised(source, {method, range, window, 1, 0.3});
  if (!filter) return state.SkipWithError("options");
  read_through(state, **filter, kDims.count());
}
#define DUBSAR_BENCH_DENOISE(name, method, range, window)                                   \
  BENCHMARK_CAPTURE(VolumeDenoise, name, DenoiseMethod::method, RangeWeight::range, window) \
      ->Unit(benchmark::kMillisecond)
DUBSAR_BENCH_DENOISE(joint_tukey_3, kJointBilateral, kTukey, 3);
DUBSAR_BENCH_DENOISE(joint_gauss_3, kJointBilateral, kGauss, 3);
DUBSAR_BENCH_DENOISE(bilateral_tukey_3, kBilateral, kTukey, 3);
DUBSAR_BENCH_DENOISE(gauss_3, kGauss, kTukey, 3);
DUBSAR_BENCH_DENOISE(median_3, kMedian, kTukey, 3);
DUBSAR_BENCH_DENOISE(joint_tukey_5, kJointBilateral, kTukey, 5);
DUBSAR_BENCH_DENOISE(median_5, kMedian, kTukey, 5);
DUBSAR_BENCH_DENOISE(gauss_7, kGauss, kTukey, 7);

}  // namespace
}  // namespace dubsar
