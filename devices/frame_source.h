#pragma once
// Pictures from a device: webcams deliver one view per frame, stereo infrared cameras two.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/clock.h"

namespace dubsar {

enum class PixelFormat : std::uint8_t { kGray8, kRgb8 };

constexpr int bytes_per_pixel(PixelFormat format) noexcept { return format == PixelFormat::kRgb8 ? 3 : 1; }

/// One moment seen by all cameras of a device: views one after the other (left, right), rows top down, no padding.
struct Frame {
  TimestampNs time = 0;        ///< when the last byte arrived, or the device's own time where it has one
  std::uint64_t sequence = 0;  ///< counts frames of this source from 1; gaps are frames that nobody asked for
  int width = 0, height = 0;   ///< of one view
  int views = 1;
  PixelFormat format = PixelFormat::kGray8;
  int exposure_us = 0;  ///< 0: unknown
  bool dark = false;    ///< taken without the device's own light
  std::vector<std::uint8_t> pixels;

  std::size_t view_bytes() const noexcept {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(bytes_per_pixel(format));
  }
  std::span<const std::uint8_t> view(int which) const noexcept {
    return std::span(pixels).subspan(static_cast<std::size_t>(which) * view_bytes(), view_bytes());
  }
};

enum class FrameSourceState { kStopped, kRunning, kLost };

/// A device that delivers frames. start, stop and poll from one thread.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;  ///< stops

  /// Opens the device and starts at most one reader thread. A source that lost its device can be started again.
  virtual Result<void> start() = 0;
  /// Joins the reader thread; the device is released.
  virtual void stop() noexcept = 0;

  /// Never blocks for a frame. True: `newest` is a frame that this function has not returned before; older ones that
  /// arrived meanwhile are gone. `newest` lends its memory to the source, so keep handing in the same object.
  virtual bool poll(Frame& newest) = 0;

  /// poll() that waits at most `timeout` for such a frame.
  virtual bool wait(Frame& newest, std::chrono::milliseconds timeout) = 0;

  /// A lost device is a state, not an error; reason() is one sentence for people.
  virtual FrameSourceState state() const = 0;
  virtual std::string reason() const = 0;
};

}  // namespace dubsar
