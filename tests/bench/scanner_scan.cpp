// A phantom scan as large as the scanner's full volume, stored in compressed chunks as facilities do, made by slabs:
// scanner_scan OUT.h5 X Y Z [CHUNK_DEPTH] [SEED] [THREADS]. Grey values come in steps of a tenth of the noise, as after
// any 16-bit conversion, so that 3072x3072x1944 voxels take about a fifth of their 73 GB. Where the field of view is
// wider than the paper's, chunks of nothing but air and its noise stand in more than one place of their layer.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "core/base/system/parallel.h"
#include "core/hdf5/chunk_encoder.h"
#include "core/hdf5/hdf5_writer.h"
#include "core/phantom/phantom_source.h"

namespace dubsar {
namespace {

constexpr std::int64_t kChunkSide = 128;
constexpr double kStepsOfNoise = 10.0;
constexpr double kContrast = phantom::kClayDensity - phantom::kAirDensity;
constexpr double kFieldMm[2] = {1871 * 0.038, 999 * 0.038};  // of the paper's scan, x and y: the object is inside
constexpr double kObjectMm = 60.0;                           // along x
constexpr const char* kData = "/entry/data/data";

/// The part of the scan, in whole chunks, that is made voxel by voxel.
struct Core {
  Dims dims;
  std::int64_t x = 0, y = 0;  ///< where it begins
};

Core core_of(const Dims& scan, double voxel_mm) {
  const auto part = [&](std::int64_t all, double mm) {
    const auto chunks = static_cast<std::int64_t>(std::ceil(mm / voxel_mm / kChunkSide));
    return std::min(all, chunks * kChunkSide);
  };
  Core core{{part(scan.x, kFieldMm[0]), part(scan.y, kFieldMm[1]), scan.z}};
  const auto margin = 0.5 * (static_cast<double>(core.dims.x) - kObjectMm / voxel_mm);
  if (margin < kChunkSide + 16 || core.dims.y < kChunkSide) return {scan};  // no column of chunks is sure to be air
  core.x = (scan.x - core.dims.x) / 2 / kChunkSide * kChunkSide;
  core.y = (scan.y - core.dims.y) / 2 / kChunkSide * kChunkSide;
  return core;
}

void round_to_steps(std::span<float> values, float step) {
  parallel_chunks(static_cast<std::int64_t>(values.size()), 1 << 16, [&](std::int64_t begin, std::int64_t end) {
    constexpr float kWhole = 0x1.8p23f;  // a float of this size has no places behind the point
    const float steps = 1.0f / step;
    for (std::int64_t i = begin; i < end; ++i) {
      float& value = values[static_cast<std::size_t>(i)];
      value = ((value * steps + kWhole) - kWhole) * step;
    }
  });
}

class ScanWriter {
 public:
  ScanWriter(Hdf5Writer& file, const Dims& scan, const Core& core, std::int64_t depth)
      : file_(file), scan_(scan), core_(core), depth_(std::min(depth, scan.z)) {}

  /// Slices [z, z + slices) of the core, and the air around it.
  Result<void> write_layer(std::int64_t z, std::int64_t slices, std::span<const float> slab) {
    const std::int64_t across = chunks(core_.dims.x), down = chunks(core_.dims.y);
    std::vector<std::vector<std::byte>> made(static_cast<std::size_t>(across * down));
    parallel_for(across * down, 1, [&](std::int64_t c) {
      thread_local std::vector<float> numbers;
      numbers.assign(static_cast<std::size_t>(depth_ * kChunkSide * kChunkSide), 0.0f);
      const std::int64_t x0 = c % across * kChunkSide, y0 = c / across * kChunkSide;
      const std::int64_t width = std::min(kChunkSide, core_.dims.x - x0),
                         height = std::min(kChunkSide, core_.dims.y - y0);
      for (std::int64_t k = 0; k < slices; ++k)
        for (std::int64_t j = 0; j < height; ++j)
          std::memcpy(numbers.data() + (k * kChunkSide + j) * kChunkSide,
                      slab.data() + (k * core_.dims.y + y0 + j) * core_.dims.x + x0,
                      static_cast<std::size_t>(width) * sizeof(float));
      made[static_cast<std::size_t>(c)] = encode_chunk(std::as_bytes(std::span(numbers)), {sizeof(float), true, 1});
    });
    std::int64_t air = z;  // which of the columns at both sides of the core comes next
    for (std::int64_t y = 0; y < chunks(scan_.y); ++y)
      for (std::int64_t x = 0; x < chunks(scan_.x); ++x) {
        const std::int64_t cx = x - core_.x / kChunkSide, cy = y - core_.y / kChunkSide;
        const bool inside = cx >= 0 && cy >= 0 && cx < across && cy < down;
        std::int64_t from = cy * across + cx;
        if (!inside) {
          ++air;
          from = air / 2 % down * across + air % 2 * (across - 1);
        }
        const std::array<std::uint64_t, 3> origin{static_cast<std::uint64_t>(z),
                                                  static_cast<std::uint64_t>(y * kChunkSide),
                                                  static_cast<std::uint64_t>(x * kChunkSide)};
        DUBSAR_TRY(file_.write_encoded_chunk(kData, origin, made[static_cast<std::size_t>(from)]));
      }
    return {};
  }

 private:
  static std::int64_t chunks(std::int64_t size) { return (size + kChunkSide - 1) / kChunkSide; }

  Hdf5Writer& file_;
  Dims scan_;
  Core core_;
  std::int64_t depth_;
};

Result<void> write_scan(const char* path, const phantom::PhantomOptions& wanted, std::int64_t depth) {
  DUBSAR_ASSIGN(phantom::PhantomOptions options, phantom::complete(wanted));
  const Dims d = options.dims;
  const Core core = core_of(d, options.voxel_mm);
  options.dims = core.dims;
  DUBSAR_ASSIGN(std::unique_ptr<const phantom::Phantom> made, phantom::Phantom::create(options));
  phantom::PhantomSource source{std::shared_ptr<const phantom::Phantom>(std::move(made))};
  DUBSAR_ASSIGN(Hdf5Writer file, Hdf5Writer::create(path));
  const auto size = [](std::int64_t n) { return static_cast<std::uint64_t>(n); };
  DUBSAR_TRY(file.create_dataset(kData, {.type = ScalarType::kF32,
                                         .dims = {size(d.z), size(d.y), size(d.x)},
                                         .chunk = {size(std::min(depth, d.z)), size(kChunkSide), size(kChunkSide)},
                                         .deflate = 1,
                                         .shuffle = true}));
  const std::vector<double> element_um(3, options.voxel_mm * 1000.0);
  DUBSAR_TRY(file.set_attribute(kData, "element_size_um", std::span<const double>(element_um)));
  // A power of two, so that the low bytes of all values are 0.
  const double noise = kContrast * std::pow(10.0, -options.snr_db / 20.0);
  const auto step = static_cast<float>(std::exp2(std::floor(std::log2(noise / kStepsOfNoise))));
  ScanWriter writer(file, d, core, depth);
  std::vector<float> slab;
  for (std::int64_t z = 0; z < d.z; z += depth) {
    const std::int64_t slices = std::min(depth, d.z - z);
    slab.resize(static_cast<std::size_t>(slices * core.dims.slice()));
    DUBSAR_TRY(source.read(z, z + slices, slab));
    round_to_steps(slab, step);
    DUBSAR_TRY(writer.write_layer(z, slices, slab));
    fmt::print(stderr, "\r{} of {} slices", z + slices, d.z);
  }
  fmt::print(stderr, "\n");
  return file.commit();
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("use: scanner_scan OUT.h5 X Y Z [CHUNK_DEPTH] [SEED] [THREADS]\n", stderr);
    return 64;
  }
  const auto number = [&](int i, std::int64_t otherwise) { return argc > i ? std::atoll(argv[i]) : otherwise; };
  dubsar::phantom::PhantomOptions options;
  options.dims = {number(2, 0), number(3, 0), number(4, 0)};
  options.seed = static_cast<std::uint64_t>(number(6, 1));
  dubsar::set_thread_count(static_cast<int>(number(7, 0)));
  const dubsar::Result<void> written = dubsar::write_scan(argv[1], options, number(5, 32));
  if (!written) fmt::print(stderr, "error: {}\n", written.error().message);
  return written ? 0 : 70;
}
