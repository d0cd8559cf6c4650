#include "devices/transport/wire_recording.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <system_error>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {

constexpr std::string_view kMagic = "dubsar-recording ";
constexpr int kVersion = 1, kRawVersion = 2;
constexpr std::size_t kMostPlainBytes = 64;  // of an event that stays readable
constexpr std::string_view kKinds = "oxrwsfc";
constexpr TimestampNs kMostRecordedNs = TimestampNs{366} * 86'400 * 1'000'000'000;

void append_hex(std::string& out, std::uint32_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += "0123456789abcdef"[(value >> shift) & 15U];
}

int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

std::string_view take_word(std::string_view& line) {
  const std::string_view word = line.substr(0, line.find(' '));
  line.remove_prefix(std::min(line.size(), word.size() + 1));
  return word;
}

template <class T>
std::optional<T> number(std::string_view word, int base, std::size_t digits) {
  T value{};
  if (word.empty() || (digits && word.size() != digits)) return std::nullopt;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value, base);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<std::vector<std::byte>> hex_bytes(std::string_view word) {
  if (word.size() % 2 != 0 || word.size() / 2 > kMaxReportBytes) return std::nullopt;
  std::vector<std::byte> bytes(word.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int high = hex_digit(word[2 * i]), low = hex_digit(word[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    bytes[i] = static_cast<std::byte>(high << 4 | low);
  }
  return bytes;
}

std::optional<RecordedEvent> parse_event(std::string_view line) {
  RecordedEvent event;
  const auto time = number<TimestampNs>(take_word(line), 10, 0);
  const std::string_view kind = take_word(line);
  if (!time || *time < 0 || *time > kMostRecordedNs || kind.size() != 1 ||
      kKinds.find(kind[0]) == std::string_view::npos)
    return std::nullopt;
  event.time = *time;
  event.kind = static_cast<WireEventKind>(kind[0]);
  if (event.kind == WireEventKind::kControl) {
    const auto type = number<std::uint8_t>(take_word(line), 16, 2);
    const auto request = number<std::uint8_t>(take_word(line), 16, 2);
    const auto value = number<std::uint16_t>(take_word(line), 16, 4);
    const auto index = number<std::uint16_t>(take_word(line), 16, 4);
    if (!type || !request || !value || !index) return std::nullopt;
    event.request = {*type, *request, *value, *index};
  }
  auto bytes = hex_bytes(line);
  if (!bytes || (event.kind == WireEventKind::kLost && !bytes->empty())) return std::nullopt;
  if (event.kind == WireEventKind::kOpened && !bytes->empty() && bytes->size() != 4) return std::nullopt;
  event.bytes = std::move(*bytes);
  return event;
}

/// How many bytes follow a line of version 2 as they are.
std::optional<std::size_t> raw_bytes(std::string_view line) {
  const std::size_t last = line.rfind(' ');
  if (last == std::string_view::npos || last + 1 >= line.size() || line[last + 1] != '=') return std::nullopt;
  const auto count = number<std::size_t>(line.substr(last + 2), 10, 0);
  return count && *count > 0 && *count <= kMaxReportBytes ? count : std::nullopt;
}

/// Text of one header line without what would end the line.
std::string one_line(std::string_view text) {
  std::string out(text.substr(0, 400));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  return out;
}

}  // namespace

bool ends_picture(const RecordedEvent& event) noexcept {
  constexpr std::byte kEndOfFrame{2};
  return event.kind == WireEventKind::kRead && event.bytes.size() > 2 && (event.bytes[1] & kEndOfFrame) != std::byte{0};
}

std::int64_t pictures_in(const Recording& recording) {
  if (!recording.raw) return 0;
  return std::count_if(recording.events.begin(), recording.events.end(), ends_picture);
}

std::string format_event(const RecordedEvent& event, bool raw) {
  std::string line = fmt::format("{} {}", event.time, static_cast<char>(event.kind));
  if (event.kind == WireEventKind::kControl) {
    const ControlRequest& r = event.request;
    line += fmt::format(" {:02x} {:02x} {:04x} {:04x}", r.request_type, r.request, r.value, r.index);
  }
  if (raw && event.bytes.size() > kMostPlainBytes) {
    line += fmt::format(" ={}\n", event.bytes.size());
    line.append(reinterpret_cast<const char*>(event.bytes.data()), event.bytes.size());
  } else if (!event.bytes.empty()) {
    line.reserve(line.size() + 2 + 2 * event.bytes.size());
    line += ' ';
    for (const std::byte byte : event.bytes) append_hex(line, std::to_integer<std::uint32_t>(byte), 2);
  }
  line += '\n';
  return line;
}

std::string format_recording(const Recording& recording) {
  std::string text =
      fmt::format("{}{}\ndriver {}\n", kMagic, recording.raw ? kRawVersion : kVersion, one_line(recording.driver));
  if (!recording.note.empty()) text += fmt::format("note {}\n", one_line(recording.note));
  for (const RecordedEvent& event : recording.events) text += format_event(event, recording.raw);
  return text;
}

Result<Recording> parse_recording(std::string_view text) {
  Recording recording;
  std::int64_t line_number = 0;
  TimestampNs last_time = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      recording.cut_off = true;
      break;
    }
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    ++line_number;
    if (line_number == 1) {
      const auto version = line.starts_with(kMagic) ? number<int>(line.substr(kMagic.size()), 10, 0) : std::nullopt;
      if (!version) return fail(ErrorKind::kBadData, "recording: the file does not start with \"{}1\"", kMagic);
      if (*version != kVersion && *version != kRawVersion)
        return fail(ErrorKind::kBadData, "recording: version {} found, this program reads versions {} and {}", *version,
                    kVersion, kRawVersion);
      recording.raw = *version == kRawVersion;
    } else if (line_number == 2) {
      if (!line.starts_with("driver ")) return fail(ErrorKind::kBadData, "recording: line 2: expected \"driver NAME\"");
      recording.driver = line.substr(7);
    } else if (line_number == 3 && line.starts_with("note ")) {
      recording.note = line.substr(5);
    } else {
      const std::optional<std::size_t> follows = recording.raw ? raw_bytes(line) : std::nullopt;
      if (follows && text.size() < *follows + 1) {
        recording.cut_off = true;
        break;
      }
      auto event = parse_event(follows ? line.substr(0, line.rfind(' ')) : line);
      if (event && follows) {
        const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
        const bool ends = event->bytes.empty() && text[*follows] == '\n' && event->kind != WireEventKind::kLost &&
                          event->kind != WireEventKind::kOpened;
        if (ends)
          event->bytes.assign(bytes, bytes + *follows);
        else
          event.reset();
        text.remove_prefix(*follows + 1);
      }
      if (!event)
        return fail(ErrorKind::kBadData, "recording: line {}: \"{}\" found, expected \"NANOSECONDS KIND HEX\"",
                    line_number, one_line(line.substr(0, 60)));
      if (event->time < last_time)
        return fail(ErrorKind::kBadData, "recording: line {}: time falls from {} to {}", line_number, last_time,
                    event->time);
      last_time = event->time;
      recording.events.push_back(std::move(*event));
    }
  }
  if (line_number < 2)
    return fail(ErrorKind::kBadData, "recording: {} whole lines found, expected a header of two", line_number);
  return recording;
}

Result<Recording> read_recording(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(const std::string text, read_text_file(path, std::int64_t{1} << 30));
  auto recording = parse_recording(text);
  if (!recording) return fail(recording.error().kind, "{}: {}", path.string(), recording.error().message);
  return recording;
}

}  // namespace dubsar
