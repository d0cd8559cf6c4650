#include "core/rays/ring_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/rays/polar_sums.h"

namespace dubsar {
namespace {

constexpr std::int64_t kRingsLook = 8, kRingsBlock = 16, kRingsLeastSide = 32;
constexpr std::int64_t kRingsMargin = 1;       ///< steps of half the resolution
constexpr double kRingsCentreReach = 2.0;      ///< voxels
constexpr double kRingsControl = 7.0;          ///< how far aside the centre is right for no ring
constexpr std::int64_t kRingsLeastShared = 8;  ///< distances with both clay and air
/// Agreement of clay and air, in deviations of chance; its correlation; what the control may have of it.
constexpr double kRingsLeastAgreement = 8.0, kRingsLeastAlike = 0.6, kRingsMostControl = 0.3, kRingsChance = 3.0;
/// A ring stands out by so many errors (one distance of a thousand by chance), and is as even over the angles.
constexpr double kRingsErrors = 3.5, kRingsMostUneven = 0.4;

/// Slices of the scan, each with what of it is sure at half the resolution.
struct RingSlices {
  std::int64_t first = 0;
  std::vector<std::vector<float>> values;
  std::vector<std::vector<Material>> sure;
};

/// Away from the other side of `level` by the margin in all directions.
Result<std::vector<Material>> sure_in_slice(SlabSource& half, std::int64_t z, float level) {
  const Dims d = half.dims();
  std::vector<float> slice(static_cast<std::size_t>(d.slice()));
  std::vector<std::uint8_t> clay(slice.size(), 1), air(slice.size(), 1);
  for (std::int64_t k = std::max<std::int64_t>(0, z - kRingsMargin); k <= std::min(d.z - 1, z + kRingsMargin); ++k) {
    DUBSAR_TRY(half.read(k, k + 1, slice));
    for (std::size_t i = 0; i < slice.size(); ++i) (slice[i] >= level ? air : clay)[i] = 0;
  }
  std::vector<Material> sure(slice.size(), Material::kUnsure);
  parallel_for(d.y, 16, [&](std::int64_t y) {
    for (std::int64_t x = 0; x < d.x; ++x) {
      bool all_clay = true, all_air = true;
      for (std::int64_t v = std::max<std::int64_t>(0, y - kRingsMargin); v <= std::min(d.y - 1, y + kRingsMargin); ++v)
        for (std::int64_t u = std::max<std::int64_t>(0, x - kRingsMargin); u <= std::min(d.x - 1, x + kRingsMargin);
             ++u) {
          all_clay &= clay[static_cast<std::size_t>(v * d.x + u)] != 0;
          all_air &= air[static_cast<std::size_t>(v * d.x + u)] != 0;
        }
      sure[static_cast<std::size_t>(y * d.x + x)] = all_clay  ? Material::kClay
                                                    : all_air ? Material::kAir
                                                              : Material::kUnsure;
    }
  });
  return sure;
}

Result<void> add_slice(SlabSource& scan, SlabSource& half, std::int64_t z, float level, RingSlices& slices) {
  std::vector<float>& values = slices.values.emplace_back(static_cast<std::size_t>(scan.dims().slice()));
  DUBSAR_TRY(scan.read(z, z + 1, values));
  DUBSAR_ASSIGN(std::vector<Material> sure, sure_in_slice(half, std::min(z / 2, half.dims().z - 1), level));
  slices.sure.push_back(std::move(sure));
  return {};
}

/// Of each slice.
std::vector<PolarSums> sums_of(const PolarSlice& polar, const RingSlices& slices) {
  std::vector<PolarSums> sums(slices.values.size(), PolarSums(polar.radii()));
  parallel_for(static_cast<std::int64_t>(sums.size()), 1, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    polar.add(slices.values[k], slices.sure[k], sums[k]);
  });
  return sums;
}

PolarSums all_of(const std::vector<PolarSums>& sums) {
  PolarSums all(sums.front().radii);
  for (const PolarSums& one : sums) all.add(one);
  return all;
}

/// Whether clay and air, or two halves of the turn, have the same rings.
struct Agreement {
  double together = 0.0;  ///< sum of products, in deviations of chance
  double alike = 0.0;
};
Agreement agreement(const AngularConstants& air, const AngularConstants& clay) {
  double products = 0.0, chance = 0.0, of_air = 0.0, of_clay = 0.0;
  std::int64_t shared = 0;
  for (std::size_t r = 0; r < air.value.size(); ++r) {
    if (!std::isfinite(air.error[r]) || !std::isfinite(clay.error[r])) continue;
    ++shared;
    const double a2 = air.error[r] * air.error[r], c2 = clay.error[r] * clay.error[r];
    products += air.value[r] * clay.value[r];
    chance += a2 * c2;
    of_air += air.value[r] * air.value[r] - a2;
    of_clay += clay.value[r] * clay.value[r] - c2;
  }
  if (shared < kRingsLeastShared || !(chance > 0.0)) return {};
  return {products / std::sqrt(chance), of_air > 0.0 && of_clay > 0.0 ? products / std::sqrt(of_air * of_clay) : 0.0};
}

Agreement agreement_about(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre) {
  const auto found = constants_over_angles(all_of(sums_of(PolarSlice(dims, centre), slices)));
  return agreement(found[0], found[1]);
}

/// Correlation of opposite halves of the turn, the lesser of two: scans of half a turn have half rings.
double alike_in_halves(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre) {
  const PolarSums sums = all_of(sums_of(PolarSlice(dims, centre), slices));
  double least = 1.0;
  for (const std::int64_t quarter : {0, 1})
    least = std::min(least, agreement(constants_over_angles(sums.half_from(quarter))[2],
                                      constants_over_angles(sums.half_from(quarter + 2))[2])
                                .alike);
  return least;
}

/// The largest value of a parabola through values at -step, 0 and step.
double vertex_of(double before, double here, double behind, double step) {
  const double curve = before - 2.0 * here + behind;
  return curve < 0.0 ? std::clamp(0.5 * step * (before - behind) / curve, -step, step) : 0.0;
}

/// Energy of what is the same over all angles.
double energy_about(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre) {
  const AngularConstants both = constants_over_angles(all_of(sums_of(PolarSlice(dims, centre), slices)))[2];
  double sum = 0.0;
  for (std::size_t r = 0; r < both.value.size(); ++r)
    if (std::isfinite(both.error[r])) sum += both.value[r] * both.value[r] / (both.error[r] * both.error[r]);
  return sum;
}

/// To a fifth of a voxel. Where that is the middle, which reconstructions turn about, it is the middle.
glm::dvec2 finer_centre(const RingSlices& slices, const Dims& dims, const glm::dvec2& middle, glm::dvec2 centre) {
  constexpr double kStep = 0.75, kMiddle = 0.3;
  for (int round = 0; round < 2; ++round) {
    const auto energy = [&](double x, double y) { return energy_about(slices, dims, centre + glm::dvec2(x, y)); };
    const double here = energy(0, 0);
    centre += glm::dvec2(vertex_of(energy(-kStep, 0), here, energy(kStep, 0), kStep),
                         vertex_of(energy(0, -kStep), here, energy(0, kStep), kStep));
  }
  return glm::length(centre - middle) < kMiddle ? middle : centre;
}

/// Where it is best, by whole voxels and then by halves.
glm::dvec2 best_centre(const RingSlices& slices, const Dims& dims, glm::dvec2 centre) {
  double most = agreement_about(slices, dims, centre).together;
  const glm::dvec2 middle = centre;
  for (const double step : {1.0, 0.5}) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const glm::dvec2 way : {glm::dvec2(step, 0), {-step, 0}, {0, step}, {0, -step}}) {
        const glm::dvec2 to = centre + way;
        if (std::abs(to.x - middle.x) > kRingsCentreReach || std::abs(to.y - middle.y) > kRingsCentreReach) continue;
        const double here = agreement_about(slices, dims, to).together;
        if (here <= 1.05 * most) continue;  // a tenth of a voxel is no reason to leave the middle
        most = here;
        centre = to;
        moved = true;
      }
    }
  }
  return centre;
}

/// What stands out, less what is chance in it, and without what the sharing between two distances took.
std::vector<double> standing_out(const AngularConstants& both) {
  std::vector<double> kept(both.value.size());
  for (std::size_t r = 0; r < kept.size(); ++r) {
    const double size = std::abs(both.value[r]);
    if (size < kRingsErrors * both.error[r] || both.uneven[r] > kRingsMostUneven * size + both.error[r]) continue;
    kept[r] = both.value[r] * (1.0 - both.error[r] * both.error[r] / (size * size));
  }
  std::vector<double> rings = kept;
  for (int round = 0; round < 2; ++round) {
    std::vector<double> next = rings;
    for (std::size_t r = 0; r < rings.size(); ++r) {
      if (kept[r] == 0.0) continue;
      const double before = r > 0 ? rings[r - 1] : 0.0, behind = r + 1 < rings.size() ? rings[r + 1] : 0.0;
      next[r] += kept[r] - (before + 4.0 * rings[r] + behind) / 6.0;
    }
    rings = std::move(next);
  }
  return rings;
}

void take_off(const std::vector<double>& rings, PolarSums& sums) {
  for (const bool clay : {false, true})
    for (std::int64_t sector = 0; sector < PolarSlice::kSectors; ++sector)
      for (std::int64_t r = 0; r < sums.radii; ++r) {
        const auto at = [&](std::int64_t i) {
          return i >= 0 && i < sums.radii ? rings[static_cast<std::size_t>(i)] : 0.0;
        };
        const std::size_t i = sums.at(clay, sector, r);
        sums.sum[i] -= sums.weight[i] * (at(r - 1) + 4.0 * at(r) + at(r + 1)) / 6.0;
      }
}

/// Takes them off the sums. In rounds: rings beside a ring, of which there may be one at every third distance, move the
/// median that it is measured from.
std::vector<double> peel(PolarSums& sums) {
  constexpr int kRounds = 4;
  std::vector<double> rings(static_cast<std::size_t>(sums.radii));
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> more = standing_out(constants_over_angles(sums)[2]);
    take_off(more, sums);
    for (std::size_t r = 0; r < rings.size(); ++r) rings[r] += more[r];
  }
  return rings;
}

/// What all slices have in common, from some of them.
Result<std::vector<double>> rings_of_all(SlabSource& scan, SlabSource& half, float level, const PolarSlice& polar,
                                         Progress& progress) {
  constexpr std::int64_t kMostSlices = 192;
  const std::int64_t count = std::min(scan.dims().z, kMostSlices);
  PolarSums all(polar.radii());
  for (std::int64_t k = 0; k < count; k += kRingsBlock) {
    if (progress.cancelled()) return cancelled_error();
    RingSlices slices;
    for (std::int64_t i = k; i < std::min(count, k + kRingsBlock); ++i)
      DUBSAR_TRY(add_slice(scan, half, i * scan.dims().z / count, level, slices));
    all.add(all_of(sums_of(polar, slices)));
  }
  return peel(all);
}

Result<FoundRings> measure(SlabSource& scan, SlabSource& half, float level, const glm::dvec2& centre,
                           Progress& progress) {
  const Dims d = scan.dims();
  const PolarSlice polar(d, centre);
  FoundRings found;
  found.field = {centre, polar.radii(), std::vector<float>(static_cast<std::size_t>(polar.radii() * d.z))};
  DUBSAR_ASSIGN(const std::vector<double> of_all, rings_of_all(scan, half, level, polar, progress));
  double squares = 0.0, seen = 0.0, rings = 0.0;
  for (std::int64_t z = 0; z < d.z; z += kRingsBlock) {
    if (progress.cancelled()) return cancelled_error();
    RingSlices slices;
    for (std::int64_t k = z; k < std::min(d.z, z + kRingsBlock); ++k)
      DUBSAR_TRY(add_slice(scan, half, k, level, slices));
    std::vector<PolarSums> sums = sums_of(polar, slices);
    for (PolarSums& one : sums) take_off(of_all, one);
    PolarSums together = all_of(sums);
    const std::vector<double> of_block = peel(together);
    const AngularConstants common = constants_over_angles(together)[2];
    parallel_for(static_cast<std::int64_t>(sums.size()), 1, [&](std::int64_t i) {
      PolarSums& one = sums[static_cast<std::size_t>(i)];
      take_off(of_block, one);
      const std::vector<double> of_one = peel(one);
      float* const to = found.field.of_slice.data() + (z + i) * polar.radii();
      for (std::size_t r = 0; r < of_one.size(); ++r) to[r] = static_cast<float>(of_all[r] + of_block[r] + of_one[r]);
    });
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (std::int64_t r = 0; r < polar.radii(); ++r) {
        if (!std::isfinite(common.error[static_cast<std::size_t>(r)])) continue;
        const double ring =
            found.field.of_slice[static_cast<std::size_t>((z + static_cast<std::int64_t>(i)) * polar.radii() + r)];
        squares += ring * ring;
        rings += ring != 0.0;
        seen += 1.0;
        found.report.strongest = std::max(found.report.strongest, std::abs(ring));
      }
    progress.advance(static_cast<std::int64_t>(sums.size()) * d.slice());
  }
  found.report.deviation = std::sqrt(squares / std::max(1.0, seen));
  found.report.rings = rings / static_cast<double>(d.z);
  return found;
}

}  // namespace

std::string describe(const RingsReport& rings) {
  return fmt::format(
      "rings of uneven detector pixels about x {:.1f}, y {:.1f}: {:.1f} % of the contrast, the strongest {:.0f} %; "
      "taken off",
      rings.look.centre.x, rings.look.centre.y, 100.0 * rings.deviation, 100.0 * rings.strongest);
}

std::string describe(const RingsLook& look) {
  return fmt::format("rings of uneven detector pixels about x {:.1f}, y {:.1f}; they will be taken off", look.centre.x,
                     look.centre.y);
}

Result<std::optional<RingsLook>> look_for_rings(SlabSource& scan, SlabSource& half, const GreyLevels& levels,
                                                Progress& progress) {
  const Dims d = scan.dims();
  if (!(levels.contrast() > 0.0) || d.x < kRingsLeastSide || d.y < kRingsLeastSide || d.z < kRingsLook)
    return std::nullopt;
  const auto level = static_cast<float>(levels.air + 0.5 * levels.contrast());
  RingSlices slices;
  for (std::int64_t k = 0; k < kRingsLook; ++k)
    DUBSAR_TRY(add_slice(scan, half, (2 * k + 1) * d.z / (2 * kRingsLook), level, slices));
  if (progress.cancelled()) return cancelled_error();
  const glm::dvec2 middle{0.5 * static_cast<double>(d.x - 1), 0.5 * static_cast<double>(d.y - 1)};
  const glm::dvec2 centre = best_centre(slices, d, middle);
  const Agreement here = agreement_about(slices, d, centre);
  double control = 0.0;
  for (const glm::dvec2 way : {glm::dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
    control = std::max(control, agreement_about(slices, d, centre + kRingsControl * way).together);
  const double halves = alike_in_halves(slices, d, centre);
  log_debug(
      "rings about {:.2f} {:.2f}: clay and air agree by {:.1f} deviations, {:.2f} alike, halves {:.2f}; elsewhere by "
      "{:.1f}",
      centre.x, centre.y, here.together, here.alike, halves, control);
  if (halves < kRingsLeastAlike || here.together < kRingsLeastAgreement || here.alike < kRingsLeastAlike ||
      control > std::max(kRingsChance, kRingsMostControl * here.together))
    return std::nullopt;
  return RingsLook{finer_centre(slices, d, middle, centre), std::min(here.alike, 1.0)};
}

Result<std::optional<FoundRings>> find_rings(SlabSource& scan, SlabSource& half, const GreyLevels& levels,
                                             Progress& progress) {
  progress.begin("rings", scan.dims().count(), "voxel");
  DUBSAR_ASSIGN(const std::optional<RingsLook> look, look_for_rings(scan, half, levels, progress));
  if (!look) return std::nullopt;
  const auto level = static_cast<float>(levels.air + 0.5 * levels.contrast());
  DUBSAR_ASSIGN(FoundRings found, measure(scan, half, level, look->centre, progress));
  RingsReport& report = found.report;
  report.look = *look;
  report.deviation /= levels.contrast();
  report.strongest /= levels.contrast();
  if (!(report.deviation > 0.0)) return std::nullopt;
  return found;
}

}  // namespace dubsar
