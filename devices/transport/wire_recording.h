#pragma once
// What a device and the host said to each other, with times, as a text file: every bug report becomes a file, every
// file a test.
//
//   dubsar-recording 1
//   driver spacemouse
//   note SpaceMouse Compact, cap pushed right
//   0 o
//   16000000 r 015e0100000000
//   20000000 c c0 81 0300 0105 4243
//
// One event per line: nanoseconds since the start (never falling, at most a year), kind, then bytes in hexadecimal.
// Kinds: o opened (bytes: vendor and product, two each, where they are known), x lost, r report read, w report written,
// s feature report set, f feature report got (first byte: its id), c control request (type, request, value, index, then
// the data). Lines end with a line feed.
//
// Cameras send 35 MB a second, twice that as text, which cannot be read in time: their recordings are of version 2, in
// which events of more than 64 bytes end in `=N`, a line feed, the N bytes as they are, and a line feed.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar {

enum class WireEventKind : char {
  kOpened = 'o',
  kLost = 'x',
  kRead = 'r',
  kWritten = 'w',
  kFeatureSet = 's',
  kFeatureGot = 'f',
  kControl = 'c',
};

struct RecordedEvent {
  TimestampNs time = 0;  ///< since the start of the recording
  WireEventKind kind = WireEventKind::kRead;
  ControlRequest request;  ///< for kControl
  std::vector<std::byte> bytes;
  bool operator==(const RecordedEvent&) const = default;
};

struct Recording {
  std::string driver;
  std::string note;
  std::vector<RecordedEvent> events;
  bool raw = false;      ///< of version 2: the driver's reports are pictures
  bool cut_off = false;  ///< the last line had no end (the program stopped while it was written) and was left out
};

/// kBadData: not a recording, another version, a broken line (its number is told), times that fall, an event longer
/// than kMaxReportBytes.
Result<Recording> parse_recording(std::string_view text);
std::string format_recording(const Recording& recording);

/// At most 1 GiB. kNoInput, kPermission, kBadData, kIo.
Result<Recording> read_recording(const std::filesystem::path& path);

/// One event as its line, with the line feed; `raw`: as in version 2.
std::string format_event(const RecordedEvent& event, bool raw = false);

/// A report that ends a picture.
bool ends_picture(const RecordedEvent& event) noexcept;
/// Of such a recording: reports whose header says that a picture ends (UVC 1.0, 2.4.3.3). Of others 0.
std::int64_t pictures_in(const Recording& recording);

}  // namespace dubsar
