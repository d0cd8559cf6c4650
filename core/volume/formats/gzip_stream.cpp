#include "core/volume/formats/gzip_stream.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace dubsar {

struct GzipStream::State {
  z_stream stream{};
  std::vector<Bytef> input = std::vector<Bytef>(1 << 18);
  bool started = false;
  ~State() {
    if (started) inflateEnd(&stream);
  }
};

GzipStream::GzipStream(InputFile file, std::int64_t offset)
    : file_(std::move(file)), begin_(offset), at_(offset), state_(std::make_unique<State>()) {}
GzipStream::GzipStream(GzipStream&&) noexcept = default;
GzipStream::~GzipStream() = default;

Result<void> GzipStream::rewind() {
  at_ = begin_;
  state_ = std::make_unique<State>();
  return {};
}

Result<void> GzipStream::read(std::span<std::byte> out) {
  const auto damaged = [&](const char* what) {
    return fail(ErrorKind::kBadData, "gzip: {} {}; the file is damaged or truncated", file_.path().string(), what);
  };
  z_stream& stream = state_->stream;
  constexpr int kGzipOrZlib = 15 + 32;
  if (!state_->started) {
    if (inflateInit2(&stream, kGzipOrZlib) != Z_OK) return fail(ErrorKind::kTryAgain, "gzip: out of memory");
    state_->started = true;
  }
  while (!out.empty()) {
    if (stream.avail_in == 0) {
      const auto count = static_cast<std::size_t>(
          std::clamp<std::int64_t>(file_.size() - at_, 0, static_cast<std::int64_t>(state_->input.size())));
      if (count == 0) return damaged("ends before the last voxel");
      DUBSAR_TRY(file_.read_at(at_, std::as_writable_bytes(std::span(state_->input)).first(count)));
      at_ += static_cast<std::int64_t>(count);
      stream.next_in = state_->input.data();
      stream.avail_in = static_cast<uInt>(count);
    }
    const auto wanted = static_cast<uInt>(std::min<std::size_t>(out.size(), std::numeric_limits<uInt>::max()));
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = wanted;
    const int status = inflate(&stream, Z_NO_FLUSH);
    out = out.subspan(wanted - stream.avail_out);
    if (status == Z_STREAM_END && !out.empty()) {
      // gzip files may be concatenated
      if (inflateReset(&stream) != Z_OK || (stream.avail_in == 0 && at_ >= file_.size()))
        return damaged("ends before the last voxel");
    } else if (status != Z_OK && status != Z_STREAM_END) {
      return damaged("cannot be unpacked");
    }
  }
  return {};
}

}  // namespace dubsar
