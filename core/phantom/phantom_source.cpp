#include "core/phantom/phantom_source.h"

#include <cmath>

#include "core/base/system/parallel.h"
#include "core/phantom/density.h"
#include "core/phantom/imaging_kernels.h"
#include "core/phantom/random.h"

namespace dubsar::phantom {
namespace {

constexpr std::int64_t kSlicesAtATime = 16;

/// Rings around the axis of rotation (z, through the middle): gains of detector columns, each a little off.
std::vector<float> ring_profile(const PhantomOptions& options) {
  if (options.rings <= 0.0) return {};
  const auto columns = static_cast<std::size_t>(std::hypot(options.dims.x, options.dims.y) / 2.0 + 3.0);
  std::vector<float> profile(columns);
  Random random(options.seed, 0x72696e67);
  // A column in seven is off; uniform on [-a, a] has the deviation a / sqrt(3).
  const double range = options.rings * std::sqrt(3.0 * 7.0);
  for (float& gain : profile)
    gain = random.uniform() < 1.0 / 7.0
               ? static_cast<float>(random.uniform(-range, range)) * (kClayDensity - kAirDensity)
               : 0.0f;
  return profile;
}

}  // namespace

PhantomSource::PhantomSource(std::shared_ptr<const Phantom> phantom) : phantom_(std::move(phantom)) {
  const PhantomOptions& options = phantom_->options();
  frame_ = scan_frame(options);
  if (!std::isinf(options.snr_db))
    sigma_ = static_cast<double>(kClayDensity - kAirDensity) / std::pow(10.0, options.snr_db / 20.0);
  rings_ = ring_profile(options);
}

void PhantomSource::fill_raw(std::int64_t z_begin, std::int64_t z_end) {
  const Dims d = dims();
  rasterise_density(*phantom_, {{-1, -1, z_begin}, {d.x + 1, d.y + 1, z_end}}, raw_row(-1, z_begin));
  const auto white =
      static_cast<float>(sigma_ / kernels::noise_left(kernels::psf_middle(phantom_->options().blur_vox)));
  if (!(white > 0.0f)) return;
  const std::uint64_t seed_key = hash64(phantom_->options().seed ^ 0x6e6f697365);
  parallel_for((z_end - z_begin) * (d.y + 2), 64, [&](std::int64_t item) {
    const std::int64_t y = item % (d.y + 2) - 1, z = z_begin + item / (d.y + 2);
    const auto place = static_cast<std::uint64_t>(z + 1) << 32 | static_cast<std::uint64_t>(y + 1);
    kernels::add_noise(hash64(seed_key ^ place), -1, white, {raw_row(y, z), static_cast<std::size_t>(d.x + 2)});
  });
}

Result<void> PhantomSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const Dims d = dims();
  DUBSAR_CHECK(0 <= z_begin && z_begin <= z_end && z_end <= d.z &&
               static_cast<std::int64_t>(out.size()) >= d.slice() * (z_end - z_begin));
  const std::int64_t slice = (d.x + 2) * (d.y + 2);
  const auto middle = static_cast<float>(kernels::psf_middle(phantom_->options().blur_vox));
  for (std::int64_t z0 = z_begin; z0 < z_end; z0 += kSlicesAtATime) {
    const std::int64_t z1 = std::min(z0 + kSlicesAtATime, z_end);
    // Slices z0 - 1 and z0 are often left from the request before.
    std::int64_t kept = 0;
    if (z0 - 1 >= raw_begin_ && z0 + 1 <= raw_end_) {
      kept = std::min(raw_end_, z1 + 1) - (z0 - 1);
      std::copy_n(raw_row(-1, z0 - 1), kept * slice, raw_.data());
    }
    raw_.resize(static_cast<std::size_t>(slice * (z1 - z0 + 2)));
    raw_begin_ = z0 - 1;
    raw_end_ = z1 + 1;
    if (z0 - 1 + kept < raw_end_) fill_raw(z0 - 1 + kept, raw_end_);
    parallel_for((z1 - z0) * d.y, 16, [&](std::int64_t item) {
      const std::int64_t y = item % d.y, z = z0 + item / d.y;
      thread_local std::vector<float> sum;
      sum.resize(static_cast<std::size_t>(d.x + 2));
      const float* rows[9];
      for (std::int64_t k = 0; k < 9; ++k) rows[k] = raw_row(y + k % 3 - 1, z + k / 3 - 1);
      kernels::blur_yz(rows, middle, sum);
      const std::span<float> row =
          out.subspan(static_cast<std::size_t>((z - z_begin) * d.slice() + y * d.x), static_cast<std::size_t>(d.x));
      kernels::blur_x(sum, middle, row);
      if (rings_.empty()) return;
      const double off = static_cast<double>(y) - 0.5 * static_cast<double>(d.y - 1);
      for (std::int64_t x = 0; x < d.x; ++x) {
        const double radius = std::hypot(static_cast<double>(x) - 0.5 * static_cast<double>(d.x - 1), off);
        const auto column = static_cast<std::size_t>(radius);
        const auto t = static_cast<float>(radius - static_cast<double>(column));
        row[static_cast<std::size_t>(x)] += (1.0f - t) * rings_[column] + t * rings_[column + 1];
      }
    });
  }
  return {};
}

}  // namespace dubsar::phantom
