#include "devices/leap/uvc_payload.h"

#include <algorithm>
#include <cstring>

namespace dubsar {
namespace {
// bmHeaderInfo, UVC 1.0 section 2.4.3.3
constexpr unsigned kFrameId = 1, kEndOfFrame = 2, kHasPresentationTime = 4, kHasSourceClock = 8, kError = 0x40,
                   kEndOfHeader = 0x80;
}  // namespace

UvcAssembler::UvcAssembler(std::size_t frame_bytes) : frame_bytes_(frame_bytes) { frame_.reserve(frame_bytes); }

void UvcAssembler::begin() noexcept {
  frame_.clear();
  announced_ = 0;
  frame_id_ = -1;
  complete_ = spoiled_ = false;
}

bool UvcAssembler::add(std::span<const std::byte> transfer) {
  if (complete_) begin();
  const std::size_t header = transfer.empty() ? 0 : static_cast<std::size_t>(transfer[0]);
  if (header < 2 || header > transfer.size()) {
    if (!transfer.empty()) ++bad_transfers_;
    spoiled_ = spoiled_ || frame_id_ >= 0;
    return false;
  }
  const auto flags = static_cast<unsigned>(transfer[1]);
  const int id = (flags & kFrameId) != 0 ? 1 : 0;
  if (frame_id_ >= 0 && id != frame_id_) {  // the end of the last frame was lost
    ++dropped_;
    begin();
  }
  frame_id_ = id;
  if ((flags & kError) != 0) spoiled_ = true;

  const auto data = transfer.subspan(header);
  announced_ += data.size();
  const std::size_t room = frame_bytes_ - frame_.size();
  frame_.insert(frame_.end(), data.begin(), data.begin() + static_cast<std::ptrdiff_t>(std::min(room, data.size())));
  if ((flags & kEndOfFrame) == 0) return false;
  if (announced_ != frame_bytes_ || spoiled_) {
    ++dropped_;
    begin();
    return false;
  }
  ++frames_;
  complete_ = true;
  return true;
}

UvcPayloadSplitter::UvcPayloadSplitter(std::size_t payload_bytes, std::size_t buffer_bytes)
    : payload_bytes_(payload_bytes == buffer_bytes ? 0 : payload_bytes), buffer_bytes_(buffer_bytes) {
  held_.reserve(payload_bytes_);
}

std::size_t encode_uvc_transfer(const UvcHeader& header, std::span<const std::byte> data,
                                std::span<std::byte> transfer) {
  if (transfer.size() < kUvcHeaderBytes) return 0;
  const std::size_t bytes = std::min(data.size(), transfer.size() - kUvcHeaderBytes);
  std::fill_n(transfer.begin(), kUvcHeaderBytes, std::byte{0});
  transfer[0] = std::byte{kUvcHeaderBytes};
  transfer[1] = std::byte((header.frame_id ? kFrameId : 0U) | (header.end_of_frame ? kEndOfFrame : 0U) |
                          (header.error ? kError : 0U) | kHasPresentationTime | kHasSourceClock | kEndOfHeader);
  std::memcpy(transfer.data() + 2, &header.presentation_time, sizeof header.presentation_time);
  std::memcpy(transfer.data() + 6, &header.presentation_time, sizeof header.presentation_time);
  if (bytes > 0) std::memcpy(transfer.data() + kUvcHeaderBytes, data.data(), bytes);
  return kUvcHeaderBytes + bytes;
}

}  // namespace dubsar
