#include "devices/transport/record_transport.h"

#include <array>
#include <utility>

#include "devices/transport/forwarding_transport.h"

namespace dubsar {
namespace {

constexpr std::size_t kPendingBytes = std::size_t{64} << 10;
constexpr TimestampNs kPendingNs = 500'000'000;

class RecordTransport final : public ForwardingTransport {
 public:
  RecordTransport(std::unique_ptr<Transport> below, std::shared_ptr<RecordingWriter> writer)
      : ForwardingTransport(std::move(below)), writer_(std::move(writer)) {
    std::array<std::byte, 4> id{};
    const UsbId who = usb_id();
    for (std::size_t i = 0; i < 4; ++i)
      id[i] = static_cast<std::byte>((std::uint32_t{who.vendor} << 16 | who.product) >> (24 - 8 * i) & 0xFFU);
    writer_->add(WireEventKind::kOpened, std::span(id).first(who == UsbId{} ? 0 : 4));
  }

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    auto length = below().read(report, timeout);
    if (length && *length > 0) writer_->add(WireEventKind::kRead, report.first(*length));
    note_loss(length);
    writer_->tick();
    return length;
  }
  Result<void> write(std::span<const std::byte> report) override {
    writer_->add(WireEventKind::kWritten, report);
    auto done = below().write(report);
    note_loss(done);
    return done;
  }
  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    auto length = below().get_feature(id, out);
    if (length && *length > 0) writer_->add(WireEventKind::kFeatureGot, out.first(*length));
    note_loss(length);
    return length;
  }
  Result<void> set_feature(std::span<const std::byte> report) override {
    writer_->add(WireEventKind::kFeatureSet, report);
    auto done = below().set_feature(report);
    note_loss(done);
    return done;
  }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    auto length = below().control(request, data, timeout);
    if (length) writer_->add(WireEventKind::kControl, data.first(*length), request);
    note_loss(length);
    return length;
  }

 private:
  template <class T>
  void note_loss(const Result<T>& result) {
    if (result || lost_ || result.error().kind != ErrorKind::kUnavailable) return;
    lost_ = true;
    writer_->add(WireEventKind::kLost, {});
    writer_->flush();
  }
  std::shared_ptr<RecordingWriter> writer_;
  bool lost_ = false;
};

}  // namespace

Result<std::shared_ptr<RecordingWriter>> RecordingWriter::create(const std::filesystem::path& path,
                                                                 std::string_view driver, std::string_view note,
                                                                 const Clock& clock, bool raw) {
  DUBSAR_ASSIGN(GrowingFile file, GrowingFile::create(path));
  const Recording header{std::string(driver), std::string(note), {}, raw};
  return std::shared_ptr<RecordingWriter>(new RecordingWriter(std::move(file), format_recording(header), raw, clock));
}

RecordingWriter::RecordingWriter(GrowingFile file, std::string header, bool raw, const Clock& clock)
    : file_(std::move(file)),
      raw_(raw),
      clock_(&clock),
      start_(clock.now()),
      pending_(std::move(header)),
      written_(start_) {
  write_out();
}

RecordingWriter::~RecordingWriter() {
  if (!finished_) flush();
}

void RecordingWriter::add(WireEventKind kind, std::span<const std::byte> bytes, const ControlRequest& request) {
  const std::lock_guard lock(mutex_);
  if (!status_ || finished_) return;
  const TimestampNs now = clock_->now();
  pending_ += format_event({now - start_, kind, request, {bytes.begin(), bytes.end()}}, raw_);
  ++event_count_;
  if (kind == WireEventKind::kRead || kind == WireEventKind::kFeatureGot || kind == WireEventKind::kControl)
    ++heard_count_;
  if (pending_.size() >= kPendingBytes || now - written_ >= kPendingNs) write_out();
}

void RecordingWriter::flush() {
  const std::lock_guard lock(mutex_);
  write_out();
}

void RecordingWriter::tick() {
  const std::lock_guard lock(mutex_);
  if (clock_->now() - written_ >= kPendingNs) write_out();
}

Result<void> RecordingWriter::finish() {
  const std::lock_guard lock(mutex_);
  write_out();
  if (status_ && !std::exchange(finished_, true)) status_ = file_.finish();
  return status_;
}

void RecordingWriter::discard() {
  const std::lock_guard lock(mutex_);
  if (status_) status_ = fail(ErrorKind::kUsage, "recording: it was discarded");
  pending_.clear();
  file_.discard();
}

Result<void> RecordingWriter::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::int64_t RecordingWriter::event_count() const {
  const std::lock_guard lock(mutex_);
  return event_count_;
}

std::int64_t RecordingWriter::heard_count() const {
  const std::lock_guard lock(mutex_);
  return heard_count_;
}

void RecordingWriter::write_out() {
  written_ = clock_->now();
  if (pending_.empty()) return;
  if (status_) status_ = file_.append(pending_);
  pending_.clear();
}

std::unique_ptr<Transport> make_record_transport(std::unique_ptr<Transport> below,
                                                 std::shared_ptr<RecordingWriter> writer) {
  return std::make_unique<RecordTransport>(std::move(below), std::move(writer));
}

}  // namespace dubsar
