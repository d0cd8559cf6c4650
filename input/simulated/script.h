#pragma once
// A script: what simulated people do before the display, as data. Read from JSON, or built by tests.

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "input/hand_frame.h"
#include "input/input_event.h"

namespace dubsar {

/// Random numbers that are the same everywhere (the distributions of the standard library are not).
class ScriptRandom {
 public:
  explicit ScriptRandom(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Sum of 12 uniforms: mean 0, standard deviation 1, at most 6.
  double normal();

 private:
  std::mt19937_64 engine_;
};

/// Between keys a hand or head moves on a straight line, starting and ending at rest (smooth step).
struct HandKey {
  double t_s = 0;
  glm::dvec3 at_m{0.0};  ///< palm, screen frame
  double grab = 0;       ///< 0..1
  double pinch_m = 0.06;
};
struct HandTrack {
  Chirality chirality = Chirality::kRight;
  glm::dvec3 shoulder_m{0.2, -0.2, 0.75};  ///< the arm comes from here
  std::vector<HandKey> keys;               ///< rising times; the hand is there from the first to the last
};
struct HeadKey {
  double t_s = 0;
  glm::dvec3 at_m{0.0, 0.0, 0.6};  ///< between the eyes
};
struct HeadTrack {
  double ipd_m = 0.063;
  std::vector<HeadKey> keys;
};
struct Dropouts {
  double per_s = 0, shortest_s = 0.02, longest_s = 0.08;
};

/// What a visitor wants to see: turned right about the upright axis, then tilted (top to the viewer), and zoomed.
struct VisitorGoal {
  double yaw_deg = 0, pitch_deg = 0, zoom = 1;
  double patience_s = 60;
};

struct Script {
  std::uint64_t seed = 1;
  double duration_s = 10, rate_hz = 90, latency_s = 0.02, noise_m = 0;
  Dropouts hand_dropouts, eye_dropouts;
  std::vector<HandTrack> hands;
  std::vector<HeadTrack> heads;
  std::vector<InputEvent> events;  ///< time counts from the script's start
  std::optional<VisitorGoal> visitor;
  int bystanders = 0;
  bool bystander_heads = true;  ///< a camera sees heads; false: hands only
};

/// Reads a script (format: docs/input.md). kConfig by name and range; unknown names are refused; at most 10000 keys.
Result<Script> parse_script(std::string_view json_text, std::string_view source);

/// The hand of a track at t_s, without noise; nothing before its first and after its last key.
std::optional<HandFrame> sample_hand(const HandTrack& track, double t_s);
std::optional<glm::dvec3> sample_head(const HeadTrack& track, double t_s);

}  // namespace dubsar
