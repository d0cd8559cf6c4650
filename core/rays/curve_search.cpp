#include "core/rays/curve_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/rays/sure_materials.h"

namespace dubsar {
namespace {

using kernels::kLanes;
constexpr std::size_t kTerms = RayCurve::kTerms;
using Vector = std::array<double, kTerms>;
using Matrix = std::array<Vector, kTerms>;

/// Groups of kLanes planes, spread over the object.
constexpr std::int64_t kGroups = 2;
/// Blocks of clay and of air, for six unknowns: fewer say nothing of a curve.
constexpr std::int64_t kLeastSure = 200;
constexpr double kLeastBend = 1.1, kMostAirLeft = 0.9;

/// Sums over pixels of one kind.
struct Moments {
  Matrix products{};
  Vector sums{};
  double count = 0.0;

  void add(const Vector& v) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      sums[i] += v[i];
      for (std::size_t j = i; j < kTerms; ++j) products[i][j] += v[i] * v[j];
    }
    count += 1.0;
  }
  void add(const Moments& other) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      sums[i] += other.sums[i];
      for (std::size_t j = i; j < kTerms; ++j) products[i][j] += other.products[i][j];
    }
    count += other.count;
  }
  double mean(const Vector& c) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i) sum += c[i] * sums[i];
    return count > 0.0 ? sum / count : 0.0;
  }
  double deviation(const Vector& c) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j < kTerms; ++j) sum += c[i] * c[j] * products[std::min(i, j)][std::max(i, j)];
    const double m = mean(c);
    return count > 0.0 ? std::sqrt(std::max(0.0, sum / count - m * m)) : 0.0;
  }
};

/// Of pixels, and of means of 2x2 pixels of one kind, which show less noise and as much unevenness.
struct Evidence {
  Moments clay, air, clay_blocks, air_blocks;
  void add(const Evidence& other) {
    clay.add(other.clay);
    air.add(other.air);
    clay_blocks.add(other.clay_blocks);
    air_blocks.add(other.air_blocks);
  }
};

/// Planes that show clay, spread evenly, at most kGroups * kLanes.
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
  std::vector<std::int64_t> with_clay, some;
  for (std::int64_t plane = 0; plane < at.planes; ++plane)
    if (shows[static_cast<std::size_t>(plane)] != 0) with_clay.push_back(plane);
  const auto all = static_cast<std::int64_t>(with_clay.size()), wanted = std::min(all, kGroups * kLanes);
  for (std::int64_t k = 0; k < wanted; ++k) some.push_back(with_clay[static_cast<std::size_t>(k * all / wanted)]);
  return some;
}

/// The images at a pixel.
Vector values_at(const std::vector<LaneImage>& images, std::int64_t x, std::int64_t y, std::size_t lane) {
  Vector v{};
  for (std::size_t k = 0; k < kTerms; ++k) v[k] = images[k].at(x, y)[lane];
  return v;
}

Evidence gather(const std::vector<LaneImage>& images, const SureMaterials& sure, const PlaneStrides& at,
                std::span<const std::int64_t> planes) {
  const auto material = [&](std::int64_t x, std::int64_t y, std::size_t lane) {
    return sure
        .of_voxel[static_cast<std::size_t>(planes[lane] * at.to_next + y * at.along_height + x * at.along_width)];
  };
  return parallel_reduce<Evidence>(
      at.height / 2, 4, {},
      [&](std::int64_t begin, std::int64_t end) {
        Evidence part;
        for (std::int64_t y = 2 * begin; y < 2 * end; y += 2)
          for (std::int64_t x = 0; x + 1 < at.width; x += 2)
            for (std::size_t lane = 0; lane < planes.size(); ++lane) {
              Vector block{};
              int of_clay = 0, of_air = 0;
              for (int corner = 0; corner < 4; ++corner) {
                const std::int64_t px = x + (corner & 1), py = y + (corner >> 1);
                const Material here = material(px, py, lane);
                if (here == Material::kUnsure) continue;
                const Vector v = values_at(images, px, py, lane);
                (here == Material::kClay ? part.clay : part.air).add(v);
                ++(here == Material::kClay ? of_clay : of_air);
                for (std::size_t k = 0; k < kTerms; ++k) block[k] += 0.25 * v[k];
              }
              if (of_clay == 4) part.clay_blocks.add(block);
              if (of_air == 4) part.air_blocks.add(block);
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
  return {evidence.clay_blocks.deviation(c) / contrast, evidence.air_blocks.deviation(c) / contrast};
}

/// c that brings the images nearest to 1 in clay and 0 in air. Of blocks: noise of the images themselves pulls c down.
Vector fit(const Evidence& evidence) {
  Matrix gram{};
  Vector right{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    right[i] = evidence.clay_blocks.sums[i] / evidence.clay_blocks.count;
    for (std::size_t j = 0; j < kTerms; ++j) {
      const std::size_t low = std::min(i, j), high = std::max(i, j);
      gram[i][j] = evidence.clay_blocks.products[low][high] / evidence.clay_blocks.count +
                   evidence.air_blocks.products[low][high] / evidence.air_blocks.count;
    }
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
  crossings += groups * kLanes * at.width * at.height * rays.directions() * static_cast<std::int64_t>(kTerms);
  const auto part = [&](std::size_t first) {
    return std::span(planes).subspan(first, std::min<std::size_t>(kLanes, planes.size() - first));
  };
  std::vector<LaneImage> images;
  for (std::size_t term = 0; term < kTerms; ++term) images.push_back(rays.image());
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
    for (std::size_t term = 1; term < kTerms; ++term) {
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
  if (evidence.clay_blocks.count < kLeastSure || evidence.air_blocks.count < kLeastSure) return std::nullopt;
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
  return curve.coefficients[0] > 0.2 && bend() > kLeastBend && after.air < kMostAirLeft * before.air;
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
    log_debug("rays about {}, {} cells: bent by {:.2f}, air {:.4f} -> {:.4f}, clay {:.4f} -> {:.4f} of the contrast",
              "xyz"[static_cast<int>(axis)], trial -> bend(), trial -> before.air, trial->after.air, trial->before.clay,
              trial->after.clay);
    const auto left = [](const CurveTrial& t) { return t.after.air / t.before.air; };
    if (trial->significant() && (!search.found || left(*trial) < left(*search.found))) search.found = *trial;
  }
  if (search.found) search.cut_by_border = touches_border(*sure, planes_across(volume.dims, search.found->axis));
  return search;
}

}  // namespace dubsar
