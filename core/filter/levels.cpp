#include "core/filter/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kCell = LevelShift::kCell;
/// Voxels beside the surface, its own not counted. As many on both sides, so that what the blur leaves there cancels.
constexpr std::int64_t kClayReach = 3, kAirReach = 3;
constexpr std::int64_t kLeastGap = 3;  ///< voxels of air along an axis: in narrower ones none is clear
constexpr std::int64_t kHalo = kAirReach + 3;
/// Between both sides of a profile, of the scan's: edges in strong scatter have .55, crumbs in foam .25.
constexpr double kLeastContrast = 0.4;
constexpr double kGauss = 12.0 / static_cast<double>(kCell);  ///< deviation, cells
constexpr int kGaussReach = 5;                                ///< cells
constexpr double kGlobalWeight = 1.0;  ///< samples, after averaging: a hundredth of what a flat piece of surface has
constexpr int kRounds = 3;
/// Of the contrast, at a tenth of the surface: phantoms without scatter whose gaps are three voxels wide have up to
/// .025.
constexpr double kLeastShift = 0.04;
constexpr double kEnds = 0.1;

/// Sums over the samples of a cell.
struct Sums {
  double clay = 0.0, clays = 0.0, air = 0.0, airs = 0.0;
  void add(const Sums& more, double weight) {
    clay += weight * more.clay;
    clays += weight * more.clays;
    air += weight * more.air;
    airs += weight * more.airs;
  }
};

std::int64_t cells_along(std::int64_t n) { return (n + kCell - 1) / kCell; }

/// One line of values through a crossing, from the first voxel on one side on.
struct Line {
  const float* from;
  std::int64_t step, count;  ///< count: voxels to the end of what is known
  float value(std::int64_t i) const { return from[i * step]; }
};

class Profiles {
 public:
  Profiles(const LevelOptions& options)
      : options_(options),
        least_contrast_(kLeastContrast * (static_cast<double>(options.clay) - static_cast<double>(options.air))) {}

  /// `clay` and `air` begin at the two ends of an edge that the surface crosses.
  void add(const Line& clay, const Line& air, float level, Sums& sums) const {
    std::int64_t deep = 1;
    while (deep < std::min(clay.count, kClayReach + 1) && clay.value(deep) >= level) ++deep;
    // What ends sooner is no clay that could be measured: crumbs that noise makes of foam, say, whose level would make
    // more of them.
    if (deep <= kClayReach && deep < clay.count) return;
    Sums here;
    for (std::int64_t i = 1; i < deep; ++i) take(clay.value(i), here.clay, here.clays);
    std::int64_t wide = 1;
    while (wide < std::min(air.count, kAirReach + 2) && air.value(wide) < level) ++wide;
    if (wide >= kLeastGap)
      for (std::int64_t i = 1; i < std::min(wide - 1, kAirReach + 1); ++i) take(air.value(i), here.air, here.airs);
    if (here.clays > 0.0 && here.airs > 0.0 && here.clay / here.clays - here.air / here.airs < least_contrast_) return;
    sums.add(here, 1.0);
  }

 private:
  void take(float value, double& sum, double& count) const {
    for (const float constant : options_.constants)
      if (value == constant) return;
    sum += static_cast<double>(value);
    count += 1.0;
  }
  const LevelOptions& options_;
  double least_contrast_;
};

/// Samples of all cells, with the surface where `shift` puts it.
Result<std::vector<Sums>> gather(SlabSource& source, const LevelOptions& options, const LevelShift& shift,
                                 Progress& progress) {
  const Dims d = source.dims(), cells = shift.cells();
  std::vector<Sums> sums(static_cast<std::size_t>(cells.count()));
  Buffer<float> slab((kCell + 2 * kHalo) * d.slice());
  const Profiles profiles(options);
  for (std::int64_t cz = 0; cz < cells.z; ++cz) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t z0 = std::max<std::int64_t>(cz * kCell - kHalo, 0), z1 = std::min((cz + 1) * kCell + kHalo, d.z);
    DUBSAR_TRY(source.read(z0, z1, slab.span()));
    parallel_for(cells.y, 1, [&](std::int64_t cy) {
      for (std::int64_t z = cz * kCell; z < std::min((cz + 1) * kCell, d.z); ++z)
        for (std::int64_t y = cy * kCell; y < std::min((cy + 1) * kCell, d.y); ++y) {
          const float* const row = slab.data() + ((z - z0) * d.y + y) * d.x;
          for (std::int64_t cx = 0; cx < cells.x; ++cx) {
            Sums& cell = sums[static_cast<std::size_t>((cz * cells.y + cy) * cells.x + cx)];
            const float level = options.threshold + shift.at(cx, cy, cz);
            for (std::int64_t x = cx * kCell; x < std::min((cx + 1) * kCell, d.x); ++x) {
              const std::array<std::int64_t, 3> at{x, y, z - z0}, size{d.x, d.y, z1 - z0}, step{1, d.x, d.slice()};
              const bool inside = row[x] >= level;
              for (std::size_t a = 0; a < 3; ++a) {
                if (at[a] + 1 >= size[a] || (row[x + step[a]] >= level) == inside) continue;
                const Line back{row + x, -step[a], at[a] + 1}, on{row + x + step[a], step[a], size[a] - at[a] - 1};
                profiles.add(inside ? back : on, inside ? on : back, level, cell);
              }
            }
          }
        }
    });
  }
  return sums;
}

/// Averaged along all three axes.
std::vector<Sums> averaged(std::vector<Sums> sums, const Dims& cells) {
  std::array<double, 2 * kGaussReach + 1> weights{};
  double all = 0.0;
  for (int k = -kGaussReach; k <= kGaussReach; ++k)
    all += weights[static_cast<std::size_t>(k + kGaussReach)] = std::exp(-0.5 * k * k / (kGauss * kGauss));
  const std::array<std::int64_t, 3> size{cells.x, cells.y, cells.z}, step{1, cells.x, cells.slice()};
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<Sums> out(sums.size());
    parallel_for(cells.count(), 1024, [&](std::int64_t i) {
      const std::int64_t place = i / step[a] % size[a];
      for (std::int64_t k = -kGaussReach; k <= kGaussReach; ++k)
        if (place + k >= 0 && place + k < size[a])
          out[static_cast<std::size_t>(i)].add(sums[static_cast<std::size_t>(i + k * step[a])],
                                               weights[static_cast<std::size_t>(k + kGaussReach)] / all);
    });
    sums = std::move(out);
  }
  return sums;
}

struct Pair {
  double clay = 0.0, air = 0.0;
};

/// The levels of all cells. What the average leaves is averaged once more and added (twicing, Tukey 1977): where all
/// samples lie to one side, as at the end of an object, an average is that of a place farther in.
std::vector<Pair> fields_of(const std::vector<Sums>& samples, const Pair& whole, const Dims& cells) {
  std::vector<Pair> fields(samples.size(), whole);
  std::vector<Sums> left = samples;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < left.size(); ++i) {
      left[i].clay = samples[i].clay - samples[i].clays * fields[i].clay;
      left[i].air = samples[i].air - samples[i].airs * fields[i].air;
    }
    const std::vector<Sums> smooth = averaged(left, cells);
    for (std::size_t i = 0; i < left.size(); ++i) {
      fields[i].clay += smooth[i].clay / (smooth[i].clays + kGlobalWeight);
      fields[i].air += smooth[i].air / (smooth[i].airs + kGlobalWeight);
    }
  }
  return fields;
}

}  // namespace

LevelShift::LevelShift(const Dims& dims)
    : cells_{cells_along(dims.x), cells_along(dims.y), cells_along(dims.z)},
      shift_(static_cast<std::size_t>(cells_.count()), 0.0f) {}

void LevelShift::subtract(std::int64_t y, std::int64_t z, std::span<float> row) const {
  struct Between {
    std::int64_t first, second;
    float share;  ///< of the second
  };
  const auto between = [](std::int64_t at, std::int64_t cells) {
    const float place = (static_cast<float>(at) + 0.5f) / static_cast<float>(kCell) - 0.5f;
    const auto first = static_cast<std::int64_t>(std::floor(place));
    return Between{std::clamp<std::int64_t>(first, 0, cells - 1), std::clamp<std::int64_t>(first + 1, 0, cells - 1),
                   place - static_cast<float>(first)};
  };
  const Between in_y = between(y, cells_.y), in_z = between(z, cells_.z);
  const auto mix = [](float a, float b, float share) { return a + share * (b - a); };
  std::vector<float> line(static_cast<std::size_t>(cells_.x));
  for (std::int64_t cx = 0; cx < cells_.x; ++cx)
    line[static_cast<std::size_t>(cx)] =
        mix(mix(at(cx, in_y.first, in_z.first), at(cx, in_y.second, in_z.first), in_y.share),
            mix(at(cx, in_y.first, in_z.second), at(cx, in_y.second, in_z.second), in_y.share), in_z.share);
  for (std::size_t x = 0; x < row.size(); ++x) {
    const Between in_x = between(static_cast<std::int64_t>(x), cells_.x);
    row[x] -= mix(line[static_cast<std::size_t>(in_x.first)], line[static_cast<std::size_t>(in_x.second)], in_x.share);
  }
}

Result<LocalLevels> measure_levels(SlabSource& source, const LevelOptions& options, Progress& progress) {
  const double contrast = static_cast<double>(options.clay) - static_cast<double>(options.air);
  LocalLevels levels;
  if (!(contrast > 0.0)) return levels;
  levels.shift = LevelShift(source.dims());
  const Dims cells = levels.shift.cells();
  for (int round = 0; round < kRounds; ++round) {
    DUBSAR_ASSIGN(const std::vector<Sums> samples, gather(source, options, levels.shift, progress));
    Sums all;
    for (const Sums& cell : samples) all.add(cell, 1.0);
    if (all.clays == 0.0 || all.airs == 0.0) return LocalLevels{};
    const std::vector<Pair> fields = fields_of(samples, {all.clay / all.clays, all.air / all.airs}, cells);
    std::vector<double> along_surface;
    for (std::int64_t i = 0; i < cells.count(); ++i) {
      const Pair& here = fields[static_cast<std::size_t>(i)];
      const double shift = 0.5 * (here.clay + here.air) - static_cast<double>(options.threshold);
      levels.shift.at(i % cells.x, i / cells.x % cells.y, i / cells.slice()) = static_cast<float>(shift);
      if (samples[static_cast<std::size_t>(i)].clays > 0.0) along_surface.push_back(shift / contrast);
    }
    std::sort(along_surface.begin(), along_surface.end());
    const auto last = static_cast<double>(along_surface.size() - 1);
    levels.least = along_surface[static_cast<std::size_t>(kEnds * last)];
    levels.most = along_surface[static_cast<std::size_t>((1.0 - kEnds) * last)];
    if (std::max(-levels.least, levels.most) < kLeastShift) {
      levels.shift = LevelShift();
      return levels;
    }
  }
  return levels;
}

std::string describe(const LocalLevels& levels) {
  return fmt::format(
      "half way between air and clay lies {:+.0f} to {:+.0f} % of the contrast from where it is for the whole scan: {}",
      100.0 * levels.least, 100.0 * levels.most,
      levels.shift.empty() ? "one threshold does"
                           : "scatter or hardening made it uneven, and the surface follows the levels beside it");
}

Result<void> LevelledSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_TRY(source_->read(z_begin, z_end, out));
  const Dims d = dims();
  parallel_for((z_end - z_begin) * d.y, 64, [&](std::int64_t i) {
    shift_->subtract(i % d.y, z_begin + i / d.y,
                     out.subspan(static_cast<std::size_t>(i * d.x), static_cast<std::size_t>(d.x)));
  });
  return {};
}

}  // namespace dubsar
