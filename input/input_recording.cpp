#include "input/input_recording.h"

#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include "input/source_options.h"

namespace dubsar {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{64} << 10;

using NextFrame = std::function<Result<std::optional<RecordedFrame>>()>;

class ReplaySource final : public InputSource {
 public:
  ReplaySource(NextFrame read, std::string note) : read_(std::move(read)), note_(std::move(note)) { advance(); }
  std::string_view name() const noexcept override { return "replay"; }
  Result<void> start() override { return {}; }
  bool has_end() const noexcept override { return true; }
  bool finished() const noexcept override { return !next_; }
  std::string note() const override { return note_; }

  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    newest.events.clear();
    if (!start_ && next_) {
      start_ = now;
      shift_ = now - next_->polled;
    }
    if (!start_ || broken_) return Freshness::kLost;
    bool any = false;
    std::vector<InputEvent> events;
    for (; next_ && next_->polled + shift_ <= now; advance()) {
      newest = std::move(next_->frame);
      any = true;
      events.insert(events.end(), newest.events.begin(), newest.events.end());
    }
    if (!any) return Freshness::kUnchanged;
    newest.events = std::move(events);
    newest.time += shift_;
    for (InputEvent& event : newest.events) event.time += shift_;
    for (HandFrame& hand : newest.hands) hand.time += shift_;
    for (HeadFrame& head : newest.heads) head.time += shift_;
    if (newest.space_mouse) newest.space_mouse->time += shift_;
    return Freshness::kNew;
  }

 private:
  void advance() {
    next_.reset();
    auto read = read_();
    if (read) {
      next_ = *std::move(read);
    } else {  // it was whole when it was checked
      broken_ = true;
      note_ = std::move(read).error().message;
    }
  }
  NextFrame read_;
  std::string note_;
  std::optional<RecordedFrame> next_;
  std::optional<TimestampNs> start_;
  TimestampNs shift_ = 0;
  bool broken_ = false;
};

}  // namespace

RecordingReader::RecordingReader(std::unique_ptr<std::istream> stream, std::string name)
    : stream_(std::move(stream)), name_(std::move(name)) {}

Result<RecordingReader> RecordingReader::open(const std::filesystem::path& path) {
  std::error_code error;
  const auto found = std::filesystem::status(path, error);
  if (std::filesystem::exists(found) && !std::filesystem::is_regular_file(found))
    return fail(ErrorKind::kBadData, "{} is not a regular file, expected a recording", path.string());
  errno = 0;
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!file->is_open()) return fail_errno(errno, fmt::format("cannot open {}", path.string()));
  return RecordingReader(std::move(file), path.string());
}

RecordingReader RecordingReader::over(std::string text, std::string name) {
  return {std::make_unique<std::istringstream>(std::move(text)), std::move(name)};
}

std::optional<std::string_view> RecordingReader::take_line() {
  std::size_t end = buffer_.find('\n', begin_);
  while (end == std::string::npos && *stream_ && buffer_.size() - begin_ <= kLongestLine) {
    buffer_.erase(0, begin_);
    begin_ = 0;
    const std::size_t had = buffer_.size();
    buffer_.resize(had + kBlockBytes);
    stream_->read(buffer_.data() + had, kBlockBytes);
    buffer_.resize(had + static_cast<std::size_t>(stream_->gcount()));
    end = buffer_.find('\n', had);
  }
  whole_line_ = end != std::string::npos;
  if (!whole_line_) end = buffer_.size();
  if (end == begin_ && !whole_line_) return std::nullopt;
  const std::string_view line = std::string_view(buffer_).substr(begin_, end - begin_);
  begin_ = end + (whole_line_ ? 1 : 0);
  ++line_number_;
  return line;
}

tl::unexpected<Error> RecordingReader::broken(std::string_view why) {
  stream_->setstate(std::ios::failbit);
  buffer_.clear();
  begin_ = 0;
  return fail(ErrorKind::kConfig, "{}: line {}: {}", name_, line_number_, why);
}

Result<std::optional<RecordedFrame>> RecordingReader::next() {
  while (const auto line = take_line()) {
    if (line->empty()) continue;
    if (line->size() > kLongestLine) return broken(fmt::format("longer than {} bytes", kLongestLine));
    auto frame = parse_line(*line);
    if (!frame && !whole_line_ && frame.error().kind == ErrorKind::kBadData) {
      cut_off_ = true;
      return std::nullopt;
    }
    if (!frame) return broken(frame.error().message);
    if (frame->polled < last_polled_) return broken("polled goes back in time");
    last_polled_ = frame->polled;
    return std::optional<RecordedFrame>(*std::move(frame));
  }
  return std::nullopt;
}

Result<std::unique_ptr<InputSource>> make_replay_source(const InputConfig& config) {
  DUBSAR_ASSIGN(const std::string path, only_path_option(config, "replay"));
  DUBSAR_ASSIGN(RecordingReader check, RecordingReader::open(path));
  std::int64_t frames = 0;
  for (;; ++frames) {
    DUBSAR_ASSIGN(const std::optional<RecordedFrame> frame, check.next());
    if (!frame) break;
  }
  if (frames == 0) return fail(ErrorKind::kConfig, "{}: no frames in it, expected one JSON object a line", path);
  std::string note = check.cut_off() ? fmt::format("{}: its last line is not whole and was left out", path) : "";
  DUBSAR_ASSIGN(RecordingReader opened, RecordingReader::open(path));
  auto reader = std::make_shared<RecordingReader>(std::move(opened));
  return std::make_unique<ReplaySource>([reader] { return reader->next(); }, std::move(note));
}

}  // namespace dubsar
