#include "devices/leap/uvc_simulator.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <optional>

#include "devices/leap/uvc_payload.h"
#include "devices/uvc/uvc_protocol.h"

namespace dubsar {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kPacketBytes = 512;             // of a bulk endpoint at high speed
constexpr std::chrono::microseconds kShortWait{200};  // rounding, and clocks that are moved by hand

}  // namespace

struct UvcSimulator::Device {
  Device(std::shared_ptr<UvcCameraModel> m, const UvcSimulatorOptions& o) : model(std::move(m)), options(o) { reset(); }

  void reset() {
    model->power_on();
    size.reset();
    probe = block_of(*find(model->default_frame()));
    frame.clear();
    payload.clear();
    sent = payload_sent = 0;
  }
  const uvc::FrameSize* find(std::uint8_t frame_index) const {
    for (const uvc::FrameSize& s : model->sizes())
      if (s.frame_index == frame_index) return &s;
    return nullptr;
  }
  uvc::StreamBlock block_of(const uvc::FrameSize& s) const {
    uvc::StreamBlock block;
    block.hint = 1;
    block.format_index = s.format_index;
    block.frame_index = s.frame_index;
    block.interval_100ns = s.interval_100ns;
    block.max_frame_bytes = static_cast<std::uint32_t>(s.frame_bytes());
    block.max_transfer_bytes = model->payload_bytes();
    return block;
  }
  TimestampNs now() const {
    static const SteadyClock kSteady;
    return options.clock != nullptr ? options.clock->now() : kSteady.now();
  }
  Result<std::size_t> stream_request(const ControlRequest& request, std::span<std::byte> data);
  bool begin_payload();

  const std::shared_ptr<UvcCameraModel> model;
  const UvcSimulatorOptions options;

  mutable std::mutex mutex;
  std::condition_variable changed;
  bool plugged = true;
  int plug_count = 0;
  uvc::StreamBlock probe;
  std::optional<uvc::FrameSize> size;  // streaming in this size
  std::vector<std::byte> frame, payload;
  std::size_t sent = 0, payload_sent = 0;
  std::uint64_t begun = 0;
  bool frame_id = false;
  TimestampNs due = 0;  // of the next frame, when paced
};

Result<std::size_t> UvcSimulator::Device::stream_request(const ControlRequest& request, std::span<std::byte> data) {
  const auto selector = static_cast<std::uint8_t>(request.value >> 8);
  if (selector != uvc::kProbeControl && selector != uvc::kCommitControl)
    return fail(ErrorKind::kBadData, "camera simulator: stall of stream selector {}", selector);
  if (request.to_host()) {
    if (request.request != uvc::kGetCurrent) return fail(ErrorKind::kBadData, "camera simulator: stall");
    const auto bytes = uvc::encode(probe);
    const std::size_t count = std::min(bytes.size(), data.size());
    std::copy_n(bytes.begin(), count, data.begin());
    return count;
  }
  DUBSAR_ASSIGN(const uvc::StreamBlock asked, uvc::decode_stream_block(data));
  const uvc::FrameSize* wanted = find(asked.frame_index);
  if (wanted == nullptr || wanted->format_index != asked.format_index) wanted = find(model->default_frame());
  probe = block_of(*wanted);
  if (selector == uvc::kCommitControl) {
    size = *wanted;
    model->commit(*size);
    frame.clear();
    payload.clear();
    sent = payload_sent = 0;
    due = now();
  }
  return data.size();
}

/// False: there is nothing to send now.
bool UvcSimulator::Device::begin_payload() {
  if (sent == frame.size()) {
    if (options.frame_limit != 0 && begun >= options.frame_limit) return false;
    if (options.paced) {
      if (now() < due) return false;
      const TimestampNs interval = 100LL * size->interval_100ns;
      due += options.clock != nullptr ? interval * (1 + (now() - due) / interval) : interval;
    }
    frame.resize(size->frame_bytes());
    model->make_frame(begun, frame);
    ++begun;
    frame_id = !frame_id;
    sent = 0;
  }
  const auto rest = std::span<const std::byte>(frame).subspan(sent);
  payload.resize(std::min<std::size_t>(model->payload_bytes(), rest.size() + kUvcHeaderBytes));
  UvcHeader header;
  header.frame_id = frame_id;
  header.end_of_frame = rest.size() + kUvcHeaderBytes <= payload.size();
  header.presentation_time = static_cast<std::uint32_t>(begun * size->interval_100ns / 10000);
  encode_uvc_transfer(header, rest, payload);
  sent += payload.size() - kUvcHeaderBytes;
  payload_sent = 0;
  return true;
}

UvcSimulator::UvcSimulator(std::shared_ptr<UvcCameraModel> model, const UvcSimulatorOptions& options)
    : device_(std::make_shared<Device>(std::move(model), options)) {}

std::unique_lock<std::mutex> UvcSimulator::lock() const { return std::unique_lock(device_->mutex); }

Result<std::size_t> UvcSimulator::control(const ControlRequest& request, std::span<std::byte> data) {
  const std::lock_guard guard(device_->mutex);
  Device& d = *device_;
  if (!d.plugged) return fail(ErrorKind::kUnavailable, "camera simulator: unplugged");
  Result<std::size_t> moved =
      fail(ErrorKind::kBadData, "camera simulator: stall of request type {:#x}", request.request_type);
  if (request == uvc::kGetConfiguration || request == uvc::kGetDevice) {
    const auto bytes =
        std::as_bytes(request == uvc::kGetDevice ? d.model->device_descriptor() : d.model->configuration_descriptor());
    const std::size_t count = std::min(bytes.size(), data.size());
    std::copy_n(bytes.begin(), count, data.begin());
    moved = count;
  } else if ((request.request_type & 0x7fU) == 0x21U) {
    moved = (request.index & 0xffU) == d.model->stream_interface() ? d.stream_request(request, data)
                                                                   : d.model->unit_request(request, data);
    if (d.model->crashed()) d.plugged = false;
  }
  d.changed.notify_all();
  return moved;
}

std::size_t UvcSimulator::next_transfer(std::span<std::byte> transfer) {
  const std::lock_guard guard(device_->mutex);
  Device& d = *device_;
  if (!d.plugged || !d.size) return 0;
  std::size_t filled = 0;
  while (filled < transfer.size()) {
    if (d.payload_sent == d.payload.size() && !d.begin_payload()) break;
    const std::size_t count = std::min(transfer.size() - filled, d.payload.size() - d.payload_sent);
    std::copy_n(d.payload.begin() + static_cast<std::ptrdiff_t>(d.payload_sent), count,
                transfer.begin() + static_cast<std::ptrdiff_t>(filled));
    filled += count;
    d.payload_sent += count;
    if (d.payload_sent < d.payload.size()) break;  // the buffer is full
    // A payload of the announced length in whole packets ends silently; any other ends with a short (or
    // empty) packet.
    if (d.payload.size() != d.model->payload_bytes() || d.payload.size() % kPacketBytes != 0) break;
  }
  return filled;
}

void UvcSimulator::unplug() {
  const std::lock_guard guard(device_->mutex);
  device_->plugged = false;
  ++device_->plug_count;
  device_->changed.notify_all();
}

void UvcSimulator::plug() {
  const std::lock_guard guard(device_->mutex);
  device_->plugged = true;
  device_->reset();
}

bool UvcSimulator::plugged() const {
  const std::lock_guard guard(device_->mutex);
  return device_->plugged;
}

class UvcSimulatedTransport final : public Transport {
 public:
  UvcSimulatedTransport(UvcSimulator simulator, int plug_count)
      : simulator_(std::move(simulator)), plug_count_(plug_count) {}

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    const auto until = steady_clock::now() + timeout;
    for (;;) {
      if (lost()) return fail(ErrorKind::kUnavailable, "camera simulator: unplugged");
      if (const std::size_t length = simulator_.next_transfer(report)) return length;
      auto& device = *simulator_.device_;
      std::unique_lock guard(device.mutex);
      const auto now = steady_clock::now();
      if (now >= until) return 0U;
      if (!device.plugged) continue;
      auto wake = until;
      if (device.options.paced && device.size)
        wake = std::min(
            wake, now + std::chrono::nanoseconds(std::max<TimestampNs>(device.due - device.now(), 0)) + kShortWait);
      device.changed.wait_until(guard, wake);
    }
  }
  Result<void> write(std::span<const std::byte>) override {
    return fail(ErrorKind::kUsage, "camera simulator: the device has no endpoint to write to");
  }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds) override {
    if (lost()) return fail(ErrorKind::kUnavailable, "camera simulator: unplugged");
    return simulator_.control(request, data);
  }

 private:
  bool lost() const {
    const std::lock_guard guard(simulator_.device_->mutex);
    return !simulator_.device_->plugged || simulator_.device_->plug_count != plug_count_;
  }
  UvcSimulator simulator_;
  int plug_count_;
};

Result<std::unique_ptr<Transport>> UvcSimulator::open() {
  const std::lock_guard guard(device_->mutex);
  if (!device_->plugged) return fail(ErrorKind::kUnavailable, "camera simulator: unplugged");
  return std::make_unique<UvcSimulatedTransport>(*this, device_->plug_count);
}

}  // namespace dubsar
