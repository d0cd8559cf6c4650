#include "core/rays/parallel_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

using kernels::kLanes;

/// Of an image that lies in the second level of cache while a group of directions crosses it.
constexpr std::int64_t kBandBytes = 384 << 10, kDirectionsTogether = 24;
/// Tiles of the image, and directions whose pieces of projections lie in the first level of cache.
constexpr std::int64_t kTile = 16, kDirectionsAtATime = 12;
/// With fewer directions tiles take two of them together, which is as much work as it saves.
constexpr std::int64_t kLeastTiled = 400;

std::int64_t bins_of(std::int64_t width, std::int64_t height) {
  return static_cast<std::int64_t>(std::ceil(std::hypot(static_cast<double>(width), static_cast<double>(height)))) + 3;
}

}  // namespace

std::int64_t ParallelRays::directions_together(std::int64_t directions) noexcept {
  return directions < kLeastTiled ? 1 : TiledRays::directions_together(directions);
}

ParallelRays::ParallelRays(std::int64_t width, std::int64_t height, std::int64_t directions)
    : width_(width), height_(height), bins_(bins_of(width, height)), ramp_(bins_) {
  for (std::int64_t k = 0; k < directions; ++k) {
    const double angle = std::numbers::pi * static_cast<double>(k) / static_cast<double>(directions);
    cos_.push_back(std::cos(angle));
    sin_.push_back(std::sin(angle));
  }
  if (directions_together(directions) > 1) tiled_.emplace(width, height, bins_, directions);
}

void ParallelRays::project(const LaneImage& image, LaneSinogram& out) const {
  if (tiled_) return tiled_->project(image, out);
  const double x_middle = 0.5 * static_cast<double>(width_ - 1), y_middle = 0.5 * static_cast<double>(height_ - 1);
  const std::int64_t groups = (directions() + kDirectionsTogether - 1) / kDirectionsTogether;
  parallel_for(groups, 1, [&](std::int64_t group) {
    const std::int64_t first = group * kDirectionsTogether, last = std::min(directions(), first + kDirectionsTogether);
    std::fill(out.row(first), out.row(last - 1) + out.row_floats(), 0.0F);
    for (const bool along_y : {true, false}) {
      const std::int64_t major = along_y ? height_ : width_, minor = along_y ? width_ : height_;
      const std::int64_t thick =
          std::clamp<std::int64_t>(kBandBytes / (minor * kLanes * static_cast<std::int64_t>(sizeof(float))), 4, 64);
      for (std::int64_t begin = 0; begin < major; begin += thick)
        for (std::int64_t k = first; k < last; ++k) {
          const double c = cos_[static_cast<std::size_t>(k)], s = sin_[static_cast<std::size_t>(k)];
          if ((std::abs(c) >= std::abs(s)) != along_y) continue;
          const double across = along_y ? c : s, along = along_y ? s : c;
          const double minor_middle = along_y ? x_middle : y_middle, major_middle = along_y ? y_middle : x_middle;
          const kernels::CrossedBand band{.image = image.at(0, 0),
                                          .major_stride = along_y ? image.row_stride() : kLanes,
                                          .minor_stride = along_y ? kLanes : image.row_stride(),
                                          .begin = begin,
                                          .end = std::min(major, begin + thick),
                                          .minor = minor,
                                          .first = minor_middle + (major_middle * along - middle()) / across,
                                          .per_bin = 1.0 / across,
                                          .per_major = -along / across,
                                          .weight = static_cast<float>(1.0 / std::abs(across))};
          kernels::project_band(band, bins_, out.row(k));
        }
    }
  });
}

// A linear interpolation over h takes 1 - h^2 w^2 / 12 of a wave w; Joseph's rule has h = max(|cos|, |sin|) along the
// detector, backprojection h = 1. A cubic one takes 1 - .0153 w^4 in the mean: large images go through two.
void ParallelRays::filter(LaneSinogram& projections) const {
  constexpr float kOfTwoCubic = 2 * 0.0153F;
  parallel_chunks(directions(), 4, [&](std::int64_t begin, std::int64_t end) {
    const std::int64_t floats = projections.row_floats();
    Buffer<float> bent(floats), restored(floats);
    const auto bend = [&](const float* row, std::int64_t i) {
      return 2.0F * row[i] - (i >= kLanes ? row[i - kLanes] : 0.0F) - (i + kLanes < floats ? row[i + kLanes] : 0.0F);
    };
    for (std::int64_t k = begin; k < end; ++k) {
      const double step =
          std::max(std::abs(cos_[static_cast<std::size_t>(k)]), std::abs(sin_[static_cast<std::size_t>(k)]));
      const auto side = static_cast<float>((1.0 + step * step) / 12.0);
      float* const row = projections.row(k);
      for (std::int64_t i = 0; i < floats; ++i) bent[i] = bend(row, i);
      for (std::int64_t i = 0; i < floats; ++i) restored[i] = row[i] + side * bent[i];
      if (tiled_)
        for (std::int64_t i = 0; i < floats; ++i) restored[i] += kOfTwoCubic * bend(bent.data(), i);
      ramp_.apply(restored.data(), row);
    }
  });
}

void ParallelRays::backproject(const LaneSinogram& filtered, LaneImage& out) const {
  out.clear();
  const double x_middle = 0.5 * static_cast<double>(width_ - 1), y_middle = 0.5 * static_cast<double>(height_ - 1);
  const auto scale = static_cast<float>(std::numbers::pi / static_cast<double>(directions()));
  if (tiled_) {
    tiled_->backproject(filtered, out);
    parallel_for(height_, 8, [&](std::int64_t y) {
      for (float* value = out.at(0, y); value < out.at(width_, y); ++value) *value *= scale;
    });
    return;
  }
  const std::int64_t across = (width_ + kTile - 1) / kTile, down = (height_ + kTile - 1) / kTile;
  parallel_for(across * down, 1, [&](std::int64_t tile) {
    const std::int64_t x0 = tile % across * kTile, x1 = std::min(width_, x0 + kTile);
    const std::int64_t y0 = tile / across * kTile, y1 = std::min(height_, y0 + kTile);
    for (std::int64_t first = 0; first < directions(); first += kDirectionsAtATime) {
      const float* rows[kDirectionsAtATime];
      double base[kDirectionsAtATime];
      const std::int64_t count = std::min(kDirectionsAtATime, directions() - first);
      for (std::int64_t k = 0; k < count; ++k) rows[k] = filtered.row(first + k);
      for (std::int64_t y = y0; y < y1; ++y) {
        for (std::int64_t k = 0; k < count; ++k) {
          const auto at = static_cast<std::size_t>(first + k);
          base[k] = middle() - x_middle * cos_[at] + (static_cast<double>(y) - y_middle) * sin_[at];
        }
        kernels::backproject_row({rows, base, cos_.data() + first, count}, x0, x1, out.at(0, y));
      }
    }
    for (std::int64_t y = y0; y < y1; ++y)
      for (float* value = out.at(x0, y); value < out.at(x1, y); ++value) *value *= scale;
  });
}

}  // namespace dubsar
