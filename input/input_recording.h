#pragma once
// Reading recordings of a session's input (input_recorder.h writes them): one JSON object a line, one line a frame, so
// that every session can be a bug report and every bug report a test.

#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "input/recorded_frame.h"

namespace dubsar {

/// Reads a recording frame by frame, so that its length does not matter. A last line that is not whole, as a program
/// that was killed leaves it, is left out.
class RecordingReader {
 public:
  /// kNoInput, kPermission; kBadData: not a regular file.
  static Result<RecordingReader> open(const std::filesystem::path& path);
  static RecordingReader over(std::string text, std::string name);

  /// Nothing at the end. kConfig with the line's number: a broken line, times that go back; the reader is then at its
  /// end.
  Result<std::optional<RecordedFrame>> next();
  /// A last line was left out; known at the end.
  bool cut_off() const noexcept { return cut_off_; }

 private:
  RecordingReader(std::unique_ptr<std::istream> stream, std::string name);
  std::optional<std::string_view> take_line();
  tl::unexpected<Error> broken(std::string_view why);

  std::unique_ptr<std::istream> stream_;
  std::string name_, buffer_;
  std::size_t begin_ = 0;  // of what has not been used in buffer_
  std::int64_t line_number_ = 0;
  TimestampNs last_polled_ = 0;
  bool whole_line_ = true, cut_off_ = false;
};

/// Options: path=FILE, or the file as a bare word. The whole file is checked first (60 MB a second), then read as it is
/// played. kConfig: broken, or no frames in it.
Result<std::unique_ptr<InputSource>> make_replay_source(const InputConfig& config);

}  // namespace dubsar
