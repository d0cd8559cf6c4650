#include "core/rays/scatter_field.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

using kernels::kLanes;

/// Scatter is smooth: a Gauss of a sixteenth of the width is wider than three cells.
constexpr std::int64_t kStrayCells = 64, kStrayDirections = 48;

/// Means of cells of voxels; what does not fill a cell at the far ends is left out.
Volume<float> means_of_cells(const Volume<float>& volume, std::int64_t cell) {
  const auto cells = [&](std::int64_t n) { return std::max<std::int64_t>(1, n / cell); };
  Volume<float> out(Dims{cells(volume.dims.x), cells(volume.dims.y), cells(volume.dims.z)});
  parallel_for(out.dims.z, 1, [&](std::int64_t z) {
    for (std::int64_t y = 0; y < out.dims.y; ++y)
      for (std::int64_t x = 0; x < out.dims.x; ++x) {
        double sum = 0.0;
        std::int64_t count = 0;
        for (std::int64_t k = z * cell; k < std::min(volume.dims.z, (z + 1) * cell); ++k)
          for (std::int64_t j = y * cell; j < std::min(volume.dims.y, (y + 1) * cell); ++j)
            for (std::int64_t i = x * cell; i < std::min(volume.dims.x, (x + 1) * cell); ++i, ++count)
              sum += static_cast<double>(volume.at(i, j, k));
        out.at(x, y, z) = static_cast<float>(sum / static_cast<double>(count));
      }
  });
  return out;
}

/// Blurs `n` numbers that are `step` apart by half a Gauss `weights`; beyond the ends there is no light.
void blur(float* line, std::int64_t n, std::int64_t step, const std::vector<float>& weights, std::vector<float>& copy) {
  copy.resize(static_cast<std::size_t>(n));
  for (std::int64_t i = 0; i < n; ++i) copy[static_cast<std::size_t>(i)] = line[i * step];
  const auto reach = static_cast<std::int64_t>(weights.size()) - 1;
  for (std::int64_t i = 0; i < n; ++i) {
    float sum = 0.0F;
    for (std::int64_t k = std::max<std::int64_t>(0, i - reach); k <= std::min(n - 1, i + reach); ++k)
      sum += weights[static_cast<std::size_t>(std::abs(i - k))] * copy[static_cast<std::size_t>(k)];
    line[i * step] = sum;
  }
}

}  // namespace

CoarseRays look_coarsely(const Volume<float>& volume, TurnAxis axis, const GreyLevels& levels) {
  const Dims d = volume.dims;
  std::int64_t cell = 1;
  while (std::max({d.x, d.y, d.z}) > kStrayCells * cell) ++cell;
  const Volume<float> coarse = means_of_cells(volume, cell);
  const PlaneStrides at = planes_across(coarse.dims, axis);
  const ParallelRays rays(at.width, at.height, kStrayDirections);
  CoarseRays out{rays.directions(),
                 at.planes,
                 rays.bins(),
                 static_cast<double>(cell),
                 static_cast<double>(cell * std::max(at.width, at.height)),
                 {}};
  out.lengths.resize(static_cast<std::size_t>(out.directions * out.planes * out.bins));
  LaneImage image = rays.image();
  LaneSinogram lengths = rays.sinogram();
  for (std::int64_t first = 0; first < at.planes; first += kLanes) {
    std::vector<std::int64_t> planes(static_cast<std::size_t>(std::min(kLanes, at.planes - first)));
    std::iota(planes.begin(), planes.end(), first);
    load_planes(coarse.voxels.data(), at, planes, levels, image);
    rays.project(image, lengths);
    for (std::int64_t k = 0; k < out.directions; ++k)
      for (const std::int64_t plane : planes)
        for (std::int64_t bin = 0; bin < out.bins; ++bin)
          out.lengths[static_cast<std::size_t>((k * out.planes + plane) * out.bins + bin)] =
              static_cast<float>(cell) * lengths.row(k)[bin * kLanes + plane - first];
  }
  return out;
}

ScatterField::ScatterField(const CoarseRays& rays, double absorbed, double spread)
    : directions_(rays.directions),
      planes_(rays.planes),
      bins_(rays.bins),
      cell_(rays.cell),
      absorbed_(absorbed),
      spread_(spread),
      field_(rays.lengths.size()) {
  std::vector<float> weights;
  const double cells = spread / rays.cell;
  double sum = -1.0;
  for (std::int64_t k = 0; k <= static_cast<std::int64_t>(std::ceil(3.0 * cells)); ++k) {
    weights.push_back(static_cast<float>(std::exp(-0.5 * static_cast<double>(k * k) / (cells * cells))));
    sum += 2.0 * static_cast<double>(weights.back());
  }
  for (float& weight : weights) weight /= static_cast<float>(sum);
  parallel_for(directions_, 1, [&](std::int64_t k) {
    float* const view = field_.data() + k * planes_ * bins_;
    const float* const lengths = rays.lengths.data() + k * planes_ * bins_;
    for (std::int64_t i = 0; i < planes_ * bins_; ++i) {
      const float p = std::max(0.0F, static_cast<float>(absorbed) * lengths[i]);
      view[i] = p * std::exp(-p);
    }
    std::vector<float> copy;
    for (std::int64_t plane = 0; plane < planes_; ++plane) blur(view + plane * bins_, bins_, 1, weights, copy);
    for (std::int64_t bin = 0; bin < bins_; ++bin) blur(view + bin, planes_, bins_, weights, copy);
  });
}

ScatterField ScatterField::in_steps_of(double voxels) const {
  ScatterField other = *this;
  other.cell_ /= voxels;
  other.spread_ /= voxels;
  other.absorbed_ *= voxels;
  return other;
}

void ScatterField::row(std::int64_t direction, std::int64_t all, std::span<const std::int64_t> planes,
                       std::int64_t bins, float* out) const {
  const double place = static_cast<double>(direction * directions_) / static_cast<double>(all);
  const auto before = std::min(directions_ - 1, static_cast<std::int64_t>(place));
  const auto part = static_cast<float>(place - static_cast<double>(before));
  const bool turned = before + 1 == directions_;  // half a turn on, the detector is mirrored
  const std::int64_t after = turned ? 0 : before + 1;
  thread_local std::vector<float> coarse;
  coarse.assign(static_cast<std::size_t>(bins_ * kLanes), 0.0F);
  for (std::size_t lane = 0; lane < planes.size(); ++lane) {
    const double z =
        std::clamp((static_cast<double>(planes[lane]) + 0.5) / cell_ - 0.5, 0.0, static_cast<double>(planes_ - 1));
    const auto low = static_cast<std::int64_t>(z), high = std::min(planes_ - 1, low + 1);
    const auto up = static_cast<float>(z - static_cast<double>(low));
    for (std::int64_t bin = 0; bin < bins_; ++bin) {
      const std::int64_t seen = turned ? bins_ - 1 - bin : bin;
      const float now = line(before, low)[bin] + up * (line(before, high)[bin] - line(before, low)[bin]);
      const float next = line(after, low)[seen] + up * (line(after, high)[seen] - line(after, low)[seen]);
      coarse[static_cast<std::size_t>(bin * kLanes) + lane] = now + part * (next - now);
    }
  }
  std::fill(out, out + bins * kLanes, 0.0F);
  const double first = 0.5 * static_cast<double>(bins_ - 1) - 0.5 * static_cast<double>(bins - 1) / cell_;
  kernels::add_sampled({coarse.data(), bins_}, first, 1.0 / cell_, 1.0F, bins, out);
}

}  // namespace dubsar
