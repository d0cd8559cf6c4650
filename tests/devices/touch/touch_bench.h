#pragma once
// A touch panel as its kernel driver would speak, and somebody who reads it. The events are the kernel's own struct and
// numbers; nothing here is made by the code that reads them.

#include <gtest/gtest.h>
#include <linux/input.h>

#include <cstring>
#include <glm/vec2.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "devices/touch/touch_protocol.h"
#include "devices/transport/sim_transport.h"

namespace dubsar::touch_bench {
using Bytes = std::vector<std::byte>;
inline constexpr int kWide = 1000, kHigh = 500;  // the axes of the panel: 0 to these

inline Bytes bytes_of(const input_event& event) {
  Bytes out(sizeof event);
  std::memcpy(out.data(), &event, sizeof event);
  return out;
}

/// What a kernel driver would say, event by event, and what its ioctls would answer.
class KernelPanel {
 public:
  explicit KernelPanel(int slots = 10)
      : slots_(slots),
        id_(std::size_t(slots), -1),
        x_(std::size_t(slots)),
        y_(std::size_t(slots)),
        tool_(std::size_t(slots)) {
    SimBehaviour behaviour;
    behaviour.on_get_feature = [this](std::uint8_t code) -> Result<Bytes> { return answer(code); };
    device.set_behaviour(std::move(behaviour));
  }
  Bytes event(int type, int code, int value) {
    input_event out{};
    out.input_event_sec = 100 + ms_ / 1000;
    out.input_event_usec = ms_ % 1000 * 1000;
    out.type = static_cast<__u16>(type);
    out.code = static_cast<__u16>(code);
    out.value = value;
    return bytes_of(out);
  }
  KernelPanel& say(int type, int code, int value) {
    const Bytes bytes = event(type, code, value);
    said.insert(said.end(), bytes.begin(), bytes.end());
    if (type == EV_ABS) remember(code, value);
    return *this;
  }
  KernelPanel& slot(int number) { return say(EV_ABS, ABS_MT_SLOT, number); }
  KernelPanel& id(int number) { return say(EV_ABS, ABS_MT_TRACKING_ID, number); }
  KernelPanel& at(int x, int y) { return say(EV_ABS, ABS_MT_POSITION_X, x).say(EV_ABS, ABS_MT_POSITION_Y, y); }
  KernelPanel& tool(int number) { return say(EV_ABS, ABS_MT_TOOL_TYPE, number); }
  KernelPanel& report() {
    say(EV_SYN, SYN_REPORT, 0);
    ms_ += 8;
    return *this;
  }
  Bytes take() { return std::exchange(said, {}); }

  SimDevice device{"panel"};
  Bytes said;
  int asked = 0;
  bool tells_tools = true;

 private:
  void remember(int code, int value) {
    if (code == ABS_MT_SLOT) current_ = value;
    if (current_ < 0 || current_ >= slots_) return;
    const auto s = static_cast<std::size_t>(current_);
    if (code == ABS_MT_TRACKING_ID) id_[s] = value;
    if (code == ABS_MT_POSITION_X) x_[s] = value;
    if (code == ABS_MT_POSITION_Y) y_[s] = value;
    if (code == ABS_MT_TOOL_TYPE) tool_[s] = value;
  }
  Result<Bytes> answer(std::uint8_t code) {
    ++asked;
    std::vector<int> numbers{0, 0, 0};
    const auto with = [&](int high, const std::vector<int>& values) {
      numbers[2] = high;
      numbers.insert(numbers.end(), values.begin(), values.end());
    };
    if (code == ABS_MT_SLOT) numbers = {current_, 0, slots_ - 1};
    if (code == ABS_MT_TRACKING_ID) with(65535, id_);
    if (code == ABS_MT_POSITION_X) with(kWide, x_);
    if (code == ABS_MT_POSITION_Y) with(kHigh, y_);
    if (code == ABS_MT_TOOL_TYPE && !tells_tools) return fail(ErrorKind::kBadData, "none");
    if (code == ABS_MT_TOOL_TYPE) with(15, tool_);
    Bytes out(1 + 4 * numbers.size());
    out[0] = std::byte{code};
    std::memcpy(out.data() + 1, numbers.data(), 4 * numbers.size());
    return out;
  }
  int slots_, current_ = 0;
  std::vector<int> id_, x_, y_, tool_;
  long ms_ = 0;
};

/// The protocol, opened on a panel.
struct Reader {
  explicit Reader(KernelPanel& of, int turn_deg = 0) : panel(of), protocol(turn_deg) {
    transport = panel.device.open().value();
    const auto started = protocol.start(*transport, now);
    EXPECT_TRUE(started) << started.error().message;
  }
  /// What the panel has said since the last time, as one read.
  std::vector<TouchFrame> read() { return read(panel.take()); }
  std::vector<TouchFrame> read(const Bytes& bytes) {
    now += 8'000'000;
    EXPECT_TRUE(protocol.keep_up(*transport, now));
    EXPECT_TRUE(bytes.empty() || protocol.accept(bytes, now));
    auto sample = protocol.newest();
    return sample ? std::move(sample->frames) : std::vector<TouchFrame>{};
  }
  KernelPanel& panel;
  TouchProtocol protocol;
  std::unique_ptr<Transport> transport;
  TimestampNs now = 1'000'000'000;
};

}  // namespace dubsar::touch_bench
