#include "core/phantom/phantom_source.h"

#include <cmath>

#include "core/base/parallel.h"
#include "core/phantom/imaging_kernels.h"
#include "core/phantom/random.h"
#include "core/phantom/rasterise.h"

namespace dubsar::phantom {
namespace {

constexpr std::int64_t kSlicesAtATime = 16;

/// Share of a voxel that lies inside a surface at signed distance d: that of a box across, of the same variance in
/// every direction.
float coverage(const Dual& field) {
  const float slope = std::sqrt(dot(field.g, field.g));
  return std::clamp(0.5f - field.v / std::max(slope, 0.2f), 0.0f, 1.0f);
}

float density(const Fields& f) {
  return kAirDensity + (kClayDensity - kAirDensity) * coverage(f.clay) +
         (kOrganicDensity - kAirDensity) * coverage(f.organic) + (kGrainDensity - kClayDensity) * coverage(f.grain);
}

}  // namespace

PhantomSource::PhantomSource(std::shared_ptr<const Phantom> phantom) : phantom_(std::move(phantom)) {
  const PhantomOptions& options = phantom_->options();
  frame_.input_voxel = {glm::dvec3(options.voxel_mm), "phantom"};
  if (!std::isinf(options.snr_db))
    sigma_ = static_cast<double>(kClayDensity - kAirDensity) / std::pow(10.0, options.snr_db / 20.0);
}

void PhantomSource::fill_raw(std::int64_t z_begin, std::int64_t z_end) {
  const Dims d = dims();
  const std::int64_t y_first = brick_of(-1), y_bricks = brick_of(d.y) - y_first + 1;
  const std::int64_t z_first = brick_of(z_begin), z_bricks = brick_of(z_end - 1) - z_first + 1;
  const auto white = static_cast<float>(sigma_ / kernels::kNoiseLeft);
  const std::uint64_t seed_key = hash64(phantom_->options().seed ^ 0x6e6f697365);
  parallel_for(y_bricks * z_bricks, 1, [&](std::int64_t item) {
    const std::int64_t y_lo = (y_first + item % y_bricks) * kBrickEdge, z_lo = (z_first + item / y_bricks) * kBrickEdge;
    const VoxelBox clip{{-1, std::max<std::int64_t>(y_lo, -1), std::max(z_lo, z_begin)},
                        {d.x + 1, std::min(y_lo + kBrickEdge, d.y + 1), std::min(z_lo + kBrickEdge, z_end)}};
    for (std::int64_t bx = brick_of(-1); bx <= brick_of(d.x); ++bx)
      visit_brick(
          *phantom_, {1.0f, false}, {bx * kBrickEdge, y_lo, z_lo}, kBrickEdge, clip,
          [&](const VoxelBox& box, const Fields& f) {
            const float value = density(f);
            for (std::int64_t z = box.lo[2]; z < box.hi[2]; ++z)
              for (std::int64_t y = box.lo[1]; y < box.hi[1]; ++y)
                std::fill(raw_row(y, z) + box.lo[0] + 1, raw_row(y, z) + box.hi[0] + 1, value);
          },
          [&](std::int64_t x, std::int64_t y, std::int64_t z, const Fields& f) { raw_row(y, z)[x + 1] = density(f); });
    if (white > 0.0f)
      for (std::int64_t z = clip.lo[2]; z < clip.hi[2]; ++z)
        for (std::int64_t y = clip.lo[1]; y < clip.hi[1]; ++y) {
          const auto place = static_cast<std::uint64_t>(z + 1) << 32 | static_cast<std::uint64_t>(y + 1);
          kernels::add_noise(hash64(seed_key ^ place), -1, white, {raw_row(y, z), static_cast<std::size_t>(d.x + 2)});
        }
  });
}

Result<void> PhantomSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const Dims d = dims();
  DUBSAR_CHECK(0 <= z_begin && z_begin <= z_end && z_end <= d.z &&
               static_cast<std::int64_t>(out.size()) >= d.slice() * (z_end - z_begin));
  const std::int64_t slice = (d.x + 2) * (d.y + 2);
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
      kernels::blur_yz(rows, sum);
      kernels::blur_x(sum, out.subspan(static_cast<std::size_t>((z - z_begin) * d.slice() + y * d.x),
                                       static_cast<std::size_t>(d.x)));
    });
  }
  return {};
}

}  // namespace dubsar::phantom
