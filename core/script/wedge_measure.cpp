#include "core/script/wedge_measure.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace dubsar {

double wedge_confidence(const PlacedImprint& placed, const WedgeScale& scale) {
  // Halfway at three tenths of what a usual wedge explains; bounds from phantoms: pores and half wedges beside a patch
  // lie outside of those of depth, two heads drawn as one outside of that of width (of what is pressed, a hundredth is
  // wider than 1.31).
  constexpr double kHalf = 0.0016, kWidth = 0.0003;
  constexpr double kLeast = 0.4, kMost = 1.6, kNarrow = 0.55, kBroad = 1.4;
  // Misfits of what is pressed lie below 2.2 usual ones in 99 of a hundred, those of a quarter of what is not above
  // 2.4 (1,346 and 78 on twenty phantoms).
  constexpr double kUnlike = 2.5;
  const double explains = 1.0 / (1.0 + std::exp(-(placed.gain - kHalf) / kWidth));
  const double depth = placed.depth / scale.usual().depth, width = placed.imprint.width();
  const auto within = [](double v, double least, double most) {
    return 1.0 / (1.0 + std::pow(std::max({least / std::max(v, 1e-3), v / most, 1e-3}), 12.0));
  };
  const double unlike = scale.misfit > 0.0 ? std::pow(placed.misfit / (kUnlike * scale.misfit), 4.0) : 0.0;
  const double unsure = 0.1 * std::exp(-std::max(0.0, placed.margin) / 4e-5);  // it may as well point another way
  return explains * within(depth, kLeast, kMost) * within(width, kNarrow, kBroad * std::max(1.0, scale.fitted)) *
         (1.0 - unsure) / (1.0 + unlike);
}

ScriptWedge measured_wedge(const PlacedImprint& placed, const WedgeScale& scale) {
  const Imprint& i = placed.imprint;
  ScriptWedge out;
  const glm::dvec3 across = glm::cross(placed.normal, placed.along);
  out.normal = placed.normal;
  out.direction = placed.along;
  out.width_mm = placed.outline.width * scale.width_mm;
  out.depth_mm = placed.depth * scale.width_mm;
  out.length_mm = (i.back() + placed.outline.reach) * scale.width_mm;
  out.head_mm = placed.head;
  out.tail_mm = placed.end;
  out.corner_mm[0] = out.head_mm + 0.5 * out.width_mm * across;
  out.corner_mm[1] = out.head_mm - 0.5 * out.width_mm * across;
  out.tip_mm = placed.foot - out.depth_mm * placed.normal;
  // docs/edition.md: of the flanks with slopes alpha along and k across.
  const double alpha = i.depth() / i.front(), k = 2.0 * i.depth() * (1.0 + i.back() / i.front()) / i.width();
  out.opening_deg = 180.0 / std::numbers::pi *
                    (std::numbers::pi -
                     std::acos(std::clamp((1.0 + alpha * alpha - k * k) / (1.0 + alpha * alpha + k * k), -1.0, 1.0)));
  out.confidence = wedge_confidence(placed, scale);
  return out;
}

}  // namespace dubsar
