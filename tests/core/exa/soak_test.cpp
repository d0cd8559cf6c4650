// Many random volumes and much damage. In `./do test` a share of each; all 500 volumes and 100,000 flips with
//   DUBSAR_SOAK=1 build/release/tests/core/exa/test_exa --gtest_filter='ExaSoak.*'

#include <sys/resource.h>

#include <chrono>
#include <cstdlib>

#include "core/base/system/parallel.h"
#include "core/exa/offsets/settle.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {

bool soak() { return std::getenv("DUBSAR_SOAK") != nullptr; }

/// Small work: threads would only wait for each other.
class OneThread {
 public:
  OneThread() { set_thread_count(1); }
  ~OneThread() { set_thread_count(0); }
};

/// Noise of any density, blobs of any size with any noise, planes and checkers; dimensions from 1 to 70.
SurfaceSamples random_samples(std::mt19937& random) {
  const auto size = [&] { return static_cast<std::int64_t>(1 + random() % (random() % 4 == 0 ? 70 : 25)); };
  const Dims dims{size(), size(), size()};
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double density = uniform(random), noise = std::pow(uniform(random), 3.0) * 2.0, step = 0.05 + uniform(random);
  const auto kind = random() % 4;
  SurfaceSamples samples;
  samples.dims = dims;
  samples.closed = random() % 2 == 0;
  samples.offset_bits = static_cast<int>(1 + random() % 16);
  samples.signs = BitVolume(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) {
        const double blob = std::sin(step * static_cast<double>(x)) + std::sin(1.1 * step * static_cast<double>(y)) +
                            std::sin(0.9 * step * static_cast<double>(z)) + noise * (uniform(random) - 0.5);
        samples.signs.set(x, y, z,
                          kind == 0   ? uniform(random) < density
                          : kind == 1 ? (x + 2 * y + 3 * z) % static_cast<std::int64_t>(2 + density * 9) == 0
                                      : blob > 0.0);
      }
  const SampleCounts counts = count_samples(samples.signs);
  for (std::int64_t i = 0; i < counts.edges; ++i)
    samples.offsets.push_back(static_cast<std::uint16_t>(random() & ((1u << samples.offset_bits) - 1)));
  for (std::int64_t i = 0; i < counts.faces; ++i) samples.joined.push_back(static_cast<std::uint8_t>(random() & 1));
  return samples;
}

TEST(ExaSoak, TheTopologyOfRandomVolumesComesBackExactly) {
  const OneThread one;
  SilentProgress progress;
  const unsigned seed = soak() ? std::random_device()() : 7u;
  std::mt19937 random(seed);
  for (int round = 0; round < (soak() ? 500 : 60); ++round) {
    SurfaceModel model;
    model.samples = random_samples(random);
    model.mesh = build_quad_mesh(model.samples, progress).value();
    model.frame.input_voxel = {{1, 1, 1}, ""};
    const auto read = decode_exa(file_of(encoded(model)), progress);
    ASSERT_TRUE(read) << read.error().message << " seed " << seed << " round " << round;
    ASSERT_TRUE(read->samples == model.samples) << "seed " << seed << " round " << round;
    ASSERT_EQ(read->mesh.quads, model.mesh.quads);
    ASSERT_EQ(read->mesh.doubled, model.mesh.doubled);
  }
}

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
long peak_kib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(ExaSoak, FlippedBitsAreRefused) {
  const OneThread one;
  SilentProgress progress;
  SurfaceModel model = sample_model({11, 9, 8}, Kind::kBlob, 31);
  ASSERT_TRUE(settle_for_exa(model, {}, progress));
  const std::string whole = file_of(encoded(model));
  std::mt19937 random(soak() ? std::random_device()() : 8u);
  for (int round = 0; round < (soak() ? 100000 : 3000); ++round) {
    std::string bytes = whole;
    for (auto flips = 1 + random() % 3; flips > 0; --flips)
      bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
    if (bytes == whole) continue;
    const auto read = decode_exa(bytes, progress);
    ASSERT_FALSE(read) << "round " << round;
    ASSERT_EQ(read.error().kind, ErrorKind::kBadData);
  }
}

TEST(ExaSoak, FlippedBitsBehindRepairedSumsGiveAnErrorOrTheSameMesh) {
  const OneThread one;
  SilentProgress progress;
  std::mt19937 random(soak() ? std::random_device()() : 9u);
  SurfaceModel model = sample_model({11, 9, 8}, Kind::kBlob, 32);
  ASSERT_TRUE(settle_for_exa(model, {}, progress));
  const std::vector<ExaBlock> blocks = encoded(model);
  const long before_kib = peak_kib();
  double slowest = 0.0;
  for (int round = 0; round < (soak() ? 100000 : 2000); ++round) {
    std::vector<ExaBlock> damaged = blocks;
    ExaBlock& block = damaged[random() % damaged.size()];
    const auto parts = split_chunks(block.bytes, block.chunks, "test");
    std::vector<std::string> chunks(parts->begin(), parts->end());
    std::string& bytes = chunks[random() % chunks.size()];
    if (bytes.empty()) continue;
    bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
    block.bytes = join_chunks(chunks);
    const double start = seconds();
    const auto read = decode_exa(file_of(damaged), progress);
    slowest = std::max(slowest, seconds() - start);
    if (!read) {
      ASSERT_TRUE(read.error().kind == ErrorKind::kBadData || read.error().kind == ErrorKind::kTryAgain)
          << read.error().message;
      continue;
    }
    ASSERT_EQ(read->mesh.quads, model.mesh.quads) << block.type;
    ASSERT_TRUE(same_bytes(read->mesh.positions, model.mesh.positions)) << block.type;
  }
  EXPECT_LT(slowest, 10.0) << "seconds for a file of some KiB";
  EXPECT_LT(peak_kib() - before_kib, 600 * 1024) << "KiB beyond what the header allows, 64 MiB and a little";
}

}  // namespace
}  // namespace dubsar
