#pragma once
// A hand that shows a gesture, drawn with lines and circles: no words, no file.

#include "app/document/gallery_picture.h"

namespace dubsar::app {

/// How the hand of a tutorial stands at a time: all lengths in radii of its round field, to the right and down.
struct TutorialPose {
  float x = 0.0f, y = 0.0f;  ///< of the palm
  float closing = 0.0f;      ///< 0 open, 1 a fist
  float opacity = 1.0f;
  float other_x = 0.0f;  ///< of a second hand at the same height
  bool two = false;
  float object_scale = 1.0f;  ///< of the tablet beside it
  float object_turn = 0.0f;   ///< -1..1: how far it is turned away
  float lifted = 0.0f;        ///< 0..1: its envelope
  float ring = 0.0f;          ///< 0..1: how much of the ring around the hand is full
};

/// The tutorial's motion repeats; nothing in it changes faster than twice a second.
TutorialPose tutorial_pose(Tutorial tutorial, double seconds) noexcept;

/// Draws the pose into the current list of Dear ImGui, around a place, in a field of `radius` pixels.
void draw_tutorial(const TutorialPose& pose, float centre_x, float centre_y, float radius);

}  // namespace dubsar::app
