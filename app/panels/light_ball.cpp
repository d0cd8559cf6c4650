#include "app/panels/light_ball.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/panels/panel_kit.h"
#include "app/stage/light_over.h"

namespace dubsar::app {
namespace {

constexpr float kRadius = 46.0f;
constexpr int kRings = 10, kRound = 32;

}  // namespace

void draw_light_ball(const LightPlace& light, float right, float bottom) {
  const float side = 2.0f * kRadius + 12.0f;
  ImGui::SetNextWindowPos(ImVec2(right - side, bottom - side));
  ImGui::SetNextWindowSize(ImVec2(side, side));
  ImGui::SetNextWindowBgAlpha(0.0f);
  ImGui::Begin("light ball", nullptr, kFixed | ImGuiWindowFlags_NoInputs);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 middle(right - 0.5f * side, bottom - 0.5f * side);
  const glm::dvec3 from = place_over(light);
  const auto tone = [&](double x, double y) {  // clay under that light alone
    const double z = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
    const double lit = 0.1 + 0.9 * std::max(0.0, x * from.x + y * from.y + z * from.z);
    const auto part = [&](int most) { return static_cast<int>(most * std::sqrt(lit)); };
    return IM_COL32(part(222), part(210), part(192), 255);
  };
  const auto at = [&](double x, double y) {
    return ImVec2(middle.x + kRadius * static_cast<float>(x), middle.y - kRadius * static_cast<float>(y));
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int k = 0; k < kRound; ++k) {
      const double r0 = static_cast<double>(ring) / kRings, r1 = static_cast<double>(ring + 1) / kRings;
      const double a0 = 2 * std::numbers::pi * k / kRound, a1 = 2 * std::numbers::pi * (k + 1) / kRound;
      const double a = 0.5 * (a0 + a1), r = 0.5 * (r0 + r1);
      list.AddQuadFilled(at(r0 * std::cos(a0), r0 * std::sin(a0)), at(r1 * std::cos(a0), r1 * std::sin(a0)),
                         at(r1 * std::cos(a1), r1 * std::sin(a1)), at(r0 * std::cos(a1), r0 * std::sin(a1)),
                         tone(r * std::cos(a), r * std::sin(a)));
    }
  list.AddCircle(middle, kRadius + 1.0f, kLine, 48, 2.0f);
  list.AddCircleFilled(at(from.x, from.y), 5.0f, kAccent, 20);
  ImGui::End();
}

}  // namespace dubsar::app
