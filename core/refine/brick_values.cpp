#include "core/refine/brick_values.h"

#include <algorithm>
#include <array>

#include "core/base/system/budget.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kEdge = BrickMask::kEdge, kPoints = kEdge * kEdge * kEdge;
constexpr std::int64_t kBlock = 4096;  ///< bricks whose memory is taken at once

}  // namespace

BrickValues::BrickValues(BrickMask inside, GridFrame frame, const OutsideValues& outside)
    : inside_(std::move(inside)),
      frame_(std::move(frame)),
      outside_(outside),
      place_(static_cast<std::size_t>(inside_.bricks().count()), kNone) {}

const float* BrickValues::values_of(std::int64_t bx, std::int64_t by, std::int64_t bz) const noexcept {
  const Dims& b = inside_.bricks();
  const std::uint32_t place = place_[static_cast<std::size_t>((bz * b.y + by) * b.x + bx)];
  return place == kNone ? nullptr : blocks_[place / kBlock].data() + place % kBlock * kPoints;
}

Result<void> BrickValues::keep(const BrickMask& bricks, SlabSource& source, Progress& progress) {
  const Dims d = dims(), b = inside_.bricks();
  DUBSAR_CHECK(source.dims() == d && bricks.dims() == d);
  DUBSAR_TRY(check_memory("the bricks near the surface",
                          static_cast<std::uint64_t>(bricks.count() * kPoints + kEdge * d.slice()) * sizeof(float)));
  Buffer<float> layer(std::min(kEdge, d.z) * d.slice());
  for (std::int64_t bz = 0; bz < b.z; ++bz) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t z0 = bz * kEdge, z1 = std::min(z0 + kEdge, d.z);
    progress.advance(z1 - z0);
    if (!bricks.any(z0, z1, 0)) continue;
    DUBSAR_TRY(source.read(z0, z1, layer.span()));
    for (std::int64_t by = 0; by < b.y; ++by)
      for (std::int64_t bx = 0; bx < b.x; ++bx) {
        if (!bricks.get(bx, by, bz)) continue;
        std::uint32_t& place = place_[static_cast<std::size_t>((bz * b.y + by) * b.x + bx)];
        DUBSAR_CHECK(place == kNone);
        place = static_cast<std::uint32_t>(kept_++);
        if (place / kBlock == blocks_.size()) blocks_.emplace_back(kBlock * kPoints);
      }
    parallel_for(b.y, 1, [&](std::int64_t by) {
      for (std::int64_t bx = 0; bx < b.x; ++bx) {
        if (!bricks.get(bx, by, bz)) continue;
        float* to = const_cast<float*>(values_of(bx, by, bz));
        const std::int64_t count = std::min(kEdge, d.x - bx * kEdge), rows = std::min(kEdge, d.y - by * kEdge);
        for (std::int64_t z = z0; z < z1; ++z)
          for (std::int64_t y = 0; y < rows; ++y)
            std::copy_n(layer.data() + ((z - z0) * d.y + by * kEdge + y) * d.x + bx * kEdge, count,
                        to + ((z - z0) * kEdge + y) * kEdge);
      }
    });
  }
  return {};
}

Result<void> BrickValues::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const Dims d = dims(), b = inside_.bricks();
  DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= d.z);
  DUBSAR_CHECK(static_cast<std::int64_t>(out.size()) >= (z_end - z_begin) * d.slice());
  parallel_for((z_end - z_begin) * d.y, 64, [&](std::int64_t i) {
    const std::int64_t y = i % d.y, z = z_begin + i / d.y;
    const std::int64_t inner = (z % kEdge * kEdge + y % kEdge) * kEdge;
    float* const to = out.data() + i * d.x;
    for (std::int64_t bx = 0; bx < b.x; ++bx) {
      const std::int64_t x = bx * kEdge, count = std::min(kEdge, d.x - x);
      if (const float* values = values_of(bx, y / kEdge, z / kEdge))
        std::copy_n(values + inner, count, to + x);
      else
        std::fill_n(to + x, count, inside_.get(bx, y / kEdge, z / kEdge) ? outside_.above : outside_.below);
    }
  });
  return {};
}

/// Has the first or last layer of a brick of `points` points across `axis` one that is not on the side of `inside`?
bool BrickValues::crosses(const float* brick, int axis, bool last, const Dims& points, bool inside,
                          float threshold) const {
  const std::array<std::int64_t, 3> n{points.x, points.y, points.z}, step{1, kEdge, kEdge * kEdge};
  const auto across = static_cast<std::size_t>(axis), u = (across + 1) % 3, v = (across + 2) % 3;
  const float* const face = brick + (last ? (n[across] - 1) * step[across] : 0);
  for (std::int64_t j = 0; j < n[v]; ++j)
    for (std::int64_t i = 0; i < n[u]; ++i)
      if ((face[i * step[u] + j * step[v]] >= threshold) != inside) return true;
  return false;
}

BrickMask BrickValues::crossed(const BrickMask& bricks, float threshold) const {
  BrickMask found(dims());
  const Dims d = dims(), b = inside_.bricks();
  parallel_for(b.y * b.z, 16, [&](std::int64_t row) {
    const std::int64_t by = row % b.y, bz = row / b.y;
    for (std::int64_t bx = 0; bx < b.x; ++bx) {
      if (values_of(bx, by, bz) != nullptr) continue;
      for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, step = side % 2 == 0 ? -1 : 1;
        const std::int64_t x = bx + (axis == 0) * step, y = by + (axis == 1) * step, z = bz + (axis == 2) * step;
        if (x < 0 || y < 0 || z < 0 || x >= b.x || y >= b.y || z >= b.z || !bricks.get(x, y, z)) continue;
        const Dims points{std::min(kEdge, d.x - x * kEdge), std::min(kEdge, d.y - y * kEdge),
                          std::min(kEdge, d.z - z * kEdge)};
        if (!crosses(values_of(x, y, z), axis, step < 0, points, inside_.get(bx, by, bz), threshold)) continue;
        found.set(bx, by, bz);
        break;
      }
    }
  });
  return found;
}

}  // namespace dubsar
