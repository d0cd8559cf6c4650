#pragma once
// The join: input to navigation to cameras to renderer to sink. Owns nothing of a window; whoever has one gives the
// surface, without one there are pictures in memory.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/clock.h"
#include "core/base/result.h"
#include "core/image_io/image.h"
#include "core/surface/tri_mesh.h"
#include "display/camera.h"
#include "display/off_axis.h"
#include "display/optics.h"
#include "display/output_sink.h"
#include "display/shading.h"
#include "input/head_follower.h"
#include "input/mapping.h"
#include "input/mixer.h"
#include "input/view_state.h"

namespace dubsar::app {

struct SessionOptions {
  std::string display = "mono";            ///< as make_sink() reads it
  std::filesystem::path profile_folder{};
  Screen screen{};                         ///< in an offscreen session, what the sink does not know better
  Viewer viewer{};                         ///< where the eyes are while no head is tracked
  Shading shading{};
  ViewDirection direction{};               ///< the front of the home view
  double margin = 0.08;                    ///< free border around the object at zoom 1
  int samples = 1;                         ///< samples x samples a pixel
  Mapping mapping{};
};

/// What went into one frame. Times are those of the clock that draw() is called with.
struct FrameReport {
  ViewState view{};
  Viewer viewer{};                         ///< the eyes that cameras were made for
  Presence head = Presence::kOff;
  Control control = Control::kNone;
  std::optional<TimestampNs> input_age;    ///< device time of the newest measurement to the cameras; none: nothing new
  std::optional<PanelLight> light;         ///< where the panel's lenses send this picture, for displays with lenses
  std::optional<glm::dvec3> selected_m;    ///< a dwelling hand chose this place
};

/// One thread: that of the GL context, which must be current in every call and outlive the session.
class Session {
 public:
  /// kUnavailable without GL 4.5 or for a sink that needs a stereo visual; kUsage, kBadData, kTryAgain as pack_mesh(),
  /// make_sink().
  static Result<std::unique_ptr<Session>> create(const TriMesh& mesh, const SessionOptions& options);
  ~Session();

  /// Sources and the sink may be changed while it runs.
  InputMixer& input() noexcept;
  Result<void> set_display(std::string_view spec);
  Result<void> set_screen(const Screen& screen);
  SinkTraits traits() const;

  /// Polls the input at `now`, moves the view on, makes the cameras for `display_time` (when the picture will be seen),
  /// renders all views and composes them on `target`.
  Result<FrameReport> draw(TimestampNs now, TimestampNs display_time, const Surface& target);

  /// The newest view; a simulated visitor looks at it. The reference is good as long as the session.
  const ViewState& view() const noexcept;
  /// What draw() got from the input last, for recordings.
  const InputFrame& last_input() const noexcept;

 private:
  struct Parts;
  explicit Session(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// screen_from_model for a view: the object fitted by `magnification`, turned, zoomed and moved; pan counts heights of
/// the window, `window_height_mm`.
glm::dmat4 screen_from_model(const Box& box, const ViewDirection& direction, const ViewState& view, double magnification,
                             double window_height_mm);

}  // namespace dubsar::app
