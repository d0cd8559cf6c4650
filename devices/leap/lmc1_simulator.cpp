#include "devices/leap/lmc1_simulator.h"

#include <array>
#include <map>
#include <optional>
#include <utility>

namespace dubsar {
namespace {

constexpr auto kSizes = [] {
  std::array<uvc::FrameSize, lmc1::kModes.size()> sizes{};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const lmc1::Mode& mode = lmc1::kModes[i];
    sizes[i] = {1, mode.frame_index, mode.width, mode.height, 16, mode.interval_100ns};
  }
  return sizes;
}();

}  // namespace

class Lmc1Simulator::Model final : public UvcCameraModel {
 public:
  explicit Model(Lmc1SimulatorOptions options)
      : options_(std::move(options)), calibration_(lmc1::encode(options_.calibration)) {}

  std::span<const std::uint8_t> device_descriptor() const override { return Lmc1Simulator::device_descriptor(); }
  std::span<const std::uint8_t> configuration_descriptor() const override {
    return Lmc1Simulator::configuration_descriptor();
  }
  std::span<const uvc::FrameSize> sizes() const override { return kSizes; }
  std::uint8_t default_frame() const override { return lmc1::kDefaultFrameIndex; }
  std::uint32_t payload_bytes() const override { return lmc1::kMaxTransferBytes; }
  std::uint8_t stream_interface() const override { return lmc1::kStreamInterface; }
  bool crashed() const override { return crashed_; }

  Result<std::size_t> unit_request(const ControlRequest& request, std::span<std::byte> data) override {
    const auto unit = static_cast<std::uint8_t>(request.index >> 8),
               selector = static_cast<std::uint8_t>(request.value >> 8);
    const auto is = [&](lmc1::Selector s) {
      return unit == lmc1::kProcessingUnit && selector == static_cast<std::uint8_t>(s);
    };
    const bool known = (unit == lmc1::kCameraTerminal && selector == lmc1::kZoomAbsolute) ||
                       is(lmc1::Selector::kBrightness) || is(lmc1::Selector::kContrast) || is(lmc1::Selector::kGain) ||
                       is(lmc1::Selector::kSaturation) || is(lmc1::Selector::kSharpness) ||
                       is(lmc1::Selector::kGamma) || is(lmc1::Selector::kWhiteBalance);
    if (!known || data.size() != 2)
      return fail(ErrorKind::kBadData, "leap simulator: stall of request {:#06x}", request.value);
    if (request.request == lmc1::kSetCurrent && !request.to_host()) {
      const int value = static_cast<int>(data[0]) | static_cast<int>(data[1]) << 8;
      if (is(lmc1::Selector::kContrast)) {
        const int which = value & 0x3f;
        crashed_ = which == 6;  // as the device does
        switches_ = value >> 6 != 0 ? switches_ | 1 << which : switches_ & ~(1 << which);
      }
      settings_[unit << 8 | selector] = value;
      return 2U;
    }
    if (request.request != lmc1::kGetCurrent || !request.to_host())
      return fail(ErrorKind::kBadData, "leap simulator: stall of request {:#x}", request.request);
    int value = setting(unit, selector);
    if (is(lmc1::Selector::kSaturation)) {
      const int address = processing(lmc1::Selector::kSharpness) - lmc1::kCalibrationAddress;
      value = address >= 0 && address < static_cast<int>(calibration_.size())
                  ? static_cast<int>(calibration_[static_cast<std::size_t>(address)])
                  : 0;
    }
    data[0] = std::byte(value & 0xff);
    data[1] = std::byte(value >> 8 & 0xff);
    return 2U;
  }

  void commit(const uvc::FrameSize& size) override {
    HandRenderOptions render = options_.render;
    render.width = size.width;
    render.height = size.height;
    if (!renderer_ || renderer_->options().width != size.width || renderer_->options().height != size.height)
      renderer_.emplace(options_.calibration, render);
    left_.resize(size.frame_bytes() / 2);
    right_.resize(left_.size());
  }

  void make_frame(std::uint64_t n, std::span<std::byte> frame) override {
    const auto interval = static_cast<std::uint64_t>(processing(lmc1::Selector::kWhiteBalance));
    const bool dark = interval > 0 && n % interval == interval - 1;
    constexpr int kLeds = 1 << 2 | 1 << 3 | 1 << 4;
    renderer_->set_lights((switches_ & kLeds) != 0 && !dark);
    const auto hands = options_.hands ? options_.hands(n) : std::vector<PosedHand>{};
    renderer_->render(hands, options_.seed + n, left_, right_);
    for (std::size_t i = 0; i < left_.size(); ++i) {
      frame[2 * i] = std::byte{left_[i]};
      frame[2 * i + 1] = std::byte{right_[i]};
    }
    lmc1::FrameMetadata metadata;
    metadata.exposure_us = exposure_us() & 511;
    metadata.gain = processing(lmc1::Selector::kGain) & 31;
    metadata.label = dark ? 1 : 0;
    lmc1::encode_metadata(metadata, frame.last<lmc1::kMetadataBytes>());
  }

  void power_on() override {
    settings_.clear();
    switches_ = 0;
    crashed_ = false;
  }

  int exposure_us() const { return setting(lmc1::kCameraTerminal, lmc1::kZoomAbsolute); }
  bool led_on(lmc1::Switch led) const { return (switches_ >> static_cast<int>(led) & 1) != 0; }

 private:
  int setting(std::uint8_t unit, std::uint8_t selector) const {
    const auto found = settings_.find(unit << 8 | selector);
    return found == settings_.end() ? 0 : found->second;
  }
  int processing(lmc1::Selector selector) const {
    return setting(lmc1::kProcessingUnit, static_cast<std::uint8_t>(selector));
  }

  const Lmc1SimulatorOptions options_;
  const std::array<std::byte, lmc1::kCalibrationBytes> calibration_;
  std::map<int, int> settings_;  // unit << 8 | selector
  int switches_ = 0;             // bit per lmc1::Switch
  bool crashed_ = false;
  std::optional<HandRenderer> renderer_;
  std::vector<std::uint8_t> left_, right_;
};

Lmc1Simulator::Lmc1Simulator(const Lmc1SimulatorOptions& options)
    : Lmc1Simulator(options, std::make_shared<Model>(options)) {}
Lmc1Simulator::Lmc1Simulator(const Lmc1SimulatorOptions& options, std::shared_ptr<Model> model)
    : UvcSimulator(model, {options.frame_limit, options.paced, options.clock}), model_(std::move(model)) {}

bool Lmc1Simulator::led_on(lmc1::Switch led) const {
  const auto guard = lock();
  return model_->led_on(led);
}
int Lmc1Simulator::exposure_us() const {
  const auto guard = lock();
  return model_->exposure_us();
}

}  // namespace dubsar
