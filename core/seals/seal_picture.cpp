#include "core/seals/seal_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/base/numbers/inch.h"
#include "core/seals/seal_match.h"

namespace dubsar {
namespace {

constexpr double kElevationDeg = 30.0;
constexpr double kShownLeast = 0.3;  // of the weight of a place
constexpr double kHatchMm = 0.8;     // from line to line, as in hand copies of broken places

/// Height as it is wanted, and whether it is shown, at mm from the lower left corner.
struct Wanted {
  const SealImpression& relief;
  bool as_stone;
  Sampled operator()(glm::dvec2 mm) const {
    if (as_stone) mm.x = (relief.width - 1) * relief.step_mm - mm.x;
    Sampled out = sampled(relief, mm);
    if (as_stone) out.mm = -out.mm;
    return out;
  }
};

}  // namespace

Image draw_seal(const SealImpression& relief, const SealPictureOptions& options) {
  const double pixel = kMmPerInch / options.dpi;
  const double wide = (relief.width - 1) * relief.step_mm, high = (relief.height - 1) * relief.step_mm;
  Image out(std::max(1, static_cast<int>(std::lround(wide / pixel))),
            std::max(1, static_cast<int>(std::lround(high / pixel))), 3);
  const Wanted wanted{relief, options.as_stone};
  const double low = std::sin(kElevationDeg * std::numbers::pi / 180.0),
               level = std::cos(kElevationDeg * std::numbers::pi / 180.0);
  const glm::dvec3 light(-level * std::sqrt(0.5), level * std::sqrt(0.5), low);
  const double h = std::max(relief.step_mm, pixel);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const glm::dvec2 p((x + 0.5) * pixel, high - (y + 0.5) * pixel);
      const Sampled here = wanted(p);
      double gray = 0.85;
      if (here.weight >= kShownLeast) {
        const auto height = [&](const glm::dvec2& d) {
          const Sampled there = wanted(p + d);
          return there.weight >= kShownLeast ? there.mm : here.mm;
        };
        const glm::dvec3 normal = glm::normalize(glm::dvec3((height({-h, 0}) - height({h, 0})) / (2 * h),
                                                            (height({0, -h}) - height({0, h})) / (2 * h), 1.0));
        gray = std::clamp(0.05 + 1.05 * glm::dot(normal, light), 0.0, 1.0);
      } else if (options.hatch) {
        const double along = (p.x + p.y) / (kHatchMm * std::sqrt(2.0));
        if (along - std::floor(along) < 0.15 / kHatchMm) gray = 0.35;
      }
      std::fill_n(out.at(x, y), 3, static_cast<std::uint8_t>(std::lround(255.0 * gray)));
    }
  return out;
}

TriMesh seal_surface(const SealImpression& relief, bool as_stone) {
  TriMesh out;
  out.frame.input_voxel.mm = glm::dvec3(1.0);
  out.frame.input_voxel.provenance = "seal";
  const Wanted wanted{relief, as_stone};
  std::vector<std::uint32_t> vertex(relief.mm.size(), ~0u);
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) {
      const glm::dvec2 p = relief.step_mm * glm::dvec2(x, y);
      const Sampled here = wanted(p);
      if (here.weight < kShownLeast) continue;
      vertex[relief.index(x, y)] = static_cast<std::uint32_t>(out.positions.size());
      out.positions.emplace_back(p.x, p.y, here.mm);
    }
  for (int y = 0; y + 1 < relief.height; ++y)
    for (int x = 0; x + 1 < relief.width; ++x) {
      const std::uint32_t a = vertex[relief.index(x, y)], b = vertex[relief.index(x + 1, y)],
                          c = vertex[relief.index(x + 1, y + 1)], d = vertex[relief.index(x, y + 1)];
      if (a != ~0u && b != ~0u && c != ~0u) out.triangles.push_back({a, b, c});
      if (a != ~0u && c != ~0u && d != ~0u) out.triangles.push_back({a, c, d});
    }
  return out;
}

}  // namespace dubsar
