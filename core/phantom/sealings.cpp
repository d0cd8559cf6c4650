// Where the seal was rolled on the envelope, what is left of it, and which place of the seal a point of it shows.

#include <algorithm>
#include <cmath>

#include "core/phantom/builder.h"

namespace dubsar::phantom {
namespace {

struct BandOfSide {
  Side side;
  const SealBand* band;
};

std::vector<BandOfSide> bands_of(const ClayBody& body) {
  std::vector<BandOfSide> out;
  for (int s = 0; s < kSides; ++s)
    for (const SealBand& band : body.bands[static_cast<std::size_t>(s)]) out.push_back({static_cast<Side>(s), &band});
  return out;
}

/// Half of the length that a band has before it fades at the edges (ClayBody::decorate()).
float half_length(const ClayBody& body, Side side) {
  const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
  return body.half[static_cast<std::size_t>(frame.right.axis)] - 0.75f * body.edge_radius;
}

}  // namespace

// The share is that of the band's own places: the threshold is a quantile of the field there.
void PhantomBuilder::wear_sealings() {
  ClayBody& body = p_.outer_.body;
  Random random(seed(), 0x5ea2);
  body.loss = {Waves(random, 12, mm(6.0), mm(16.0), 1.0f), Waves(random, 8, mm(12.0), mm(30.0), 1.0f),
               Waves(random, 8, mm(1.2), mm(3.0), 1.0f), mm(0.35)};
  constexpr int kAlong = 120, kAcross = 40;
  for (int s = 0; s < kSides; ++s)
    for (SealBand& band : body.bands[static_cast<std::size_t>(s)]) {
      const auto side = static_cast<Side>(s);
      std::vector<float> field;
      for (int j = 0; j < kAcross; ++j)
        for (int i = 0; i < kAlong; ++i) {
          const float right = half_length(body, side) * (2.0f * (static_cast<float>(i) + 0.5f) / kAlong - 1.0f);
          const float up = band.bottom + mm(SealRelief::kHeightMm) * (static_cast<float>(j) + 0.5f) / kAcross;
          Point point;
          point.p = body.surface_point(side, right, up);
          field.push_back(body.loss.where.evaluate(point).v);
        }
      const auto kept =
          static_cast<std::ptrdiff_t>((1.0 - p_.options_.writing.seals_lost) * static_cast<double>(field.size() - 1));
      std::nth_element(field.begin(), field.begin() + kept, field.end());
      band.lost_above = field[static_cast<std::size_t>(kept)];
    }
}

std::vector<Sealing> Phantom::sealings() const {
  const ClayBody& body = outer_.body;
  std::vector<Sealing> out;
  for (const auto& [side, band] : bands_of(body)) {
    const float middle = band->bottom + 0.5f * SealRelief::kHeightMm * place_.voxels_per_mm;
    const auto at = [&](float right) { return place_.grid_point(body.surface_point(side, right, middle)); };
    out.push_back({side, at(-half_length(body, side)), at(half_length(body, side))});
  }
  return out;
}

std::optional<SealPlace> Phantom::seal_place(std::size_t sealing, const glm::dvec3& at) const {
  const ClayBody& body = outer_.body;
  const auto [side, band] = bands_of(body).at(sealing);
  const SideFrame& frame = kSideFrames[static_cast<std::size_t>(side)];
  const Point point = place_.point(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z));
  const float right = frame.right.sign * point.p[frame.right.axis], up = frame.up.sign * point.p[frame.up.axis];
  const float y = (up - band->bottom) / place_.voxels_per_mm, x = right / place_.voxels_per_mm + band->phase_mm;
  if (y <= 0.0f || y >= SealRelief::kHeightMm) return {};
  SealPlace out;
  out.x_mm = static_cast<double>(x - SealRelief::kTurnMm * std::floor(x / SealRelief::kTurnMm));
  out.y_mm = static_cast<double>(y);
  out.height_mm = static_cast<double>(seal_.height({x, Float4{}}, {y, Float4{}}).v);
  constexpr float kWhole = 0.97f;  // of the impression: less is rounded away with the edge
  out.shown = std::abs(right) <= half_length(body, side) && body.decor_share(side, point) >= kWhole &&
              !(body.loss.where.evaluate(point).v > band->lost_above);
  return out;
}

}  // namespace dubsar::phantom
