#include "core/rays/ring_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/rays/ring_slices.h"

namespace dubsar {
namespace {

constexpr std::int64_t kRingsLook = 8, kRingsBlock = 16, kRingsLeastSide = 32;
constexpr double kRingsCentreReach = 2.0;      ///< voxels
constexpr double kRingsControl = 7.0;          ///< how far aside the centre is right for no ring
constexpr std::int64_t kRingsLeastShared = 8;  ///< distances with both clay and air
/// Agreement of clay and air, in deviations of chance; its correlation; what the control may have of it.
constexpr double kRingsLeastAgreement = 8.0, kRingsLeastAlike = 0.6, kRingsMostControl = 0.3, kRingsChance = 3.0;
/// A ring stands out by so many errors (one distance of a thousand by chance), and is as even over the angles.
constexpr double kRingsErrors = 3.5, kRingsMostUneven = 0.4;
/// Of the contrast: rings that reach the other side of the level are taken for surfaces, and looked for again where
/// thin ones are left out.
constexpr double kRingsStrong = 0.2;

/// Whether clay and air, or two halves of the turn, have the same rings.
struct Agreement {
  double together = 0.0;  ///< sum of products, in deviations of chance
  double alike = 0.0;
};
struct AgreementSums {
  double products = 0.0, chance = 0.0, of_air = 0.0, of_clay = 0.0;
  std::int64_t shared = 0;
  void add(const AngularConstants& air, const AngularConstants& clay);
  Agreement result() const noexcept {
    if (shared < kRingsLeastShared || !(chance > 0.0)) return {};
    return {products / std::sqrt(chance), of_air > 0.0 && of_clay > 0.0 ? products / std::sqrt(of_air * of_clay) : 0.0};
  }
};
void AgreementSums::add(const AngularConstants& air, const AngularConstants& clay) {
  for (std::size_t r = 0; r < air.value.size(); ++r) {
    if (!std::isfinite(air.error[r]) || !std::isfinite(clay.error[r])) continue;
    ++shared;
    const double a2 = air.error[r] * air.error[r], c2 = clay.error[r] * clay.error[r];
    products += air.value[r] * clay.value[r];
    chance += a2 * c2;
    of_air += air.value[r] * air.value[r] - a2;
    of_clay += clay.value[r] * clay.value[r] - c2;
  }
}

Agreement agreement(const AngularConstants& air, const AngularConstants& clay) {
  AgreementSums sums;
  sums.add(air, clay);
  return sums.result();
}

/// The turn as a whole, or both halves of it from `half_turn` on.
std::vector<PolarSums> arcs_of(const PolarSums& sums, const std::optional<std::int64_t>& half_turn) {
  std::vector<PolarSums> arcs;
  if (half_turn)
    for (const std::int64_t first : {*half_turn, *half_turn + PolarSlice::kSectors / 2})
      arcs.push_back(sums.half_from(first));
  else
    arcs.push_back(sums);
  return arcs;
}

Agreement agreement_about(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre) {
  const auto found = constants_over_angles(all_of(sums_of(PolarSlice(dims, centre), slices)));
  return agreement(found[0], found[1]);
}

/// The same in each slice: pixels of other slices are others, and near the axis all that is air may be above the
/// object. What noise leaves of it is less sure, so that it counts where it is sure and better.
Agreement agreement_of_slices(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre,
                              const std::optional<std::int64_t>& half_turn) {
  const std::vector<PolarSums> sums = sums_of(PolarSlice(dims, centre), slices);
  AgreementSums one_by_one, together;
  for (const PolarSums& slice : sums)
    for (const PolarSums& arc : arcs_of(slice, half_turn)) {
      const auto found = constants_over_angles(arc);
      one_by_one.add(found[0], found[1]);
    }
  for (const PolarSums& arc : arcs_of(all_of(sums), half_turn)) {
    const auto found = constants_over_angles(arc);
    together.add(found[0], found[1]);
  }
  const Agreement each = one_by_one.result(), all = together.result();
  return each.together >= kRingsLeastAgreement && each.alike > all.alike ? each : all;
}

/// The most of it where no ring has its centre: beside the centre in four directions.
double agreement_beside(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre,
                        const std::optional<std::int64_t>& half_turn) {
  double most = 0.0;
  for (const glm::dvec2 way : {glm::dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
    most = std::max(most, agreement_of_slices(slices, dims, centre + kRingsControl * way, half_turn).together);
  return most;
}

/// Correlation of opposite halves of the turn, the lesser of two: scans of half a turn have half rings.
double alike_in_halves(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre) {
  const PolarSums sums = all_of(sums_of(PolarSlice(dims, centre), slices));
  double least = 1.0;
  for (const std::int64_t first : {std::int64_t{0}, PolarSlice::kSectors / 4})
    least = std::min(least, agreement(constants_over_angles(sums.half_from(first))[2],
                                      constants_over_angles(sums.half_from(first + PolarSlice::kSectors / 2))[2])
                                .alike);
  return least;
}

/// Energy of what is the same over an arc, in units of chance.
double energy_of(const AngularConstants& both) {
  double sum = 0.0;
  for (std::size_t r = 0; r < both.value.size(); ++r)
    if (std::isfinite(both.error[r])) sum += both.value[r] * both.value[r] / (both.error[r] * both.error[r]);
  return sum;
}

/// From which sector on half rings are other ones: both halves are the most even then.
std::int64_t best_half_turn(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre) {
  const PolarSums sums = all_of(sums_of(PolarSlice(dims, centre), slices));
  std::int64_t best = 0;
  double most = 0.0;
  for (std::int64_t first = 0; first < PolarSlice::kSectors / 2; ++first) {
    double energy = 0.0;
    for (const PolarSums& arc : arcs_of(sums, first)) energy += energy_of(constants_over_angles(arc)[2]);
    if (energy > most) most = energy, best = first;
  }
  return best;
}

/// The largest value of a parabola through values at -step, 0 and step.
double vertex_of(double before, double here, double behind, double step) {
  const double curve = before - 2.0 * here + behind;
  return curve < 0.0 ? std::clamp(0.5 * step * (before - behind) / curve, -step, step) : 0.0;
}

/// Energy of what is the same over all angles.
double energy_about(const RingSlices& slices, const Dims& dims, const glm::dvec2& centre) {
  return energy_of(constants_over_angles(all_of(sums_of(PolarSlice(dims, centre), slices)))[2]);
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
        if (here <= most + 0.05 * std::abs(most)) continue;  // a tenth of a voxel is no reason to leave the middle
        most = here;
        centre = to;
        moved = true;
      }
    }
  }
  return centre;
}

/// What stands out, less what is chance in it, and without what the sharing between two distances took.
std::vector<double> standing_out(const AngularConstants& both, double least) {
  std::vector<double> kept(both.value.size());
  for (std::size_t r = 0; r < kept.size(); ++r) {
    const double size = std::abs(both.value[r]);
    if (size < least || size < kRingsErrors * both.error[r] || both.uneven[r] > kRingsMostUneven * size + both.error[r])
      continue;
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
std::vector<double> peel(PolarSums& sums, double least = 0.0) {
  constexpr int kRounds = 4;
  std::vector<double> rings(static_cast<std::size_t>(sums.radii));
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> more = standing_out(constants_over_angles(sums)[2], least);
    take_off(more, sums);
    for (std::size_t r = 0; r < rings.size(); ++r) rings[r] += more[r];
  }
  return rings;
}

/// What all slices have in common, from some of them: of each arc.
Result<std::vector<std::vector<double>>> rings_of_all(SlabSource& scan, SlabSource& half, float level,
                                                      const PolarSlice& polar,
                                                      const std::optional<std::int64_t>& half_turn,
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
  std::vector<std::vector<double>> rings;
  for (PolarSums& arc : arcs_of(all, half_turn)) rings.push_back(peel(arc));
  return rings;
}

/// Of the slices of a block, in one arc: what all have, then what the block has, then each. Counts for the report.
struct RingCounts {
  double squares = 0.0, seen = 0.0, rings = 0.0, strongest = 0.0;
};
void measure_block(std::vector<PolarSums> sums, std::vector<PolarSums> with_thin, double strong,
                   const std::vector<double>& of_all, std::int64_t stride, float* to, RingCounts& counts) {
  const std::int64_t radii = sums.front().radii;
  for (PolarSums& one : sums) take_off(of_all, one);
  PolarSums together = all_of(sums);
  const std::vector<double> of_block = peel(together);
  const AngularConstants common = constants_over_angles(together)[2];
  parallel_for(static_cast<std::int64_t>(sums.size()), 1, [&](std::int64_t i) {
    PolarSums& one = sums[static_cast<std::size_t>(i)];
    take_off(of_block, one);
    std::vector<double> rings = peel(one);
    for (std::size_t r = 0; r < rings.size(); ++r) rings[r] += of_all[r] + of_block[r];
    PolarSums& thin = with_thin[static_cast<std::size_t>(i)];
    take_off(rings, thin);
    const std::vector<double> more = peel(thin, strong);
    for (std::size_t r = 0; r < rings.size(); ++r)
      to[i * stride + static_cast<std::int64_t>(r)] = static_cast<float>(rings[r] + more[r]);
  });
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(sums.size()); ++i)
    for (std::int64_t r = 0; r < radii; ++r) {
      if (!std::isfinite(common.error[static_cast<std::size_t>(r)])) continue;
      const double ring = to[i * stride + r];
      counts.squares += ring * ring;
      counts.rings += ring != 0.0;
      counts.seen += 1.0;
      counts.strongest = std::max(counts.strongest, std::abs(ring));
    }
}

Result<FoundRings> measure(SlabSource& scan, SlabSource& half, const GreyLevels& levels, const RingsLook& look,
                           Progress& progress) {
  const auto level = static_cast<float>(levels.air + 0.5 * levels.contrast());
  const double strong = kRingsStrong * levels.contrast();
  const Dims d = scan.dims();
  const PolarSlice polar(d, look.centre);
  FoundRings found;
  RingField& field = found.field;
  field.centre = look.centre;
  field.radii = polar.radii();
  if (look.half_turn)
    field.half = HalfTurn{2.0 * std::numbers::pi *
                          (static_cast<double>(*look.half_turn) / static_cast<double>(PolarSlice::kSectors) - 0.5)};
  field.of_slice.resize(static_cast<std::size_t>(field.arcs() * field.radii * d.z));
  DUBSAR_ASSIGN(const auto of_all, rings_of_all(scan, half, level, polar, look.half_turn, progress));
  RingCounts counts;
  for (std::int64_t z = 0; z < d.z; z += kRingsBlock) {
    if (progress.cancelled()) return cancelled_error();
    RingSlices slices;
    slices.first = z;
    for (std::int64_t k = z; k < std::min(d.z, z + kRingsBlock); ++k)
      DUBSAR_TRY(add_slice(scan, half, k, level, slices));
    const std::vector<PolarSums> sums = sums_of(polar, slices);
    DUBSAR_TRY(take_thin_for_rings(half, level, slices));
    const std::vector<PolarSums> with_thin = sums_of(polar, slices);
    for (std::int64_t arc = 0; arc < field.arcs(); ++arc) {
      const auto part = static_cast<std::size_t>(arc);
      std::vector<PolarSums> of_arc, thin_of_arc;
      for (const PolarSums& one : sums) of_arc.push_back(std::move(arcs_of(one, look.half_turn)[part]));
      for (const PolarSums& one : with_thin) thin_of_arc.push_back(std::move(arcs_of(one, look.half_turn)[part]));
      measure_block(std::move(of_arc), std::move(thin_of_arc), strong, of_all[static_cast<std::size_t>(arc)],
                    field.arcs() * field.radii, field.of_slice.data() + (z * field.arcs() + arc) * field.radii, counts);
    }
    progress.advance(static_cast<std::int64_t>(sums.size()) * d.slice());
  }
  found.report.strongest = counts.strongest;
  found.report.deviation = std::sqrt(counts.squares / std::max(1.0, counts.seen));
  found.report.rings = counts.rings / static_cast<double>(d.z);
  return found;
}

/// Looks about the middle, where a reconstruction turns: scans of half a turn.
std::optional<RingsLook> look_for_half_rings(const RingSlices& slices, const Dims& dims, const glm::dvec2& middle) {
  const std::int64_t first = best_half_turn(slices, dims, middle);
  const Agreement here = agreement_of_slices(slices, dims, middle, first);
  const double control = agreement_beside(slices, dims, middle, first);
  const PolarSums sums = all_of(sums_of(PolarSlice(dims, middle), slices));
  AgreementSums quarters;  // first and second of each half
  for (const std::int64_t begin : {first, first + PolarSlice::kSectors / 2}) {
    PolarSums before = sums.half_from(begin).half_from(begin - PolarSlice::kSectors / 4 + PolarSlice::kSectors),
              behind = sums.half_from(begin).half_from(begin + PolarSlice::kSectors / 4);
    quarters.add(constants_over_angles(before)[2], constants_over_angles(behind)[2]);
  }
  log_debug(
      "half rings from sector {}: clay and air agree by {:.1f} deviations, {:.2f} alike, quarters {:.2f}; "
      "elsewhere by {:.1f}",
      first, here.together, here.alike, quarters.result().alike, control);
  if (quarters.result().alike < kRingsLeastAlike || here.together < kRingsLeastAgreement ||
      here.alike < kRingsLeastAlike || control > std::max(kRingsChance, kRingsMostControl * here.together))
    return std::nullopt;
  return RingsLook{middle, std::min(here.alike, 1.0), first};
}

}  // namespace

std::string describe(const RingsReport& rings) {
  return fmt::format(
      "{} of uneven detector pixels about x {:.1f}, y {:.1f}: {:.1f} % of the contrast, the strongest {:.0f} %; "
      "taken off",
      rings.look.half_turn ? "half rings" : "rings", rings.look.centre.x, rings.look.centre.y, 100.0 * rings.deviation,
      100.0 * rings.strongest);
}

std::string describe(const RingsLook& look) {
  return fmt::format("{} of uneven detector pixels about x {:.1f}, y {:.1f}; they will be taken off",
                     look.half_turn ? "half rings" : "rings", look.centre.x, look.centre.y);
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
  const Agreement here = agreement_of_slices(slices, d, centre, std::nullopt);
  const double control = agreement_beside(slices, d, centre, std::nullopt);
  const double halves = alike_in_halves(slices, d, centre);
  log_debug(
      "rings about {:.2f} {:.2f}: clay and air agree by {:.1f} deviations, {:.2f} alike, halves {:.2f}; elsewhere by "
      "{:.1f}",
      centre.x, centre.y, here.together, here.alike, halves, control);
  if (halves < kRingsLeastAlike || here.together < kRingsLeastAgreement || here.alike < kRingsLeastAlike ||
      control > std::max(kRingsChance, kRingsMostControl * here.together))
    return halves < kRingsLeastAlike ? look_for_half_rings(slices, d, middle) : std::nullopt;
  return RingsLook{finer_centre(slices, d, middle, centre), std::min(here.alike, 1.0), std::nullopt};
}

Result<std::optional<FoundRings>> find_rings(SlabSource& scan, SlabSource& half, const GreyLevels& levels,
                                             Progress& progress) {
  progress.begin("rings", scan.dims().count(), "voxel");
  DUBSAR_ASSIGN(const std::optional<RingsLook> look, look_for_rings(scan, half, levels, progress));
  if (!look) return std::nullopt;
  DUBSAR_ASSIGN(FoundRings found, measure(scan, half, levels, *look, progress));
  RingsReport& report = found.report;
  report.look = *look;
  report.deviation /= levels.contrast();
  report.strongest /= levels.contrast();
  if (!(report.deviation > 0.0)) return std::nullopt;
  return found;
}

}  // namespace dubsar
