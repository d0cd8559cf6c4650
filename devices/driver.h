#pragma once
// Joins a transport that may be lost and a protocol that knows only bytes.

#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <utility>

#include "core/base/system/clock.h"
#include "devices/device_driver.h"
#include "devices/transport/reconnector.h"

namespace dubsar {

/// A protocol: start() after every opening, keep_up() in every poll (keep-alives), accept() per report (false: not a
/// valid one), newest() gives what has changed since it was asked last.
template <class P>
concept DeviceProtocol = requires(P protocol, Transport& transport, std::span<const std::byte> bytes, TimestampNs now) {
  typename P::Sample;
  { protocol.start(transport, now) } -> std::same_as<Result<void>>;
  { protocol.keep_up(transport, now) } -> std::same_as<Result<void>>;
  { protocol.accept(bytes, now) } -> std::same_as<bool>;
  { protocol.newest() } -> std::same_as<std::optional<typename P::Sample>>;
};

/// Reads all that has come, newest wins. A lost device is a state: poll() then gives nothing and tries to open it
/// again (Reconnector). A device that sends kMaxRefusedInARow invalid reports in a row is opened again too. One thread.
template <DeviceProtocol Protocol>
class Driver final : public DeviceDriver {
 public:
  using Sample = typename Protocol::Sample;
  static constexpr int kMaxRefusedInARow = 1000;
  static constexpr int kMaxReportsPerPoll = 1024;  ///< a flood cannot hold the caller
  static constexpr std::size_t kBufferBytes = 4096;

  /// `stamps`: reports carry its time at which they were read, which matters when poll() waits; null: the time that
  /// poll() was given. It outlives the driver.
  Driver(OpenTransport open, Protocol protocol, const Clock* stamps = nullptr)
      : reconnector_(std::move(open)), protocol_(std::move(protocol)), stamps_(stamps) {}

  /// Waits at most `timeout` for the first report, then takes those that are there.
  std::optional<Sample> poll(TimestampNs now, milliseconds timeout = milliseconds(0)) {
    const int opened_before = reconnector_.times_opened();
    Transport* const transport = reconnector_.transport(now);
    if (!transport) return std::nullopt;
    if (reconnector_.times_opened() != opened_before) {
      refused_in_a_row_ = 0;
      dropped_ = 0;
      if (auto started = protocol_.start(*transport, now); !started) return lose(started.error(), now);
    }
    if (auto kept = protocol_.keep_up(*transport, now); !kept && kept.error().kind == ErrorKind::kUnavailable)
      return lose(kept.error(), now);
    for (int i = 0; i < kMaxReportsPerPoll; ++i) {
      const auto length = transport->read(buffer_, i == 0 ? timeout : milliseconds(0));
      if (!length) {
        if (length.error().kind == ErrorKind::kUnavailable) lose(length.error(), now);
        break;
      }
      if (*length == 0) break;
      if (protocol_.accept(std::span<const std::byte>(buffer_).first(*length), stamps_ ? stamps_->now() : now)) {
        ++counts_.accepted;
        refused_in_a_row_ = 0;
        continue;
      }
      ++counts_.refused;
      if (++refused_in_a_row_ < kMaxRefusedInARow) continue;
      lose({ErrorKind::kUnavailable, "the device has sent 1000 invalid reports in a row and is opened again"}, now);
      break;
    }
    if (const Transport* const open = reconnector_.open_transport()) {
      const DroppedInput dropped = open->dropped();
      counts_.refused += dropped.count - std::exchange(dropped_, dropped.count);
      if constexpr (requires(Protocol & p) { p.hear_of_dropped(dropped); }) protocol_.hear_of_dropped(dropped);
    }
    return protocol_.newest();
  }

  std::optional<DeviceSample> next(TimestampNs now, milliseconds timeout) override {
    auto sample = poll(now, timeout);
    if (!sample) return std::nullopt;
    return DeviceSample(*std::move(sample));
  }
  void wake() noexcept override { reconnector_.wake(); }
  void recentre() noexcept override {
    if constexpr (requires(Protocol & p) { p.recentre(); }) protocol_.recentre();
  }
  bool connected() const noexcept override { return reconnector_.connected(); }
  const std::string& reason() const noexcept override { return reconnector_.reason(); }
  /// What a protocol with a note() has to say about an open device that works, or gives nothing; empty otherwise.
  std::string note() const override {
    if constexpr (requires(const Protocol& p) { p.note(); }) return connected() ? protocol_.note() : std::string();
    return {};
  }
  const DriverCounts& counts() const noexcept override { return counts_; }
  Protocol& protocol() noexcept { return protocol_; }

 private:
  std::nullopt_t lose(const Error& error, TimestampNs now) {
    ++counts_.losses;
    reconnector_.lost(error, now);
    return std::nullopt;
  }
  Reconnector reconnector_;
  Protocol protocol_;
  const Clock* stamps_;
  std::array<std::byte, kBufferBytes> buffer_{};
  DriverCounts counts_;
  int refused_in_a_row_ = 0;
  std::uint64_t dropped_ = 0;  ///< by the transport, as far as counted
};

}  // namespace dubsar
