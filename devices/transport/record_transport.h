#pragma once
// Writes down everything that passes through a transport.

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/base/clock.h"
#include "devices/transport/wire_recording.h"

namespace dubsar {

/// A growing recording. What is written reaches the file within 64 KiB or at flush(), so that a crash leaves a usable
/// recording. The first error ends the writing; it is kept for finish(). Any thread.
class RecordingWriter {
 public:
  /// Replaces an old file. kCannotCreate, kPermission.
  static Result<std::shared_ptr<RecordingWriter>> create(const std::filesystem::path& path, std::string_view driver,
                                                         std::string_view note, const Clock& clock);
  ~RecordingWriter();

  /// Adds one event at the present time.
  void add(WireEventKind kind, std::span<const std::byte> bytes, const ControlRequest& request = {});
  void flush();
  /// Writes what is left and tells the first error there was.
  Result<void> finish();
  std::int64_t event_count() const;

 private:
  RecordingWriter(int descriptor, std::string path, std::string header, const Clock& clock);
  void write_out();  ///< with mutex_ held

  const int descriptor_;
  const std::string path_;
  const Clock* const clock_;
  const TimestampNs start_;
  mutable std::mutex mutex_;
  std::string pending_;           // guarded by mutex_
  std::int64_t event_count_ = 0;  // guarded by mutex_
  Result<void> status_;           // guarded by mutex_
};

/// Passes everything on to `below` and writes it down, also its being opened and lost.
std::unique_ptr<Transport> make_record_transport(std::unique_ptr<Transport> below,
                                                 std::shared_ptr<RecordingWriter> writer);

}  // namespace dubsar
