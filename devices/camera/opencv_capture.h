#pragma once
// Cameras through OpenCV's Video4Linux code, for those that are linked with it.

#include "devices/camera/capture.h"

namespace dubsar {

/// See OpenCapture. Asks for MJPG; takes what the camera has.
Result<std::unique_ptr<Capture>> open_opencv_capture(const std::string& path, const CaptureFormat& format);

}  // namespace dubsar
