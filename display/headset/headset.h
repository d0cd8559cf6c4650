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
  TimestampNs period = 0;         ///< between two pictures of the headset
  bool seen = true;               ///< false: the runtime shows no picture of ours now, so none need be made
  bool recentred = false;         ///< the wearer asked for a new middle since the last picture
};

/// How pictures lie over the room that a see-through headset shows.
enum class SeeThrough { kNo, kAlpha, kAdditive };

/// Through what pictures reach the runtime: OpenGL, and Vulkan where it takes none; or one of them.
enum class SessionGraphics { kAny, kGl, kVulkan };

struct HeadsetWish {
  SeeThrough see_through = SeeThrough::kNo;
  SessionGraphics graphics = SessionGraphics::kAny;
};

/// Calls from the thread of one GL context, which is current and outlives it.
class Headset {
 public:
  virtual ~Headset() = default;

  /// Pixels of an eye's picture as the runtime recommends them; of the newest headset after a loss. 0 x 0 before the
  /// first was found.
  virtual PixelSize eye_size() const = 0;

  /// The next picture's moment: waits for its turn (about one refresh). Nothing while there is no runtime or headset,
  /// nobody wears it, the session is not ready or was lost; it is tried again by itself, reason() says why. A picture
  /// that was begun and not ended is given back empty.
  virtual std::optional<WearerFrame> begin() = 0;
  /// Hands in layers 0 and 1 for the eyes of the last begin(). Errors are ours of GL; those that the runtime leaves
  /// are dropped, and a session that is lost is none.
  virtual Result<void> end(const ViewArray& views) = 0;
  virtual std::string reason() const = 0;  ///< why begin() gave nothing; empty: it gave something
  /// The wearer chose "quit" in the runtime's menu. A new session is asked for 10 s later: who shows things for one
  /// person ends before, a gallery waits for the next wearer.
  virtual bool ended() const { return false; }
};

/// The headset that this machine's OpenXR runtime has, or will have. Nothing is opened before begin(): a runtime that
/// is started later is found then. kUnavailable: no loader in this build.
Result<std::unique_ptr<Headset>> make_headset(const HeadsetWish& wish = {});

/// One sentence for `dubsar doctor`: the runtime and what it can, or why there is none. Loads other people's code: ask
/// in a process of its own.
struct HeadsetFacts {
  bool present = false;
  std::string words;
};
HeadsetFacts headset_facts();

}  // namespace dubsar
