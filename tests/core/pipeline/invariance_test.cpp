// The same object gives the same answer, however it is written down: padding, grey scale, place on the grid, axes.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/hdf5/hdf5_writer.h"
#include "core/phantom/phantom_source.h"
#include "core/pipeline/pipeline.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

constexpr Dims kLarge{104, 80, 104}, kDims{80, 56, 80};  ///< what there is, and what a run sees of it
constexpr std::int64_t kMargin = 12;                     ///< of the middle one

struct Scan {
  Dims dims;
  std::vector<float> values;
  float& at(std::int64_t x, std::int64_t y, std::int64_t z) {
    return values[static_cast<std::size_t>((z * dims.y + y) * dims.x + x)];
  }
  float at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return values[static_cast<std::size_t>((z * dims.y + y) * dims.x + x)];
  }
};

/// What a run finds, in voxels.
struct Answer {
  std::map<std::string, double> volumes, areas;  ///< by part
  double threshold = 0.0, unmeasured = 0.0, fairing = 0.0;
  std::string text, warnings;  ///< of the report
};

class Invariance : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_invariance_{}", ::getpid());
    fs::create_directories(folder_);
    phantom::PhantomOptions wanted;
    wanted.dims = kLarge;
    wanted.voxel_mm = 0.85;
    wanted.seed = 5;
    wanted.snr_db = 24.0;
    phantom::PhantomSource source(phantom::Phantom::create(wanted).value());
    large_ = {kLarge, std::vector<float>(static_cast<std::size_t>(kLarge.count()))};
    ASSERT_TRUE(source.read(0, kLarge.z, large_.values));
    // Grey values as of a scanner: air 1000, clay 9000.
    for (float& v : large_.values) v = std::clamp(std::round(1000.0f + 8000.0f * v), 0.0f, 65535.0f);
    scan_ = part({kMargin, kMargin, kMargin}, kDims);
    plain_ = answer(scan_);
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  template <class Number = float>
  static Answer answer(const Scan& scan, std::vector<std::uint64_t> chunk = {}) {
    const fs::path path = folder_ / "scan.h5";
    fs::remove(path);
    auto writer = Hdf5Writer::create(path.string()).value();
    const Dims d = scan.dims;
    const std::vector<Number> numbers(scan.values.begin(), scan.values.end());
    Hdf5Storage storage{
        .dims = {static_cast<std::uint64_t>(d.z), static_cast<std::uint64_t>(d.y), static_cast<std::uint64_t>(d.x)},
        .chunk = std::move(chunk)};
    EXPECT_TRUE(writer.template write<Number>("/v", storage, numbers));
    EXPECT_TRUE(writer.commit());
    PipelineOptions options;
    options.import.path = path;
    options.detail = Detail::kScan;
    options.occlusion.reset();
    SilentProgress progress;
    const auto result = run_pipeline(options, progress);
    EXPECT_TRUE(result) << result.error().message;
    Answer found;
    if (!result) return found;
    for (const Partition& part : result->report.partitions) {
      found.volumes[part.name] += part.volume_mm3;
      found.areas[part.name] += part.area_mm2;
    }
    found.threshold = static_cast<double>(result->report.threshold.value);
    found.fairing = static_cast<double>(result->report.surface_by.fairing);
    found.unmeasured = result->report.scan.unmeasured.share;
    found.text = report_text(result->report);
    for (const std::string& warning : result->report.scan.warnings) found.warnings += warning + "\n";
    return found;
  }

  static Scan part(const std::array<std::int64_t, 3>& from, const Dims& dims) {
    Scan out{dims, std::vector<float>(static_cast<std::size_t>(dims.count()))};
    for (std::int64_t z = 0; z < dims.z; ++z)
      for (std::int64_t y = 0; y < dims.y; ++y)
        for (std::int64_t x = 0; x < dims.x; ++x) out.at(x, y, z) = large_.at(x + from[0], y + from[1], z + from[2]);
    return out;
  }

  static void expect_same(const Answer& found, double tolerance, const std::string& what) {
    ASSERT_EQ(found.volumes.size(), plain_.volumes.size()) << what << "\n" << found.text;
    for (const auto& [part, volume] : plain_.volumes) {
      ASSERT_TRUE(found.volumes.contains(part)) << what << ": " << part;
      EXPECT_NEAR(found.volumes.at(part), volume, tolerance * std::abs(volume)) << what << ": " << part;
      EXPECT_NEAR(found.areas.at(part), plain_.areas.at(part), tolerance * plain_.areas.at(part))
          << what << ": " << part;
    }
  }

  static inline fs::path folder_;
  static inline Scan large_, scan_;
  static inline Answer plain_;
};

TEST_F(Invariance, PaddingOfEveryKindTakesNoPart) {
  const auto circle = [](std::int64_t x, std::int64_t y, std::int64_t) {
    return std::hypot((double(x) - 39.5) / 43.0, (double(y) - 27.5) / 36.0) > 1.0;
  };
  const auto each_slice = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return std::hypot((double(x) - 39.5) / (42.0 + double(z % 5)), (double(y) - 27.5) / 36.0) > 1.0;
  };
  int turn = 0;
  for (const float pad : {0.0f, -1.0f, -1000.0f, 65535.0f, std::numeric_limits<float>::quiet_NaN()}) {
    const bool by_slice = turn++ % 2 != 0;
    Scan padded = scan_;
    double outside = 0.0;
    for (std::int64_t z = 0; z < kDims.z; ++z)
      for (std::int64_t y = 0; y < kDims.y; ++y)
        for (std::int64_t x = 0; x < kDims.x; ++x)
          if (by_slice ? each_slice(x, y, z) : circle(x, y, z)) {
            padded.at(x, y, z) = pad;
            ++outside;
          }
    const Answer found = pad >= 0.0f ? answer<std::uint16_t>(padded) : answer(padded);
    const std::string what = fmt::format("pad {} {}", pad, by_slice ? "by slice" : "along z");
    EXPECT_NEAR(found.unmeasured, outside / double(kDims.count()), 1e-9) << what;
    expect_same(found, 5e-3, what);
    EXPECT_NEAR(found.threshold, plain_.threshold, 20.0) << what;
    EXPECT_NE(found.text.find("no measurement, left out of all estimates and taken as"), std::string::npos);
  }
}

TEST_F(Invariance, GreyValuesMayHaveAnyScaleAndOffset) {
  for (const auto& [a, b] : {std::pair{0.25f, 0.0f}, {1.0f, -3000.0f}, {1.7e-4f, -0.21f}, {3.0f, 20000.0f}}) {
    Scan scaled = scan_;
    for (float& v : scaled.values) v = a * v + b;
    const Answer found = answer(scaled);
    const std::string what = fmt::format("{} v + {}", a, b);
    // Greys are whole numbers and their noise is less than one: what filters leave of it is found as 24.8 or 28.6 dB.
    expect_same(found, 1e-2, what);
    EXPECT_NEAR((found.threshold - double(b)) / double(a), plain_.threshold, 8.0) << what;
  }
}

TEST_F(Invariance, InvertedGreysAreToldInOneSentence) {
  Scan inverted = scan_;
  for (float& v : inverted.values) v = 20000.0f - v;
  EXPECT_NE(answer(inverted).warnings.find("air is brighter than clay in this scan"), std::string::npos);
  EXPECT_EQ(plain_.warnings.find("brighter"), std::string::npos);
}

TEST_F(Invariance, ChunksAndNumberTypesChangeNothing) {
  expect_same(answer(scan_, {16, 16, 16}), 1e-12, "chunks of 16");
  expect_same(answer<std::uint16_t>(scan_, {7, 56, 11}), 1e-12, "uint16, uneven chunks");
  expect_same(answer<std::int32_t>(scan_), 1e-12, "int32");
}

TEST_F(Invariance, WhereTheObjectLiesInTheScanChangesNothing) {
  for (const std::array<std::int64_t, 3>& from :
       {std::array<std::int64_t, 3>{12, 12, 11}, {11, 13, 12}, {9, 20, 15}, {14, 4, 9}})
    expect_same(answer(part(from, kDims)), 1e-2, fmt::format("from {} {} {}", from[0], from[1], from[2]));
  expect_same(answer(large_), 1e-2, "with all of the margin");
  expect_same(answer(part({14, 14, 14}, {76, 52, 76})), 1e-2, "with less margin");
}

TEST_F(Invariance, MirrorsAndOtherAxesChangeNothing) {
  Scan mirrored = scan_, turned{{kDims.z, kDims.x, kDims.y}, std::vector<float>(scan_.values.size())};
  for (std::int64_t z = 0; z < kDims.z; ++z)
    for (std::int64_t y = 0; y < kDims.y; ++y)
      for (std::int64_t x = 0; x < kDims.x; ++x) {
        mirrored.at(kDims.x - 1 - x, y, z) = scan_.at(x, y, z);
        turned.at(z, x, y) = scan_.at(x, y, z);
      }
  expect_same(answer(mirrored), 1e-2, "mirrored");
  expect_same(answer(turned), 1e-2, "axes exchanged");
}

/// A box with a round pit in it, blurred (by distance), with noise of 14 dB that hangs together over two voxels.
Scan noisy_box() {
  Scan scan{{104, 80, 92}, {}};
  const auto count = static_cast<std::size_t>(scan.dims.count());
  std::mt19937 random(17);
  std::normal_distribution<float> normal;
  std::vector<float> noise(count), spread(count);
  for (float& v : noise) v = normal(random);
  for (const std::size_t step : {std::size_t{1}, std::size_t(scan.dims.x), std::size_t(scan.dims.slice())}) {
    for (std::size_t i = 0; i < count; ++i)
      spread[i] = 0.5f * noise[i] + 0.25f * (noise[(i + step) % count] + noise[(i + count - step) % count]);
    noise = spread;
  }
  scan.values.resize(count);
  for (std::int64_t z = 0; z < scan.dims.z; ++z)
    for (std::int64_t y = 0; y < scan.dims.y; ++y)
      for (std::int64_t x = 0; x < scan.dims.x; ++x) {
        const double dx = double(x) - 51.3, dy = double(y) - 39.6, dz = double(z) - 45.2;
        const double px = 0.96 * dx - 0.28 * dy, py = 0.8 * (0.28 * dx + 0.96 * dy) - 0.6 * dz,
                     pz = 0.6 * (0.28 * dx + 0.96 * dy) + 0.8 * dz;
        const double box = std::max({std::abs(px) - 34.0, std::abs(py) - 20.0, std::abs(pz) - 22.0}),
                     pit = 9.0 - std::hypot(px - 4.0, py - 20.0, pz + 6.0);
        const double inside = 0.5 * std::erfc(std::max(box, pit) / (0.9 * std::sqrt(2.0)));
        const std::size_t at = static_cast<std::size_t>((z * scan.dims.y + y) * scan.dims.x + x);
        scan.values[at] = std::round(1000.0f + 8000.0f * (float(inside) + 0.7f * noise[at]));
      }
  return scan;
}

TEST_F(Invariance, ANoisySurfaceIsMadeFairTheSameWhereverItLies) {
  const Scan noisy = noisy_box();
  const Dims d = noisy.dims, moved{d.x - 3, d.y, d.z - 7};
  Scan mirrored = noisy, turned{{d.z, d.x, d.y}, noisy.values},
       shifted{moved, std::vector<float>(static_cast<std::size_t>(moved.count()))};
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) {
        mirrored.at(d.x - 1 - x, y, z) = noisy.at(x, y, z);
        turned.at(z, x, y) = noisy.at(x, y, z);
        if (x >= 3 && z >= 7) shifted.at(x - 3, y, z - 7) = noisy.at(x, y, z);
      }
  const Answer plain = answer(noisy);
  EXPECT_GT(plain.fairing, 0.5);
  const double volume = plain.volumes.at("object"), area = plain.areas.at("object");
  for (const auto& [what, scan] :
       {std::pair{"mirrored", mirrored}, std::pair{"axes exchanged", turned}, std::pair{"shifted", shifted}}) {
    const Answer found = answer(scan);
    EXPECT_NEAR(found.fairing, plain.fairing, 0.05) << what;
    EXPECT_NEAR(found.volumes.at("object"), volume, 2e-3 * volume) << what;
    EXPECT_NEAR(found.areas.at("object"), area, 2e-3 * area) << what;
  }
}

}  // namespace
}  // namespace dubsar
