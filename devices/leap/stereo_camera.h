#pragma once
// What all Leap cameras have in common: two infrared pictures in one video stream over USB, a calibration on
// board, exposure and lights. Each kind of camera adds its own requests and its own pixels.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "core/base/system/clock.h"
#include "devices/frame_source.h"
#include "devices/leap/lmc1_calibration.h"
#include "devices/transport/transport.h"
#include "devices/uvc/uvc_protocol.h"

namespace dubsar {

struct StreamCounters {
  std::uint64_t frames = 0, dropped_frames = 0, bad_transfers = 0;
};

class StereoCamera : public FrameSource {
 public:
  /// From the device, in start(); nothing before.
  virtual std::optional<lmc1::Calibration> calibration() const = 0;
  /// Of one eye's pictures, once started.
  virtual int width() const = 0;
  virtual int height() const = 0;
  virtual StreamCounters counters() const = 0;
};

/// One bulk transfer as dubsar asks for it; transports are opened with this size.
inline constexpr std::size_t kStereoTransferBytes = 16384;

/// How one kind of camera is spoken to. prepare() and lights_out() are called by start() and stop(), unpack() by
/// poll().
class StereoCameraKind {
 public:
  virtual ~StereoCameraKind() = default;

  struct Stream {
    int width = 0, height = 0;  ///< of one eye
    std::size_t frame_bytes = 0;
    std::size_t payload_bytes = 0;  ///< as the device agreed; 0: every transfer is a payload
  };
  /// Reads the calibration, commits a video mode, sets exposure and lights.
  virtual Result<Stream> prepare(Transport& transport) = 0;
  virtual const std::optional<lmc1::Calibration>& calibration() const = 0;
  /// `bytes` are stream.frame_bytes; sets pixels, exposure_us and dark, the rest is set already.
  virtual void unpack(std::span<const std::byte> bytes, Frame& frame) = 0;
  virtual void lights_out(Transport& transport) noexcept = 0;
};

/// Which kind the opened device is; asked at each start.
using FindCameraKind = std::function<Result<std::unique_ptr<StereoCameraKind>>(Transport&)>;

/// poll() and wait() read what has come, in their caller's thread. A frame's `time` is that of the clock at its last
/// byte; the clock outlives the camera.
std::unique_ptr<StereoCamera> make_stereo_camera(OpenTransport open, FindCameraKind find, const Clock& clock);

}  // namespace dubsar
