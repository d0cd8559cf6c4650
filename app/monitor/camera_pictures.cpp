#include "app/monitor/camera_pictures.h"

#include <filesystem>
#include <thread>

#include "core/base/system/clock.h"
#include "devices/camera/capture.h"
#include "devices/camera/picture_frames.h"
#include "devices/camera/webcam.h"

namespace dubsar::app {

Result<VerbResult> watch_camera(const std::string& folder, double seconds, Progress& progress) {
  if (!folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
      return fail(ErrorKind::kCannotCreate, "devices: cannot create the folder {}: {}", folder, error.message());
  }
  const SteadyClock clock;
  DUBSAR_ASSIGN(const OpenCapture open, load_capture());
  const auto camera = make_camera({}, open, clock);
  DUBSAR_TRY(camera->start());
  FrameRecorder recorder(folder);
  Frame frame;
  std::int64_t pictures = 0;
  const TimestampNs start = clock.now(), end = start + static_cast<TimestampNs>(1e9 * seconds);
  while (clock.now() < end && !progress.cancelled() && camera->state() == FrameSourceState::kRunning) {
    if (!camera->poll(frame)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }
    ++pictures;
    if (!folder.empty()) DUBSAR_TRY(recorder.write(frame));
  }
  VerbResult result;
  const double rate = static_cast<double>(pictures) / std::max(1e-3, 1e-9 * static_cast<double>(clock.now() - start));
  result.json = {{"pictures", pictures},          {"per_second", rate},
                 {"width", frame.width},          {"height", frame.height},
                 {"written", recorder.written()}, {"reason", camera->reason()}};
  result.text = fmt::format("{} pictures of {} x {}, {:.1f} a second\n", pictures, frame.width, frame.height, rate);
  if (recorder.written() > 0) result.text += fmt::format("{} in {}\n", recorder.written(), folder);
  if (pictures == 0) {
    result.failure = Error{ErrorKind::kUnavailable,
                           camera->reason().empty() ? "the camera is open and sends nothing" : camera->reason()};
  }
  return result;
}

}  // namespace dubsar::app
