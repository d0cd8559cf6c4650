#include "core/rays/curve_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/rays/sure_materials.h"

namespace dubsar {
namespace {

using kernels::kLanes;
using Vector = std::array<double, RayCurve::kTerms>;
using Matrix = std::array<Vector, RayCurve::kTerms>;

/// Groups of kLanes planes, spread over the object.
constexpr std::int64_t kGroups = 2;
/// Planes whose noise has nothing in common: blur and interpolation reach one voxel.
constexpr std::int64_t kApart = 2;
/// Pixels of clay and of air, for six unknowns: fewer say nothing of a curve.
constexpr std::int64_t kLeastSure = 500;
/// Products of two planes may be a little less than 0 by chance, squares are not: parts of the contrast, squared.
constexpr double kRidge = 1e-5;
/// Wrong axes and real differences of clay may even clay out, but not air: up to 13 % of the variance was seen to go,
/// while that of air rose by 30 to 90 %.
constexpr double kLeastBend = 1.1, kMostLeft = 0.8, kMostAirLeft = 1.1;

/// Sums over pixels of one kind, each seen in two planes close to each other. Products are those of one plane with the
/// other: their noise has nothing in common, what scatter and hardening do has.
struct Moments {
  Matrix products{};
  Vector sums{};
  double count = 0.0;

  void add(const Vector& v, const Vector& w) {
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
      sums[i] += 0.5 * (v[i] + w[i]);
      for (std::size_t j = i; j < RayCurve::kTerms; ++j) products[i][j] += 0.5 * (v[i] * w[j] + v[j] * w[i]);
    }
    count += 1.0;
  }
  void add(const Moments& other) {
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
      sums[i] += other.sums[i];
      for (std::size_t j = i; j < RayCurve::kTerms; ++j) products[i][j] += other.products[i][j];
    }
    count += other.count;
  }
  double product(std::size_t i, std::size_t j) const { return products[std::min(i, j)][std::max(i, j)] / count; }
  double mean(const Vector& c) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i) sum += c[i] * sums[i];
    return sum / count;
  }
  double deviation(const Vector& c) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < RayCurve::kTerms; ++i)
      for (std::size_t j = 0; j < RayCurve::kTerms; ++j) sum += c[i] * c[j] * product(i, j);
    const double m = mean(c);
    return std::sqrt(std::max(0.0, sum - m * m));
  }
};

struct Evidence {
  Moments clay, air;
  void add(const Evidence& other) {
    clay.add(other.clay);
    air.add(other.air);
  }
};

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

/// The images at a pixel.
Vector values_at(const std::vector<LaneImage>& images, std::int64_t x, std::int64_t y, std::size_t lane) {
  Vector v{};
  for (std::size_t k = 0; k < RayCurve::kTerms; ++k) v[k] = images[k].at(x, y)[lane];
  return v;
}

Evidence gather(const std::vector<LaneImage>& images, const SureMaterials& sure, const PlaneStrides& at,
                std::span<const std::int64_t> planes) {
  const auto material = [&](std::int64_t x, std::int64_t y, std::size_t lane) {
    return sure
        .of_voxel[static_cast<std::size_t>(planes[lane] * at.to_next + y * at.along_height + x * at.along_width)];
  };
  return parallel_reduce<Evidence>(
      at.height, 8, {},
      [&](std::int64_t begin, std::int64_t end) {
        Evidence part;
        for (std::int64_t y = begin; y < end; ++y)
          for (std::int64_t x = 0; x < at.width; ++x)
            for (std::size_t lane = 0; lane + 1 < planes.size(); lane += 2) {
              const Material here = material(x, y, lane);
              if (here == Material::kUnsure || here != material(x, y, lane + 1)) continue;
              (here == Material::kClay ? part.clay : part.air)
                  .add(values_at(images, x, y, lane), values_at(images, x, y, lane + 1));
            }
        return part;
      },
      [](Evidence all, const Evidence& part) {
        all.add(part);
        return all;
      });
}

Evenness evenness(const Evidence& evidence, const Vector& c) {
  const double contrast = evidence.clay.mean(c) - evidence.air.mean(c);
  return {evidence.clay.deviation(c) / contrast, evidence.air.deviation(c) / contrast};
}

/// c that brings the images nearest to 1 in clay and 0 in air.
Vector fit(const Evidence& evidence) {
  Matrix gram{};
  Vector right{};
  for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
    right[i] = evidence.clay.sums[i] / evidence.clay.count;
    for (std::size_t j = 0; j < RayCurve::kTerms; ++j)
      gram[i][j] = evidence.clay.product(i, j) + evidence.air.product(i, j);
    gram[i][i] += kRidge;
  }
  return nonnegative_fit(gram, right);
}

/// Nothing where too few pixels are sure or rays of no length arrive.
Result<std::optional<CurveTrial>> try_axis(const Volume<float>& volume, const SureMaterials& sure, TurnAxis axis,
                                           std::int64_t& crossings, Progress& progress) {
  const PlaneStrides at = planes_across(volume.dims, axis);
  const std::vector<std::int64_t> planes = planes_to_look_at(sure, at);
  const ParallelRays rays(at.width, at.height, std::max(at.width, at.height));
  const auto groups = (static_cast<std::int64_t>(planes.size()) + kLanes - 1) / kLanes;
  crossings += groups * kLanes * at.width * at.height * rays.directions() * static_cast<std::int64_t>(RayCurve::kTerms);
  const auto part = [&](std::size_t first) {
    return std::span(planes).subspan(first, std::min<std::size_t>(kLanes, planes.size() - first));
  };
  std::vector<LaneImage> images;
  for (std::size_t term = 0; term < RayCurve::kTerms; ++term) images.push_back(rays.image());
  std::vector<LaneSinogram> recorded;
  float longest = 0.0F;
  for (std::size_t first = 0; first < planes.size(); first += kLanes) {
    if (progress.cancelled()) return cancelled_error();
    load_planes(volume.voxels.data(), at, part(first), sure.levels, images[0]);
    recorded.push_back(rays.sinogram());
    rays.project(images[0], recorded.back());
    for (std::int64_t k = 0; k < rays.directions(); ++k)
      longest = std::max(
          longest, *std::max_element(recorded.back().row(k), recorded.back().row(k) + recorded.back().row_floats()));
  }
  if (!(longest > 1.0F)) return std::nullopt;
  Evidence evidence;
  LaneSinogram power = rays.sinogram();
  for (std::size_t first = 0; first < planes.size(); first += kLanes) {
    load_planes(volume.voxels.data(), at, part(first), sure.levels, images[0]);
    const LaneSinogram& p = recorded[first / kLanes];
    for (std::size_t term = 1; term < RayCurve::kTerms; ++term) {
      if (progress.cancelled()) return cancelled_error();
      parallel_for(rays.directions(), 4, [&](std::int64_t k) {
        for (std::int64_t i = 0; i < p.row_floats(); ++i) {
          const float t = std::max(p.row(k)[i], 0.0F) / longest;
          float value = t;
          for (std::size_t n = 0; n < term; ++n) value *= t;
          power.row(k)[i] = longest * value;
        }
      });
      rays.filter(power);
      rays.backproject(power, images[term]);
    }
    evidence.add(gather(images, sure, at, part(first)));
  }
  if (evidence.clay.count < kLeastSure || evidence.air.count < kLeastSure) return std::nullopt;
  const Vector as_it_is{1.0};
  CurveTrial trial;
  trial.axis = axis;
  trial.curve = {fit(evidence), longest};
  trial.before = evenness(evidence, as_it_is);
  trial.after = evenness(evidence, trial.curve.coefficients);
  return std::optional(trial);
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
         left() < kMostLeft;
}

Result<CurveSearch> search_curve(const Volume<float>& volume, std::int64_t margin, std::optional<TurnAxis> only,
                                 Progress& progress) {
  CurveSearch search;
  const Result<SureMaterials> sure = find_sure_materials(volume, margin);
  if (!sure || sure->air < kLeastSure || sure->clay < kLeastSure || !(sure->levels.contrast() > 0.0)) return search;
  search.levels = sure->levels;
  for (const TurnAxis axis : {TurnAxis::kZ, TurnAxis::kY, TurnAxis::kX}) {
    if (only && axis != *only) continue;
    DUBSAR_ASSIGN(const std::optional<CurveTrial> trial, try_axis(volume, *sure, axis, search.crossings, progress));
    if (!trial) continue;
    search.trials.push_back(*trial);
    const char name = "xyz"[static_cast<int>(axis)];
    log_debug("rays about {}: bent by {:.2f}, air {:.4f} -> {:.4f}, clay {:.4f} -> {:.4f} of the contrast", name,
              trial->bend(), trial->before.air, trial->after.air, trial->before.clay, trial->after.clay);
    if (trial->significant() && (!search.found || trial->left() < search.found->left())) search.found = *trial;
  }
  if (search.found) search.cut_by_border = touches_border(*sure, planes_across(volume.dims, search.found->axis));
  return search;
}

}  // namespace dubsar
