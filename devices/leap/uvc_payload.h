#pragma once
// USB Video Class payload headers: bulk transfers in, whole frames out, and back again for simulators.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dubsar {

/// Puts the transfers of one stream together. A frame ends with the end-of-frame flag; it is handed out only if it has
/// exactly the announced length, was neither flagged as an error nor cut short by the next frame (the frame identifier
/// flips between frames). Any bytes may come in.
class UvcAssembler {
 public:
  /// Frames of `frame_bytes`; memory for one is held.
  explicit UvcAssembler(std::size_t frame_bytes);

  /// One bulk transfer as it came. True: frame() is complete and stays until the next call.
  bool add(std::span<const std::byte> transfer);
  std::span<const std::byte> frame() const noexcept { return frame_; }

  std::uint64_t frames() const noexcept { return frames_; }
  std::uint64_t dropped_frames() const noexcept { return dropped_; }       ///< wrong length, error flag, cut short
  std::uint64_t bad_transfers() const noexcept { return bad_transfers_; }  ///< header missing or impossible

 private:
  void begin() noexcept;

  std::size_t frame_bytes_;
  std::vector<std::byte> frame_;
  std::size_t announced_ = 0;  ///< bytes seen of this frame, also those beyond its length
  int frame_id_ = -1;          ///< -1: between frames
  bool complete_ = false, spoiled_ = false;
  std::uint64_t frames_ = 0, dropped_ = 0, bad_transfers_ = 0;
};

/// Cuts what comes from a bulk endpoint into payloads: a payload ends with the device's announced size or with a
/// transfer that does not fill the host's buffer, wherever the buffers end.
class UvcPayloadSplitter {
 public:
  /// `payload_bytes`: dwMaxPayloadTransferSize that the device agreed to, 0: every transfer is a payload.
  /// `buffer_bytes`: of one transfer.
  UvcPayloadSplitter(std::size_t payload_bytes, std::size_t buffer_bytes);

  /// Calls each(payload) for every payload that this transfer completes.
  template <class Each>
  void add(std::span<const std::byte> transfer, const Each& each) {
    if (payload_bytes_ == 0) return each(transfer);
    const bool last = transfer.size() < buffer_bytes_;
    while (!transfer.empty()) {
      const std::size_t count =
          payload_bytes_ - held_.size() < transfer.size() ? payload_bytes_ - held_.size() : transfer.size();
      held_.insert(held_.end(), transfer.begin(), transfer.begin() + static_cast<std::ptrdiff_t>(count));
      transfer = transfer.subspan(count);
      if (held_.size() < payload_bytes_ && !(last && transfer.empty())) continue;
      each(std::span<const std::byte>(held_));
      held_.clear();
    }
  }

 private:
  std::size_t payload_bytes_, buffer_bytes_;
  std::vector<std::byte> held_;
};

struct UvcHeader {
  bool frame_id = false;
  bool end_of_frame = false;
  bool error = false;
  std::uint32_t presentation_time = 0;
};
inline constexpr std::size_t kUvcHeaderBytes = 12;  ///< with presentation time and source clock

/// Writes header and as much of `data` as fits into `transfer`; returns the length of the transfer.
std::size_t encode_uvc_transfer(const UvcHeader& header, std::span<const std::byte> data,
                                std::span<std::byte> transfer);

}  // namespace dubsar
