#include "core/rays/curve_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/rays/curve_evidence.h"
#include "core/rays/sure_materials.h"

namespace dubsar {
namespace {

using kernels::kLanes;

/// Groups of kLanes planes, spread over the object.
constexpr std::int64_t kGroups = 2;
/// Planes whose noise has nothing in common: blur and interpolation reach one voxel.
constexpr std::int64_t kApart = 2;
/// Pixels of clay and of air, for six unknowns: fewer say nothing of a curve.
constexpr std::int64_t kLeastSure = 500;
/// Wrong axes and real differences of clay may even clay out, but not air: up to 13 % of the variance was seen to go,
/// while that of air rose by 30 to 90 %.
constexpr double kLeastBend = 1.1, kMostLeft = 0.8, kMostAirLeft = 1.1;
/// Scatter that varies over the detector leaves much of its unevenness to a curve of lengths alone (.6 to .7 of the
/// variance, and air less even); with its field .03 to .1 are left.
constexpr double kLeftToLookFarther = 0.9, kLeftByStray = 0.8;

/// Pairs of planes, kApart from each other, that show clay, spread evenly, at most kGroups * kLanes planes.
std::vector<std::int64_t> planes_to_look_at(const SureMaterials& sure, const PlaneStrides& at) {
  std::vector<std::uint8_t> shows(static_cast<std::size_t>(at.planes));
  parallel_for(at.planes, 1, [&](std::int64_t plane) {
    for (std::int64_t y = 0; y < at.height; ++y)
      for (std::int64_t x = 0; x < at.width; ++x)
        if (sure.of_voxel[static_cast<std::size_t>(plane * at.to_next + y * at.along_height + x * at.along_width)] ==
            Material::kClay) {
          shows[static_cast<std::size_t>(plane)] = 1;
          return;
        }
  });
  std::vector<std::int64_t> first, some;  // of pairs
  for (std::int64_t plane = 0; plane + kApart < at.planes; ++plane)
    if (shows[static_cast<std::size_t>(plane)] != 0 && shows[static_cast<std::size_t>(plane + kApart)] != 0)
      first.push_back(plane);
  const auto all = static_cast<std::int64_t>(first.size()), wanted = std::min(all, kGroups * kLanes / 2);
  for (std::int64_t k = 0; k < wanted; ++k) {
    some.push_back(first[static_cast<std::size_t>(k * all / wanted)]);
    some.push_back(some.back() + kApart);
  }
  return some;
}

/// Planes across an axis, projected.
struct AxisView {
  AxisView(const Volume<float>& volume, const SureMaterials& sure, TurnAxis turned)
      : axis(turned),
        at(planes_across(volume.dims, turned)),
        planes(planes_to_look_at(sure, at)),
        rays(at.width, at.height, std::max(at.width, at.height)) {}
  std::size_t groups() const { return recorded.size(); }
  std::span<const std::int64_t> planes_of(std::size_t group) const {
    const std::size_t first = group * kLanes;
    return std::span(planes).subspan(first, std::min<std::size_t>(kLanes, planes.size() - first));
  }

  TurnAxis axis;
  PlaneStrides at;
  std::vector<std::int64_t> planes;
  ParallelRays rays;
  std::vector<LaneSinogram> recorded;          ///< of each group of planes
  std::vector<std::vector<LaneImage>> images;  ///< of each group, for each term
  float longest = 0.0F;
};

std::optional<CurveTrial> trial_by(const std::vector<EvenEvidence>& pairs, const AxisView& view) {
  const EvenEvidence evidence = sum_of(pairs);
  if (evidence.clay.count < kLeastSure || evidence.air.count < kLeastSure) return std::nullopt;
  CurveTrial trial;
  trial.axis = view.axis;
  trial.curve.longest = view.longest;
  trial.before = evenness(evidence, {1.0});
  const TermVector c = fit(evidence);
  trial.after = evenness(evidence, c);
  trial.curve.coefficients = c;
  trial.elsewhere = look_elsewhere(pairs);
  return trial;
}

/// By the powers of recorded lengths. Nothing where too few pixels are sure or rays of no length arrive.
Result<std::optional<CurveTrial>> try_axis(const Volume<float>& volume, const SureMaterials& sure, AxisView& view,
                                           std::int64_t& crossings, Progress& progress) {
  const ParallelRays& rays = view.rays;
  const std::size_t groups = (view.planes.size() + kLanes - 1) / kLanes;
  crossings += static_cast<std::int64_t>(groups) * kLanes * view.at.width * view.at.height * rays.directions() *
               static_cast<std::int64_t>(RayCurve::kTerms);
  for (std::size_t group = 0; group < groups; ++group) {
    if (progress.cancelled()) return cancelled_error();
    view.recorded.push_back(rays.sinogram());
    std::vector<LaneImage>& images = view.images.emplace_back();
    for (std::size_t term = 0; term < RayCurve::kTerms; ++term) images.push_back(rays.image());
    load_planes(volume.voxels.data(), view.at, view.planes_of(group), sure.levels, images[0]);
    LaneSinogram& p = view.recorded.back();
    rays.project(images[0], p);
    for (std::int64_t k = 0; k < rays.directions(); ++k)
      view.longest = std::max(view.longest, *std::max_element(p.row(k), p.row(k) + p.row_floats()));
  }
  if (!(view.longest > 1.0F)) return std::nullopt;
  std::vector<EvenEvidence> evidence;  // of each pair of planes
  LaneSinogram power = rays.sinogram();
  for (std::size_t group = 0; group < groups; ++group) {
    const LaneSinogram& p = view.recorded[group];
    for (std::size_t term = 1; term < RayCurve::kTerms; ++term) {
      if (progress.cancelled()) return cancelled_error();
      parallel_for(rays.directions(), 4, [&](std::int64_t k) {
        for (std::int64_t i = 0; i < p.row_floats(); ++i) {
          const float t = std::max(p.row(k)[i], 0.0F) / view.longest;
          float value = t;
          for (std::size_t n = 0; n < term; ++n) value *= t;
          power.row(k)[i] = view.longest * value;
        }
      });
      rays.filter(power);
      rays.backproject(power, view.images[group][term]);
    }
    for (const EvenEvidence& pair : gather(view.images[group], sure, view.at, view.planes_of(group)))
      evidence.push_back(pair);
  }
  return trial_by(evidence, view);
}

/// By the first powers and those of what scatter adds. The images of the last terms are those of the field then.
Result<std::optional<CurveTrial>> try_stray(const SureMaterials& sure, AxisView& view,
                                            std::shared_ptr<const ScatterField> field, Progress& progress) {
  const ParallelRays& rays = view.rays;
  std::vector<LaneSinogram> x;
  struct Largest {
    float x = 0.0F, p = 0.0F, stray = 0.0F;
  };
  Largest largest;
  for (std::size_t group = 0; group < view.groups(); ++group) {
    if (progress.cancelled()) return cancelled_error();
    x.push_back(rays.sinogram());
    const LaneSinogram& p = view.recorded[group];
    const Largest here = parallel_reduce<Largest>(
        rays.directions(), 1, {},
        [&](std::int64_t k, std::int64_t) {
          Largest part;
          float* const row = x.back().row(k);
          field->row(k, rays.directions(), view.planes_of(group), rays.bins(), row);
          for (std::int64_t i = 0; i < p.row_floats(); ++i) {
            if (p.row(k)[i] > part.p) part.p = p.row(k)[i], part.stray = row[i];
            row[i] = std::max(0.0F, row[i]) * std::exp(static_cast<float>(field->absorbed()) * p.row(k)[i]);
            part.x = std::max(part.x, row[i]);
          }
          return part;
        },
        [](Largest all, const Largest& part) {
          all.x = std::max(all.x, part.x);
          return part.p > all.p ? Largest{all.x, part.p, part.stray} : all;
        });
    largest.x = std::max(largest.x, here.x);
    if (here.p > largest.p) largest.p = here.p, largest.stray = here.stray;
  }
  if (!(largest.x > 0.0F)) return std::nullopt;
  std::vector<EvenEvidence> evidence;  // of each pair of planes
  LaneSinogram power = rays.sinogram();
  for (std::size_t group = 0; group < view.groups(); ++group) {
    for (std::size_t term = 0; term < RayCurve::kStrayTerms; ++term) {
      if (progress.cancelled()) return cancelled_error();
      parallel_for(rays.directions(), 4, [&](std::int64_t k) {
        for (std::int64_t i = 0; i < power.row_floats(); ++i) {
          const float t = x[group].row(k)[i] / largest.x;
          power.row(k)[i] = view.longest * (term == 0 ? t : term == 1 ? t * t : t * t * t * t);
        }
      });
      rays.filter(power);
      rays.backproject(power, view.images[group][RayCurve::kPlainTerms + term]);
    }
    for (const EvenEvidence& pair : gather(view.images[group], sure, view.at, view.planes_of(group)))
      evidence.push_back(pair);
  }
  std::optional<CurveTrial> trial = trial_by(evidence, view);
  if (!trial) return trial;
  RayCurve& curve = trial->curve;
  for (std::size_t term = 0; term < RayCurve::kStrayTerms; ++term)
    std::swap(curve.stray[term], curve.coefficients[RayCurve::kPlainTerms + term]);
  curve.absorbed = field->absorbed();
  curve.stray_unit = static_cast<double>(largest.x);
  curve.longest_stray = static_cast<double>(largest.stray);
  trial->stray = std::move(field);
  return trial;
}

/// The field that makes clay and air most even: its spread first, then how much light clay absorbs, then both finer.
Result<std::optional<CurveTrial>> search_stray(const Volume<float>& volume, const SureMaterials& sure, AxisView& view,
                                               std::int64_t& crossings, Progress& progress) {
  const CoarseRays coarse = look_coarsely(volume, view.axis, sure.levels);
  std::optional<CurveTrial> best;
  double best_spread = 0.0, best_absorbed = 1.5;  // of the width; of the longest ray
  const auto look = [&](double spread, double absorbed) -> Result<void> {
    crossings += static_cast<std::int64_t>(view.groups() * RayCurve::kStrayTerms) * kLanes * view.at.width *
                 view.at.height * view.rays.directions();
    DUBSAR_ASSIGN(std::optional<CurveTrial> trial,
                  try_stray(sure, view,
                            std::make_shared<ScatterField>(coarse, absorbed / static_cast<double>(view.longest),
                                                           spread * coarse.width),
                            progress));
    if (trial && (!best || trial->after.sum() < best->after.sum())) {
      best = std::move(trial);
      best_spread = spread;
      best_absorbed = absorbed;
    }
    return {};
  };
  for (const double spread : {0.08, 0.16, 0.32}) DUBSAR_TRY(look(spread, best_absorbed));
  for (const double absorbed : {1.0, 2.25, 3.5})
    if (best) DUBSAR_TRY(look(best_spread, absorbed));
  const double middle = best_spread;
  for (const double factor : {0.75, 1.33})
    if (best) DUBSAR_TRY(look(middle * factor, best_absorbed));
  if (best)
    log_debug(
        "scatter spread by {:.2f} of the width, clay absorbs {:.2f} along the longest ray: air {:.4f} -> {:.4f}, "
        "clay {:.4f} -> {:.4f}; in other planes {:.2f} is left, {:.1f} errors less",
        best_spread, best_absorbed, best->before.air, best->after.air, best->before.clay, best->after.clay,
        best->elsewhere.left, best->elsewhere.gain / best->elsewhere.error);
  return best;
}

/// Whether clay lies at the border of a plane.
bool touches_border(const SureMaterials& sure, const PlaneStrides& at) {
  const auto is_clay = [&](std::int64_t x, std::int64_t y, std::int64_t plane) {
    return sure.of_voxel[static_cast<std::size_t>(plane * at.to_next + y * at.along_height + x * at.along_width)] ==
           Material::kClay;
  };
  for (std::int64_t plane = 0; plane < at.planes; ++plane) {
    for (std::int64_t x = 0; x < at.width; ++x)
      if (is_clay(x, 0, plane) || is_clay(x, at.height - 1, plane)) return true;
    for (std::int64_t y = 0; y < at.height; ++y)
      if (is_clay(0, y, plane) || is_clay(at.width - 1, y, plane)) return true;
  }
  return false;
}

}  // namespace

bool CurveTrial::significant() const noexcept {
  // Without its first term a curve would take away details on short rays.
  return curve.coefficients[0] > 0.2 && bend() > kLeastBend && after.air < kMostAirLeft * before.air + 1e-3 &&
         left() < kMostLeft && elsewhere.sure() && elsewhere.left < kMostLeft;
}

Result<CurveSearch> search_curve(const Volume<float>& volume, std::int64_t margin, std::optional<TurnAxis> only,
                                 const std::shared_ptr<const ScatterField>& known, Progress& progress) {
  CurveSearch search;
  const Result<SureMaterials> sure = find_sure_materials(volume, margin);
  if (!sure || sure->air < kLeastSure || sure->clay < kLeastSure || !(sure->levels.contrast() > 0.0)) return search;
  search.levels = sure->levels;
  std::optional<AxisView> most_bent;
  double least_left = kLeftToLookFarther;
  for (const TurnAxis axis : {TurnAxis::kZ, TurnAxis::kY, TurnAxis::kX}) {
    if (only && axis != *only) continue;
    AxisView view(volume, *sure, axis);
    DUBSAR_ASSIGN(const std::optional<CurveTrial> trial, try_axis(volume, *sure, view, search.crossings, progress));
    if (!trial) continue;
    search.trials.push_back(*trial);
    const char name = "xyz"[static_cast<int>(axis)];
    log_debug(
        "rays about {}: bent by {:.2f}, air {:.4f} -> {:.4f}, clay {:.4f} -> {:.4f} of the contrast; in other planes "
        "{:.2f} is left, {:.1f} errors less",
        name, trial->bend(), trial->before.air, trial->after.air, trial->before.clay, trial->after.clay,
        trial->elsewhere.left, trial->elsewhere.gain / trial->elsewhere.error);
    if (trial->significant() && (!search.found || trial->left() < search.found->left())) search.found = *trial;
    if (known || (trial->bend() > kLeastBend && trial->left() < least_left)) {
      least_left = trial->left();
      most_bent.emplace(std::move(view));
    }
  }
  if (most_bent) {
    std::optional<CurveTrial> stray;
    if (known) {
      DUBSAR_ASSIGN(stray, try_stray(*sure, *most_bent, known, progress));
    } else {
      DUBSAR_ASSIGN(stray, search_stray(volume, *sure, *most_bent, search.crossings, progress));
    }
    if (stray && stray->significant() &&
        (!search.found || stray->after.sum() < kLeftByStray * search.found->after.sum()))
      search.found = std::move(stray);
  }
  if (search.found) search.cut_by_border = touches_border(*sure, planes_across(volume.dims, search.found->axis));
  return search;
}

}  // namespace dubsar
