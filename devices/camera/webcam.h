#pragma once
// A webcam as a source of frames.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/system/clock.h"
#include "devices/camera/capture.h"
#include "devices/device_info.h"
#include "devices/frame_source.h"

namespace dubsar {

struct WebcamOptions {
  std::string path;  ///< "/dev/video0"; empty: the first usable camera, looked for at every start
  CaptureFormat format;
};

/// One reader thread; frames are RGB, one view, with the clock's time when they were complete. A lost camera
/// is a state; start() opens it again, whichever node it has now when no path was given. stop() may have to
/// wait for one picture, a second when the camera is silent. `open` may be called from the thread that calls
/// start(). The clock outlives the source and can be used from the reader thread.
std::unique_ptr<FrameSource> make_camera(
    const WebcamOptions& options,
    std::function<Result<std::unique_ptr<Capture>>(const std::string&, const CaptureFormat&)> open, const Clock& clock);

/// All Video4Linux nodes that deliver pictures, and why one cannot be used. Asks each for its name, starts
/// none. The Leap's own camera is left to its driver. Any thread.
std::vector<DeviceInfo> list_cameras();

}  // namespace dubsar
