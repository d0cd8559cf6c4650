#pragma once
// A camera's pictures one after the other, blocking: what the reader thread of a camera works with.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

struct CaptureFormat {
  int width = 640, height = 480;
  double fps = 30.0;
};

class Capture {
 public:
  virtual ~Capture() = default;
  /// Waits for a picture, a second or so at most. RGB, rows top down, no gaps; `width` and `height` as the
  /// device gives them. False: none came in time. kUnavailable: the device is gone.
  virtual Result<bool> read(std::vector<std::uint8_t>& rgb, int& width, int& height) = 0;
};

/// Opens a device node. It may give another size and rate than asked for. kUnavailable, kPermission.
using OpenCapture = Result<std::unique_ptr<Capture>> (*)(const std::string& path, const CaptureFormat& format);

/// What the module with OpenCV's capture code exports under the name "dubsar_capture".
struct CaptureModule {
  int version = kVersion;
  OpenCapture open = nullptr;
  static constexpr int kVersion = 1;
};

/// Loads that module on first use: it lies beside the program, or in ../lib/dubsar from there. Kept out of
/// the program because OpenCV's videoio alone brings 220 libraries, 0.14 s at every start. kUnavailable says
/// what to install. Any thread.
Result<OpenCapture> load_capture();

}  // namespace dubsar
