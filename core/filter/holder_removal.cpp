#include "core/filter/holder_removal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kHalfSteps = 2;  ///< of the scan after 2:1, a cell
constexpr int kMostlyOf27 = 14;
constexpr int kGrown = 2;          ///< cells, beyond those
constexpr std::int64_t kNear = 2;  ///< voxels: of the Gauss, and of what lies beside a voxel
constexpr std::uint8_t kAirBeside = 1, kClayBeside = 2;
constexpr std::array<float, 5> kBinomial{1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};  ///< variance 1

/// Cells of which `count` of the 27 around are set.
std::vector<std::uint8_t> with_neighbours(const std::vector<std::uint8_t>& set, const Dims& d, int count) {
  std::vector<std::uint8_t> out(set.size());
  parallel_for(d.z, 1, [&](std::int64_t z) {
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) {
        int sum = 0;
        for (std::int64_t c = -1; c <= 1; ++c)
          for (std::int64_t b = -1; b <= 1; ++b)
            for (std::int64_t a = -1; a <= 1; ++a) {
              // Beyond the border it goes on.
              const std::int64_t i = std::clamp<std::int64_t>(x + a, 0, d.x - 1),
                                 j = std::clamp<std::int64_t>(y + b, 0, d.y - 1),
                                 k = std::clamp<std::int64_t>(z + c, 0, d.z - 1);
              sum += set[static_cast<std::size_t>((k * d.y + j) * d.x + i)];
            }
        out[static_cast<std::size_t>((z * d.y + y) * d.x + x)] = sum >= count ? 1 : 0;
      }
  });
  return out;
}

struct Between {
  std::int64_t first, second;
  float share;  ///< of the second
};
Between between(std::int64_t at, std::int64_t steps, std::int64_t cells) {
  const float place = (static_cast<float>(at) + 0.5f) / static_cast<float>(steps) - 0.5f;
  const auto first = static_cast<std::int64_t>(std::floor(place));
  return {std::clamp<std::int64_t>(first, 0, cells - 1), std::clamp<std::int64_t>(first + 1, 0, cells - 1),
          place - static_cast<float>(first)};
}

}  // namespace

bool HolderMask::row(std::int64_t y, std::int64_t z, std::int64_t steps, std::span<float> out) const {
  const Between in_y = between(y, steps, cells.y), in_z = between(z, steps, cells.z);
  std::vector<float> line(static_cast<std::size_t>(cells.x), 0.0f);
  const auto add = [&](std::int64_t cy, std::int64_t cz, float weight) {
    const std::uint8_t* const from = inside.data() + (cz * cells.y + cy) * cells.x;
    for (std::int64_t cx = 0; cx < cells.x; ++cx) line[static_cast<std::size_t>(cx)] += from[cx] != 0 ? weight : 0.0f;
  };
  add(in_y.first, in_z.first, (1.0f - in_y.share) * (1.0f - in_z.share));
  add(in_y.second, in_z.first, in_y.share * (1.0f - in_z.share));
  add(in_y.first, in_z.second, (1.0f - in_y.share) * in_z.share);
  add(in_y.second, in_z.second, in_y.share * in_z.share);
  if (std::all_of(line.begin(), line.end(), [](float v) { return v == 0.0f; })) return false;
  for (std::size_t x = 0; x < out.size(); ++x) {
    const Between in_x = between(static_cast<std::int64_t>(x), steps, cells.x);
    const float a = line[static_cast<std::size_t>(in_x.first)], b = line[static_cast<std::size_t>(in_x.second)];
    out[x] = a + in_x.share * (b - a);
  }
  return true;
}

Result<HolderMask> make_holder_mask(SlabSource& half, const FoundHolder& found, Progress& progress) {
  const Dims d = half.dims(), at = found.grid.dims;
  const auto cells_along = [](std::int64_t n) { return (n + kHalfSteps - 1) / kHalfSteps; };
  const Holder& holder = found.holder;
  HolderMask mask;
  mask.cells = {cells_along(d.x), cells_along(d.y), cells_along(d.z)};
  mask.inside.resize(static_cast<std::size_t>(mask.cells.count()));
  mask.air = static_cast<float>(holder.air);
  mask.holder = static_cast<float>(holder.grey);
  mask.clay = static_cast<float>(holder.clay);
  const std::vector<std::uint8_t> zone = with_neighbours(found.inside, at, 1);
  const float least = 0.5f * (mask.air + mask.holder), most = 0.5f * (mask.holder + mask.clay);
  const auto cell_of = [&](std::int64_t step, std::size_t axis, std::int64_t cells) {
    return std::clamp<std::int64_t>((step - found.grid.origin[axis]) / found.grid.cell, 0, cells - 1);
  };
  Buffer<float> slab(kHalfSteps * d.slice());
  for (std::int64_t cz = 0; cz < mask.cells.z; ++cz) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t z0 = cz * kHalfSteps, z1 = std::min(d.z, z0 + kHalfSteps);
    DUBSAR_TRY(half.read(z0, z1, slab.span()));
    const std::int64_t kz = cell_of(z0, 2, at.z);
    parallel_for(mask.cells.y, 8, [&](std::int64_t cy) {
      const std::int64_t y0 = cy * kHalfSteps, y1 = std::min(d.y, y0 + kHalfSteps), ky = cell_of(y0, 1, at.y);
      for (std::int64_t cx = 0; cx < mask.cells.x; ++cx) {
        const std::int64_t x0 = cx * kHalfSteps, x1 = std::min(d.x, x0 + kHalfSteps);
        if (zone[static_cast<std::size_t>(found.grid.index(cell_of(x0, 0, at.x), ky, kz))] == 0) continue;
        float sum = 0.0f;
        for (std::int64_t z = z0; z < z1; ++z)
          for (std::int64_t y = y0; y < y1; ++y)
            for (std::int64_t x = x0; x < x1; ++x) sum += slab[((z - z0) * d.y + y) * d.x + x];
        const float mean = sum / static_cast<float>((x1 - x0) * (y1 - y0) * (z1 - z0));
        mask.inside[static_cast<std::size_t>((cz * mask.cells.y + cy) * mask.cells.x + cx)] =
            mean > least && mean < most ? 1 : 0;
      }
    });
  }
  mask.inside = with_neighbours(mask.inside, mask.cells, kMostlyOf27);
  for (int i = 0; i < kGrown; ++i) mask.inside = with_neighbours(mask.inside, mask.cells, 1);
  return mask;
}

bool HolderMask::reaches(std::int64_t z_begin, std::int64_t z_end, std::int64_t steps) const {
  const std::int64_t first = between(z_begin, steps, cells.z).first, last = between(z_end - 1, steps, cells.z).second;
  return std::any_of(inside.begin() + first * cells.slice(), inside.begin() + (last + 1) * cells.slice(),
                     [](std::uint8_t cell) { return cell != 0; });
}

Result<void> HolderlessSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const Dims d = dims();
  if (!mask_.reaches(z_begin, z_end, steps_)) return source_->read(z_begin, z_end, out);
  // [s0, s1): smoothed; what lies beside it is read for that.
  const std::int64_t s0 = std::max<std::int64_t>(0, z_begin - kNear), s1 = std::min(d.z, z_end + kNear);
  const std::int64_t z0 = std::max<std::int64_t>(0, s0 - kNear), z1 = std::min(d.z, s1 + kNear);
  Buffer<float> slab((z1 - z0) * d.slice()), smooth((s1 - s0) * d.slice());
  std::vector<std::uint8_t> beside(static_cast<std::size_t>((s1 - s0) * d.slice()));
  DUBSAR_TRY(source_->read(z0, z1, slab.span()));
  const float contrast = mask_.clay - mask_.air, above = mask_.holder - mask_.air;
  const float is_air = mask_.air + 0.5f * above, is_clay = 0.5f * (mask_.holder + mask_.clay);
  const auto width = static_cast<std::size_t>(d.x);
  parallel_for((s1 - s0) * d.y, 8, [&](std::int64_t item) {
    const std::int64_t y = item % d.y, z = s0 + item / d.y;
    std::vector<float> across(width, 0.0f);
    for (std::int64_t c = -kNear; c <= kNear; ++c)
      for (std::int64_t b = -kNear; b <= kNear; ++b) {
        const std::int64_t j = std::clamp<std::int64_t>(y + b, 0, d.y - 1),
                           k = std::clamp<std::int64_t>(z + c, 0, d.z - 1);
        const float weight =
            kBinomial[static_cast<std::size_t>(b + kNear)] * kBinomial[static_cast<std::size_t>(c + kNear)];
        const float* const row = slab.data() + ((k - z0) * d.y + j) * d.x;
        for (std::size_t x = 0; x < width; ++x) across[x] += weight * row[x];
      }
    for (std::int64_t x = 0; x < d.x; ++x) {
      float sum = 0.0f;
      for (std::int64_t a = -kNear; a <= kNear; ++a)
        sum += kBinomial[static_cast<std::size_t>(a + kNear)] *
               across[static_cast<std::size_t>(std::clamp<std::int64_t>(x + a, 0, d.x - 1))];
      smooth[item * d.x + x] = sum;
      const std::uint8_t kind = sum < is_air ? kAirBeside : sum > is_clay ? kClayBeside : 0;
      if (kind == 0) continue;
      for (std::int64_t a = std::max<std::int64_t>(0, x - kNear); a <= std::min(d.x - 1, x + kNear); ++a)
        beside[static_cast<std::size_t>(item * d.x + a)] |= kind;
    }
  });
  parallel_for((z_end - z_begin) * d.y, 8, [&](std::int64_t item) {
    const std::int64_t y = item % d.y, z = z_begin + item / d.y;
    const float* const from = slab.data() + ((z - z0) * d.y + y) * d.x;
    float* const to = out.data() + item * d.x;
    std::copy(from, from + d.x, to);
    std::vector<float> share(width);
    if (!mask_.row(y, z, steps_, share)) return;
    std::vector<std::uint8_t> near(width);
    for (std::int64_t k = std::max(s0, z - kNear); k <= std::min(s1 - 1, z + kNear); ++k)
      for (std::int64_t j = std::max<std::int64_t>(0, y - kNear); j <= std::min(d.y - 1, y + kNear); ++j) {
        const std::uint8_t* const row = beside.data() + ((k - s0) * d.y + j) * d.x;
        for (std::size_t x = 0; x < width; ++x) near[x] |= row[x];
      }
    const float* const even = smooth.data() + ((z - s0) * d.y + y) * d.x;
    for (std::size_t x = 0; x < width; ++x) {
      const bool edge_in_air = near[x] == (kAirBeside | kClayBeside);
      if (share[x] == 0.0f || edge_in_air || (mask_.left_out && from[x] == *mask_.left_out)) continue;
      const float low = mask_.air + share[x] * above;
      to[x] = mask_.air + std::max(0.0f, even[x] - low) * contrast / (mask_.clay - low) + (from[x] - even[x]);
    }
  });
  return {};
}

}  // namespace dubsar
