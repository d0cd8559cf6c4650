#include "core/phantom/holder.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/parallel.h"

namespace dubsar::phantom {
namespace {

constexpr double kHolderHeight = 0.2, kHolderWidth = 0.9;  ///< of the grid's

float share_within(double distance) { return static_cast<float>(std::clamp(0.5 - distance, 0.0, 1.0)); }

}  // namespace

void add_holder(const Phantom& phantom, const VoxelBounds& box, float* out) {
  const PhantomOptions& o = phantom.options();
  if (o.artefacts.holder <= 0.0) return;
  const double top = kHolderHeight * static_cast<double>(o.dims.z);
  const double a = 0.5 * kHolderWidth * static_cast<double>(o.dims.x),
               b = 0.5 * kHolderWidth * static_cast<double>(o.dims.y);
  const double x_middle = 0.5 * static_cast<double>(o.dims.x - 1), y_middle = 0.5 * static_cast<double>(o.dims.y - 1);
  const float density = static_cast<float>(o.artefacts.holder) * (kClayDensity - kAirDensity);
  const std::int64_t width = box.hi[0] - box.lo[0], height = box.hi[1] - box.lo[1];
  parallel_for((box.hi[2] - box.lo[2]) * height, 8, [&](std::int64_t item) {
    const std::int64_t y = box.lo[1] + item % height, z = box.lo[2] + item / height;
    const float below = share_within(static_cast<double>(z) - top);
    if (below <= 0.0f) return;
    float* const row = out + item * width;
    for (std::int64_t x = box.lo[0]; x < box.hi[0]; ++x) {
      const double u = (static_cast<double>(x) - x_middle) / a, v = (static_cast<double>(y) - y_middle) / b;
      const double radius = std::hypot(u, v);
      const double slope = radius > 0.0 ? std::hypot(u / a, v / b) / radius : 1.0;
      const float within = share_within((radius - 1.0) / slope);
      if (within <= 0.0f) continue;
      const Fields f = phantom.fields(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 2.0f);
      const float steep = std::max(std::sqrt(dot(f.outer.g, f.outer.g)), 0.2f);
      row[x - box.lo[0]] += density * below * within * share_within(static_cast<double>(-f.outer.v / steep));
    }
  });
}

}  // namespace dubsar::phantom
