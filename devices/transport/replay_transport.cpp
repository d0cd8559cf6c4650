#include "devices/transport/replay_transport.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace dubsar {

class ReplayTransport final : public Transport {
 public:
  ReplayTransport(ReplaySession& session, UsbId id) : session_(&session), id_(id) {}
  UsbId usb_id() const noexcept override { return id_; }

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    const auto& events = session_->recording_.events;
    if (std::exchange(rests_, false)) return std::size_t{0};
    while (!lost_ && !session_->finished()) {
      const RecordedEvent& event = events[session_->next_];
      if (event.kind != WireEventKind::kRead && event.kind != WireEventKind::kLost) {
        ++session_->next_;  // what the host did then is not done again
        continue;
      }
      if (!due(event.time, timeout)) return std::size_t{0};
      ++session_->next_;
      session_->last_time_ = std::max(session_->last_time_, event.time);
      if (event.kind == WireEventKind::kLost) {
        lost_ = true;
        break;
      }
      if (event.bytes.empty()) continue;
      // As fast as it is read, each picture is all there is for a moment: else a driver would take the newest only.
      rests_ = session_->factor_ == 0.0 && session_->pictures_ && ends_picture(event);
      const std::size_t length = std::min(report.size(), event.bytes.size());
      std::copy_n(event.bytes.begin(), length, report.begin());
      return length;
    }
    return gone();
  }

  Result<void> write(std::span<const std::byte>) override {
    if (lost_) return gone();
    return {};
  }
  Result<void> set_feature(std::span<const std::byte>) override {
    if (lost_) return gone();
    return {};
  }

  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    if (lost_) return gone();
    const RecordedEvent* const event = answer(session_->next_feature_, [id](const RecordedEvent& e) {
      return e.kind == WireEventKind::kFeatureGot && !e.bytes.empty() &&
             std::to_integer<std::uint8_t>(e.bytes[0]) == id;
    });
    if (!event) return fail(ErrorKind::kBadData, "replay: the recording has no more answers for feature report {}", id);
    return copy(*event, out);
  }

  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds) override {
    if (lost_) return gone();
    if (!request.to_host()) return data.size();
    const RecordedEvent* const event = answer(session_->next_control_, [&](const RecordedEvent& e) {
      return e.kind == WireEventKind::kControl && e.request == request;
    });
    if (!event)
      return fail(ErrorKind::kBadData, "replay: the recording has no more answers for control request {:#04x} {:#06x}",
                  request.request, request.value);
    return copy(*event, data);
  }

 private:
  /// Waits at most `timeout` of the real time for a recorded time.
  bool due(TimestampNs time, milliseconds timeout) const {
    // a device that said nothing for long, or a time stamp that is wrong, is not waited for
    if (session_->factor_ > 0.0 && time - session_->last_time_ > ReplaySession::kLongestPauseNs)
      session_->skip_to(time - ReplaySession::kLongestPauseNs);
    const auto ahead = [&] { return time - session_->recorded_now(); };
    if (session_->factor_ == 0.0 || ahead() <= 0) return true;
    const double wait_ns =
        std::min(static_cast<double>(ahead()) / session_->factor_, static_cast<double>(timeout.count()) * 1e6);
    if (wait_ns > 0.0) std::this_thread::sleep_for(std::chrono::nanoseconds(std::llround(wait_ns)));
    return ahead() <= 0;
  }
  template <class Matches>
  const RecordedEvent* answer(std::size_t& next, const Matches& matches) const {
    const auto& events = session_->recording_.events;
    for (std::size_t i = next; i < events.size(); ++i) {
      if (!matches(events[i])) continue;
      next = i + 1;
      return &events[i];
    }
    return nullptr;
  }
  static std::size_t copy(const RecordedEvent& event, std::span<std::byte> out) {
    const std::size_t length = std::min(out.size(), event.bytes.size());
    std::copy_n(event.bytes.begin(), length, out.begin());
    return length;
  }
  tl::unexpected<Error> gone() const {
    if (session_->finished()) return fail(ErrorKind::kUnavailable, "replay: the recording is at its end");
    return fail(ErrorKind::kUnavailable, "replay: the device was lost here when this was recorded");
  }

  ReplaySession* session_;
  UsbId id_;
  bool lost_ = false, rests_ = false;
};

ReplaySession::ReplaySession(Recording recording, const Clock& clock, double factor)
    : recording_(std::move(recording)),
      clock_(&clock),
      pictures_(recording_.raw),
      factor_(std::isfinite(factor) ? std::clamp(factor, 0.0, 1e6) : 1.0),
      start_(clock.now()) {}

TimestampNs ReplaySession::recorded_now() const noexcept {
  if (factor_ == 0.0) return last_time_;
  return skipped_ + static_cast<TimestampNs>(static_cast<double>(clock_->now() - start_) * factor_);
}

void ReplaySession::skip_to(TimestampNs time) noexcept { skipped_ += std::max<TimestampNs>(time - recorded_now(), 0); }

Result<void> ReplaySession::ran_dry() const {
  if (!dry_ || next_ >= recording_.events.size()) return {};
  return fail(ErrorKind::kUnavailable,
              "replay: the recording has no more answers for its driver, and {} of its {} events were not reached; "
              "record the device again",
              recording_.events.size() - next_, recording_.events.size());
}

Result<std::unique_ptr<Transport>> ReplaySession::open() {
  const std::size_t given = next_ + next_feature_ + next_control_;
  dry_ = dry_ || given == given_at_open_;
  given_at_open_ = given;
  DUBSAR_TRY(ran_dry());
  if (finished()) return fail(ErrorKind::kUnavailable, "replay: the recording is at its end");
  UsbId id;
  for (std::size_t i = next_; i < recording_.events.size(); ++i) {
    const RecordedEvent& event = recording_.events[i];
    if (event.kind == WireEventKind::kRead) break;
    if (event.kind != WireEventKind::kOpened || event.bytes.size() != 4) continue;
    const auto word = [&](std::size_t at) {
      return static_cast<std::uint16_t>(std::to_integer<unsigned>(event.bytes[at]) << 8 |
                                        std::to_integer<unsigned>(event.bytes[at + 1]));
    };
    id = {word(0), word(2)};
    break;
  }
  return std::make_unique<ReplayTransport>(*this, id);
}

}  // namespace dubsar
