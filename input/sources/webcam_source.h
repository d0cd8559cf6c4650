#pragma once
// A webcam as an input: the head from the face before it, hands when asked for.

#include <functional>
#include <memory>

#include "devices/frame_source.h"
#include "input/input_source.h"

namespace dubsar {

/// Options: device=/dev/video0 (the first usable camera), size=640x480, fps=30; hfov=60 degrees of the
/// picture's width, at=X/Y/Z millimetres of the lens from the panel's centre (10 mm above its upper edge),
/// tilt=degrees downwards; ipd=63 mm between the pupils; models=FOLDER; replay=FOLDER of pictures instead of
/// a camera. Without the face network OpenCV's cascade is used, and note() says so. kUsage, kUnavailable:
/// neither of them is here.
Result<std::unique_ptr<InputSource>> make_webcam_source(const InputConfig& config);

/// The same over any frames; config.options without device, size, fps and replay. `ended`: true when there
/// are no more.
struct WebcamFrames {
  std::unique_ptr<FrameSource> source;
  std::function<bool()> ended{};
};
Result<std::unique_ptr<InputSource>> make_webcam_source_over(WebcamFrames frames, const InputConfig& config);

}  // namespace dubsar
