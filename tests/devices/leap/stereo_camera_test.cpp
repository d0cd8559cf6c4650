// Both kinds of camera on a bad cable: what is delivered is what the device rendered, and the rest is
// counted.

#include "devices/leap/stereo_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "devices/leap/leap_camera.h"
#include "devices/leap/lmc1_simulator.h"
#include "devices/leap/rigel_simulator.h"
#include "tests/devices/transport/fault_transport.h"

namespace dubsar {
namespace {

constexpr TimestampNs kTick = 20'000'000;  // longer than a frame of either camera
constexpr int kFrames = 60;

/// About one transfer in thirty is dropped, cut or, if wished, garbled: a device gone mad, since the bus
/// itself checks its bytes. Garbled pixels in a transfer without a header cannot be told from others.
std::vector<Fault> bad_cable(std::uint64_t transfers, bool garbled) {
  std::mt19937 random(5);
  std::vector<Fault> faults;
  for (std::uint64_t at = 0; at < transfers; ++at) {
    if (random() % 30 != 0) continue;
    const FaultKind kind =
        std::array{FaultKind::kDrop, FaultKind::kTruncate, FaultKind::kGarbage}[random() % (garbled ? 3 : 2)];
    faults.push_back({kind, at, 1, random() % 16000});
  }
  return faults;
}

struct Seen {
  int whole = 0, wrong = 0;
  StreamCounters counters;
};

/// Reads kFrames ticks; frame n of the device is the one of tick n.
template <class Simulator>
Seen run(Simulator& simulator, ManualClock& clock, const lmc1::Calibration& calibration, std::size_t metadata_bytes,
         bool garbled) {
  LeapCameraOptions options;
  options.calibration_settle = milliseconds(0);
  auto camera = make_leap_camera(
      [&]() -> Result<std::unique_ptr<Transport>> {
        DUBSAR_ASSIGN(auto inner, simulator.open());
        return make_fault_transport(std::move(inner), bad_cable(19 * kFrames, garbled), 9);
      },
      options, clock);
  Seen seen;
  const auto started = camera->start();
  EXPECT_TRUE(started);
  if (!started) return seen;
  const HandRenderer renderer(calibration, HandRenderOptions{});
  std::vector<std::uint8_t> left(640 * 240), right(640 * 240);
  Frame frame;
  for (int tick = 0; tick < kFrames; ++tick, clock.advance(kTick)) {
    bool fresh = false;
    for (int i = 0; i < 20; ++i) fresh = camera->poll(frame) || fresh;  // a dropped transfer looks like silence
    if (!fresh) continue;
    renderer.render({}, 1 + static_cast<std::uint64_t>(tick), left, right);
    const auto same = [&](int eye, const std::vector<std::uint8_t>& rendered) {
      return std::equal(rendered.begin(), rendered.end() - static_cast<std::ptrdiff_t>(metadata_bytes),
                        frame.view(eye).begin());
    };
    ++(frame.width == 640 && frame.height == 240 && same(0, left) && same(1, right) ? seen.whole : seen.wrong);
  }
  seen.counters = camera->counters();
  EXPECT_EQ(camera->state(), FrameSourceState::kRunning);
  return seen;
}

void expect_survival(const Seen& seen) {
  EXPECT_EQ(seen.wrong, 0);
  EXPECT_GT(seen.whole, kFrames / 4);
  EXPECT_LT(seen.whole, kFrames - 5);  // the cable was bad indeed
  EXPECT_EQ(static_cast<std::uint64_t>(seen.whole), seen.counters.frames);
  EXPECT_GE(seen.counters.dropped_frames, 5U);
}

TEST(StereoCamera, AControllerOnABadCableDeliversOnlyWholePictures) {
  ManualClock clock;
  Lmc1SimulatorOptions device;
  device.paced = true;
  device.clock = &clock;
  Lmc1Simulator simulator(device);
  expect_survival(run(simulator, clock, device.calibration, 6, true));
}

TEST(StereoCamera, ARigelOnABadCableDeliversOnlyWholePictures) {
  for (const std::uint32_t payload : {20480U, 16384U, 30000U}) {
    ManualClock clock;
    RigelSimulatorOptions device;
    device.stream.paced = true;
    device.stream.clock = &clock;
    device.payload_bytes = payload;
    RigelSimulator simulator(device);
    SCOPED_TRACE(payload);
    expect_survival(run(simulator, clock, device.calibration, 640, payload == kStereoTransferBytes));
  }
}

}  // namespace
}  // namespace dubsar
