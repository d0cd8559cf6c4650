#pragma once
// Videos of numbered pictures, by ffmpeg where it is installed.

#include <filesystem>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace dubsar::app {

/// By the suffix: .mp4 and .mov (H.264), .webm (VP9), .mkv (FFV1, no pixel is changed). kUsage for others.
Result<void> check_video_name(const std::filesystem::path& path);
bool is_video_name(const std::filesystem::path& path);

/// kUnavailable, with what to install, where no program of this name is on the PATH.
Result<std::filesystem::path> find_ffmpeg();

struct VideoRequest {
  std::filesystem::path ffmpeg;
  std::filesystem::path folder;  ///< of the pictures
  std::string pattern;           ///< "picture_%05d.png", beginning with number 1
  int pictures = 0;
  double fps = 25.0;
  std::filesystem::path out;
};

/// Writes `out` whole or not at all; sRGB, with the tags that say so. kCancelled, kIo with what ffmpeg said last.
Result<void> make_video(const VideoRequest& request, Progress& progress);

}  // namespace dubsar::app
