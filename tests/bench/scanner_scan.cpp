// A phantom scan as large as the scanner's full volume, stored in compressed chunks as facilities do, made by slabs:
// scanner_scan OUT.h5 X Y Z [CHUNK_DEPTH] [SEED]. Grey values come in steps of a tenth of the noise, as after any
// 16-bit conversion, so that 3072x3072x1944 voxels take about a fifth of their 73 GB.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/base/parallel.h"
#include "core/hdf5/hdf5_writer.h"
#include "core/phantom/phantom_source.h"

namespace dubsar {
namespace {

constexpr std::uint64_t kChunkSide = 128;
constexpr double kStepsOfNoise = 10.0;
constexpr double kContrast = phantom::kClayDensity - phantom::kAirDensity;

Result<void> write_scan(const char* path, const phantom::PhantomOptions& wanted, std::int64_t depth) {
  DUBSAR_ASSIGN(std::unique_ptr<const phantom::Phantom> made, phantom::Phantom::create(wanted));
  const std::shared_ptr<const phantom::Phantom> shared(std::move(made));
  phantom::PhantomSource source(shared);
  const phantom::PhantomOptions& options = shared->options();
  const Dims d = options.dims;
  DUBSAR_ASSIGN(Hdf5Writer file, Hdf5Writer::create(path));
  const std::string data = "/entry/data/data";
  const auto size = [](std::int64_t n) { return static_cast<std::uint64_t>(n); };
  DUBSAR_TRY(file.create_dataset(
      data, {.type = ScalarType::kF32,
             .dims = {size(d.z), size(d.y), size(d.x)},
             .chunk = {size(std::min(depth, d.z)), std::min(kChunkSide, size(d.y)), std::min(kChunkSide, size(d.x))},
             .deflate = 1,
             .shuffle = true}));
  const std::vector<double> element_um(3, options.voxel_mm * 1000.0);
  DUBSAR_TRY(file.set_attribute(data, "element_size_um", std::span<const double>(element_um)));
  // A power of two, so that the low bytes of all values are 0.
  const double noise = kContrast * std::pow(10.0, -options.snr_db / 20.0);
  const double step = std::exp2(std::floor(std::log2(noise / kStepsOfNoise)));
  std::vector<float> slab;
  for (std::int64_t z = 0; z < d.z; z += depth) {
    const std::int64_t slices = std::min(depth, d.z - z);
    slab.resize(static_cast<std::size_t>(slices * d.slice()));
    constexpr std::int64_t kAtOnce = 16;
    for (std::int64_t from = 0; from < slices; from += kAtOnce)
      DUBSAR_TRY(source.read(z + from, z + std::min(slices, from + kAtOnce),
                             std::span(slab).subspan(static_cast<std::size_t>(from * d.slice()))));
    parallel_for(static_cast<std::int64_t>(slab.size()), 1 << 16, [&](std::int64_t i) {
      float& value = slab[static_cast<std::size_t>(i)];
      value = static_cast<float>(std::round(static_cast<double>(value) / step) * step);
    });
    DUBSAR_TRY(file.write_slab<float>(data, size(z), slab));
    fmt::print(stderr, "\r{} of {} slices", z + slices, d.z);
  }
  fmt::print(stderr, "\n");
  return file.commit();
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("use: scanner_scan OUT.h5 X Y Z [CHUNK_DEPTH] [SEED]\n", stderr);
    return 64;
  }
  const auto number = [&](int i, std::int64_t otherwise) { return argc > i ? std::atoll(argv[i]) : otherwise; };
  dubsar::phantom::PhantomOptions options;
  options.dims = {number(2, 0), number(3, 0), number(4, 0)};
  options.seed = static_cast<std::uint64_t>(number(6, 1));
  const dubsar::Result<void> written = dubsar::write_scan(argv[1], options, number(5, 64));
  if (!written) fmt::print(stderr, "error: {}\n", written.error().message);
  return written ? 0 : 70;
}
