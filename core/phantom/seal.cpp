#include "core/phantom/seal.h"

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>

#include "core/phantom/random.h"

namespace dubsar::phantom {
namespace {

using glm::vec2;

// Plane figures are unions of strokes with round ends and a radius that changes along the stroke (mm). Heads face +x.
struct Limb {
  vec2 a, b;
  float radius_a, radius_b;
};

float distance(vec2 p, const Limb& limb) {
  const vec2 d = limb.b - limb.a;
  const float t = std::clamp(glm::dot(p - limb.a, d) / std::max(glm::dot(d, d), 1e-6f), 0.0f, 1.0f);
  return glm::length(p - limb.a - t * d) - (limb.radius_a + t * (limb.radius_b - limb.radius_a));
}

using Figure = std::vector<Limb>;

const Figure kWorshipper{{{0, 1.6f}, {0, 7.2f}, 1.75f, 1.05f},          {{0, 7.4f}, {0.1f, 9.3f}, 1.3f, 1.15f},
                         {{0.15f, 11.3f}, {0.25f, 11.7f}, 0.95f, 0.9f}, {{0.9f, 10.9f}, {0.8f, 9.9f}, 0.45f, 0.25f},
                         {{0.9f, 9.0f}, {2.3f, 8.6f}, 0.5f, 0.4f},      {{2.3f, 8.6f}, {3.0f, 10.6f}, 0.42f, 0.34f},
                         {{0.4f, 0.5f}, {1.5f, 0.4f}, 0.4f, 0.35f}};
const Figure kDeity{{{0.2f, 4.2f}, {0.0f, 8.6f}, 1.5f, 1.25f},     {{0.0f, 4.2f}, {2.6f, 4.4f}, 1.35f, 1.0f},
                    {{2.7f, 4.3f}, {2.9f, 1.0f}, 1.0f, 1.2f},      {{0.1f, 10.7f}, {0.2f, 11.2f}, 0.95f, 0.95f},
                    {{-1.0f, 12.3f}, {0.2f, 12.6f}, 0.28f, 0.42f}, {{0.2f, 12.6f}, {1.5f, 12.5f}, 0.42f, 0.24f},
                    {{-0.8f, 13.2f}, {0.2f, 13.6f}, 0.25f, 0.36f}, {{0.2f, 13.6f}, {1.2f, 13.4f}, 0.36f, 0.22f},
                    {{0.9f, 8.2f}, {3.0f, 8.0f}, 0.5f, 0.4f},      {{3.2f, 8.2f}, {3.3f, 9.0f}, 0.35f, 0.6f},
                    {{-1.6f, 0.5f}, {-1.6f, 3.0f}, 0.42f, 0.42f},  {{0.6f, 0.5f}, {0.6f, 3.0f}, 0.42f, 0.42f},
                    {{-1.7f, 1.4f}, {0.7f, 1.4f}, 0.3f, 0.3f},     {{-2.0f, 3.0f}, {0.9f, 3.0f}, 0.42f, 0.42f},
                    {{3.4f, 0.5f}, {4.2f, 0.4f}, 0.4f, 0.35f}};
const Figure kBull{{{-2.6f, 4.6f}, {1.4f, 4.9f}, 1.25f, 1.55f},  {{1.8f, 5.6f}, {3.2f, 6.8f}, 1.2f, 0.85f},
                   {{3.3f, 6.9f}, {4.5f, 6.1f}, 0.8f, 0.45f},    {{3.2f, 7.6f}, {3.9f, 8.8f}, 0.32f, 0.2f},
                   {{3.9f, 8.8f}, {3.5f, 9.6f}, 0.2f, 0.16f},    {{2.0f, 4.0f}, {2.2f, 0.6f}, 0.62f, 0.35f},
                   {{0.9f, 3.8f}, {0.8f, 0.6f}, 0.55f, 0.35f},   {{-2.0f, 3.9f}, {-1.8f, 0.6f}, 0.6f, 0.35f},
                   {{-3.1f, 4.0f}, {-3.4f, 0.6f}, 0.62f, 0.35f}, {{-3.7f, 5.2f}, {-4.4f, 3.6f}, 0.26f, 0.2f},
                   {{-4.4f, 3.6f}, {-4.3f, 2.2f}, 0.2f, 0.34f}};
const Figure kStar{{{-1.1f, 0}, {1.1f, 0}, 0.24f, 0.24f},
                   {{0, -1.1f}, {0, 1.1f}, 0.24f, 0.24f},
                   {{-0.8f, -0.8f}, {0.8f, 0.8f}, 0.22f, 0.22f},
                   {{-0.8f, 0.8f}, {0.8f, -0.8f}, 0.22f, 0.22f},
                   {{0, 0}, {0, 0.01f}, 0.5f, 0.5f}};
const Figure kCrescent{{{-1.3f, 0.5f}, {-0.7f, -0.2f}, 0.16f, 0.36f},
                       {{-0.7f, -0.2f}, {0, -0.45f}, 0.36f, 0.44f},
                       {{0, -0.45f}, {0.7f, -0.2f}, 0.44f, 0.36f},
                       {{0.7f, -0.2f}, {1.3f, 0.5f}, 0.36f, 0.16f}};
const Figure kAltar{{{-1.1f, 0.5f}, {-0.3f, 4.2f}, 0.35f, 0.35f},
                    {{1.1f, 0.5f}, {0.3f, 4.2f}, 0.35f, 0.35f},
                    {{-1.4f, 4.7f}, {1.4f, 4.7f}, 0.42f, 0.42f},
                    {{-0.5f, 5.7f}, {0.6f, 5.8f}, 0.55f, 0.5f},
                    {{-0.7f, 2.3f}, {0.7f, 2.3f}, 0.26f, 0.26f}};
const Figure kVessel{{{0, 0.6f}, {0, 1.2f}, 0.75f, 0.85f}, {{0, 2.0f}, {0, 2.6f}, 0.36f, 0.5f}};

struct Placed {
  const Figure* figure;
  vec2 at;
  float mirror;  ///< 1 or -1
};

float profile(float signed_distance, float width) {
  const float x = std::clamp(-signed_distance / width, 0.0f, 1.0f);
  return x * x * (3.0f - 2.0f * x);
}

// Uniform cubic B-spline weights and their derivatives at fraction t.
void spline(float t, std::array<float, 4>& w, std::array<float, 4>& d) {
  const float s = 1.0f - t;
  w = {s * s * s / 6.0f, (3.0f * t * t * t - 6.0f * t * t + 4.0f) / 6.0f,
       (3.0f * s * s * s - 6.0f * s * s + 4.0f) / 6.0f, t * t * t / 6.0f};
  d = {-0.5f * s * s, 0.5f * (3.0f * t * t - 4.0f * t), -0.5f * (3.0f * s * s - 4.0f * s), 0.5f * t * t};
}

}  // namespace

SealRelief::SealRelief(std::uint64_t seed) : nodes_(static_cast<std::size_t>(kColumns) * kRows) {
  Random random(seed, 0x5ea1);
  const auto jitter = [&] { return static_cast<float>(random.uniform(-0.35, 0.35)); };
  // The scene: worshippers led from the right to the enthroned deity, a bull behind; symbols in the sky.
  std::vector<Placed> scene{{&kDeity, {4.6f, 1.4f}, 1},
                            {&kAltar, {10.6f + jitter(), 1.3f}, 1},
                            {&kWorshipper, {15.6f + jitter(), 1.3f}, -1},
                            {&kWorshipper, {21.4f + jitter(), 1.3f}, -1},
                            {&kBull, {30.6f, 1.3f}, random.uniform() < 0.5 ? 1.0f : -1.0f},
                            {&kCrescent, {10.4f, 12.2f + jitter()}, 1},
                            {&kStar, {18.4f, 14.0f}, 1},
                            {&kStar, {29.4f + jitter(), 12.8f}, 1},
                            {&kVessel, {25.4f, 1.4f}, 1},
                            {&kVessel, {34.8f, 11.4f}, 1}};
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const vec2 p{kTurnMm * static_cast<float>(column) / kColumns, kHeightMm * static_cast<float>(row) / kRows};
      float height = 0.0f;
      for (const Placed& placed : scene) {
        vec2 local = p - placed.at;
        local.x -= kTurnMm * std::round(local.x / kTurnMm);
        local.x *= placed.mirror;
        float nearest = 1e9f;
        for (const Limb& limb : *placed.figure) nearest = std::min(nearest, distance(local, limb));
        float relief = profile(nearest, 0.75f);
        const bool robed = placed.figure == &kWorshipper || placed.figure == &kDeity;
        if (robed && local.y < 7.4f)  // the tiers of a flounced robe
          relief *= 1.0f - 0.28f * (0.5f + 0.5f * std::cos(local.y * 5.2f));
        height = std::max(height, relief);
      }
      const float border = std::min(std::abs(p.y - 0.75f), std::abs(p.y - (kHeightMm - 0.75f))) - 0.42f;
      height = std::max(height, 0.75f * profile(border, 0.4f));
      nodes_[static_cast<std::size_t>(row) * kColumns + column] = kReliefMm * height;
    }
}

Dual SealRelief::height(const Dual& x_mm, const Dual& y_mm) const {
  if (y_mm.v <= 0.0f || y_mm.v >= kHeightMm) return {};
  constexpr float kPerMmX = kColumns / kTurnMm, kPerMmY = kRows / kHeightMm;
  const float turns = x_mm.v / kTurnMm, column = (turns - std::floor(turns)) * kColumns, row = y_mm.v * kPerMmY;
  const int c0 = static_cast<int>(column), r0 = static_cast<int>(row);
  std::array<float, 4> wx, dx, wy, dy;
  spline(column - static_cast<float>(c0), wx, dx);
  spline(row - static_cast<float>(r0), wy, dy);
  float value = 0.0f, slope_x = 0.0f, slope_y = 0.0f;
  for (int j = 0; j < 4; ++j) {
    const int r = r0 + j - 1;
    if (r < 0 || r >= kRows) continue;
    float line = 0.0f, line_slope = 0.0f;
    for (int i = 0; i < 4; ++i) {
      const int c = (c0 + i - 1 + kColumns) % kColumns;
      const float node = nodes_[static_cast<std::size_t>(r) * kColumns + c];
      line += wx[static_cast<std::size_t>(i)] * node;
      line_slope += dx[static_cast<std::size_t>(i)] * node;
    }
    value += wy[static_cast<std::size_t>(j)] * line;
    slope_x += wy[static_cast<std::size_t>(j)] * line_slope;
    slope_y += dy[static_cast<std::size_t>(j)] * line;
  }
  return {value, x_mm.g * (slope_x * kPerMmX) + y_mm.g * (slope_y * kPerMmY)};
}

}  // namespace dubsar::phantom
