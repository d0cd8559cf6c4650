#pragma once
// How a real hand's fingers close and open before a hand tracker: two movements of each, recorded at 115 Hz.

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace dubsar {

/// What a tracker said at one moment of a movement.
struct RecordedMoment {
  double t_s, grab, pinch_mm;
  glm::dvec3 went_mm;  ///< the palm, since the movement began: right, up, to the viewer
};

/// One movement of the fingers, and how they then rest.
struct RecordedFingers {
  enum Kind { kCloses, kOpens } kind;
  double there_s;  ///< from the beginning until the fingers are where they go; the tracker goes on changing its mind
  std::vector<RecordedMoment> moments;

  struct State {
    double grab, pinch;  ///< 0 as at the beginning, 1 as at the end
    glm::dvec3 went_m;   ///< opening: back to where the closed hand came from
  };
  /// `part`: 0 at the beginning, 1 at there_s, more while they rest.
  State at(double part) const;
};

/// Recorded by Leap Motion for its library leapjs-playback (Apache-2.0; recorder/recordings/grab.json.lz), one right
/// hand; extract_recorded_hands.py says how they were taken from it.
std::span<const RecordedFingers> recorded_fingers();

}  // namespace dubsar
