#include "core/rays/straighten.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/rays/row_curve.h"

namespace dubsar {
namespace {

using kernels::kLanes;

/// Pairs of planes from the middle half of the grid, two apart, so that their noise has nothing in common; none in a
/// grid that is too thin.
std::vector<std::int64_t> pairs_of_planes(std::int64_t all) {
  constexpr std::int64_t kPlanesApart = 2;
  std::vector<std::int64_t> planes;
  if (all < 2 * kLanes) return planes;
  for (std::int64_t pair = 0; pair < kLanes / 2; ++pair) {
    planes.push_back(all / 4 + pair * (all / 2) / (kLanes / 2));
    planes.push_back(planes.back() + kPlanesApart);
  }
  return planes;
}

/// As many as rays lie side by side.
std::int64_t directions_for(const PlaneStrides& planes) noexcept { return std::max(planes.width, planes.height); }

/// More than rays lie side by side: what few directions leave in the air would draw the shift towards 0.
std::int64_t directions_for_shift(const PlaneStrides& planes) noexcept { return directions_for(planes) * 3 / 2; }

Result<AxisShift> look_for_shift(GridStore& grid, const PlaneStrides& at, const StraightenOptions& options) {
  const ParallelRays rays(at.width, at.height, directions_for_shift(at));
  const RowCurve curve(options.curve, options.stray.get(), rays.directions(), rays.bins());
  const std::vector<std::int64_t> planes = pairs_of_planes(at.planes);
  if (planes.empty()) return AxisShift{};
  LaneImage image = rays.image();
  if (grid.in_memory()) {
    load_planes(grid.page(0, grid.dims().z).data(), at, planes, options.levels, image);
  } else {
    const std::int64_t slice = grid.dims().slice();
    Buffer<float> slices(kLanes * slice);
    std::vector<std::int64_t> here;
    for (const std::int64_t z : planes) {
      const auto place = static_cast<std::int64_t>(here.size());
      DUBSAR_TRY(grid.read(z, z + 1, slices.span().subspan(static_cast<std::size_t>(place * slice))));
      here.push_back(place);
    }
    load_planes(slices.data(), at, here, options.levels, image);
  }
  LaneSinogram recorded = rays.sinogram();
  rays.project(image, recorded);
  return find_axis_shift(rays, image, recorded, [&](std::int64_t direction, const float* p, float* bend) {
    curve.bend(direction, planes, p, bend);
  });
}

}  // namespace

double crossings_of(const Dims& grid, TurnAxis axis) noexcept {
  const std::int64_t directions = directions_for(planes_across(grid, axis));
  const std::int64_t together = ParallelRays::directions_together(directions);
  return 2.0 * static_cast<double>(grid.count()) * static_cast<double>(directions) / static_cast<double>(together);
}

Result<AxisShift> find_shift_in(GridStore& grid, const StraightenOptions& options) {
  if (!grid.in_memory() && options.axis != TurnAxis::kZ) return AxisShift{};
  const PlaneStrides at = planes_across(grid.dims(), options.axis);
  return look_for_shift(grid, at, options);
}

Result<Straightened> straighten(GridStore& grid, const StraightenOptions& options, Progress& progress) {
  const Dims dims = grid.dims();
  const PlaneStrides at = planes_across(dims, options.axis);
  if (!grid.in_memory() && options.axis != TurnAxis::kZ)
    return fail(ErrorKind::kTryAgain,
                "rays that turn about {} of the scan cross all of its slices, which do not fit into memory together: "
                "store it with that axis as z, or allow more memory",
                options.axis == TurnAxis::kX ? "x" : "y");
  const ParallelRays rays(at.width, at.height, directions_for(at));
  const RowCurve curve(options.curve, options.stray.get(), rays.directions(), rays.bins());
  Straightened done;
  DUBSAR_ASSIGN(done.axis_shift, look_for_shift(grid, at, options));
  const bool moves = done.axis_shift.pixels != 0.0;
  if (!moves && !options.curve.bends()) return done;
  LaneImage image = rays.image();
  LaneSinogram projections = rays.sinogram(), moved(moves ? rays.directions() : 0, rays.bins());
  std::vector<std::int64_t> planes(static_cast<std::size_t>(kLanes)), of_grid(planes);
  Buffer<float> read(grid.in_memory() ? 0 : kLanes * dims.slice());
  for (std::int64_t first = 0; first < at.planes; first += kLanes) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t last = std::min(at.planes, first + kLanes);
    planes.resize(static_cast<std::size_t>(last - first));
    of_grid.resize(planes.size());
    std::iota(of_grid.begin(), of_grid.end(), first);
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
    if (moves) shift_rays(projections, done.axis_shift, moved);
    parallel_chunks(rays.directions(), 4, [&](std::int64_t begin, std::int64_t end) {
      std::vector<float> bend(static_cast<std::size_t>(projections.row_floats()));
      for (std::int64_t k = begin; k < end; ++k) {
        float* const p = projections.row(k);
        const float* const at_axis = moves ? moved.row(k) : p;
        curve.bend(k, of_grid, at_axis, bend.data());
        for (std::int64_t i = 0; i < projections.row_floats(); ++i)
          p[i] = bend[static_cast<std::size_t>(i)] + (moves ? at_axis[i] - p[i] : 0.0F);
      }
    });
    rays.filter(projections);
    rays.backproject(projections, image);
    add_planes(image, at, planes, static_cast<float>(options.levels.contrast()), voxels);
    if (!grid.in_memory()) {
      DUBSAR_TRY(grid.store(first, last));
    }
    progress.advance((last - first) * at.width * at.height);
  }
  return done;
}

}  // namespace dubsar
