#include "core/rays/tiled_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

using kernels::kLanes;

/// Of a band that rays cross, 0.5 MB at a time: its rows, the columns beside it from which rays enter, and the columns
/// that are crossed by all groups in turn.
constexpr std::int64_t kThick = 32, kBeyond = kThick / 2 + 2, kAcross = 128;
/// Tiles whose sinogram, of all groups of directions, lies in the second level of cache; of 1871 directions 1.2 MB.
constexpr std::int64_t kSide = 64, kLocalHalf = 47, kLocalBins = 2 * kLocalHalf + 1;
/// Pieces of a tile, and groups whose pieces of rows lie in the first level of cache.
constexpr std::int64_t kPiece = 16, kGroupsAtATime = 12;
/// Directions of one task of projection, so that each task reads the image seldom and there are enough for all threads.
constexpr std::int64_t kDirectionsOfTask = 24;
constexpr double kMostOff = 0.25;
constexpr double kRadius = 0.5 * (kSide - 1) * std::numbers::sqrt2;
static_assert(kLocalHalf > kRadius + 1.0);

/// Directions `apart` from each other, of which none is farther than kMostOff from their middle at this radius.
std::int64_t together_for(double radius, double apart) {
  return static_cast<std::int64_t>(2.0 * kMostOff / (radius * apart)) + 1;
}

}  // namespace

std::int64_t TiledRays::directions_together(std::int64_t directions) noexcept {
  return together_for(kRadius, std::numbers::pi / static_cast<double>(directions));
}

TiledRays::TiledRays(std::int64_t width, std::int64_t height, std::int64_t bins, std::int64_t directions)
    : width_(width), height_(height), bins_(bins), directions_(directions), together_(directions_together(directions)) {
  const double apart = std::numbers::pi / static_cast<double>(directions);
  of_band_ = std::min(kDirectionsOfTask / 2, together_for(0.5 * kThick, apart));
  for (std::int64_t k = 0; k < directions; ++k) {
    cos_.push_back(std::cos(apart * static_cast<double>(k)));
    sin_.push_back(std::sin(apart * static_cast<double>(k)));
  }
  for (std::int64_t first = 0; first < directions; first += together_) {
    const std::int64_t count = std::min(together_, directions - first);
    const double angle = apart * (static_cast<double>(first) + 0.5 * static_cast<double>(count - 1));
    group_cos_.push_back(std::cos(angle));
    group_sin_.push_back(std::sin(angle));
  }
}

std::int64_t TiledRays::tiles() const noexcept {
  return (width_ + kSide - 1) / kSide * ((height_ + kSide - 1) / kSide);
}

TiledRays::Tile TiledRays::tile(std::int64_t k) const noexcept {
  const std::int64_t across = (width_ + kSide - 1) / kSide;
  const std::int64_t x = k % across * kSide, y = k / across * kSide;
  return {x, y, std::min(kSide, width_ - x), std::min(kSide, height_ - y)};
}

double TiledRays::place_of(const Tile& tile, std::int64_t direction) const noexcept {
  const double x = static_cast<double>(tile.x) + 0.5 * static_cast<double>(tile.width - width_);
  const double y = static_cast<double>(tile.y) + 0.5 * static_cast<double>(tile.height - height_);
  const auto k = static_cast<std::size_t>(direction);
  return 0.5 * static_cast<double>(bins_ - 1) + x * cos_[k] + y * sin_[k];
}

void TiledRays::project(const LaneImage& image, LaneSinogram& out) const {
  parallel_for((directions_ + kDirectionsOfTask - 1) / kDirectionsOfTask, 1, [&](std::int64_t task) {
    const std::int64_t task_first = task * kDirectionsOfTask;
    const std::int64_t task_last = std::min(directions_, task_first + kDirectionsOfTask);
    std::fill(out.row(task_first), out.row(task_last - 1) + out.row_floats(), 0.0F);
    for (const bool along_y : {true, false}) project_bands(image, {task_first, task_last, along_y}, out);
  });
}

void TiledRays::project_bands(const LaneImage& image, const Task& task, LaneSinogram& out) const {
  const std::int64_t all_major = task.along_y ? height_ : width_, minor = task.along_y ? width_ : height_;
  const double minor_middle = 0.5 * static_cast<double>(minor - 1);
  const double major_middle = 0.5 * static_cast<double>(all_major - 1), middle = 0.5 * static_cast<double>(bins_ - 1);
  const auto across_of = [&](std::int64_t k) { return (task.along_y ? cos_ : sin_)[static_cast<std::size_t>(k)]; };
  const auto along_of = [&](std::int64_t k) { return (task.along_y ? sin_ : cos_)[static_cast<std::size_t>(k)]; };
  // Groups of directions whose rays follow this axis.
  struct Group {
    std::int64_t first, last;
    double per_major;
  };
  std::vector<Group> groups;
  for (std::int64_t k = task.first; k < task.last; ++k) {
    if ((std::abs(cos_[static_cast<std::size_t>(k)]) >= std::abs(sin_[static_cast<std::size_t>(k)])) != task.along_y)
      continue;
    if (groups.empty() || groups.back().last != k || k - groups.back().first == of_band_) groups.push_back({k, k, 0.0});
    groups.back().last = k + 1;
  }
  if (groups.empty()) return;
  for (Group& group : groups) {
    for (std::int64_t k = group.first; k < group.last; ++k) group.per_major -= along_of(k) / across_of(k);
    group.per_major /= static_cast<double>(group.last - group.first);
  }
  const std::int64_t local = minor + 2 * kBeyond;
  std::vector<float> crossed(groups.size() * static_cast<std::size_t>(local * kLanes));
  for (std::int64_t begin = 0; begin < all_major; begin += kThick) {
    const std::int64_t major = std::min(kThick, all_major - begin);
    std::fill(crossed.begin(), crossed.end(), 0.0F);
    for (std::int64_t from = 0; from < local; from += kAcross)
      for (std::size_t g = 0; g < groups.size(); ++g)
        kernels::project_band(
            {.image = task.along_y ? image.at(0, begin) : image.at(begin, 0),
             .major_stride = task.along_y ? image.row_stride() : kLanes,
             .minor_stride = task.along_y ? kLanes : image.row_stride(),
             .begin = 0,
             .end = major,
             .minor = minor,
             .first = static_cast<double>(from - kBeyond) - 0.5 * static_cast<double>(major - 1) * groups[g].per_major,
             .per_bin = 1.0,
             .per_major = groups[g].per_major,
             .weight = 1.0F},
            std::min(kAcross, local - from), crossed.data() + (static_cast<std::int64_t>(g) * local + from) * kLanes);
    // Where a ray crosses the middle of the band, its sum is that of the group's rays beside it.
    const double band_middle = static_cast<double>(begin) + 0.5 * static_cast<double>(major - 1) - major_middle;
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (std::int64_t k = groups[g].first; k < groups[g].last; ++k) {
        const double across = across_of(k);
        const double first =
            static_cast<double>(kBeyond) + minor_middle - (middle + band_middle * along_of(k)) / across;
        kernels::add_sampled({crossed.data() + static_cast<std::int64_t>(g) * local * kLanes, local}, first,
                             1.0 / across, static_cast<float>(1.0 / std::abs(across)), bins_, out.row(k));
      }
  }
}

void TiledRays::backproject(const LaneSinogram& filtered, LaneImage& out) const {
  const auto groups = static_cast<std::int64_t>(group_cos_.size());
  constexpr std::int64_t kRow = kLocalBins * kLanes;
  parallel_for(tiles(), 1, [&](std::int64_t k) {
    const Tile at = tile(k);
    thread_local std::vector<float> local;
    local.assign(static_cast<std::size_t>(groups * kRow), 0.0F);
    for (std::int64_t direction = 0; direction < directions_; ++direction)
      kernels::add_interpolated(filtered.row(direction), bins_,
                                place_of(at, direction) - static_cast<double>(kLocalHalf), kLocalBins,
                                local.data() + direction / together_ * kRow);
    const double x_middle = static_cast<double>(at.x) + 0.5 * static_cast<double>(at.width - 1);
    const double y_middle = static_cast<double>(at.y) + 0.5 * static_cast<double>(at.height - 1);
    for (std::int64_t y0 = at.y; y0 < at.y + at.height; y0 += kPiece)
      for (std::int64_t x0 = at.x; x0 < at.x + at.width; x0 += kPiece)
        for (std::int64_t first = 0; first < groups; first += kGroupsAtATime) {
          const float* rows[kGroupsAtATime];
          double base[kGroupsAtATime];
          const std::int64_t count = std::min(kGroupsAtATime, groups - first);
          for (std::int64_t g = 0; g < count; ++g) rows[g] = local.data() + (first + g) * kRow;
          for (std::int64_t y = y0; y < std::min(at.y + at.height, y0 + kPiece); ++y) {
            for (std::int64_t g = 0; g < count; ++g) {
              const auto group = static_cast<std::size_t>(first + g);
              base[g] = static_cast<double>(kLocalHalf) - x_middle * group_cos_[group] +
                        (static_cast<double>(y) - y_middle) * group_sin_[group];
            }
            kernels::backproject_row({rows, base, group_cos_.data() + first, count}, x0,
                                     std::min(at.x + at.width, x0 + kPiece), out.at(0, y));
          }
        }
  });
}

}  // namespace dubsar
