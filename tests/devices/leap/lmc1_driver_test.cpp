
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "devices/leap/lmc1_simulator.h"
#include "tests/devices/leap/eventually.h"
#include "tests/devices/leap/hand_above.h"
#include "tests/devices/leap/one_kind.h"

namespace dubsar {
namespace {

using std::chrono::steady_clock;

Lmc1Options quick_lmc1() {
  Lmc1Options options;
  options.calibration_settle = milliseconds(0);
  return options;
}

std::ptrdiff_t threads_now() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), std::filesystem::directory_iterator());
}

TEST(Lmc1Driver, DeliversTheFramesThatTheDeviceRendered) {
  Lmc1SimulatorOptions device;
  device.frame_limit = 3;
  device.hands = [](std::uint64_t) { return std::vector{hand_above()}; };
  Lmc1Simulator simulator(device);
  SteadyClock clock;
  auto driver = lmc1_camera([&] { return simulator.open(); }, quick_lmc1(), clock);
  ASSERT_TRUE(driver->start());
  EXPECT_EQ(driver->calibration(), device.calibration);
  EXPECT_TRUE(simulator.led_on(lmc1::Switch::kLedCentre));
  EXPECT_EQ(simulator.exposure_us(), 200);
  Frame frame;
  ASSERT_TRUE(driver->poll(frame));  // the newest of three
  EXPECT_EQ(driver->counters().frames, 3U);
  EXPECT_FALSE(driver->poll(frame));
  EXPECT_EQ(frame.sequence, 3U);
  EXPECT_EQ(frame.views, 2);
  EXPECT_EQ(frame.exposure_us, 200);
  EXPECT_FALSE(frame.dark);
  EXPECT_GT(frame.time, 0);

  HandRenderOptions render = device.render;
  std::vector<std::uint8_t> left(640 * 240), right(640 * 240);
  const PosedHand hand = hand_above();
  HandRenderer(device.calibration, render).render({&hand, 1}, device.seed + 2, left, right);
  const auto without_metadata = [](std::span<const std::uint8_t> view) { return view.first(view.size() - 6); };
  EXPECT_TRUE(std::ranges::equal(without_metadata(frame.view(0)), without_metadata(left)));
  EXPECT_TRUE(std::ranges::equal(without_metadata(frame.view(1)), without_metadata(right)));
  driver->stop();
  EXPECT_EQ(driver->state(), FrameSourceState::kStopped);
  EXPECT_FALSE(simulator.led_on(lmc1::Switch::kLedCentre));
}

/// Every third read finds nothing, as on a busy machine.
class PausingTransport final : public Transport {
 public:
  explicit PausingTransport(std::unique_ptr<Transport> device) : device_(std::move(device)) {}
  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    return ++reads_ % 3 == 0 ? Result<std::size_t>(0U) : device_->read(report, timeout);
  }
  Result<void> write(std::span<const std::byte> report) override { return device_->write(report); }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    return device_->control(request, data, timeout);
  }

 private:
  std::unique_ptr<Transport> device_;
  int reads_ = 0;
};

TEST(Lmc1Driver, PausesWithinAFrameDoNotLoseIt) {
  Lmc1SimulatorOptions device;
  device.frame_limit = 5;
  Lmc1Simulator simulator(device);
  SteadyClock clock;
  auto driver = lmc1_camera(
      [&]() -> Result<std::unique_ptr<Transport>> {
        DUBSAR_ASSIGN(auto opened, simulator.open());
        return std::make_unique<PausingTransport>(std::move(opened));
      },
      quick_lmc1(), clock);
  ASSERT_TRUE(driver->start());
  Frame frame;
  ASSERT_TRUE(eventually([&] { return driver->poll(frame) && frame.sequence == 5; }))
      << driver->counters().frames << " frames, " << driver->counters().dropped_frames << " dropped";
  EXPECT_EQ(driver->counters().dropped_frames, 0U);
}

TEST(Lmc1Driver, UnpluggedIsAStateAndReplugStartsAgain) {
  Lmc1SimulatorOptions device;
  device.paced = true;
  Lmc1Simulator simulator(device);
  SteadyClock clock;
  auto driver = lmc1_camera([&] { return simulator.open(); }, quick_lmc1(), clock);
  ASSERT_TRUE(driver->start());
  Frame frame;
  ASSERT_TRUE(eventually([&] { return driver->poll(frame); }));
  simulator.unplug();
  ASSERT_TRUE(eventually([&] { return driver->poll(frame), driver->state() == FrameSourceState::kLost; }));
  EXPECT_THAT(driver->reason(), testing::HasSubstr("unplugged"));
  EXPECT_EQ(driver->start().error().kind, ErrorKind::kUnavailable);
  simulator.plug();
  ASSERT_TRUE(driver->start());
  EXPECT_TRUE(eventually([&] { return driver->poll(frame); }));
  EXPECT_EQ(driver->state(), FrameSourceState::kRunning);
}

TEST(Lmc1Driver, HundredCyclesOfPlugAndUnplugLeaveNoThread) {
  Lmc1SimulatorOptions device;
  device.frame_limit = 1;
  Lmc1Simulator simulator(device);
  SteadyClock clock;
  const auto before = threads_now();
  for (int i = 0; i < 100; ++i) {
    auto driver = lmc1_camera([&] { return simulator.open(); }, quick_lmc1(), clock);
    ASSERT_TRUE(driver->start());
    simulator.unplug();
    if (i % 2 == 0) {
      Frame frame;
      ASSERT_TRUE(eventually([&] { return driver->poll(frame), driver->state() == FrameSourceState::kLost; }));
    }
    driver.reset();
    simulator.plug();
  }
  EXPECT_EQ(threads_now(), before);
}

TEST(Lmc1Driver, ExposureAndDarkFramesAreTheDevices) {
  Lmc1SimulatorOptions device;
  device.paced = true;
  Lmc1Simulator simulator(device);
  SteadyClock clock;
  Lmc1Options options = quick_lmc1();
  options.exposure_us = 333;
  options.dark_frame_interval = 2;
  auto driver = lmc1_camera([&] { return simulator.open(); }, options, clock);
  ASSERT_TRUE(driver->start());
  EXPECT_EQ(simulator.exposure_us(), 333);
  Frame frame;
  EXPECT_TRUE(eventually([&] { return driver->wait(frame, milliseconds(50)) && frame.dark; }));
  EXPECT_TRUE(eventually([&] { return driver->wait(frame, milliseconds(50)) && !frame.dark; }));
  options.exposure_us = 5;
  EXPECT_FALSE(lmc1_camera([&] { return simulator.open(); }, options, clock)->start());
}

TEST(Lmc1Driver, WithoutDarkFramesEveryFrameIsLitWhateverItsLabelIs) {
  std::vector<std::byte> bytes(std::size_t{640} * 240 * 2);
  lmc1::encode_metadata({200, 16, 1}, std::span(bytes).last<lmc1::kMetadataBytes>());
  for (const int interval : {0, 2}) {
    Lmc1Options options = quick_lmc1();
    options.dark_frame_interval = interval;
    const auto kind = lmc1_kind(options);
    Frame frame;
    frame.width = 640;
    frame.height = 240;
    frame.views = 2;
    frame.pixels.resize(2 * frame.view_bytes());
    kind->unpack(bytes, frame);
    EXPECT_EQ(frame.dark, interval == 2);
  }
}

TEST(Lmc1Driver, ADeviceThatStallsItsCalibrationIsRefusedInOneSentence) {
  Lmc1SimulatorOptions device;
  device.calibration.baseline_mm = 0.0F;
  Lmc1Simulator simulator(device);
  SteadyClock clock;
  auto driver = lmc1_camera([&] { return simulator.open(); }, quick_lmc1(), clock);
  const auto started = driver->start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(started.error().message, testing::HasSubstr("baseline of 0 mm"));
  EXPECT_EQ(driver->state(), FrameSourceState::kStopped);
}

TEST(Lmc1Driver, UnknownModesAreRefused) {
  Lmc1Simulator simulator(Lmc1SimulatorOptions{});
  SteadyClock clock;
  Lmc1Options options = quick_lmc1();
  options.width = 320;
  auto driver = lmc1_camera([&] { return simulator.open(); }, options, clock);
  EXPECT_EQ(driver->start().error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
