#pragma once
// A session's surroundings for one source: a clock moved by hand, a bell rung by hand, simulated devices.

#include <gtest/gtest.h>

#include "devices/transport/sim_transport.h"
#include "input/input_source.h"
#include "tests/input/milliseconds.h"

namespace dubsar::test {

inline constexpr TimestampNs kSecond = 1'000'000'000;

struct SourceBench {
  SourceBench() {
    config.clock = &clock;
    config.simulated_time = true;
    config.hotplug = bell;
  }
  /// All devices that are asked for are `device`.
  void put(SimDevice& device) {
    config.reach_device = [&device](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
      return OpenTransport([&device] { return device.open(); });
    };
  }
  std::unique_ptr<InputSource> make(std::string_view spec) const {
    auto source = make_input(spec, config);
    EXPECT_TRUE(source) << (source ? "" : source.error().message);
    return source ? std::move(*source) : nullptr;
  }
  Freshness poll(InputSource& source) { return source.poll(clock.now(), frame); }

  ManualClock clock{kSecond};
  std::shared_ptr<HotplugBell> bell = std::make_shared<HotplugBell>();
  InputConfig config;
  InputFrame frame;
};

}  // namespace dubsar::test
