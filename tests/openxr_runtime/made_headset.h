#pragma once
// An OpenXR runtime of our own for tests: a headset whose wearer moves as a function of time, behind Debian's loader.
// The library is loaded by the loader; a test that opens the same file gets the same headset by made_headset().

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace dubsar::testing {

struct MadePose {
  glm::dvec3 position{0.0};  ///< metres in the LOCAL space
  glm::dquat rotation{1, 0, 0, 0};
};

/// What a call of xrEndFrame brought.
struct MadeFrame {
  std::int64_t predicted = 0, displayed = 0;  ///< what xrWaitFrame said last, and what the application answered
  int layers = 0;
  std::uint64_t layer_flags = 0;
  int blend = 0;  ///< XrEnvironmentBlendMode
  std::array<MadePose, 2> poses{};
  std::array<std::array<float, 4>, 2> fov{};          ///< left, right, up, down
  std::array<std::vector<std::uint8_t>, 2> red{};     ///< the eyes' pictures, rows from below
  std::array<std::optional<glm::dvec2>, 2> bright{};  ///< mean place of pixels lighter than half, from the lower left
};

/// The head turns about the vertical and nods, and sways; times are in seconds.
struct MadeWearer {
  double yaw_amplitude = 0.0, yaw_hz = 0.7, nod_amplitude = 0.0, sway_m = 0.0;
  double yaw_middle = 0.0;                ///< radians, to the left
  glm::dvec3 head_middle{0.0, 0.0, 0.0};  ///< between the eyes
  double eyes_apart_m = 0.064;
  double refresh_hz = 90.0;  ///< pictures a second that the headset shows; not changed while a session runs
  double floor_m = -1.5;
  bool has_floor = true;
};

/// Hands at rest in front of the wearer; while hold_from <= t < hold_to the right one pinches or is a fist, and moves.
struct MadeHands {
  bool right_hand = false, fist = false;
  double hold_from = 0.0, hold_to = 0.0;
  glm::dvec3 hand_from{0.15, -0.2, -0.35}, hand_speed{0.0};  ///< m and m/s from hold_from on
  bool controller = false;
  double squeeze = 0.0;
  MadePose grip{};
};

/// What a runtime may be without.
struct MadeLacks {
  bool newer_api = false;               ///< no instance for an application of more than 1.0
  bool gl = false, gl_session = false;  ///< does not list OpenGL; lists it and begins no session of it
  bool egl = false, hands = false, time = false;
  bool vulkan = false;
};

/// What runtimes do that nobody would expect of a library; seen at real ones or told of them in their trackers.
struct MadeManners {
  std::string gl_error_after;           ///< the call that leaves a GL error behind, e.g. "xrEndFrame"
  std::string context_taken_by;         ///< the call that leaves no GL context current
  bool refuses_gl_errors = false;       ///< takes no picture while a GL error of the application waits
  bool hand_source = false;             ///< tells seen hands from those of controllers
  bool hands_from_controllers = false;  ///< closes fingers round a controller that is held
  bool refuses_trackers = false;        ///< of seen hands, as Monado where it has none
  bool spoils_gl_state = false;
  bool hidden = false;  ///< shows nothing of ours
  MadeLacks lacks;
  int views = 2;  ///< counted under PRIMARY_STEREO
  int eye_px = 240;
  int busy_waits = 0;                                         ///< time-outs before an image is let go, counted down
  int recentre_lead = 0;                                      ///< frames from telling a new middle to having it
  std::vector<int> blends{1};                                 ///< XrEnvironmentBlendMode, the favourite first
  std::vector<std::int64_t> formats{0x881A, 0x8C43, 0x8058};  ///< RGBA16F, SRGB8_ALPHA8, RGBA8
};

/// XrSessionState, for tests that know nothing of OpenXR's headers.
enum class XrState {
  kIdle = 1,
  kReady = 2,
  kSynchronized = 3,
  kVisible = 4,
  kFocused = 5,
  kStopping = 6,
  kExiting = 8
};

/// Taken when they are met.
struct MadeFaults {
  bool lose_session = false, no_headset = false, recentre = false, end_instance = false;
  std::vector<XrState> states;  ///< to be told of, in order
};

/// Handles that were given and not taken back.
struct MadeHandles {
  int instances = 0, sessions = 0, swapchains = 0, spaces = 0, hand_trackers = 0;
};

/// All that a test may change, and what happened.
struct MadeFacts {
  MadeWearer wearer;
  MadeHands hands;
  MadeManners manners;
  MadeFaults faults;
  bool read_pictures = true;
  // What happened.
  std::vector<MadeFrame> frames;
  MadeHandles alive;
  int sessions_ever = 0, instances_ever = 0, wrong_calls = 0;
  const char* binding = "";  ///< "EGL", "GLX", "Vulkan"
  double now_s = 0.0;        ///< of the last xrWaitFrame: its display time
};

/// Hold `mutex` to read or change anything while a session runs.
struct MadeHeadset : MadeFacts {
  std::mutex mutex;
  /// As it was at first; not while an instance is alive.
  void reset() { static_cast<MadeFacts&>(*this) = MadeFacts(); }
};

/// The head at a time, in seconds: the middle between the eyes.
inline MadePose made_head(const MadeFacts& h, double t) {
  const double turn = 2.0 * 3.14159265358979323846 * h.wearer.yaw_hz * t;
  const glm::dquat yaw =
      glm::angleAxis(h.wearer.yaw_middle + h.wearer.yaw_amplitude * std::sin(turn), glm::dvec3(0, 1, 0));
  const glm::dquat nod = glm::angleAxis(h.wearer.nod_amplitude * std::sin(1.3 * turn), glm::dvec3(1, 0, 0));
  return {h.wearer.head_middle +
              glm::dvec3(h.wearer.sway_m * std::sin(0.8 * turn), 0.3 * h.wearer.sway_m * std::cos(turn), 0.0),
          yaw * nod};
}

inline constexpr int kMadeEyePx = 240;

}  // namespace dubsar::testing

extern "C" dubsar::testing::MadeHeadset* made_headset();
