#include "core/filter/resample.h"

#include <algorithm>
#include <array>

#include "core/base/system/parallel.h"
#include "core/filter/gauss_kernels.h"

namespace dubsar {
namespace {

constexpr std::int64_t kRingBytes = 24 << 20;  // input slices kept: small enough to stay in a last-level cache

std::int64_t halved(std::int64_t n) { return n > 1 ? n / 2 : n; }

std::int64_t output_slices_at_a_time(Dims in) {
  const std::int64_t fits = kRingBytes / (in.slice() * static_cast<std::int64_t>(sizeof(float)));
  return std::clamp<std::int64_t>((fits - 1) / 2, 1, 32);
}

/// Input index of the centre of output sample i; an axis of one voxel has only its own.
std::int64_t centre(std::int64_t n, std::int64_t i) { return n > 1 ? 2 * i + 1 : i; }

}  // namespace

HalfResolutionSource::HalfResolutionSource(SlabSource& source)
    : source_(&source),
      dims_{halved(source.dims().x), halved(source.dims().y), halved(source.dims().z)},
      frame_(source.frame()),
      batch_(output_slices_at_a_time(source.dims())),
      ring_(source.dims(), 2 * batch_ + 1, SliceRing::Rows::kContiguous) {
  const Dims in = source.dims();
  const std::array<std::int64_t, 3> n{in.x, in.y, in.z};
  for (int axis = 0; axis < 3; ++axis) {
    if (n[static_cast<std::size_t>(axis)] == 1) continue;
    frame_.origin_vox[axis] += frame_.scale[axis];
    frame_.scale[axis] *= 2.0;
  }
}

Result<void> HalfResolutionSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= dims_.z);
  DUBSAR_CHECK(static_cast<std::int64_t>(out.size()) >= (z_end - z_begin) * dims_.slice());
  const Dims in = source_->dims();
  for (std::int64_t z = z_begin; z < z_end; z += batch_) {
    const std::int64_t end = std::min(z_end, z + batch_);
    DUBSAR_TRY(ring_.load(*source_, {centre(in.z, z) - 1, centre(in.z, end - 1) + 2}));
    float* to = out.data() + (z - z_begin) * dims_.slice();
    parallel_chunks((end - z) * dims_.y, 16, [&](std::int64_t begin, std::int64_t stop) {
      Buffer<float> line(in.x + 1);
      for (std::int64_t row = begin; row < stop; ++row) {
        const std::int64_t y0 = centre(in.y, row % dims_.y), z0 = centre(in.z, z + row / dims_.y);
        std::array<const float*, 9> rows{};
        for (int k = 0; k < 9; ++k) rows[static_cast<std::size_t>(k)] = ring_.row(y0 + k % 3 - 1, z0 + k / 3 - 1);
        if (in.x == 1) {
          kernels::gauss3_yz(rows.data(), 1, to + row);
          continue;
        }
        kernels::gauss3_yz(rows.data(), in.x, line.data());
        line[in.x] = line[in.x - 1];
        kernels::gauss3_x_half(line.data(), dims_.x, to + row * dims_.x);
      }
    });
  }
  return {};
}

}  // namespace dubsar
