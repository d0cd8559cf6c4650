#include "core/phantom/phantom_source.h"

#include <cmath>

#include "core/base/system/parallel.h"
#include "core/phantom/density.h"
#include "core/phantom/imaging_kernels.h"
#include "core/phantom/random.h"

namespace dubsar::phantom {
namespace {

constexpr std::int64_t kSlicesAtATime = 16;

/// The widest point spread that three voxels make well: beyond it their middle counts little more than its sides. What
/// is wider is that of a focal spot and of motion, before the light is counted: noise is as correlated as usual.
constexpr double kWidestTaps = 0.8;

}  // namespace

PhantomSource::PhantomSource(std::shared_ptr<const Phantom> phantom)
    : phantom_(std::move(phantom)), artefacts_(phantom_->options()) {
  const PhantomOptions& options = phantom_->options();
  frame_ = scan_frame(options);
  if (!std::isinf(options.snr_db))
    sigma_ = static_cast<double>(kClayDensity - kAirDensity) / std::pow(10.0, options.snr_db / 20.0);
  middle_ = kernels::psf_middle(options.blur_vox);
  if (options.blur_vox <= kWidestTaps) return;
  halo_ = 2;
  middle_ = kernels::psf_middle(kUsualBlur);
  first_middle_ = kernels::psf_middle(std::sqrt(options.blur_vox * options.blur_vox - kUsualBlur * kUsualBlur));
}

void PhantomSource::add_noise(std::int64_t y, std::int64_t z, std::span<float> row) const {
  const auto white = static_cast<float>(sigma_ / kernels::noise_left(middle_));
  if (!(white > 0.0f)) return;
  const std::uint64_t seed_key = hash64(phantom_->options().seed ^ 0x6e6f697365);
  const auto place = static_cast<std::uint64_t>(z + 1) << 32 | static_cast<std::uint64_t>(y + 1);
  kernels::add_noise(hash64(seed_key ^ place), -1, white, row);
}

void PhantomSource::fill_raw(std::int64_t z_begin, std::int64_t z_end) {
  const Dims d = dims();
  const std::int64_t h = halo_;
  rasterise_density(*phantom_, {{-h, -h, z_begin}, {d.x + h, d.y + h, z_end}}, raw_row(-h, z_begin));
  if (h == 2) return;
  parallel_for((z_end - z_begin) * (d.y + 2), 64, [&](std::int64_t item) {
    const std::int64_t y = item % (d.y + 2) - 1, z = z_begin + item / (d.y + 2);
    add_noise(y, z, {raw_row(y, z), static_cast<std::size_t>(d.x + 2)});
  });
}

/// The first of two passes, and noise: slices [z_begin, z_end) of one voxel more than the grid on each side.
void PhantomSource::blur_once(std::int64_t z_begin, std::int64_t z_end) {
  const std::int64_t width = dims().x + 2, height = dims().y + 2;
  once_.resize(static_cast<std::size_t>(width * height * (z_end - z_begin)));
  const auto middle = static_cast<float>(first_middle_);
  parallel_for((z_end - z_begin) * height, 16, [&](std::int64_t item) {
    const std::int64_t y = item % height - 1, z = z_begin + item / height;
    thread_local std::vector<float> sum;
    sum.resize(static_cast<std::size_t>(width + 2));
    const float* rows[9];
    for (std::int64_t k = 0; k < 9; ++k) rows[k] = raw_row(y + k % 3 - 1, z + k / 3 - 1);
    kernels::blur_yz(rows, middle, sum);
    const std::span<float> row{once_.data() + item * width, static_cast<std::size_t>(width)};
    kernels::blur_x(sum, middle, row);
    add_noise(y, z, row);
  });
}

Result<void> PhantomSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const Dims d = dims();
  DUBSAR_CHECK(0 <= z_begin && z_begin <= z_end && z_end <= d.z &&
               static_cast<std::int64_t>(out.size()) >= d.slice() * (z_end - z_begin));
  const std::int64_t h = halo_, slice = (d.x + 2 * h) * (d.y + 2 * h);
  const auto middle = static_cast<float>(middle_);
  for (std::int64_t z0 = z_begin; z0 < z_end; z0 += kSlicesAtATime) {
    const std::int64_t z1 = std::min(z0 + kSlicesAtATime, z_end);
    // Slices z0 - h to z0 + h - 1 are often left from the request before.
    std::int64_t kept = 0;
    if (z0 - h >= raw_begin_ && z0 + h <= raw_end_) {
      kept = std::min(raw_end_, z1 + h) - (z0 - h);
      std::copy_n(raw_row(-h, z0 - h), kept * slice, raw_.data());
    }
    raw_.resize(static_cast<std::size_t>(slice * (z1 - z0 + 2 * h)));
    raw_begin_ = z0 - h;
    raw_end_ = z1 + h;
    if (z0 - h + kept < raw_end_) fill_raw(z0 - h + kept, raw_end_);
    if (h == 2) blur_once(z0 - 1, z1 + 1);
    parallel_for((z1 - z0) * d.y, 16, [&](std::int64_t item) {
      const std::int64_t y = item % d.y, z = z0 + item / d.y;
      thread_local std::vector<float> sum;
      sum.resize(static_cast<std::size_t>(d.x + 2));
      const float* rows[9];
      for (std::int64_t k = 0; k < 9; ++k)
        rows[k] = h == 2 ? once_.data() + ((z + k / 3 - z0) * (d.y + 2) + y + k % 3) * (d.x + 2)
                         : raw_row(y + k % 3 - 1, z + k / 3 - 1);
      kernels::blur_yz(rows, middle, sum);
      const std::span<float> row =
          out.subspan(static_cast<std::size_t>((z - z_begin) * d.slice() + y * d.x), static_cast<std::size_t>(d.x));
      kernels::blur_x(sum, middle, row);
      if (!artefacts_.empty()) artefacts_.apply(y, z, row);
    });
  }
  return {};
}

}  // namespace dubsar::phantom
