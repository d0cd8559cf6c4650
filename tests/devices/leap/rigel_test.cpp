#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <random>
#include <thread>

#include "devices/leap/rigel_simulator.h"
#include "devices/leap/uvc_payload.h"
#include "tests/devices/leap/eventually.h"
#include "tests/devices/leap/hand_above.h"
#include "tests/devices/leap/one_kind.h"

namespace dubsar {
namespace {

using std::chrono::steady_clock;
using ::testing::HasSubstr;

constexpr rigel::Units kUnits{0, 224, 2};

std::vector<std::byte> configuration() {
  const auto bytes = std::as_bytes(RigelSimulator::configuration_descriptor());
  return {bytes.begin(), bytes.end()};
}

RigelSimulatorOptions one_hand() {
  RigelSimulatorOptions device;
  device.hands = [](std::uint64_t) { return std::vector{hand_above()}; };
  return device;
}

RigelOptions quick_rigel() {
  RigelOptions options;
  options.height = 240;
  return options;
}

// --- bytes ---

TEST(RigelProtocol, SettingsAreRequestsToExtensionUnit224) {
  const auto exposure = rigel::exposure_us(kUnits, 0x0123);
  ASSERT_TRUE(exposure);
  EXPECT_EQ(exposure->request, (ControlRequest{0x21, 0x01, 0x1e00, 0xe000}));
  EXPECT_EQ(exposure->bytes, 2U);
  EXPECT_EQ(exposure->data[0], std::byte{0x23});
  EXPECT_EQ(exposure->data[1], std::byte{0x01});
  const auto leds = rigel::leds(kUnits, true);
  EXPECT_EQ(leds[0], uvc::control_write({0x21, 0x01, 0x1b00, 0xe000}, 1, 1));
  EXPECT_EQ(leds[1], uvc::control_write({0x21, 0x01, 0x0600, 0xe000}, 1, 4));
  EXPECT_EQ(rigel::get_extension(kUnits, rigel::Selector::kCalibration), (ControlRequest{0xa1, 0x81, 0x1900, 0xe000}));
  EXPECT_EQ(rigel::gain(kUnits, 1)->request, (ControlRequest{0x21, 0x01, 0x0400, 0x0200}));
}

TEST(RigelProtocol, SettingsOutsideTheirRangeAreRefusedAndGapsAreLeftOut) {
  for (const int us : {-1, 9, 4001}) EXPECT_EQ(rigel::exposure_us(kUnits, us).error().kind, ErrorKind::kUsage);
  for (const int step : {-1, 65}) EXPECT_FALSE(rigel::gain(kUnits, step));
  for (int step = 0; step <= 64; ++step) {
    const auto value = static_cast<int>(rigel::gain(kUnits, step)->data[0]);
    EXPECT_TRUE(value == 0 || (value >= 16 && value <= 79)) << step;
  }
  EXPECT_FALSE(rigel::gain({0, 224, 0}, 1));
  for (const int n : {-1, 3, 129}) EXPECT_FALSE(rigel::dark_frame_interval(kUnits, n));
  const auto interval = [](int n) { return static_cast<int>(rigel::dark_frame_interval(kUnits, n)->data[0]); };
  EXPECT_EQ(interval(0), 0);
  EXPECT_EQ(interval(2), 2);
  EXPECT_EQ(interval(4), 3);  // one dark frame and three lit ones
  EXPECT_EQ(interval(128), 127);
}

TEST(RigelProtocol, EveryLineIsTheLeftRowAndThenTheRightRow) {
  std::vector<std::byte> frame;
  for (int i = 1; i <= 12; ++i) frame.push_back(std::byte(i));
  std::array<std::uint8_t, 6> left{}, right{};
  rigel::split_rows(frame, 3, left, right);
  EXPECT_THAT(left, testing::ElementsAre(1, 2, 3, 7, 8, 9));
  EXPECT_THAT(right, testing::ElementsAre(4, 5, 6, 10, 11, 12));
}

TEST(RigelProtocol, TheEmbeddedLineIsReadWhereTheDeviceSaysAndNowhereElse) {
  const rigel::EmbeddedLine where{4, 8, std::nullopt, 20};
  const auto bytes = rigel::encode(where);
  EXPECT_EQ(rigel::decode_embedded_line(bytes), where);
  EXPECT_EQ(bytes[0], std::byte{2});
  EXPECT_EQ(bytes[4], std::byte{4});
  EXPECT_EQ(bytes[8], std::byte{0xff});  // no gain
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_FALSE(rigel::decode_embedded_line(std::span(bytes).first(length)));
  auto legacy = bytes;
  legacy[0] = std::byte{1};
  EXPECT_FALSE(rigel::decode_embedded_line(legacy));

  std::vector<std::byte> line(32);
  rigel::encode_metadata({7, 1234, 99, 0x01020304}, where, line);
  EXPECT_EQ(rigel::decode_metadata(where, line), (rigel::Metadata{7, 1234, 0, 0x01020304}));
  EXPECT_EQ(line[20], std::byte{4});
  for (std::size_t length = 0; length < 24; ++length) {  // offsets beyond a short line are 0
    const auto metadata = rigel::decode_metadata(where, std::span(line).first(length));
    EXPECT_EQ(metadata.frame_count, 0U);
    EXPECT_EQ(metadata.exposure_us, length >= 12 ? 1234U : 0U);
  }
}

// --- descriptors ---

TEST(UvcDescriptors, TheSimulatedRigelDescribesItself) {
  const auto camera = uvc::parse_configuration(configuration());
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->control_interface, 0);
  EXPECT_EQ(camera->stream_interface, 1);
  EXPECT_EQ(camera->bulk_endpoint, 0x82);
  EXPECT_EQ(camera->camera_terminal, 1);
  EXPECT_EQ(camera->processing_unit, 2);
  ASSERT_EQ(camera->extension_units.size(), 2U);
  EXPECT_TRUE(std::ranges::equal(camera->frames, RigelSimulator::sizes()));
  EXPECT_EQ(rigel::find_units(*camera)->extension, 224);
  EXPECT_EQ(camera->find(640, 240)->frame_index, 2);
  EXPECT_EQ(camera->find(640, 241), nullptr);
  auto moved = *camera;
  moved.extension_units[1].unit = 9;  // the GUID decides, then the number
  EXPECT_EQ(rigel::find_units(moved)->extension, 9);
  moved.extension_units[1].guid = {};
  EXPECT_THAT(rigel::find_units(moved).error().message, HasSubstr("none of Leap Motion's"));
}

TEST(UvcDescriptors, EveryTruncationIsRefused) {
  const auto whole = configuration();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    auto part = std::vector(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_FALSE(uvc::parse_configuration(part)) << length;
    if (length < 9) continue;
    part[2] = std::byte(length & 0xffU);  // as if the device had meant it
    part[3] = std::byte(length >> 8);
    if (const auto camera = uvc::parse_configuration(part)) {
      EXPECT_FALSE(camera->frames.empty());
      EXPECT_GT(length, 200U);  // it ends after the first picture size at least
    }
  }
}

TEST(UvcDescriptors, FlippedBitsAndRandomBytesDoNoHarm) {
  auto bytes = configuration();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= std::byte(1U << bit % 8);
    if (const auto camera = uvc::parse_configuration(bytes)) {
      for (const uvc::FrameSize& size : camera->frames) EXPECT_LE(size.frame_bytes(), std::size_t{65535} * 65535 * 32);
      (void)rigel::find_units(*camera);
    }
    bytes[bit / 8] ^= std::byte(1U << bit % 8);
  }
  std::mt19937 random(7);
  for (int n = 0; n < 20'000; ++n) {
    std::vector<std::byte> noise(random() % 300);
    for (std::byte& byte : noise) byte = std::byte(random() % 40);
    if (noise.size() >= 9) {
      noise[1] = std::byte{2};
      noise[2] = std::byte(noise.size() & 0xffU);
      noise[3] = std::byte(noise.size() >> 8);
    }
    EXPECT_FALSE(uvc::parse_configuration(noise));
  }
}

// --- payloads across transfers ---

TEST(UvcPayloadSplitter, PayloadsComeBackWholeHoweverTransfersCutThem) {
  for (const std::size_t payload_bytes : {512U, 1024U, 1300U, 3072U})
    for (const std::size_t buffer : {512U, 2048U, 4096U}) {
      // As an endpoint sends it: full payloads in whole packets run on, others end the transfer.
      std::vector<std::vector<std::byte>> payloads;
      for (int i = 0; i < 5; ++i) payloads.emplace_back(i == 4 ? 300 : payload_bytes, std::byte(i + 1));
      std::vector<std::vector<std::byte>> transfers(1);
      for (const auto& payload : payloads) {
        for (const std::byte byte : payload) {
          if (transfers.back().size() == buffer) transfers.emplace_back();
          transfers.back().push_back(byte);
        }
        if (payload.size() % 512 != 0) transfers.emplace_back();
      }
      UvcPayloadSplitter splitter(payload_bytes, buffer);
      std::vector<std::vector<std::byte>> found;
      for (const auto& transfer : transfers)
        if (!transfer.empty())
          splitter.add(transfer, [&](std::span<const std::byte> p) { found.emplace_back(p.begin(), p.end()); });
      EXPECT_TRUE(found == payloads) << payload_bytes << " " << buffer;
    }
}

// --- simulator and driver ---

TEST(RigelDriver, DeliversThePicturesThatTheDeviceRendered) {
  for (const std::uint32_t payload : {20480U, 16384U, 3000U, 40000U}) {
    RigelSimulatorOptions device = one_hand();
    device.stream.frame_limit = 2;
    device.payload_bytes = payload;
    RigelSimulator simulator(device);
    SteadyClock clock;
    auto driver = rigel_camera([&] { return simulator.open(); }, quick_rigel(), clock);
    const auto started = driver->start();
    ASSERT_TRUE(started) << started.error().message;
    EXPECT_EQ(driver->calibration(), device.calibration);
    EXPECT_TRUE(simulator.lights_on());
    EXPECT_EQ(simulator.exposure_us(), 200);
    Frame frame;
    ASSERT_TRUE(driver->poll(frame)) << payload;  // the newest of two
    EXPECT_EQ(driver->counters().frames, 2U);
    EXPECT_EQ(driver->counters().bad_transfers + driver->counters().dropped_frames, 0U);
    EXPECT_FALSE(driver->poll(frame));
    EXPECT_EQ(frame.sequence, 2U);
    EXPECT_EQ(frame.width, 640);
    EXPECT_EQ(frame.height, 240);
    EXPECT_EQ(frame.exposure_us, 200);
    EXPECT_FALSE(frame.dark);

    std::vector<std::uint8_t> left(640 * 240), right(640 * 240);
    const PosedHand hand = hand_above();
    HandRenderOptions render = device.render;
    HandRenderer(device.calibration, render).render({&hand, 1}, device.seed + 1, left, right);
    for (auto* eye : {&left, &right}) std::copy_n(eye->end() - 1280, 640, eye->end() - 640);  // numbers stood there
    EXPECT_TRUE(std::ranges::equal(frame.view(0), left));
    EXPECT_TRUE(std::ranges::equal(frame.view(1), right));
    driver->stop();
    EXPECT_FALSE(simulator.lights_on());
  }
}

TEST(RigelDriver, ASir170WithoutTheEmbeddedLineWorksToo) {
  RigelSimulatorOptions device;
  device.product = rigel::kSir170;
  device.embedded_line = false;
  device.stream.frame_limit = 1;
  RigelSimulator simulator(device);
  SteadyClock clock;
  RigelOptions options = quick_rigel();
  auto driver = rigel_camera([&] { return simulator.open(); }, options, clock);
  ASSERT_TRUE(driver->start());
  Frame frame;
  ASSERT_TRUE(driver->poll(frame));
  EXPECT_EQ(frame.exposure_us, 0);
  EXPECT_EQ(RigelSimulator::device_descriptor(device.product)[10], 0x03);
}

TEST(RigelDriver, ExposureAndDarkFramesAreTheDevices) {
  RigelSimulatorOptions device;
  device.stream.paced = true;
  RigelSimulator simulator(device);
  SteadyClock clock;
  RigelOptions options = quick_rigel();
  options.exposure_us = 777;
  options.dark_frame_interval = 4;
  auto driver = rigel_camera([&] { return simulator.open(); }, options, clock);
  ASSERT_TRUE(driver->start());
  EXPECT_EQ(simulator.exposure_us(), 777);
  Frame frame;
  EXPECT_TRUE(eventually([&] { return driver->wait(frame, milliseconds(50)) && frame.dark; }));
  EXPECT_TRUE(eventually([&] { return driver->wait(frame, milliseconds(50)) && !frame.dark; }));
  options.exposure_us = 5000;
  EXPECT_FALSE(rigel_camera([&] { return simulator.open(); }, options, clock)->start());
  options = quick_rigel();
  options.dark_frame_interval = 3;
  EXPECT_FALSE(rigel_camera([&] { return simulator.open(); }, options, clock)->start());
}

TEST(RigelDriver, UnpluggedIsAStateAndReplugStartsAgain) {
  RigelSimulatorOptions device;
  device.stream.paced = true;
  RigelSimulator simulator(device);
  SteadyClock clock;
  auto driver = rigel_camera([&] { return simulator.open(); }, quick_rigel(), clock);
  ASSERT_TRUE(driver->start());
  Frame frame;
  ASSERT_TRUE(eventually([&] { return driver->poll(frame); }));
  simulator.unplug();
  ASSERT_TRUE(eventually([&] { return driver->poll(frame), driver->state() == FrameSourceState::kLost; }));
  EXPECT_EQ(driver->start().error().kind, ErrorKind::kUnavailable);
  simulator.plug();
  EXPECT_FALSE(simulator.lights_on());  // settings are gone with the power
  ASSERT_TRUE(driver->start());
  EXPECT_TRUE(eventually([&] { return driver->poll(frame); }));
}

TEST(RigelDriver, AThousandCyclesLeaveNoThreadAndNoDescriptor) {
  RigelSimulatorOptions device;
  device.stream.frame_limit = 1;
  RigelSimulator simulator(device);
  SteadyClock clock;
  const auto entries = [](const char* folder) {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  };
  const auto threads = entries("/proc/self/task"), descriptors = entries("/proc/self/fd");
  RigelOptions options = quick_rigel();
  options.width = options.height = 384;  // the cheapest picture
  for (int i = 0; i < 1000; ++i) {
    auto driver = rigel_camera([&] { return simulator.open(); }, options, clock);
    ASSERT_TRUE(driver->start());
    simulator.unplug();
    if (i % 10 == 0) {
      Frame frame;
      ASSERT_TRUE(eventually([&] { return driver->poll(frame), driver->state() == FrameSourceState::kLost; }));
    }
    driver.reset();
    simulator.plug();
  }
  EXPECT_EQ(entries("/proc/self/task"), threads);
  EXPECT_EQ(entries("/proc/self/fd"), descriptors);
}

/// Answers like the simulator, but with other descriptors.
class AlteredTransport final : public Transport {
 public:
  AlteredTransport(std::unique_ptr<Transport> inner, std::vector<std::byte> configuration)
      : inner_(std::move(inner)), configuration_(std::move(configuration)) {}
  Result<std::size_t> read(std::span<std::byte> out, milliseconds timeout) override {
    return inner_->read(out, timeout);
  }
  Result<void> write(std::span<const std::byte> out) override { return inner_->write(out); }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    if (request != uvc::kGetConfiguration) return inner_->control(request, data, timeout);
    const std::size_t count = std::min(data.size(), configuration_.size());
    std::copy_n(configuration_.begin(), count, data.begin());
    return count;
  }

 private:
  std::unique_ptr<Transport> inner_;
  std::vector<std::byte> configuration_;
};

TEST(RigelDriver, CamerasThatCannotBeUsedSayWhy) {
  RigelSimulator simulator{RigelSimulatorOptions{}};
  SteadyClock clock;
  const auto error_of = [&](std::vector<std::byte> descriptors, RigelOptions options) {
    auto driver = rigel_camera(
        [&]() -> Result<std::unique_ptr<Transport>> {
          DUBSAR_ASSIGN(auto inner, simulator.open());
          return std::make_unique<AlteredTransport>(std::move(inner), descriptors);
        },
        options, clock);
    const auto started = driver->start();
    EXPECT_FALSE(started);
    EXPECT_EQ(driver->state(), FrameSourceState::kStopped);
    return started ? Error{} : started.error();
  };
  RigelOptions wrong_size = quick_rigel();
  wrong_size.width = 752;
  EXPECT_THAT(error_of(configuration(), wrong_size).message, HasSubstr("640x480, 640x240, 384x384"));
  auto isochronous = configuration();
  isochronous[isochronous.size() - 4] = std::byte{1};
  EXPECT_EQ(error_of(isochronous, quick_rigel()).kind, ErrorKind::kUnavailable);
  EXPECT_THAT(error_of(isochronous, quick_rigel()).message, HasSubstr("isochronously"));
  EXPECT_EQ(error_of({}, quick_rigel()).kind, ErrorKind::kBadData);
  auto longer = configuration();
  longer[2] = std::byte{0xff};
  EXPECT_EQ(error_of(longer, quick_rigel()).kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
