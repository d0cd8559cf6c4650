#pragma once
// A recording that behaves like the device it was made of.

#include <memory>

#include "core/base/system/clock.h"
#include "devices/transport/wire_recording.h"

namespace dubsar {

/// Plays one recording, through as many openings as it holds. Reports come in order, when they are due, but after a
/// pause of kLongestPauseNs at most; what the host sends is accepted unseen; feature and control answers are the
/// recorded ones, in order per request. The session must outlive its transports. One thread.
class ReplaySession {
 public:
  /// `factor`: speed, 2 is twice as fast; 0: as fast as it is read. `clock` gives the real time and outlives this.
  static constexpr TimestampNs kLongestPauseNs = 5'000'000'000;
  ReplaySession(Recording recording, const Clock& clock, double factor = 1.0);

  /// Goes on behind the last loss. kUnavailable at the end of the recording, and where the driver was opened since and
  /// got nothing from it any more: its answers have run out, and asking again would never end.
  Result<std::unique_ptr<Transport>> open();

  /// Recorded time: of the last report with factor 0, and that of the playback otherwise. Gives drivers the same
  /// timestamps in every replay with factor 0.
  const Clock& recorded_clock() const noexcept { return recorded_clock_; }
  /// kUnavailable once answers have run out before the end (see open()).
  Result<void> ran_dry() const;
  /// So much of the recorded time passes at once: a driver waits before it opens its device again.
  void pass(TimestampNs time) noexcept { factor_ == 0.0 ? last_time_ += time : skipped_ += time; }
  bool finished() const noexcept { return dry_ || next_ >= recording_.events.size(); }
  const Recording& recording() const noexcept { return recording_; }

 private:
  static constexpr std::size_t kNotOpened = static_cast<std::size_t>(-1);
  friend class ReplayTransport;
  class RecordedClock final : public Clock {
   public:
    explicit RecordedClock(const ReplaySession& session) : session_(&session) {}
    TimestampNs now() const noexcept override { return session_->recorded_now(); }

   private:
    const ReplaySession* session_;
  };
  TimestampNs recorded_now() const noexcept;
  void skip_to(TimestampNs time) noexcept;  ///< the recorded time is at least this from now on

  const Recording recording_;
  const Clock* const clock_;
  const bool pictures_;  ///< reports are parts of pictures
  const double factor_;
  const TimestampNs start_;
  std::size_t next_ = 0;          ///< event that read() looks at next
  std::size_t next_feature_ = 0;  ///< events before it have been given as feature answers
  std::size_t next_control_ = 0;
  std::size_t given_at_open_ = kNotOpened;  ///< events that were given when it was opened last
  bool dry_ = false;                        ///< the driver asks for answers that the recording does not have
  TimestampNs skipped_ = 0;                 ///< of recorded time, in pauses
  TimestampNs last_time_ = 0;               ///< recorded time of the last event that was given
  RecordedClock recorded_clock_{*this};
};

}  // namespace dubsar
