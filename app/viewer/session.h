#pragma once
// The join: input to navigation to cameras to renderer to sink. Owns nothing of a window; whoever has one gives the
// surface, without one there are pictures in memory.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/clock.h"
#include "core/base/result.h"
#include "core/image_io/image.h"
#include "core/mesh/tri_mesh.h"
#include "display/optics/off_axis.h"
#include "display/optics/optics.h"
#include "display/render/camera.h"
#include "display/render/shading.h"
#include "display/sinks/sink_catalog.h"
#include "input/mixer.h"
#include "input/navigation/mapping.h"
#include "input/navigation/view_state.h"
#include "input/people/head_follower.h"

namespace dubsar {
class ViewArray;
}

namespace dubsar::app {

enum class Quality {
  kExact,     ///< all triangles and samples in every picture
  kAdaptive,  ///< coarse views while things move, where exact ones take longer than budget_ms or nobody knows yet what
              ///< they take, and while the window's size changes; exact ones at rest
};

struct SessionOptions {
  SinkSpec display{"mono"};
  /// Displays and panels that may be named; who owns it, too, may put other figures into it and set the display again.
  std::shared_ptr<SinkCatalog> catalog = std::make_shared<SinkCatalog>();
  std::filesystem::path model_folder{};  ///< networks of the webcam source; empty: none
  Screen screen{};                       ///< in an offscreen session, what the sink does not know better
  Viewer viewer{};                       ///< where the eyes are while no head is tracked
  Shading shading{};
  ViewDirection direction{};  ///< the front of the home view
  double margin = 0.08;       ///< free border around the object at zoom 1
  int samples = 1;            ///< samples x samples a pixel
  Mapping mapping{};
  Quality quality = Quality::kExact;
  double budget_ms = 14.0;     ///< kAdaptive: for the views of one picture
  bool stereo_window = false;  ///< the target has a left and a right buffer
  double magnification = 0.0;  ///< 1: life size at zoom 1; 0: as large as fits
  bool pattern = false;        ///< numbered views (display/render/test_pattern.h) in place of the mesh
};

/// Draws over all views before they are composed, so that it stands at the same place for both eyes: on the panel's
/// plane.
class LayerPainter {
 public:
  virtual ~LayerPainter() = default;
  /// `window_mm` is what the panel shows across; pixels of a layer need not be square on it.
  virtual Result<void> paint(ViewArray& layers, const glm::dvec2& window_mm) = 0;
};

/// What went into one frame. Times are those of the clock that draw() is called with.
struct FrameReport {
  ViewState view{};
  Viewer viewer{};  ///< the eyes that cameras were made for
  Presence head = Presence::kOff;
  Control control = Control::kNone;
  bool moving = false;                   ///< the view, the eyes or the light are not where they were painted last
  std::optional<TimestampNs> input_age;  ///< device time of the newest measurement to the cameras; none: nothing new
  std::optional<PanelLight> light;       ///< where the panel's lenses send this picture, for displays with lenses
  std::optional<glm::dvec3> selected_m;  ///< a dwelling hand chose this place
};

/// One thread: that of the GL context, which must be current in every call and outlive the session. Only steer() and
/// input() may be called from another thread, too.
class Session {
 public:
  /// kUnavailable without GL 4.5 or for a sink that needs a stereo visual; kUsage, kBadData, kTryAgain as pack_mesh(),
  /// SinkCatalog::make(). `sink` is what options.display names, where somebody made it already.
  static Result<std::unique_ptr<Session>> create(const TriMesh& mesh, const SessionOptions& options,
                                                 std::unique_ptr<OutputSink> sink = nullptr);
  ~Session();

  /// Sources and the sink may be changed while it runs.
  InputMixer& input() noexcept;
  Result<void> set_display(const SinkSpec& spec);
  Result<void> set_screen(const Screen& screen);
  SinkTraits traits() const;

  /// Polls the input at `now` and moves the view on. Gestures want 60 and more of these a second, however long pictures
  /// take: a session in real time calls it from a thread of its own. Cheap: no GL.
  void steer(TimestampNs now);
  /// Told all input that comes, in the thread and at the time of the poll. Set it before there are sources.
  void on_input(std::function<void(TimestampNs now, const InputFrame& frame)> told);
  /// steer(), and what the next picture shall show: cameras are for `display_time`, when it will be seen. Cheap: no GL.
  FrameReport poll(TimestampNs now, TimestampNs display_time);
  /// True when paint() would make another picture than it did last: something moved by more than 0.05 mm of an eye, the
  /// overlay or the display changed, or views are still coarse and things rest.
  bool needs_paint() const noexcept;
  /// Renders the views of the last poll() and composes them on `target`: the field that is due, where traits() has two.
  Result<void> paint(const Surface& target, Field field = Field::kFirst);
  /// Where the panel's lenses send what was painted last.
  std::optional<PanelLight> light() const;
  /// poll() and paint(), whatever changed.
  Result<FrameReport> draw(TimestampNs now, TimestampNs display_time, const Surface& target,
                           Field field = Field::kFirst);

  /// Drawn over the views from the next paint() on; call it again when it looks different. Null: nothing. It outlives
  /// the session or is taken away.
  void set_overlay(LayerPainter* painter);
  int coarse_views() const noexcept;  ///< of the last picture; 0: all are exact

  /// The view of the last poll(); a simulated visitor looks at it. The reference is good as long as the session.
  const ViewState& view() const noexcept;

 private:
  struct Parts;
  explicit Session(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// screen_from_model for a view: the object fitted by `magnification`, turned, zoomed and moved; pan counts heights of
/// the window, `window_height_mm`, from `middle_mm`, the place of the window's middle on the panel.
glm::dmat4 screen_from_model(const Box& box, const ViewDirection& direction, const ViewState& view,
                             double magnification, double window_height_mm, const glm::dvec2& middle_mm = {0.0, 0.0});

}  // namespace dubsar::app
