#include "app/panels/tutorial_picture.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dubsar::app {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// 0 before `from`, 1 after `to`, smooth in between.
float ease(float t, float from, float to) {
  const float x = std::clamp((t - from) / (to - from), 0.0f, 1.0f);
  return x * x * (3.0f - 2.0f * x);
}

ImU32 colour(float r, float g, float b, float opacity) { return ImGui::GetColorU32(ImVec4(r, g, b, opacity)); }

struct Finger {
  float angle, length, thickness;
};
constexpr std::array<Finger, 5> kFingers{{{-1.05f, 0.30f, 0.105f},  // thumb
                                          {-0.36f, 0.44f, 0.095f},
                                          {-0.10f, 0.49f, 0.095f},
                                          {0.15f, 0.45f, 0.095f},
                                          {0.42f, 0.35f, 0.085f}}};

void capsule(ImDrawList& list, ImVec2 a, ImVec2 b, float thickness, ImU32 paint) {
  list.AddLine(a, b, paint, thickness);
  list.AddCircleFilled(a, 0.5f * thickness, paint, 16);
  list.AddCircleFilled(b, 0.5f * thickness, paint, 16);
}

void draw_hand(ImDrawList& list, ImVec2 at, float unit, float closing, bool mirrored, float opacity) {
  const ImU32 skin = colour(0.93f, 0.89f, 0.82f, opacity), shade = colour(0.55f, 0.50f, 0.44f, opacity);
  const float side = mirrored ? -1.0f : 1.0f;
  for (const Finger& finger : kFingers) {
    const float reach = finger.length * (1.0f - 0.72f * closing) + 0.16f;
    const float angle = side * finger.angle * (1.0f - 0.35f * closing);
    const ImVec2 root(at.x + unit * 0.16f * std::sin(angle), at.y - unit * 0.16f * std::cos(angle));
    const ImVec2 tip(at.x + unit * reach * std::sin(angle), at.y - unit * reach * std::cos(angle));
    capsule(list, root, tip, unit * (finger.thickness + 0.03f), shade);
    capsule(list, root, tip, unit * finger.thickness, skin);
  }
  list.AddCircleFilled(at, unit * 0.225f, shade, 32);
  list.AddCircleFilled(at, unit * 0.21f, skin, 32);
  if (closing > 0.5f)  // bent fingers lie over the palm
    for (int i = 0; i < 4; ++i) {
      const float x = at.x + side * unit * (-0.135f + 0.09f * static_cast<float>(i));
      capsule(list, ImVec2(x, at.y - unit * 0.10f), ImVec2(x, at.y + unit * 0.03f), unit * 0.075f,
              colour(0.84f, 0.79f, 0.71f, opacity * (closing - 0.5f) * 2.0f));
    }
}

void draw_tablet(ImDrawList& list, ImVec2 at, float unit, const TutorialPose& pose) {
  const float scale = unit * 0.30f * pose.object_scale, wide = scale * 0.75f * std::cos(1.2f * pose.object_turn);
  const ImU32 clay = colour(0.66f, 0.52f, 0.38f, 1.0f), dark = colour(0.38f, 0.29f, 0.2f, 1.0f);
  list.AddRectFilled(ImVec2(at.x - wide, at.y - scale), ImVec2(at.x + wide, at.y + scale), clay, 0.25f * scale);
  for (int row = 0; row < 4; ++row) {
    const float y = at.y + scale * (-0.6f + 0.4f * static_cast<float>(row));
    list.AddLine(ImVec2(at.x - 0.7f * wide, y), ImVec2(at.x + 0.7f * wide, y), dark, std::max(1.0f, 0.05f * scale));
  }
  if (pose.lifted <= 0.0f) return;
  const float up = at.y - 2.2f * scale * pose.lifted;
  list.AddRectFilled(ImVec2(at.x - 1.15f * wide, up - 1.15f * scale), ImVec2(at.x + 1.15f * wide, up + 1.15f * scale),
                     colour(0.78f, 0.68f, 0.54f, 1.0f - 0.6f * pose.lifted), 0.3f * scale);
}

}  // namespace

TutorialPose tutorial_pose(Tutorial tutorial, double seconds) noexcept {
  TutorialPose out;
  const auto t = static_cast<float>(std::fmod(std::max(seconds, 0.0), 4.0));
  const float there_and_back = 0.5f - 0.5f * std::cos(0.5f * kPi * t);  // once in 4 s
  switch (tutorial) {
    case Tutorial::kShowHand:
      out.y = 0.75f - 0.6f * ease(t, 0.0f, 1.5f);
      out.opacity = ease(t, 0.0f, 0.8f) * (1.0f - ease(t, 3.4f, 4.0f));
      break;
    case Tutorial::kGrab:
      out.y = 0.75f - 0.5f * ease(t, 0.0f, 0.9f);  // it comes, takes hold, turns, lets go
      out.opacity = ease(t, 0.0f, 0.6f) * (1.0f - ease(t, 3.6f, 4.0f));
      out.closing = ease(t, 1.0f, 1.6f) * (1.0f - ease(t, 3.1f, 3.6f));
      out.x = -0.2f + 0.5f * ease(t, 1.8f, 2.9f);
      out.object_turn = 0.85f * ease(t, 1.8f, 2.9f) * (1.0f - ease(t, 3.3f, 4.0f));
      break;
    case Tutorial::kTurn:
      out.closing = 1.0f;
      out.x = -0.35f + 0.7f * there_and_back;
      out.y = 0.3f;
      out.object_turn = -0.7f + 1.4f * there_and_back;
      break;
    case Tutorial::kTwoHands:
      out.two = true;
      out.opacity = ease(t, 0.0f, 0.4f) * (1.0f - ease(t, 3.6f, 4.0f));
      out.closing = ease(t, 0.4f, 0.9f) * (1.0f - ease(t, 3.5f, 3.9f));
      out.x = 0.22f + 0.38f * ease(t, 1.1f, 2.9f);
      out.other_x = -out.x;
      out.y = 0.3f;
      out.object_scale = 0.6f + 0.6f * ease(t, 1.1f, 2.9f) * (1.0f - ease(t, 3.5f, 4.0f));
      break;
    case Tutorial::kRest:
      out.y = 0.3f;
      out.ring = ease(t, 0.3f, 1.7f) * (1.0f - ease(t, 3.4f, 4.0f));
      out.lifted = ease(t, 1.7f, 2.7f) * (1.0f - ease(t, 3.4f, 4.0f));
      break;
    case Tutorial::kSwipe:
      out.x = -0.6f + 1.2f * ease(t, 0.8f, 1.5f);
      out.y = 0.3f;
      out.opacity = ease(t, 0.0f, 0.6f) * (1.0f - ease(t, 1.6f, 2.2f));
      out.object_turn = ease(t, 1.0f, 1.9f) * (1.0f - ease(t, 3.4f, 4.0f));
      break;
  }
  return out;
}

void draw_tutorial(const TutorialPose& pose, float centre_x, float centre_y, float radius) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 centre(centre_x, centre_y);
  list.AddCircleFilled(centre, radius, colour(0.09f, 0.09f, 0.1f, 0.82f), 64);
  list.AddCircle(centre, radius, colour(0.85f, 0.64f, 0.25f, 0.9f), 64, std::max(1.0f, 0.02f * radius));
  draw_tablet(list, ImVec2(centre_x, centre_y - 0.42f * radius), radius, pose);
  const auto place = [&](float x) { return ImVec2(centre_x + radius * x, centre_y + radius * (pose.y + 0.12f)); };
  const float unit = (pose.two ? 1.0f : 1.3f) * radius;
  draw_hand(list, place(pose.x), unit, pose.closing, false, pose.opacity);
  if (pose.two) draw_hand(list, place(pose.other_x), unit, pose.closing, true, pose.opacity);
  if (pose.ring > 0.0f) {
    list.PathArcTo(place(pose.x), 0.42f * radius, -0.5f * kPi, (2.0f * pose.ring - 0.5f) * kPi, 48);
    list.PathStroke(colour(0.85f, 0.64f, 0.25f, 1.0f), 0, 0.05f * radius);
  }
}

}  // namespace dubsar::app
