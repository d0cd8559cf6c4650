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

/// Taken when they are met.
struct MadeFaults {
  bool lose_session = false, no_headset = false, recentre = false, end_instance = false;
};

/// Handles that were given and not taken back.
struct MadeHandles {
  int instances = 0, sessions = 0, swapchains = 0, spaces = 0, hand_trackers = 0;
};

/// All that a test may change, and what happened.
struct MadeFacts {
  MadeWearer wearer;
  MadeHands hands;
  MadeFaults faults;
  bool read_pictures = true;
  // What happened.
  std::vector<MadeFrame> frames;
  MadeHandles alive;
  int sessions_ever = 0, wrong_calls = 0;
  const char* binding = "";  ///< "EGL", "GLX"
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
