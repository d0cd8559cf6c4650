#include "core/rays/axis_shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

using kernels::kLanes;

/// Of the air that is looked at from clay, in pixels: nearer there are edges, farther only noise.
constexpr std::int64_t kNearest = 4, kFarthest = 14;
/// Shifts that are made; what lies between is interpolated between their images.
constexpr double kTried = 0.75, kMost = 1.25, kStep = 1.0 / 64.0;
/// Around the shift that was found, where waves of some pixels are no parabola over kTried any more: 1 is found as .9.
constexpr double kTriedFiner = 0.25;
constexpr double kLeast = 0.08, kMostAirShare = 0.9;
/// The air is looked at in so many parts: what is gained must be seen in them all, not in the noise of some.
constexpr std::int64_t kStripes = 16;
constexpr std::size_t kParts = kStripes * kLanes / 2;
/// Standard errors of the gain over the same shift the other way, from the parts. Set by the gain over no shift, of
/// which noise of 14 dB about a right axis reached 3.5 and axes off by .15 to .5 pixel 7 to 19; not measured again
/// since.
constexpr double kSignificantGain = 5.0;

using Energy = std::array<std::array<double, 3>, 3>;
using Energies = std::vector<Energy>;  ///< of kParts

Energies sum_of(Energies a, const Energies& b) {
  for (std::size_t p = 0; p < a.size(); ++p)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) a[p][i][j] += b[p][i][j];
  return a;
}

/// Pixels of air beside clay, of one pair of lanes.
std::vector<std::uint8_t> air_beside(const LaneImage& planes, std::int64_t lane) {
  const std::int64_t w = planes.width(), h = planes.height();
  std::vector<std::int64_t> clay(static_cast<std::size_t>((w + 1) * (h + 1)));  // sums over the box from (0, 0)
  const auto sum = [&](std::int64_t x, std::int64_t y) -> std::int64_t& {
    return clay[static_cast<std::size_t>(y * (w + 1) + x)];
  };
  for (std::int64_t y = 0; y < h; ++y)
    for (std::int64_t x = 0; x < w; ++x) {
      float mean = 0.0F;  // of 3x3 pixels of both planes, against noise
      for (std::int64_t k = 0; k < 9; ++k) {
        const float* at = planes.at(std::min(x + k % 3 - 1, w), std::min(y + k / 3 - 1, h)) + lane;
        mean += (at[0] + at[1]) / 18.0F;
      }
      sum(x + 1, y + 1) = sum(x, y + 1) + sum(x + 1, y) - sum(x, y) + (mean > 0.5F ? 1 : 0);
    }
  const auto within = [&](std::int64_t x, std::int64_t y, std::int64_t reach) {
    const std::int64_t x0 = std::max<std::int64_t>(0, x - reach), x1 = std::min(w, x + reach + 1);
    const std::int64_t y0 = std::max<std::int64_t>(0, y - reach), y1 = std::min(h, y + reach + 1);
    return sum(x1, y1) - sum(x0, y1) - sum(x1, y0) + sum(x0, y0) > 0;
  };
  std::vector<std::uint8_t> air(static_cast<std::size_t>(w * h));
  for (std::int64_t y = 0; y < h; ++y)
    for (std::int64_t x = 0; x < w; ++x)
      air[static_cast<std::size_t>(y * w + x)] = !within(x, y, kNearest - 1) && within(x, y, kFarthest) ? 1 : 0;
  return air;
}

/// Products of three images in the air, of one plane of a pair with the other.
Energies energies_of(const std::array<const LaneImage*, 3>& images, const std::vector<std::vector<std::uint8_t>>& air) {
  const std::int64_t w = images[0]->width();
  const std::int64_t h = images[0]->height();
  return parallel_reduce<Energies>(
      h, 8, Energies(kParts),
      [&](std::int64_t begin, std::int64_t end) {
        Energies parts(kParts);
        for (std::int64_t y = begin; y < end; ++y)
          for (std::int64_t x = 0; x < w; ++x)
            for (std::size_t pair = 0; pair < air.size(); ++pair) {
              if (air[pair][static_cast<std::size_t>(y * w + x)] == 0) continue;
              Energy& part = parts[pair * kStripes + static_cast<std::size_t>(y * kStripes / h)];
              for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j)
                  part[i][j] += static_cast<double>(images[i]->at(x, y)[2 * pair]) * images[j]->at(x, y)[2 * pair + 1];
            }
        return parts;
      },
      sum_of);
}

Energy total(const Energies& parts) {
  Energy sum{};
  for (const Energy& part : parts)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) sum[i][j] += part[i][j];
  return sum;
}

/// Of the image between three that are `step` apart, `t` steps from the middle one.
double energy_at(const Energy& energy, double t) {
  const std::array<double, 3> weight{0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) sum += weight[i] * weight[j] * energy[i][j];
  return sum;
}

/// How much less energy a shift by `t` steps leaves than the same shift the other way, in all parts together, in its
/// standard errors: interpolation smooths both, which takes energy of streaks and of noise, too.
double significance(const Energies& energies, double t) {
  double sum = 0.0, squares = 0.0;
  for (const Energy& part : energies) {
    const double gain = energy_at(part, -t) - energy_at(part, t);
    sum += gain;
    squares += gain * gain;
  }
  const double error2 = squares - sum * sum / static_cast<double>(energies.size());
  return error2 > 0.0 ? sum / std::sqrt(error2) : 0.0;
}

}  // namespace

void shift_rays(const LaneSinogram& in, const AxisShift& shift, LaneSinogram& out) {
  parallel_for(in.directions(), 4, [&](std::int64_t k) {
    const double d = shift.flipped && 2 * k < in.directions() ? -shift.pixels : shift.pixels;
    float* const row = out.row(k);
    std::fill(row, row + in.row_floats(), 0.0F);
    kernels::add_interpolated(in.row(k), in.bins(), d, in.bins(), row);
  });
}

AxisShift find_axis_shift(const ParallelRays& rays, const LaneImage& planes, const LaneSinogram& recorded,
                          const BendOfRow& bend) {
  std::vector<std::vector<std::uint8_t>> air(static_cast<std::size_t>(kLanes / 2));
  parallel_for(kLanes / 2, 1,
               [&](std::int64_t pair) { air[static_cast<std::size_t>(pair)] = air_beside(planes, 2 * pair); });
  LaneSinogram moved = rays.sinogram();
  const auto image_with = [&](const AxisShift& shift) {
    LaneImage image = rays.image();
    shift_rays(recorded, shift, moved);
    parallel_chunks(rays.directions(), 4, [&](std::int64_t begin, std::int64_t end) {
      std::vector<float> bent(static_cast<std::size_t>(moved.row_floats()));
      for (std::int64_t k = begin; k < end; ++k) {
        bend(k, moved.row(k), bent.data());
        for (std::int64_t i = 0; i < moved.row_floats(); ++i)
          moved.row(k)[i] += bent[static_cast<std::size_t>(i)] - recorded.row(k)[i];
      }
    });
    rays.filter(moved);
    rays.backproject(moved, image);
    parallel_for(image.height(), 8, [&](std::int64_t y) {
      for (std::int64_t i = 0; i < image.width() * kLanes; ++i) image.at(0, y)[i] += planes.at(0, y)[i];
    });
    return image;
  };
  const LaneImage unmoved = image_with({});
  AxisShift best;
  double as_it_is = 0.0;
  for (const bool flipped : {false, true}) {
    const LaneImage before = image_with({-kTried, flipped}), after = image_with({kTried, flipped});
    const Energies parts = energies_of({&before, &unmoved, &after}, air);
    const Energy energy = total(parts);
    as_it_is = energy_at(energy, 0.0);
    if (!(as_it_is > 0.0)) continue;
    for (double shift = -kMost; shift <= kMost; shift += kStep) {
      const double left = energy_at(energy, shift / kTried) / as_it_is;
      if (std::abs(shift) < kLeast || left > kMostAirShare || (best.pixels != 0.0 && left >= best.left)) continue;
      if (significance(parts, shift / kTried) < kSignificantGain) continue;
      best = {shift, flipped, left};
    }
  }
  if (best.pixels == 0.0) return best;
  const double around = best.pixels;
  const LaneImage before = image_with({around - kTriedFiner, best.flipped}),
                  middle = image_with({around, best.flipped}), after = image_with({around + kTriedFiner, best.flipped});
  const Energy energy = total(energies_of({&before, &middle, &after}, air));
  best.left = energy_at(energy, 0.0) / as_it_is;
  for (double off = -kTriedFiner; off <= kTriedFiner; off += kStep / 2.0) {
    const double left = energy_at(energy, off / kTriedFiner) / as_it_is;
    if (left < best.left) best = {around + off, best.flipped, left};
  }
  return best;
}

}  // namespace dubsar
