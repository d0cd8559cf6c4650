#pragma once
// Writes down everything that passes through a transport.

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/base/files/growing_file.h"
#include "core/base/system/clock.h"
#include "devices/transport/wire_recording.h"

namespace dubsar {

/// A growing recording. Where an older file is, it grows beside it as NAME.partial and takes its place only at
/// finish(). What is older than half a second, or more than 64 KiB, is in that file, so that even a killed program
/// leaves a usable recording there. The first error ends the writing; it is kept for finish(). Any thread.
class RecordingWriter {
 public:
  /// `raw`: of version 2, for reports that are pictures. kCannotCreate: also where something is that a file must not
  /// replace; kPermission.
  static Result<std::shared_ptr<RecordingWriter>> create(const std::filesystem::path& path, std::string_view driver,
                                                         std::string_view note, const Clock& clock, bool raw = false);
  ~RecordingWriter();

  /// Adds one event at the present time.
  void add(WireEventKind kind, std::span<const std::byte> bytes, const ControlRequest& request = {});
  void flush();
  /// Writes out what has waited for half a second; cheap, for loops that wait for the device.
  void tick();
  /// Writes what is left and puts the recording in its place, or tells the first error there was and leaves what was
  /// there. Without it the recording stays where it grew.
  Result<void> finish();
  void discard();  ///< takes away what was written; an older file stays
  /// The first error there was so far.
  Result<void> status() const;
  std::int64_t event_count() const;
  std::int64_t heard_count() const;  ///< of those that the device said

 private:
  RecordingWriter(GrowingFile file, std::string header, bool raw, const Clock& clock);
  void write_out();  ///< with mutex_ held

  GrowingFile file_;  // guarded by mutex_
  const bool raw_;    // of version 2
  const Clock* const clock_;
  const TimestampNs start_;
  mutable std::mutex mutex_;
  std::string pending_;                             // guarded by mutex_
  TimestampNs written_;                             // guarded by mutex_; when pending_ was last empty
  std::int64_t event_count_ = 0, heard_count_ = 0;  // guarded by mutex_
  bool finished_ = false;                           // guarded by mutex_
  Result<void> status_;                             // guarded by mutex_
};

/// Passes everything on to `below` and writes it down, also its being opened and lost.
std::unique_ptr<Transport> make_record_transport(std::unique_ptr<Transport> below,
                                                 std::shared_ptr<RecordingWriter> writer);

}  // namespace dubsar
