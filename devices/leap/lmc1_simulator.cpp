#include "devices/leap/lmc1_simulator.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>

#include "devices/leap/uvc_payload.h"

namespace dubsar {

using std::chrono::steady_clock;

namespace {
constexpr std::chrono::microseconds kShortWait{200};  // rounding, and clocks that are moved by hand
}  // namespace

struct Lmc1Simulator::Device {
  explicit Device(Lmc1SimulatorOptions o) : options(std::move(o)), calibration(lmc1::encode(options.calibration)) {}

  Result<std::size_t> unit_request(const ControlRequest& request, std::span<std::byte> data);
  Result<std::size_t> stream_request(const ControlRequest& request, std::span<std::byte> data);
  int setting(std::uint8_t unit, std::uint8_t selector) const {
    const auto found = settings.find(unit << 8 | selector);
    return found == settings.end() ? 0 : found->second;
  }
  void begin_frame();

  const Lmc1SimulatorOptions options;
  const std::array<std::byte, lmc1::kCalibrationBytes> calibration;

  mutable std::mutex mutex;
  std::condition_variable changed;
  bool plugged = true;
  int plug_count = 0;
  std::map<int, int> settings;  // unit << 8 | selector
  int switches = 0;             // bit per lmc1::Switch
  lmc1::StreamBlock probe = lmc1::request_mode(lmc1::kModes[3]);
  const lmc1::Mode* mode = nullptr;  // streaming in this mode
  std::optional<HandRenderer> renderer;
  std::vector<std::uint8_t> left, right;
  std::vector<std::byte> frame;
  std::size_t sent = 0;
  std::uint64_t begun = 0;
  bool frame_id = false;
  TimestampNs due = 0;  // of the next frame, when paced
  TimestampNs now() const {
    static const SteadyClock kSteady;
    return options.clock ? options.clock->now() : kSteady.now();
  }
};

Result<std::size_t> Lmc1Simulator::Device::unit_request(const ControlRequest& request, std::span<std::byte> data) {
  const auto unit = static_cast<std::uint8_t>(request.index >> 8), selector = static_cast<std::uint8_t>(request.value >> 8);
  const auto is = [&](lmc1::Selector s) { return unit == lmc1::kProcessingUnit && selector == static_cast<std::uint8_t>(s); };
  const bool known = (unit == lmc1::kCameraTerminal && selector == lmc1::kZoomAbsolute) || is(lmc1::Selector::kBrightness) ||
                     is(lmc1::Selector::kContrast) || is(lmc1::Selector::kGain) || is(lmc1::Selector::kSaturation) ||
                     is(lmc1::Selector::kSharpness) || is(lmc1::Selector::kGamma) || is(lmc1::Selector::kWhiteBalance);
  if (!known || data.size() != 2) return fail(ErrorKind::kBadData, "leap simulator: stall of request {:#06x}", request.value);
  if (request.request == lmc1::kSetCurrent && !request.to_host()) {
    const int value = static_cast<int>(data[0]) | static_cast<int>(data[1]) << 8;
    if (is(lmc1::Selector::kContrast)) {
      const int which = value & 0x3f;
      if (which == 6) plugged = false;  // as the device does
      switches = value >> 6 != 0 ? switches | 1 << which : switches & ~(1 << which);
    }
    settings[unit << 8 | selector] = value;
    return 2U;
  }
  if (request.request != lmc1::kGetCurrent || !request.to_host())
    return fail(ErrorKind::kBadData, "leap simulator: stall of request {:#x}", request.request);
  int value = setting(unit, selector);
  if (is(lmc1::Selector::kSaturation)) {
    const int address = setting(lmc1::kProcessingUnit, static_cast<std::uint8_t>(lmc1::Selector::kSharpness)) -
                        lmc1::kCalibrationAddress;
    value = address >= 0 && address < static_cast<int>(calibration.size())
                ? static_cast<int>(calibration[static_cast<std::size_t>(address)])
                : 0;
  }
  data[0] = std::byte(value & 0xff);
  data[1] = std::byte(value >> 8 & 0xff);
  return 2U;
}

Result<std::size_t> Lmc1Simulator::Device::stream_request(const ControlRequest& request, std::span<std::byte> data) {
  const auto selector = static_cast<std::uint8_t>(request.value >> 8);
  if (selector != lmc1::kProbeControl && selector != lmc1::kCommitControl)
    return fail(ErrorKind::kBadData, "leap simulator: stall of stream selector {}", selector);
  if (request.to_host()) {
    if (request.request != lmc1::kGetCurrent) return fail(ErrorKind::kBadData, "leap simulator: stall");
    const auto bytes = lmc1::encode(probe);
    const std::size_t count = std::min(bytes.size(), data.size());
    std::copy_n(bytes.begin(), count, data.begin());
    return count;
  }
  DUBSAR_ASSIGN(const lmc1::StreamBlock asked, lmc1::decode_stream_block(data));
  const lmc1::Mode* wanted = lmc1::find_mode(asked.frame_index);
  if (asked.format_index != 1 || wanted == nullptr) wanted = lmc1::find_mode(lmc1::kDefaultFrameIndex);
  probe = lmc1::request_mode(*wanted);
  if (selector == lmc1::kCommitControl) {
    mode = wanted;
    HandRenderOptions render = options.render;
    render.width = wanted->width;
    render.height = wanted->height;
    renderer.emplace(options.calibration, render);
    frame.clear();
    sent = 0;
    due = now();
  }
  return data.size();
}

void Lmc1Simulator::Device::begin_frame() {
  const std::size_t pixels = mode->frame_bytes() / 2;
  left.resize(pixels);
  right.resize(pixels);
  frame.resize(2 * pixels);
  const int interval = setting(lmc1::kProcessingUnit, static_cast<std::uint8_t>(lmc1::Selector::kWhiteBalance));
  const bool dark = interval > 0 && begun % static_cast<std::uint64_t>(interval) == static_cast<std::uint64_t>(interval - 1);
  constexpr int kLeds = 1 << 2 | 1 << 3 | 1 << 4;
  renderer->set_lights((switches & kLeds) != 0 && !dark);
  const auto hands = options.hands ? options.hands(begun) : std::vector<PosedHand>{};
  renderer->render(hands, options.seed + begun, left, right);
  for (std::size_t i = 0; i < pixels; ++i) {
    frame[2 * i] = std::byte{left[i]};
    frame[2 * i + 1] = std::byte{right[i]};
  }
  lmc1::FrameMetadata metadata;
  metadata.exposure_us = setting(lmc1::kCameraTerminal, lmc1::kZoomAbsolute) & 511;
  metadata.gain = setting(lmc1::kProcessingUnit, static_cast<std::uint8_t>(lmc1::Selector::kGain)) & 31;
  metadata.label = dark ? 1 : 0;
  lmc1::encode_metadata(metadata, std::span(frame).last<lmc1::kMetadataBytes>());
  ++begun;
  frame_id = !frame_id;
  sent = 0;
}

Lmc1Simulator::Lmc1Simulator(Lmc1SimulatorOptions options) : device_(std::make_shared<Device>(std::move(options))) {}

Result<std::size_t> Lmc1Simulator::control(const ControlRequest& request, std::span<std::byte> data) {
  const std::lock_guard lock(device_->mutex);
  if (!device_->plugged) return fail(ErrorKind::kUnavailable, "leap simulator: unplugged");
  Result<std::size_t> moved = fail(ErrorKind::kBadData, "leap simulator: stall of request type {:#x}", request.request_type);
  if ((request.request_type & 0x7fU) == 0x21U)
    moved = (request.index & 0xffU) == lmc1::kControlInterface ? device_->unit_request(request, data)
                                                              : device_->stream_request(request, data);
  device_->changed.notify_all();
  return moved;
}

std::size_t Lmc1Simulator::next_transfer(std::span<std::byte> transfer) {
  const std::lock_guard lock(device_->mutex);
  Device& d = *device_;
  if (!d.plugged || d.mode == nullptr) return 0;
  if (d.sent == d.frame.size()) {
    if (d.options.frame_limit != 0 && d.begun >= d.options.frame_limit) return 0;
    if (d.options.paced) {
      if (d.now() < d.due) return 0;
      d.due += 100LL * d.mode->interval_100ns;
    }
    d.begin_frame();
  }
  const auto rest = std::span<const std::byte>(d.frame).subspan(d.sent);
  const std::size_t limit = std::min(transfer.size(), lmc1::kMaxTransferBytes);
  UvcHeader header;
  header.frame_id = d.frame_id;
  header.end_of_frame = rest.size() + kUvcHeaderBytes <= limit;
  header.presentation_time = static_cast<std::uint32_t>(d.begun * d.mode->interval_100ns / 10000);
  const std::size_t length = encode_uvc_transfer(header, rest, transfer.first(limit));
  d.sent += length - std::min(length, kUvcHeaderBytes);
  return length;
}

void Lmc1Simulator::unplug() {
  const std::lock_guard lock(device_->mutex);
  device_->plugged = false;
  ++device_->plug_count;
  device_->changed.notify_all();
}

void Lmc1Simulator::plug() {
  const std::lock_guard lock(device_->mutex);
  device_->plugged = true;
  device_->mode = nullptr;
  device_->settings.clear();
  device_->switches = 0;
  device_->frame.clear();
  device_->sent = 0;
}

bool Lmc1Simulator::plugged() const {
  const std::lock_guard lock(device_->mutex);
  return device_->plugged;
}
std::uint64_t Lmc1Simulator::frames_begun() const {
  const std::lock_guard lock(device_->mutex);
  return device_->begun;
}
bool Lmc1Simulator::led_on(lmc1::Switch led) const {
  const std::lock_guard lock(device_->mutex);
  return (device_->switches >> static_cast<int>(led) & 1) != 0;
}
int Lmc1Simulator::exposure_us() const {
  const std::lock_guard lock(device_->mutex);
  return device_->setting(lmc1::kCameraTerminal, lmc1::kZoomAbsolute);
}

class Lmc1SimulatedTransport final : public Transport {
 public:
  Lmc1SimulatedTransport(Lmc1Simulator simulator, int plug_count)
      : simulator_(std::move(simulator)), plug_count_(plug_count) {}

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    const auto until = steady_clock::now() + timeout;
    for (;;) {
      if (lost()) return fail(ErrorKind::kUnavailable, "leap simulator: unplugged");
      if (const std::size_t length = simulator_.next_transfer(report)) return length;
      auto& device = *simulator_.device_;
      std::unique_lock lock(device.mutex);
      const auto now = steady_clock::now();
      if (now >= until) return 0U;
      if (!device.plugged) continue;
      auto wake = until;
      if (device.options.paced && device.mode != nullptr)
        wake = std::min(wake, now + std::chrono::nanoseconds(std::max<TimestampNs>(device.due - device.now(), 0)) + kShortWait);
      device.changed.wait_until(lock, wake);
    }
  }
  Result<void> write(std::span<const std::byte>) override {
    return fail(ErrorKind::kUsage, "leap simulator: the device has no endpoint to write to");
  }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds) override {
    if (lost()) return fail(ErrorKind::kUnavailable, "leap simulator: unplugged");
    return simulator_.control(request, data);
  }

 private:
  bool lost() const {
    const std::lock_guard lock(simulator_.device_->mutex);
    return !simulator_.device_->plugged || simulator_.device_->plug_count != plug_count_;
  }
  Lmc1Simulator simulator_;
  int plug_count_;
};

Result<std::unique_ptr<Transport>> Lmc1Simulator::open() {
  const std::lock_guard lock(device_->mutex);
  if (!device_->plugged) return fail(ErrorKind::kUnavailable, "leap simulator: unplugged");
  return std::make_unique<Lmc1SimulatedTransport>(*this, device_->plug_count);
}

}  // namespace dubsar
