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
  std::uint32_t presentation_time() const noexcept { return presentation_time_; }  ///< device ticks; 0: none came

  std::uint64_t frames() const noexcept { return frames_; }
  std::uint64_t dropped_frames() const noexcept { return dropped_; }      ///< wrong length, error flag, cut short
  std::uint64_t bad_transfers() const noexcept { return bad_transfers_; } ///< header missing or impossible

 private:
  void begin() noexcept;

  std::size_t frame_bytes_;
  std::vector<std::byte> frame_;
  std::size_t announced_ = 0;  ///< bytes seen of this frame, also those beyond its length
  std::uint32_t presentation_time_ = 0;
  int frame_id_ = -1;  ///< -1: between frames
  bool complete_ = false, spoiled_ = false;
  std::uint64_t frames_ = 0, dropped_ = 0, bad_transfers_ = 0;
};

struct UvcHeader {
  bool frame_id = false;
  bool end_of_frame = false;
  bool error = false;
  std::uint32_t presentation_time = 0;
};
inline constexpr std::size_t kUvcHeaderBytes = 12;  ///< with presentation time and source clock

/// Writes header and as much of `data` as fits into `transfer`; returns the length of the transfer.
std::size_t encode_uvc_transfer(const UvcHeader& header, std::span<const std::byte> data, std::span<std::byte> transfer);

}  // namespace dubsar
