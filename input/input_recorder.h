#pragma once
// A session's input on its way to a file, as it comes: input_recording.h plays it.

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/base/files/growing_file.h"
#include "input/recorded_frame.h"

namespace dubsar {

/// Any thread. What was added is in the file 0.2 s later, whatever becomes of the process; a thread of its own writes,
/// so that nobody waits for the disk unless it is 4096 frames behind.
class InputRecorder {
 public:
  /// An older file of this name stays until finish() (GrowingFile). kCannotCreate, kPermission, kIo.
  static Result<std::unique_ptr<InputRecorder>> create(const std::filesystem::path& path);
  /// finish(), for sessions that end by an error.
  ~InputRecorder();
  InputRecorder(const InputRecorder&) = delete;
  InputRecorder& operator=(const InputRecorder&) = delete;

  /// One poll's input, in the order of time. Polls that brought nothing new take no room.
  void add(TimestampNs polled, const InputFrame& frame);
  /// What the session itself took from the window before any source saw it, such as F keys: it goes with the next
  /// frame.
  void add_event(const InputEvent& event);
  /// Waits until all that was added is in the file: for sessions that are faster than real time. The first error there
  /// was, such as a full disk.
  Result<void> flush();
  /// Ends the recording: it has its name then. One without a frame is taken away. Adding nothing afterwards; calling it
  /// again gives the same answer.
  Result<void> finish();

  std::int64_t frames() const;
  /// The first error there was so far, without waiting for anything.
  Result<void> status() const;

 private:
  explicit InputRecorder(GrowingFile file);
  void write_loop();

  GrowingFile file_;  // the thread's; finish() has joined it

  mutable std::mutex mutex_;  // for all below
  std::condition_variable wake_, written_;
  std::vector<RecordedFrame> pending_;
  std::vector<InputEvent> events_;
  RecordedFrame last_{};               // that was added, without the events that add_event() told of
  std::int64_t added_ = 0, done_ = 0;  // frames
  bool hurry_ = false, ending_ = false, finished_ = false;
  Result<void> status_;
  std::thread thread_;
};

}  // namespace dubsar
