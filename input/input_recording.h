#pragma once
// Input as a file: one JSON object a line, one line a frame, so that every session can be a bug report and every bug
// report a test.

#include <string>
#include <string_view>
#include <vector>

#include "input/input_source.h"

namespace dubsar {

struct RecordedFrame {
  TimestampNs polled = 0;  ///< when the program got it; frame.time says when the device measured it
  InputFrame frame;
};

/// One line without its end; doubles keep all digits that matter (1 um, 1e-6).
std::string record_line(const RecordedFrame& recorded);

/// All lines of a recording, at most 8 MiB and 200000 frames. kConfig with the line's number for broken lines, times
/// that go back, numbers out of range.
Result<std::vector<RecordedFrame>> parse_recording(std::string_view text, std::string_view source);

/// Plays frames at the speed they were recorded at, from the first poll on; device times keep their age.
std::unique_ptr<InputSource> replay_frames(std::vector<RecordedFrame> frames);

/// Options: path=FILE, or the file as a bare word.
Result<std::unique_ptr<InputSource>> make_replay_source(const InputConfig& config);

}  // namespace dubsar
