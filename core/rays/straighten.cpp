#include "core/rays/straighten.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

using kernels::kLanes;

/// p -> g(p) / c1 - p, as a table with linear interpolation: its error is below 1e-6 of the longest ray.
class Difference {
 public:
  explicit Difference(const RayCurve& curve) : curve_(curve), step_(curve.longest / kSteps) {
    for (int i = 0; i <= kSteps + 1; ++i) table_.push_back(static_cast<float>(exact(i * step_)));
  }
  float operator()(float p) const noexcept {
    if (p <= 0.0F) return 0.0F;
    const float place = p * static_cast<float>(1.0 / step_);
    if (place >= static_cast<float>(kSteps)) return static_cast<float>(exact(p));
    const auto cell = static_cast<std::size_t>(place);
    const float part = place - static_cast<float>(cell);
    return table_[cell] + part * (table_[cell + 1] - table_[cell]);
  }

 private:
  static constexpr int kSteps = 2048;
  double exact(double p) const noexcept { return curve_.value(p) / curve_.coefficients[0] - p; }

  RayCurve curve_;
  double step_;
  std::vector<float> table_;
};

/// As many as rays lie side by side.
std::int64_t directions_for(const PlaneStrides& planes) noexcept { return std::max(planes.width, planes.height); }

}  // namespace

double crossings_of(const Dims& grid, TurnAxis axis) noexcept {
  return 2.0 * static_cast<double>(grid.count()) * static_cast<double>(directions_for(planes_across(grid, axis)));
}

Result<void> straighten(GridStore& grid, const StraightenOptions& options, Progress& progress) {
  const Dims dims = grid.dims();
  const PlaneStrides at = planes_across(dims, options.axis);
  if (!grid.in_memory() && options.axis != TurnAxis::kZ)
    return fail(ErrorKind::kTryAgain,
                "rays that turn about {} of the scan cross all of its slices, which do not fit into memory together: "
                "store it with that axis as z, or allow more memory",
                options.axis == TurnAxis::kX ? "x" : "y");
  const ParallelRays rays(at.width, at.height, directions_for(at));
  const Difference difference(options.curve);
  LaneImage image = rays.image();
  LaneSinogram projections = rays.sinogram();
  std::vector<std::int64_t> planes(static_cast<std::size_t>(kLanes));
  Buffer<float> read(grid.in_memory() ? 0 : kLanes * dims.slice());
  for (std::int64_t first = 0; first < at.planes; first += kLanes) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t last = std::min(at.planes, first + kLanes);
    planes.resize(static_cast<std::size_t>(last - first));
    float* voxels = nullptr;
    if (grid.in_memory()) {
      voxels = grid.page(0, dims.z).data();
      std::iota(planes.begin(), planes.end(), first);
    } else {
      DUBSAR_TRY(grid.read(first, last, read.span()));
      const std::span<float> page = grid.page(first, last);
      std::copy(read.data(), read.data() + (last - first) * dims.slice(), page.begin());
      voxels = page.data();
      std::iota(planes.begin(), planes.end(), 0);
    }
    image.clear();
    load_planes(voxels, at, planes, options.levels, image);
    rays.project(image, projections);
    parallel_for(rays.directions(), 4, [&](std::int64_t k) {
      std::transform(projections.row(k), projections.row(k) + projections.row_floats(), projections.row(k), difference);
    });
    rays.filter(projections);
    rays.backproject(projections, image);
    add_planes(image, at, planes, static_cast<float>(options.levels.contrast()), voxels);
    if (!grid.in_memory()) {
      DUBSAR_TRY(grid.store(first, last));
    }
    progress.advance((last - first) * at.width * at.height);
  }
  return {};
}

}  // namespace dubsar
