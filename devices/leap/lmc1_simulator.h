#pragma once
// A Leap Motion Controller in memory, down to its descriptors, control requests, calibration bytes and bulk transfers.
// Never chosen unless named.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/base/clock.h"
#include "devices/leap/hand_renderer.h"
#include "devices/leap/lmc1_protocol.h"
#include "devices/transport.h"

namespace dubsar {

struct Lmc1SimulatorOptions {
  lmc1::Calibration calibration = example_calibration(true);
  /// The hands of frame number n (from 0). Called in the thread that reads.
  std::function<std::vector<PosedHand>(std::uint64_t n)> hands;
  HandRenderOptions render{};  ///< width and height are those of the mode that the host asks for
  std::uint64_t seed = 1;
  std::uint64_t frame_limit = 0;  ///< sends no more frames than this; 0: no limit
  bool paced = false;             ///< frames come at the rate of the mode, not as fast as they are read
  const Clock* clock = nullptr;   ///< of the pace; null: the steady clock. Outlives the simulator, any thread
};

/// Copies share one device, which outlives its transports. Any thread.
class Lmc1Simulator {
 public:
  explicit Lmc1Simulator(Lmc1SimulatorOptions options);

  static std::span<const std::uint8_t> device_descriptor() noexcept;         ///< 18 bytes
  static std::span<const std::uint8_t> configuration_descriptor() noexcept;  ///< 355 bytes
  static constexpr const char* kManufacturer = "Leap Motion";
  static constexpr const char* kProduct = "Leap Motion Controller";

  /// A class request to one of the interfaces; kBadData is a stall.
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data);
  /// The next bulk transfer, or 0 when there is none now: not streaming, limit reached, or paced and not due.
  std::size_t next_transfer(std::span<std::byte> transfer);

  void unplug();
  void plug();
  bool plugged() const;
  /// kUnavailable while unplugged. Lost for good once unplugged.
  Result<std::unique_ptr<Transport>> open();

  std::uint64_t frames_begun() const;
  bool led_on(lmc1::Switch led) const;
  int exposure_us() const;

 private:
  struct Device;
  std::shared_ptr<Device> device_;
  friend class Lmc1SimulatedTransport;
};

}  // namespace dubsar
