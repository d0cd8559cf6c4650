#pragma once
// A head-mounted display, as the displays of this program see it: when the next picture is wanted, where the eyes will
// be then, and what the wearer's hands do. OpenXR stays behind this door (headset/openxr_*.cpp).

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/numbers/pose.h"
#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "display/render/images/surface.h"

namespace dubsar {

class ViewArray;

/// Where an eye looks from, and the tangents of what it sees: left and down are below 0.
struct HeadsetEye {
  Pose pose{};
  double left = -1.0, right = 1.0, down = -1.0, up = 1.0;
};

/// Metres, +X right, +Y up, -Z forwards, in one frame that stays where the room is.
struct WornJoint {
  Pose pose{};
  double radius_m = 0.0;
  bool valid = false, tracked = false;
};

/// The 26 joints in the order of XR_EXT_hand_tracking.
struct WornHand {
  bool active = false;
  std::array<WornJoint, 26> joints{};
};

struct WornController {
  bool active = false;  ///< held, and seen
  Pose grip{};
  double squeeze = 0.0;  ///< 0..1
  bool select = false;
};

/// What is known of the wearer at the moment that a picture is made for; [0] left, [1] right.
struct WearerFrame {
  TimestampNs time = 0;       ///< when the picture is begun, steady clock
  TimestampNs displayed = 0;  ///< when its light reaches the eyes; everything is predicted for then
  std::array<HeadsetEye, 2> eyes{};
  std::array<WornHand, 2> hands{};
  std::array<WornController, 2> controllers{};
  std::optional<double> floor_m;  ///< height of the floor
  bool recentred = false;         ///< the wearer asked for a new middle since the last picture
};

/// Calls from the thread of one GL context, which is current and outlives it.
class Headset {
 public:
  virtual ~Headset() = default;

  /// "NAME VERSION" of the runtime, and the device's own name.
  virtual std::string runtime() const = 0;
  virtual std::string device() const = 0;
  virtual PixelSize eye_size() const = 0;  ///< what the runtime recommends
  virtual bool has_hands() const = 0;

  /// The next picture's moment: waits for its turn (about one refresh). Nothing while nobody wears the headset, the
  /// session is not ready or was lost; it is tried again by itself, reason() says why. A picture that was begun and not
  /// ended is given back empty.
  virtual std::optional<WearerFrame> begin() = 0;
  /// Hands in layers 0 and 1 for the eyes of the last begin(). Errors are those of GL; a session that is lost is none.
  virtual Result<void> end(const ViewArray& views) = 0;
  virtual std::string reason() const = 0;  ///< why begin() gave nothing; empty: it gave something
};

/// The headset that this machine's OpenXR runtime has. kUnavailable, with what to do: no loader in this build, no
/// runtime, no headset, no OpenGL. Needs no GL context yet.
Result<std::unique_ptr<Headset>> open_headset();

/// One sentence for `dubsar doctor`: the runtime and what it can, or why there is none.
struct HeadsetFacts {
  bool present = false;
  std::string words;
};
HeadsetFacts headset_facts();

}  // namespace dubsar
