// Where the phantom's lines were ruled.

#include <cmath>

#include "core/phantom/phantom.h"

namespace dubsar::phantom {
namespace {

constexpr int kRuledPlaces = 301;   // of a line that are looked at
constexpr float kRuledHalf = 0.5f;  // of the depth: a line ends where less is left

/// As ClayBody::decorate() draws it.
float bent_up(const ClayBody& body, const Ruling& ruling, int k, float right) {
  const auto line = static_cast<float>(k);
  const float bend = 0.0004f * (1.0f + 0.5f * std::cos(2.1f * line)) / body.voxels_per_mm;
  const float off = right + 0.3f * ruling.half_length * std::cos(1.7f * line);
  return ruling.first + line * ruling.pitch - bend * off * off;
}

}  // namespace

std::vector<RuledLine> Phantom::ruled_lines() const {
  std::vector<RuledLine> out;
  for (const Owner owner : {Owner::kTablet, Owner::kEnvelope}) {
    const ClayBody& body = owner == Owner::kTablet ? tablet_.body : outer_.body;
    for (int s = 0; s < kSides; ++s)
      for (const Ruling& ruling : body.rulings[static_cast<std::size_t>(s)])
        for (int k = 0; k < ruling.count; ++k) {
          RuledLine line{owner, static_cast<Side>(s), {}, 0.0};
          float whole = 0.0f;
          for (int i = 0; i < kRuledPlaces; ++i) {
            const float right = ruling.half_length * (2.0f * static_cast<float>(i) / (kRuledPlaces - 1) - 1.0f);
            Point point;
            point.p = body.surface_point(line.side, right, bent_up(body, ruling, k, right));
            const Dual within{-std::abs(right), Float4{}};
            const float share = body.decor_share(line.side, point) *
                                smooth_step(within, -ruling.half_length, 1.0f - 0.93f * ruling.half_length).v;
            whole = std::max(whole, share);
            if (share >= kRuledHalf) line.points.push_back(place_.grid_point(point.p));
          }
          line.depth = static_cast<double>(body.ruling_depth * whole);
          if (line.points.size() > 1) out.push_back(std::move(line));
        }
  }
  return out;
}

}  // namespace dubsar::phantom
