#pragma once
// The one interface behind which every input stands, what it delivers, and how sources are made by their names.

#include <filesystem>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "core/base/text/option_list.h"
#include "devices/device_info.h"
#include "devices/device_spec.h"
#include "devices/touch/touch_sample.h"
#include "devices/transport/hotplug_bell.h"
#include "input/hand_frame.h"
#include "input/hand_grip.h"
#include "input/input_event.h"
#include "input/navigation/view_state.h"

namespace dubsar {

class WindowEvents;
class WornFeed;

/// A head as trackers see it, in the screen frame (panel centre, metres). An eye that was not seen is missing.
struct HeadFrame {
  TimestampNs time = 0;
  std::uint32_t id = 0;
  bool tracked = false;  ///< measured now
  double confidence = 0.0;
  std::optional<glm::dvec3> left_eye_m, right_eye_m;
  bool operator==(const HeadFrame&) const = default;
};

/// Deflection of a six-axis 3D mouse, -1..1 each, axes of the screen frame; it stays until the next report.
struct SpaceMouseMotion {
  TimestampNs time = 0;
  glm::dvec3 push{0.0}, twist{0.0};
  bool operator==(const SpaceMouseMotion&) const = default;
};

/// What a source knows at one moment. Poses are the newest ones; events and touches are all since the last poll, oldest
/// first.
struct InputFrame {
  TimestampNs time = 0;  ///< device time of the newest thing in here
  std::vector<InputEvent> events;
  std::optional<SpaceMouseMotion> space_mouse;
  std::vector<HandFrame> hands;  ///< screen frame, everybody's, at most kMaxHands
  std::vector<HeadFrame> heads;  ///< everybody's
  HandGrips grips{};             ///< of who wears a headset; while one is active, `hands` are only shown
  /// Fingers on a touch panel, whose events the window makes that knows where it is (gestures/touch_pointer.h). They
  /// are not recorded, those events are.
  std::vector<TouchFrame> touches;
};

enum class Freshness {
  kNew,        ///< something was measured since the last poll
  kUnchanged,  ///< nothing new, the last frame still holds
  kLost,       ///< the device is gone or silent; a state, not an error: it may come back
};

class InputSource {
 public:
  virtual ~InputSource() = default;
  virtual std::string_view name() const noexcept = 0;
  /// Opens the device; at most one reader thread, joined by the destructor. Errors: kUnavailable, kPermission with what
  /// to do.
  virtual Result<void> start() = 0;
  /// Never blocks; the newest measurement wins and `newest` keeps its poses when there is none. Call it from one
  /// thread.
  virtual Freshness poll(TimestampNs now, InputFrame& newest) noexcept = 0;
  /// Scripts and recordings come to an end, live devices never do.
  virtual bool has_end() const noexcept { return false; }
  virtual bool finished() const noexcept { return false; }
  /// Makes the present heading "straight on" soon, for trackers whose heading drifts; others do nothing. Any thread.
  virtual void recentre() noexcept {}
  /// One sentence for people: why the device is lost, or what its measurements lack; empty: nothing to say.
  virtual std::string note() const { return {}; }
};

struct InputConfig {
  std::vector<Option> options;           ///< of the one source that is made with it
  WindowEvents* window = nullptr;        ///< where mouse and keyboard come from; none without a window
  std::function<ViewState()> seen_view;  ///< what a simulated visitor looks at; asked in any thread
  /// The session's clock, on which devices stamp what they measure; null: the steady clock. It outlives the source and
  /// may be read in any thread.
  const Clock* clock = nullptr;
  /// The clock is moved by hand: devices are read in poll(), without a thread, so that the same script gives the same
  /// input.
  bool simulated_time = false;
  DeviceOpener reach_device;             ///< how devices are reached; empty: the real ones
  std::filesystem::path model_folder;    ///< networks that ./do models fetched; empty: none
  glm::dvec2 panel_m{0.344, 0.194};      ///< width and height of the whole panel; a webcam sits on its top edge
  std::shared_ptr<WornFeed> worn;        ///< of the headset that pictures are made for; none without one
  std::shared_ptr<HotplugBell> hotplug;  ///< shared by the sources of a session; null: lost devices come back by pauses
};

/// Names of all sources, in the order of their priority when several see hands or heads: those of a window, of the
/// table of drivers, of programs and files. Needs dubsar_input_sources, as what follows does.
std::vector<std::string_view> input_source_names();

/// Specs for make_input() of what a session takes beside its window's mouse and keyboard when its user names nothing:
/// of these devices, those that can be used, as "spacemouse", "head:rift" ...; never services, servers, cameras,
/// simulations. `whole_screen`: the session covers its monitor, and may have for itself what is on it.
std::vector<std::string> present_inputs(const std::vector<DeviceInfo>& present, bool whole_screen = false);
/// The same for this machine; takes some milliseconds.
std::vector<std::string> present_inputs(bool whole_screen = false);

/// Makes and starts the source that "NAME[:option,...]" names (source_spec.h): kUsage with the names there are or what
/// the options are. `base` holds what the text cannot say.
Result<std::unique_ptr<InputSource>> make_input(std::string_view spec, const InputConfig& base = {});

}  // namespace dubsar
