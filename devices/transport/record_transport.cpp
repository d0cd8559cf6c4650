#include "devices/transport/record_transport.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace dubsar {
namespace {

constexpr std::size_t kPendingBytes = std::size_t{64} << 10;

class RecordTransport final : public Transport {
 public:
  RecordTransport(std::unique_ptr<Transport> below, std::shared_ptr<RecordingWriter> writer)
      : below_(std::move(below)), writer_(std::move(writer)) {
    writer_->add(WireEventKind::kOpened, {});
  }

  Result<std::size_t> read(std::span<std::byte> report, milliseconds timeout) override {
    auto length = below_->read(report, timeout);
    if (length && *length > 0) writer_->add(WireEventKind::kRead, report.first(*length));
    note_loss(length);
    return length;
  }
  Result<void> write(std::span<const std::byte> report) override {
    writer_->add(WireEventKind::kWritten, report);
    auto done = below_->write(report);
    note_loss(done);
    return done;
  }
  Result<std::size_t> get_feature(std::uint8_t id, std::span<std::byte> out) override {
    auto length = below_->get_feature(id, out);
    if (length && *length > 0) writer_->add(WireEventKind::kFeatureGot, out.first(*length));
    note_loss(length);
    return length;
  }
  Result<void> set_feature(std::span<const std::byte> report) override {
    writer_->add(WireEventKind::kFeatureSet, report);
    auto done = below_->set_feature(report);
    note_loss(done);
    return done;
  }
  Result<std::size_t> control(const ControlRequest& request, std::span<std::byte> data, milliseconds timeout) override {
    auto length = below_->control(request, data, timeout);
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
  std::unique_ptr<Transport> below_;
  std::shared_ptr<RecordingWriter> writer_;
  bool lost_ = false;
};

}  // namespace

Result<std::shared_ptr<RecordingWriter>> RecordingWriter::create(const std::filesystem::path& path,
                                                                 std::string_view driver, std::string_view note,
                                                                 const Clock& clock) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    const int error = errno;
    if (error == EACCES || error == EPERM) return fail_errno(error, "cannot write " + path.string());
    return fail(ErrorKind::kCannotCreate, "recording: cannot create {}: {}", path.string(),
                std::generic_category().message(error));
  }
  const Recording header{std::string(driver), std::string(note), {}, false};
  return std::shared_ptr<RecordingWriter>(
      new RecordingWriter(descriptor, path.string(), format_recording(header), clock));
}

RecordingWriter::RecordingWriter(int descriptor, std::string path, std::string header, const Clock& clock)
    : descriptor_(descriptor),
      path_(std::move(path)),
      clock_(&clock),
      start_(clock.now()),
      pending_(std::move(header)) {}

RecordingWriter::~RecordingWriter() {
  flush();
  ::close(descriptor_);
}

void RecordingWriter::add(WireEventKind kind, std::span<const std::byte> bytes, const ControlRequest& request) {
  const std::lock_guard lock(mutex_);
  if (!status_) return;
  pending_ += format_event({clock_->now() - start_, kind, request, {bytes.begin(), bytes.end()}});
  ++event_count_;
  if (pending_.size() >= kPendingBytes) write_out();
}

void RecordingWriter::flush() {
  const std::lock_guard lock(mutex_);
  write_out();
}

Result<void> RecordingWriter::finish() {
  const std::lock_guard lock(mutex_);
  write_out();
  return status_;
}

std::int64_t RecordingWriter::event_count() const {
  const std::lock_guard lock(mutex_);
  return event_count_;
}

void RecordingWriter::write_out() {
  std::string_view left = pending_;
  while (status_ && !left.empty()) {
    const ::ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written > 0)
      left.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      status_ = fail_errno(errno, "cannot write " + path_);
  }
  pending_.clear();
}

std::unique_ptr<Transport> make_record_transport(std::unique_ptr<Transport> below,
                                                 std::shared_ptr<RecordingWriter> writer) {
  return std::make_unique<RecordTransport>(std::move(below), std::move(writer));
}

}  // namespace dubsar
