#include "display/render/lod_mesh.h"

#include <algorithm>

#include "display/render/lod.h"

namespace dubsar {
namespace {

constexpr double kFinestGrid = 1024, kCoarsestGrid = 63.9, kGridStep = 0.70710678118654752;  // half the triangles each
constexpr double kWorthwhile = 0.75;  // of the triangles of the finer level

}  // namespace

Result<void> LodMesh::add(const PackedMesh& level, double cell_mm) {
  DUBSAR_ASSIGN(GpuMesh gpu, GpuMesh::upload(level));
  if (levels_.empty()) {
    partition_box_mm_ = level.partition_box_mm;
    for (int p = 0; p < kMaxPartitions; ++p)
      if (level.first_triangle[p] < level.first_triangle[p + 1])
        has_triangles_ = static_cast<std::uint8_t>(has_triangles_ | 1 << p);
  }
  levels_.push_back({std::move(gpu), cell_mm, static_cast<std::int64_t>(level.triangles.size())});
  return {};
}

Result<LodMesh> LodMesh::exact(const PackedMesh& mesh) {
  LodMesh out;
  DUBSAR_TRY(out.add(mesh, 0.0));
  return out;
}

Result<LodMesh> LodMesh::with_levels(PackedMesh mesh) {
  LodMesh out;
  const glm::dvec3 size = mesh.box_mm.size();
  const double longest = std::max({size.x, size.y, size.z});
  sort_into_chunks(mesh);
  DUBSAR_TRY(out.add(mesh, 0.0));
  for (double grid = kFinestGrid; grid >= kCoarsestGrid && longest > 0; grid *= kGridStep) {
    PackedMesh coarser = cluster_vertices(mesh, longest / grid);
    if (coarser.triangles.empty()) break;
    if (static_cast<double>(coarser.triangles.size()) > kWorthwhile * static_cast<double>(mesh.triangles.size()))
      continue;
    sort_into_chunks(coarser);
    DUBSAR_TRY(out.add(coarser, longest / grid));
    mesh = std::move(coarser);
  }
  return out;
}

int LodMesh::level_for(double cell_mm) const noexcept {
  int best = 0;
  for (int i = 1; i < levels(); ++i)
    if (levels_[static_cast<std::size_t>(i)].cell_mm <= cell_mm) best = i;
  return best;
}

Box LodMesh::box_of(std::uint8_t partitions) const {
  return joined_box(partition_box_mm_, static_cast<std::uint8_t>(partitions & has_triangles_));
}

}  // namespace dubsar
