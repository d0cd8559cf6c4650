#pragma once
// A Leap Motion Controller in memory, down to its descriptors, control requests, calibration bytes and bulk
// transfers. Never chosen unless named.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/leap/hand_renderer.h"
#include "devices/leap/lmc1_protocol.h"
#include "devices/leap/uvc_simulator.h"

namespace dubsar {

struct Lmc1SimulatorOptions {
  lmc1::Calibration calibration = example_calibration(true);
  /// The hands of frame number n (from 0). Called in the thread that reads.
  std::function<std::vector<PosedHand>(std::uint64_t n)> hands;
  HandRenderOptions render{};  ///< width and height are those of the mode that the host asks for
  std::uint64_t seed = 1;
  std::uint64_t frame_limit = 0;  ///< as in UvcSimulatorOptions, also the next two
  bool paced = false;
  const Clock* clock = nullptr;
};

class Lmc1Simulator : public UvcSimulator {
 public:
  explicit Lmc1Simulator(const Lmc1SimulatorOptions& options);

  static std::span<const std::uint8_t> device_descriptor() noexcept;         ///< 18 bytes
  static std::span<const std::uint8_t> configuration_descriptor() noexcept;  ///< 355 bytes
  static constexpr const char* kManufacturer = "Leap Motion";
  static constexpr const char* kProduct = "Leap Motion Controller";

  bool led_on(lmc1::Switch led) const;
  int exposure_us() const;

 private:
  class Model;
  Lmc1Simulator(const Lmc1SimulatorOptions& options, std::shared_ptr<Model> model);
  std::shared_ptr<Model> model_;
};

}  // namespace dubsar
