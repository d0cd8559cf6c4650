#pragma once
// A recording's frames all at once, and a source that plays them from a file.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "input/input_recording.h"

namespace dubsar {

/// All frames of a text. Errors as RecordingReader.
inline Result<std::vector<RecordedFrame>> frames_of(std::string text, std::string name) {
  RecordingReader reader = RecordingReader::over(std::move(text), std::move(name));
  std::vector<RecordedFrame> frames;
  for (;;) {
    DUBSAR_ASSIGN(std::optional<RecordedFrame> frame, reader.next());
    if (!frame) return frames;
    frames.push_back(*std::move(frame));
  }
}

/// The source "replay" over a file with these frames, which is gone from its folder when this returns.
inline std::unique_ptr<InputSource> replay_of(const std::vector<RecordedFrame>& frames) {
  const auto path = std::filesystem::temp_directory_path() / ("dubsar_replay_" + std::to_string(::getpid()) + ".jsonl");
  {
    std::ofstream file(path);
    for (const RecordedFrame& frame : frames) file << record_line(frame) << "\n";
  }
  InputConfig config;
  config.options = {{"path", path.string()}};
  auto source = make_replay_source(config).value();
  std::filesystem::remove(path);
  return source;
}

}  // namespace dubsar
