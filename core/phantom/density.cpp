#include "core/phantom/density.h"

#include <cmath>

#include "core/base/system/parallel.h"
#include "core/phantom/holder.h"

namespace dubsar::phantom {
namespace {

/// Share of a voxel that lies inside a surface at signed distance d: that of a box across, of the same variance in
/// every direction.
float coverage(const Dual& field) {
  const float slope = std::sqrt(dot(field.g, field.g));
  return std::clamp(0.5f - field.v / std::max(slope, 0.2f), 0.0f, 1.0f);
}

/// Share of clay in a voxel, that of the envelope weighted. A film of air thinner than a voxel has both clays in it:
/// they are summed, where one field of both would know the nearer wall only.
float clay_of_two(const Fields& f, float envelope_density) {
  const float tablet = coverage(f.tablet);
  const float envelope = std::min(coverage(max(max(f.outer, f.wall), -f.crack)), 1.0f - tablet);
  const float hollow = std::max(coverage(f.pore), coverage(f.organic));
  return (tablet + envelope_density * envelope) * (1.0f - hollow);
}

float density(const Fields& f, const PhantomOptions& options) {
  const float clay =
      tells_clays_apart(options) ? clay_of_two(f, static_cast<float>(options.envelope_density)) : coverage(f.clay);
  return kAirDensity + (kClayDensity - kAirDensity) * clay + (kOrganicDensity - kAirDensity) * coverage(f.organic) +
         (kGrainDensity - kClayDensity) * coverage(f.grain);
}

}  // namespace

void rasterise_density(const Phantom& phantom, const VoxelBounds& box, float* out) {
  const std::int64_t width = box.hi[0] - box.lo[0], height = box.hi[1] - box.lo[1];
  const auto row = [&](std::int64_t y, std::int64_t z) {
    return out + ((z - box.lo[2]) * height + y - box.lo[1]) * width - box.lo[0];
  };
  const std::int64_t y_first = brick_of(box.lo[1]), y_bricks = brick_of(box.hi[1] - 1) + 1 - y_first;
  const std::int64_t z_first = brick_of(box.lo[2]), z_bricks = brick_of(box.hi[2] - 1) + 1 - z_first;
  const RasterRule rule{1.0f, tells_clays_apart(phantom.options())};
  parallel_for(y_bricks * z_bricks, 1, [&](std::int64_t item) {
    const std::int64_t y_lo = (y_first + item % y_bricks) * kBrickEdge, z_lo = (z_first + item / y_bricks) * kBrickEdge;
    for (std::int64_t bx = brick_of(box.lo[0]); bx <= brick_of(box.hi[0] - 1); ++bx)
      visit_brick(
          phantom, rule, {bx * kBrickEdge, y_lo, z_lo}, kBrickEdge, box,
          [&](const VoxelBounds& part, const Fields& f) {
            const float value = density(f, phantom.options());
            for (std::int64_t z = part.lo[2]; z < part.hi[2]; ++z)
              for (std::int64_t y = part.lo[1]; y < part.hi[1]; ++y)
                std::fill(row(y, z) + part.lo[0], row(y, z) + part.hi[0], value);
          },
          [&](std::int64_t x, std::int64_t y, std::int64_t z, const Fields& f) {
            row(y, z)[x] = density(f, phantom.options());
          });
  });
  add_holder(phantom, box, out);
}

GridFrame scan_frame(const PhantomOptions& options) {
  GridFrame frame;
  frame.input_voxel = {glm::dvec3(options.voxel_mm), "phantom"};
  return frame;
}

DensitySource::DensitySource(const Phantom& phantom) : phantom_(phantom), frame_(scan_frame(phantom.options())) {}

Result<void> DensitySource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const Dims d = dims();
  DUBSAR_CHECK(0 <= z_begin && z_begin <= z_end && z_end <= d.z &&
               static_cast<std::int64_t>(out.size()) >= d.slice() * (z_end - z_begin));
  rasterise_density(phantom_, {{0, 0, z_begin}, {d.x, d.y, z_end}}, out.data());
  for (float& value : out.first(static_cast<std::size_t>(d.slice() * (z_end - z_begin))))
    value = (value - kAirDensity) / (kClayDensity - kAirDensity);
  return {};
}

}  // namespace dubsar::phantom
