#pragma once
// Frames from picture files, for tests, demonstrations and bug reports.

#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/frame_source.h"

namespace dubsar {

/// One picture after the other as the clock goes on; its last one ends it (state kStopped).
class PictureFrames : public FrameSource {
 public:
  virtual bool finished() const noexcept = 0;
};

/// A folder's PNG and JPEG files in the order of their names. A name of 12 digits is the time in microseconds
/// since the first picture, as FrameRecorder writes it; all others follow at `fps`. Pictures are read when
/// their time comes; one that cannot be read makes the source lost with the reason. start() begins anew:
/// kNoInput without pictures. No thread. The clock outlives it.
std::unique_ptr<PictureFrames> make_picture_frames(const std::filesystem::path& folder, double fps, const Clock& clock);

/// Writes RGB frames as PNG files into a folder that is there. Only what somebody asked for is ever written.
class FrameRecorder {
 public:
  explicit FrameRecorder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Result<void> write(const Frame& frame);
  int written() const noexcept { return written_; }

 private:
  std::filesystem::path folder_;
  TimestampNs first_ = 0;
  int written_ = 0;
};

}  // namespace dubsar
