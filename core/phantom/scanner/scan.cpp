#include "core/phantom/scanner/scan.h"

#include <algorithm>
#include <vector>

#include "core/base/system/budget.h"
#include "core/base/system/parallel.h"
#include "core/phantom/scanner/panel.h"
#include "core/phantom/scanner/projector.h"

namespace dubsar::phantom {
namespace {

constexpr std::int64_t kSlicesTogether = 16;

/// Slices become columns.
Result<Columns> read_columns(SlabSource& object) {
  const Dims d = object.dims();
  Columns columns(d.x, d.y, d.z);
  columns.clear();
  std::vector<float> slab;
  for (std::int64_t z0 = 0; z0 < d.z; z0 += kSlicesTogether) {
    const std::int64_t slices = std::min(kSlicesTogether, d.z - z0);
    slab.resize(static_cast<std::size_t>(slices * d.slice()));
    DUBSAR_TRY(object.read(z0, z0 + slices, slab));
    parallel_for(d.x, 4, [&](std::int64_t x) {
      for (std::int64_t y = 0; y < d.y; ++y)
        for (std::int64_t z = 0; z < slices; ++z)
          columns.at(x, y)[z0 + z] = slab[static_cast<std::size_t>(z * d.slice() + y * d.x + x)];
    });
  }
  return columns;
}

Volume<float> as_volume(const Columns& columns, const Dims& d) {
  Volume<float> volume(d);
  parallel_for((d.z + kSlicesTogether - 1) / kSlicesTogether, 1, [&](std::int64_t slab) {
    for (std::int64_t x = 0; x < d.x; ++x)
      for (std::int64_t y = 0; y < d.y; ++y)
        for (std::int64_t z = slab * kSlicesTogether; z < std::min((slab + 1) * kSlicesTogether, d.z); ++z)
          volume.at(x, y, z) = columns.at(x, y)[z];
  });
  return volume;
}

}  // namespace

Result<ScannedVolume> scan_object(SlabSource& object, double voxel_mm, const ScannerOptions& options,
                                  std::uint64_t seed, Progress& progress) {
  ScannedVolume scan;
  DUBSAR_ASSIGN(scan.geometry, make_geometry(object.dims(), voxel_mm, options.turn));
  const ScanGeometry& g = scan.geometry;
  const std::int64_t columns_bytes = g.dims.x * g.dims.y * Columns::padded(g.dims.z) * 4;
  const std::int64_t views_bytes = g.views * g.columns * Columns::padded(g.rows) * 4;
  DUBSAR_TRY(check_memory("scanner", static_cast<std::uint64_t>(views_bytes + 2 * columns_bytes)));
  Columns views;
  {
    DUBSAR_ASSIGN(const Columns columns, read_columns(object));
    DUBSAR_ASSIGN(views, project(columns, g, progress));
  }
  const Beam beam(options.beam);
  scan.clay_per_mm = beam.clay_per_mm();
  scan.water_per_mm = beam.water_per_mm();
  DUBSAR_ASSIGN(const LongestRay longest, Panel(options.beam, options.panel, g, seed).expose(views, progress));
  scan.longest_mm = longest.clay_mm;
  scan.least_light = beam.transmission(longest.clay_mm);
  scan.stray_light = longest.scatter;
  DUBSAR_ASSIGN(const Columns columns, reconstruct(views, g, options.turn.window, progress));
  scan.per_mm = as_volume(columns, g.dims);
  return scan;
}

}  // namespace dubsar::phantom
