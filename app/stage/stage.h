#pragma once
// What a session draws with: the surface in graphics memory, the display, and what lies over the picture. It is told
// what to show and paints it; it knows nothing of input, windows or documents.

#include <memory>
#include <optional>

#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "core/compare/surface_difference.h"
#include "core/image_io/image.h"
#include "core/mesh/tri_mesh.h"
#include "display/optics/off_axis.h"
#include "display/optics/optics.h"
#include "display/render/camera.h"
#include "display/render/scene.h"
#include "display/render/shading.h"
#include "display/sinks/catalog/sink_catalog.h"
#include "display/sinks/view_pictures.h"
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

enum class Subject {
  kSurface,
  kLater,    ///< there may be no surface yet, set_mesh() brings it; until then the ground is shown
  kPattern,  ///< numbered views (display/render/images/test_pattern.h) in place of the mesh
};

/// What the object may take up.
struct StageRoom {
  double margin = 0.08;  ///< free border around it at zoom 1
  /// Words and buttons stand beside the object (gallery_room()), and what nobody has seen is paler clay, not blue.
  bool gallery = false;
  /// Degrees that the eyes may converge more or less than on the panel (display/optics/comfort.h): what would be deeper
  /// makes the picture flatter. 0: as deep as things are. Worn displays show the world as it is.
  double most_parallax_deg = 0.0;
};

struct StageOptions {
  SinkSpec display{"mono"};
  /// Displays and panels that may be named; who owns it, too, may put other figures into it and set the display again.
  std::shared_ptr<SinkCatalog> catalog = std::make_shared<SinkCatalog>();
  Screen screen{};    ///< without a window, what the sink does not know better
  Observer viewer{};  ///< where the eyes are while no head is tracked
  Shading shading{};
  std::string style = "relief";  ///< the name of the shading's style and light
  ViewDirection direction{};     ///< the front of the home view
  StageRoom room{};
  int samples = 1;  ///< samples x samples a pixel
  Quality quality = Quality::kExact;
  double budget_ms = 14.0;     ///< kAdaptive: for the views of one picture
  bool stereo_window = false;  ///< the target has a left and a right buffer
  double magnification = 0.0;  ///< 1: life size at zoom 1; 0: as large as fits
  Subject subject = Subject::kSurface;
  std::shared_ptr<const ViewPictures> pictures{};  ///< these in place of the mesh
};

/// What stands on and around the surface: measures, notes. In mm of the model.
struct Marks {
  std::vector<LinesItem> lines;
  std::vector<LabelItem> labels;
  bool operator==(const Marks&) const = default;
};

/// What a picture shows besides what the stage was made with.
struct Shown {
  ViewState view{};
  double fit = 1.0;  ///< times the size that fits at zoom 1: parts that stand apart need more room
  Style style{};
  OtherLook other{};
  PartLooks parts{};
  std::optional<Light> light{};    ///< but for its place, which is the view's; none: the stage's own
  std::vector<ClipPlane> clips{};  ///< besides the stage's own; in the model's frame
  Fog fog{};                       ///< none: the stage's own
  Marks marks{};
  std::vector<LinesItem> before{};  ///< people's hands: mm of the screen frame
  Glow glow{};                      ///< where one would take hold, in the screen frame
  /// Another one in the left half of every view, this one in the right half (above and below where the panel is
  /// upright); null: this one alone. What that shows beside it is not looked at.
  std::shared_ptr<const Shown> compared{};
  /// What `compared` is of, where it is another surface: the stage's own comes first then, and both are of one scale.
  std::shared_ptr<const TriMesh> surface{};
  std::optional<LabelItem> caption{};  ///< of a half, below what is in it; the stage knows its place
  bool lens_zoom = true;               ///< of one view: as Stage::camera_mm() says; false: the eyes stay where they are
  friend bool operator==(const Shown& a, const Shown& b) {
    return a.light == b.light && a.clips == b.clips && a.fog == b.fog && a.marks == b.marks && a.before == b.before &&
           a.glow == b.glow && a.view.rotation == b.view.rotation && a.view.zoom == b.view.zoom &&
           a.view.pan == b.view.pan && a.view.nearer == b.view.nearer &&
           a.view.light_azimuth_deg == b.view.light_azimuth_deg &&
           a.view.light_elevation_deg == b.view.light_elevation_deg && a.fit == b.fit && a.style == b.style &&
           a.other == b.other && a.parts == b.parts && a.lens_zoom == b.lens_zoom && a.surface == b.surface &&
           a.caption == b.caption && !a.compared == !b.compared && (!a.compared || *a.compared == *b.compared);
  }
};

/// What stands over the surface in its own depth, in every view where it is there.
struct Magnifier {
  glm::dvec3 at_mm{0.0};  ///< of the model
  double factor = 3.0;    ///< 2 to 8
  double size = 0.34;     ///< across, of the view's height
  friend bool operator==(const Magnifier&, const Magnifier&) = default;
};
struct OverlayMarks {
  std::optional<Magnifier> magnifier{};
  std::optional<glm::dvec3> cursor_mm{};  ///< of the model
  bool any() const noexcept { return magnifier || cursor_mm; }
  friend bool operator==(const OverlayMarks&, const OverlayMarks&) = default;
};

/// Draws over all views before they are composed, so that it stands at the same place for both eyes: on the panel's
/// plane.
class LayerPainter {
 public:
  virtual ~LayerPainter() = default;
  /// `window_mm` is what the panel shows across; pixels of a layer need not be square on it.
  virtual Result<void> paint(ViewArray& layers, const glm::dvec2& window_mm) = 0;
};

/// One thread: that of the GL context, which must be current in every call and outlive the stage.
class Stage {
 public:
  /// `mesh` outlives it. kUnavailable without GL 4.5 or for a sink that needs a stereo visual; kUsage, kBadData,
  /// kTryAgain as pack_mesh(), SinkCatalog::make(). `sink` is what options.display names, where somebody made it
  /// already.
  static Result<std::unique_ptr<Stage>> create(const TriMesh& mesh, const StageOptions& options,
                                               std::unique_ptr<OutputSink> sink = nullptr);
  ~Stage();

  /// Another surface, which outlives it, in the place of the present one. Errors of create(); then nothing changes.
  Result<void> set_mesh(const TriMesh& mesh);

  /// May be changed at any time; when one fails nothing changes.
  Result<void> set_display(const SinkSpec& spec);
  Result<void> set_screen(const Screen& screen);
  /// Of worn displays: the object is put before the wearer anew.
  void recentre();
  /// Each eye gets the other's view. kUnavailable for displays that have not two views.
  Result<void> swap_eyes();
  SinkTraits traits() const;
  /// Where the eyes of somebody are expected whom nobody sees, metres in the screen frame.
  glm::dvec3 rest_m() const;

  /// What the next picture shows, at `now`.
  void show(const Shown& shown, const FollowedEyes& eyes, TimestampNs now);
  const Shown& shown() const noexcept;
  /// Whether it differs from the last picture: an eye moved by more than 0.05 mm, or anything else.
  bool moved() const noexcept;
  /// True when paint() would make another picture than it did last: moved(), the overlay or the display changed, or
  /// views are still coarse and things rest; after work() only where it made one exact.
  bool needs_paint() const noexcept;
  /// Does a piece of what is to be made exact while things rest, of some milliseconds: true when more is left that is
  /// not to be seen yet. Between show() and paint(); who does not call it gets the piece from paint().
  Result<bool> work();
  /// Renders the views and composes them on `target`: the field that is due, where traits() has two.
  Result<void> paint(const Surface& target, Field field = Field::kFirst);

  const Observer& viewer() const noexcept;  ///< where the eyes are
  /// Between the eyes that cameras are made for. A picture of one view is enlarged by its zoom as a whole, as a lens
  /// does it: its camera stands so many times farther away, so that what is near does not swell, and nobody gets into
  /// the clay.
  glm::dvec3 camera_mm() const;
  std::optional<PanelLight> light() const;  ///< where the panel's lenses send what was painted last
  int coarse_views() const noexcept;        ///< of the last picture; 0: all are exact
  /// Of worn displays: who wears it, as of the last paint(), in the screen frame; and why nobody does.
  std::optional<WearerFrame> wearer() const;
  std::string display_note() const;
  bool display_ended() const;  ///< who wears the display chose to end
  /// Drawn over the views from the next paint() on; call it again when it looks different. Null: nothing. It outlives
  /// the stage or is taken away.
  void set_overlay(LayerPainter* painter);

  /// How far the stage's surface is from the one beside it, where its colours tell it; none: not known yet.
  const SurfaceDifference* difference() const noexcept;
  /// How much of the surface has been measured, 0..1, while what is shown waits for it; none: nothing is measured.
  std::optional<double> measuring() const noexcept;

  /// Drawn over the pictures from the next paint() on; what is under the glass is exact.
  void set_overlay_marks(const OverlayMarks& marks);
  /// Where the middle of the eyes sees the surface at a place of the window (heights of it from its middle, y up), in
  /// mm of the model; none: there is none. Draws that pixel alone. Errors of the renderer.
  Result<std::optional<glm::dvec3>> place_at(const glm::dvec2& at);

  /// The object as the next picture shows it, without what lies over it, at `factor` times the pixels of a view, exact;
  /// seen from the middle of the eyes. kUsage: more than 16384 pixels on a side; kTryAgain: also while figures that its
  /// colours tell are being measured.
  Result<Image> still(int factor);

  /// `shown` as small as a thumbnail, with as many triangles as that needs; what the stage shows stays as it is.
  /// Between a coarse picture and its exact one it is refused (kTryAgain).
  Result<Image> thumbnail(const Shown& shown, int height);

  /// Where the object stands that was shown last: from mm of the model to mm of the screen.
  glm::dmat4 screen_from_model() const;
  /// Of what it was made with, in the model's frame.
  const Box& box_mm() const noexcept;
  /// What the panel shows across, mm, and its middle.
  glm::dvec2 window_mm() const noexcept;
  glm::dvec2 middle_mm() const noexcept;

 private:
  struct Parts;
  explicit Stage(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// screen_from_model for a view: the object fitted by `magnification`, turned, zoomed and moved; pan counts heights of
/// the window, `window_height_mm`, from `middle_mm`, the place of the window's middle on the panel.
glm::dmat4 screen_from_model(const Box& box, const ViewDirection& direction, const ViewState& view,
                             double magnification, double window_height_mm, const glm::dvec2& middle_mm = {0.0, 0.0});

}  // namespace dubsar::app
