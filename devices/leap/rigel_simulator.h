#pragma once
// A Rigel in memory, down to its descriptors, extension unit, calibration and bulk transfers. What is public
// is byte for byte: units, selectors, sizes of their data, calibration, row layout, embedded line. Not
// public, and therefore ours: picture sizes, rates, payload size, endpoint, strings, and the optics (a
// plausible fisheye). Never chosen unless named.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "devices/leap/hand_renderer.h"
#include "devices/leap/rigel_protocol.h"
#include "devices/leap/uvc_simulator.h"

namespace dubsar {

/// 64 mm baseline, equidistant fisheyes of 260 px at 640x480: 141 degrees wide.
lmc1::Calibration example_rigel_calibration();

struct RigelSimulatorOptions {
  std::uint16_t product = rigel::kRigel;
  lmc1::Calibration calibration = example_rigel_calibration();
  /// The hands of frame number n (from 0). Called in the thread that reads.
  std::function<std::vector<PosedHand>(std::uint64_t n)> hands;
  HandRenderOptions render{};  ///< width and height are those of the mode that the host asks for
  std::uint64_t seed = 1;
  UvcSimulatorOptions stream{};
  bool embedded_line = true;  ///< false: the firmware stalls the request for its layout
  std::uint32_t payload_bytes = 20480;
};

class RigelSimulator : public UvcSimulator {
 public:
  explicit RigelSimulator(const RigelSimulatorOptions& options);

  static std::array<std::uint8_t, 18> device_descriptor(std::uint16_t product) noexcept;
  static std::span<const std::uint8_t> configuration_descriptor() noexcept;
  static std::span<const uvc::FrameSize> sizes() noexcept;

  bool lights_on() const;
  int exposure_us() const;

 private:
  class Model;
  explicit RigelSimulator(const RigelSimulatorOptions& options, std::shared_ptr<Model> model);
  std::shared_ptr<Model> model_;
};

}  // namespace dubsar
