#pragma once
// One moment of a session's input as one line of JSON: what recordings are made of.

#include <string>
#include <string_view>

#include "input/input_source.h"

namespace dubsar {

struct RecordedFrame {
  TimestampNs polled = 0;  ///< when the program got it; frame.time says when the device measured it
  InputFrame frame;
};

/// No line is longer: 8 hands of 26 joints take 30 kB, 4096 events 400 kB.
inline constexpr std::size_t kLongestLine = std::size_t{1} << 20;

/// One line without its end. Places keep 1 um, rotations 1e-8; a line read and written again is the same.
std::string record_line(const RecordedFrame& recorded);

/// kBadData: no JSON, as a part of a line is none. kConfig: something missing, numbers out of range; says which.
Result<RecordedFrame> parse_line(std::string_view line);

}  // namespace dubsar
