// A whole scan of a phantom: the file, its truth, its bytes.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/base/system/parallel.h"
#include "core/hdf5/hdf5_file.h"
#include "core/phantom/density.h"
#include "core/phantom/phantom_source.h"
#include "core/phantom/scanner/beam.h"
#include "core/phantom/write_phantom.h"

namespace dubsar::phantom {
namespace {

namespace fs = std::filesystem;

class ScannerScan : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dubsar_scanner_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<float> write(const std::string& scanner, const std::optional<fs::path>& truth = std::nullopt) {
    PhantomOptions options;
    options.dims = {64, 44, 60};
    options.seed = 21;
    options.scanner = parse_scanner(scanner).value();
    SilentProgress progress;
    const fs::path path = folder_ / "s.h5";
    report_ = write_phantom(path, truth, options, progress).value();
    const auto file = Hdf5File::open(path).value();
    const auto data = file.open_dataset("/entry/data/data").value();
    std::vector<float> stored(static_cast<std::size_t>(options.dims.count()));
    EXPECT_TRUE(data.read_stored(std::vector<std::uint64_t>(3, 0), data.info().dims,
                                 std::as_writable_bytes(std::span(stored))));
    return stored;
  }

  fs::path folder_;
  PhantomReport report_;
};

TEST_F(ScannerScan, TheObjectIsThePhantomsWhateverScansIt) {
  const std::vector<float> scan = write("ideal,turn=half,cone=0,views=120,blur=0", folder_ / "t.h5");
  EXPECT_TRUE(fs::exists(folder_ / "t.h5"));
  // Against the density itself: the same where nothing changes within three voxels, at the scale of the beam.
  const auto phantom = Phantom::create(report_.options).value();
  const double clay = report_.scanner->clay_per_mm;
  EXPECT_NEAR(clay, 0.18 * clay_attenuation(80.0, 0.15), 1e-12);  // 1.8 g/cm3
  double n[2] = {0, 0}, sum[2] = {0, 0};
  for (std::int64_t z = 4; z < 56; z += 2)
    for (std::int64_t y = 2; y < 42; y += 2)
      for (std::int64_t x = 2; x < 62; x += 2) {
        const Fields f = phantom->fields(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        if (std::abs(f.clay.v) < 3.0f || f.grain.v < 3.0f || f.organic.v < 3.0f) continue;
        const int i = f.clay.v < 0.0f;
        n[i] += 1.0;
        sum[i] += static_cast<double>(scan[static_cast<std::size_t>((z * 44 + y) * 64 + x)]) / clay;
      }
  ASSERT_GT(n[1], 100.0);
  EXPECT_NEAR(sum[1] / n[1], 1.0, 0.01);
  EXPECT_NEAR(sum[0] / n[0], 0.0, 0.01);
}

TEST_F(ScannerScan, SameBytesForAnyThreads) {
  set_thread_count(1);
  const std::vector<float> one = write("medium,views=48");
  set_thread_count(3);
  const std::vector<float> three = write("medium,views=48");
  set_thread_count(0);
  EXPECT_EQ(one, three);
}

TEST_F(ScannerScan, DensityIsThatOfTheScanBeforeItIsBlurred) {
  PhantomOptions options;
  options.dims = {64, 44, 60};
  options.snr_db = INFINITY;
  options.blur_vox = 0.3;
  const std::shared_ptr<const Phantom> phantom = Phantom::create(options).value();
  DensitySource source(*phantom);
  std::vector<float> density(static_cast<std::size_t>(options.dims.count())), blurred(density.size());
  ASSERT_TRUE(source.read(0, 60, density));
  ASSERT_TRUE(PhantomSource(phantom).read(0, 60, blurred));
  double sharp = 0.0, soft = 0.0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    sharp += static_cast<double>(density[i]);
    soft += static_cast<double>(blurred[i]) / 0.0017;
  }
  EXPECT_NEAR(soft / sharp, 1.0, 1e-4);
}

}  // namespace
}  // namespace dubsar::phantom
