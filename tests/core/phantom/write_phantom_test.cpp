#include "core/phantom/write_phantom.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/hdf5/hdf5_file.h"
#include "core/phantom/phantom_source.h"

namespace dubsar::phantom {
namespace {

namespace fs = std::filesystem;

class WritePhantom : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dubsar_phantom_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(WritePhantom, FilesHoldTheScanAndTheTruth) {
  const PhantomOptions options = parse_preset("tiny").value();
  SilentProgress progress;
  const auto report = write_phantom(folder_ / "a.h5", folder_ / "t.h5", options, progress);
  ASSERT_TRUE(report) << report.error().message;
  const std::shared_ptr<const Phantom> phantom = Phantom::create(options).value();
  const Dims d = options.dims;

  const auto file = Hdf5File::open(folder_ / "a.h5").value();
  const auto data = file.open_dataset("/entry/data/data").value();
  EXPECT_EQ(data.info().dims, (std::vector<std::uint64_t>{96, 64, 96}));
  const std::vector<std::uint64_t> zero(3, 0);
  std::vector<float> stored(static_cast<std::size_t>(d.count())), expected(stored.size());
  ASSERT_TRUE(data.read_stored(zero, data.info().dims, std::as_writable_bytes(std::span(stored))));
  ASSERT_TRUE(PhantomSource(phantom).read(0, d.z, expected));
  EXPECT_EQ(stored, expected);
  EXPECT_NEAR(file.numbers("/entry/data/data", "element_size_um").value().at(0), options.voxel_mm * 1000.0, 1e-9);
  EXPECT_EQ(file.string("/entry/data/x", "units").value(), "mm");

  const auto truth = Hdf5File::open(folder_ / "t.h5").value();
  const auto label_data = truth.open_dataset("/truth/label").value();
  std::vector<std::uint8_t> stored_label(stored.size()), label(stored.size());
  ASSERT_TRUE(label_data.read_stored(zero, label_data.info().dims, std::as_writable_bytes(std::span(stored_label))));
  std::vector<std::int16_t> distance(stored.size());
  rasterise_truth(*phantom, 0, d.z, label, distance);
  EXPECT_EQ(stored_label, label);
  const auto wedges = truth.number_dataset("/truth/wedges");
  const auto columns = truth.strings("/truth/wedges", "columns").value();
  ASSERT_TRUE(wedges);
  ASSERT_EQ(wedges->size(), columns.size() * phantom->wedges().size());
  EXPECT_EQ(columns[9], "depth");
  EXPECT_EQ(wedges->at(9), phantom->wedges().front().depth);
  EXPECT_EQ(report->tablet_wedges + report->envelope_wedges, static_cast<int>(phantom->wedges().size()));
}

TEST_F(WritePhantom, CancelLeavesNoFile) {
  SilentProgress progress;
  progress.cancel();
  const auto report = write_phantom(folder_ / "b.h5", std::nullopt, parse_preset("tiny").value(), progress);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::kCancelled);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace dubsar::phantom
