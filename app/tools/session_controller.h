#pragma once
// Who leads a session besides those that steer it, such as a gallery: it sees what happens, says what lies over the
// picture, and may let the object move by itself.

#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/document.h"
#include "app/document/gallery_picture.h"
#include "app/stage/object_places.h"
#include "app/steering/input_controller.h"
#include "app/steering/source_set.h"
#include "display/render/scene.h"

namespace dubsar::app {

struct SessionMoment {
  TimestampNs now = 0;
  const Steered& steered;
  const Document& document;
  std::span<const SourceRow> sources;
  glm::dvec2 window_mm{1.0}, middle_mm{0.0};  ///< what the panel shows across, and its middle in the screen frame
  std::span<const ScreenRect> objects{};      ///< where what is shown stands, one or more that stand apart
  std::string_view trouble{};                 ///< a panel of the session that cannot be shown now, in words
  bool surface = true;                        ///< the document is that of a surface; false: it is being read
  bool on_screen = true;                      ///< the panel's window is on the screen; false: something has hidden it
};

/// What is shown in place of the document's own state, such as a step of a tour.
struct GuidedScene {
  Keyframe frame{};
  bool camera = true;         ///< its camera and light as well; false: those of whoever steers
  bool keep = false;          ///< now, once: the document becomes this, and hands go on from here
  std::vector<Note> notes{};  ///< on the surface, while it is shown
};

struct Guidance {
  std::vector<std::string> commands{};      ///< done now
  glm::dquat turn{1.0, 0.0, 0.0, 0.0};      ///< the object is turned this much further in this picture
  std::vector<LinesItem> lines{};           ///< in the screen frame, mm
  Glow glow{};                              ///< on the object; in the screen frame
  std::optional<GuidedScene> scene{};       ///< none: the document
  std::optional<GalleryPicture> picture{};  ///< over everything else; none: what there always is
  GestureScene gestures{};                  ///< what hands may do
  bool end = false;                         ///< the session is over
};

/// One thread: that of the session.
class SessionController {
 public:
  virtual ~SessionController() = default;
  /// True: the event is the guide's, nobody else sees it.
  virtual bool takes(const InputEvent& event, TimestampNs now) = 0;
  virtual Guidance lead(const SessionMoment& moment) = 0;
  /// A picture is on the panel.
  virtual void presented(TimestampNs now) = 0;
};

}  // namespace dubsar::app
