#include "devices/leap/rigel_simulator.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

namespace dubsar {
namespace {

using rigel::Selector;

constexpr std::uint8_t kProcessingUnit = 2;
constexpr rigel::EmbeddedLine kLine{4, 8, 12, 24};

/// Bytes of a control of the extension unit; 0: there is none.
std::size_t control_bytes(std::uint8_t selector) {
  switch (static_cast<Selector>(selector)) {
    case Selector::kStrobeInterval:
    case Selector::kStrobeControl:
      return 1;
    case Selector::kExposure:
      return 2;
    case Selector::kLedCharge:
    case Selector::kHardwareClock:
    case Selector::kFrameInterval:
      return 4;
    case Selector::kEmbeddedLine:
      return rigel::kEmbeddedLineBytes;
    case Selector::kCalibration:
      return lmc1::kCalibrationBytes;
  }
  return 0;
}

}  // namespace

class RigelSimulator::Model final : public UvcCameraModel {
 public:
  explicit Model(RigelSimulatorOptions options)
      : options_(std::move(options)), calibration_(lmc1::encode(options_.calibration)) {}

  std::span<const std::uint8_t> device_descriptor() const override { return device_; }
  std::span<const std::uint8_t> configuration_descriptor() const override {
    return RigelSimulator::configuration_descriptor();
  }
  std::span<const uvc::FrameSize> sizes() const override { return RigelSimulator::sizes(); }
  std::uint8_t default_frame() const override { return 1; }
  std::uint32_t payload_bytes() const override { return options_.payload_bytes; }
  std::uint8_t stream_interface() const override { return 1; }

  Result<std::size_t> unit_request(const ControlRequest& request, std::span<std::byte> data) override {
    const auto unit = static_cast<std::uint8_t>(request.index >> 8),
               selector = static_cast<std::uint8_t>(request.value >> 8);
    const bool set = request.request == uvc::kSetCurrent && !request.to_host();
    const bool get = request.request == uvc::kGetCurrent && request.to_host();
    const std::size_t bytes = unit == rigel::kUsualExtensionUnit                            ? control_bytes(selector)
                              : unit == kProcessingUnit && selector == rigel::kGainSelector ? 2U
                                                                                            : 0U;
    if (bytes == 0 || data.size() != bytes || (!set && !get)) return stall(unit, selector);
    if (unit == kProcessingUnit) return exchange(gain_, data, set);
    switch (static_cast<Selector>(selector)) {
      case Selector::kCalibration:
        if (set) return stall(unit, selector);
        std::copy(calibration_.begin(), calibration_.end(), data.begin());
        return bytes;
      case Selector::kEmbeddedLine: {
        if (set || !options_.embedded_line) return stall(unit, selector);
        const auto line = rigel::encode(kLine);
        std::copy(line.begin(), line.end(), data.begin());
        return bytes;
      }
      case Selector::kHardwareClock:
        if (set) return stall(unit, selector);
        return exchange(clock_us_, data, false);
      default:
        return exchange(settings_[selector], data, set);
    }
  }

  void commit(const uvc::FrameSize& size) override {
    size_ = size;
    HandRenderOptions render = options_.render;
    render.width = size.width;
    render.height = size.height;
    const bool known = size.width == 640;  // how other sizes are cropped is not known
    if (!known) renderer_.reset();
    if (known && (!renderer_ || renderer_->options().height != size.height))
      renderer_.emplace(options_.calibration, render);
    left_.assign(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), 0);
    right_ = left_;
  }

  void make_frame(std::uint64_t n, std::span<std::byte> frame) override {
    const bool dark = dark_frame(n);
    if (renderer_) {
      renderer_->set_lights(lights_on() && !dark);
      const auto hands = options_.hands ? options_.hands(n) : std::vector<PosedHand>{};
      renderer_->render(hands, options_.seed + n, left_, right_);
    }
    const auto width = static_cast<std::size_t>(size_.width);
    for (std::size_t at = 0; at < left_.size(); at += width) {
      std::memcpy(frame.data() + 2 * at, left_.data() + at, width);
      std::memcpy(frame.data() + 2 * at + width, right_.data() + at, width);
    }
    clock_us_ = static_cast<std::uint32_t>(n * size_.interval_100ns / 10);
    if (!options_.embedded_line) return;
    rigel::Metadata metadata;
    metadata.frame_label = dark ? 1 : 0;
    metadata.exposure_us = setting(Selector::kExposure);
    metadata.gain = gain_;
    metadata.frame_count = static_cast<std::uint32_t>(n);
    rigel::encode_metadata(metadata, kLine, frame.last(2 * width));
  }

  void power_on() override {
    settings_.clear();
    gain_ = 0;
  }

  bool lights_on() const { return setting(Selector::kStrobeControl) != 0 && setting(Selector::kLedCharge) != 0; }
  std::uint32_t setting(Selector selector) const {
    const auto found = settings_.find(static_cast<std::uint8_t>(selector));
    return found == settings_.end() ? 0 : found->second;
  }

 private:
  static tl::unexpected<Error> stall(std::uint8_t unit, std::uint8_t selector) {
    return fail(ErrorKind::kBadData, "rigel simulator: stall of selector {} of unit {}", selector, unit);
  }
  /// A little-endian number of 1 to 4 bytes.
  static Result<std::size_t> exchange(std::uint32_t& value, std::span<std::byte> data, bool set) {
    if (set) value = 0;
    for (std::size_t i = 0; i < data.size(); ++i) {
      if (set)
        value |= static_cast<std::uint32_t>(data[i]) << 8 * i;
      else
        data[i] = std::byte(value >> 8 * i & 0xffU);
    }
    return data.size();
  }
  bool dark_frame(std::uint64_t n) const {
    const std::uint64_t interval = setting(Selector::kStrobeInterval);
    if (interval < 3) return interval == 1 || (interval == 2 && n % 2 == 1);
    return n % (interval + 1) == interval;  // one dark frame and `interval` lit ones
  }

  const RigelSimulatorOptions options_;
  const std::array<std::byte, lmc1::kCalibrationBytes> calibration_;
  const std::array<std::uint8_t, 18> device_ = RigelSimulator::device_descriptor(options_.product);
  std::map<std::uint8_t, std::uint32_t> settings_;
  std::uint32_t gain_ = 0, clock_us_ = 0;
  uvc::FrameSize size_;
  std::optional<HandRenderer> renderer_;
  std::vector<std::uint8_t> left_, right_;
};

lmc1::Calibration example_rigel_calibration() {
  lmc1::Calibration calibration;
  calibration.version = 1;
  calibration.score = 200;
  calibration.baseline_mm = 64.0F;
  for (lmc1::EyeCalibration* eye : {&calibration.left, &calibration.right}) {
    eye->focal_px = 260.0F;
    eye->old_focal_px = 260.0F;
    // tan(r) / r, an equidistant lens, as (1 - r^2/15) / (1 - 2 r^2/5): within 1.5 % up to 75 degrees
    eye->radial = {-1.0F / 15.0F, 0, 0, -0.4F, 0, 0};
  }
  calibration.left.offset_x_px = 1.5F;
  calibration.left.offset_y_px = -0.75F;
  calibration.right.offset_x_px = -2.0F;
  calibration.right.offset_y_px = 1.25F;
  return calibration;
}

RigelSimulator::RigelSimulator(const RigelSimulatorOptions& options)
    : RigelSimulator(options, std::make_shared<Model>(options)) {}
RigelSimulator::RigelSimulator(const RigelSimulatorOptions& options, std::shared_ptr<Model> model)
    : UvcSimulator(model, options.stream), model_(std::move(model)) {}

bool RigelSimulator::lights_on() const {
  const auto guard = lock();
  return model_->lights_on();
}
int RigelSimulator::exposure_us() const {
  const auto guard = lock();
  return static_cast<int>(model_->setting(Selector::kExposure));
}

}  // namespace dubsar
