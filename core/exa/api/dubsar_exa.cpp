#include "core/exa/api/dubsar_exa.h"

#include <exception>

#include "core/exa/exa_file.h"

namespace dubsar_exa {
namespace {
using namespace dubsar;

/// Nothing may leave the library but what its header names.
template <class Work>
bool guarded(std::string& error, const Work& work) {
  try {
    const Result<void> done = work();
    if (!done) error = done.error().message;
    return done.has_value();
  } catch (const std::bad_alloc&) {
    error = "exa: out of memory";
  } catch (const std::exception& e) {
    error = e.what();
  }
  return false;
}

std::array<float, 3> array_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }

void fill(TriMesh&& mesh, Surface& surface) {
  surface = {};
  for (const glm::vec3& p : mesh.positions)
    surface.positions_mm.push_back(array_of(glm::vec3(mesh.frame.mm_from_grid(glm::dvec3(p)))));
  for (const glm::vec3& n : mesh.normals) surface.normals.push_back(array_of(n));
  surface.triangles = std::move(mesh.triangles);
  surface.k_min = std::move(mesh.k_min);
  surface.k_max = std::move(mesh.k_max);
  surface.shape = std::move(mesh.shape);
  surface.light = std::move(mesh.ao);
  surface.triangle_partition.assign(mesh.triangle_partition.begin(), mesh.triangle_partition.end());
  surface.inferred = std::move(mesh.triangle_inferred);
  for (const dubsar::Partition& p : mesh.partitions)
    surface.partitions.push_back({p.id, p.name, p.body, p.area_mm2, p.volume_mm3, p.watertight});
}

Result<SurfaceModel> read_model(const std::string& path, const ReadOptions& options, Progress& progress) {
  if (options.level != 0) return read_exa_level(path, options.level, progress);
  if (options.box_high != std::array<std::int64_t, 3>{})
    return read_exa_box(path, {options.box_low, options.box_high}, progress);
  return read_exa(path, progress, {options.attributes});
}

Result<void> fill_from(const SurfaceModel& model, const ReadOptions& options, Surface& surface) {
  MeshOptions mesh;
  mesh.fill_holes = options.fill_holes;
  if (options.partition >= 0) mesh.partition = static_cast<PartitionId>(options.partition);
  if (!options.body.empty()) mesh.body = options.body;
  DUBSAR_ASSIGN(TriMesh triangles, make_tri_mesh(model, mesh));
  fill(std::move(triangles), surface);
  return {};
}
}  // namespace

bool read_info(const std::string& path, Info& info, std::string& error) {
  return guarded(error, [&]() -> Result<void> {
    DUBSAR_ASSIGN(const ExaInfo found, read_exa_info(path));
    const ExaHeader& header = found.header;
    const glm::dvec3 step = header.frame.grid_voxel_mm();
    info = {found.major,
            found.minor,
            {header.dims.x, header.dims.y, header.dims.z},
            header.vertices,
            header.quads,
            found.stats.bytes,
            {step.x, step.y, step.z},
            header.tool,
            found.provenance};
    return {};
  });
}

bool read(const std::string& path, const ReadOptions& options, Surface& surface, std::string& error) {
  return guarded(error, [&]() -> Result<void> {
    SilentProgress progress;
    DUBSAR_ASSIGN(const SurfaceModel model, read_model(path, options, progress));
    return fill_from(model, options, surface);
  });
}

bool read_bytes(const void* bytes, std::size_t size, const ReadOptions& options, Surface& surface, std::string& error) {
  return guarded(error, [&]() -> Result<void> {
    if (options.level != 0 || options.box_high != std::array<std::int64_t, 3>{})
      return fail(ErrorKind::kUsage,
                  "exa: a level or a box asked for of bytes in memory, expected neither: read a file");
    SilentProgress progress;
    DUBSAR_ASSIGN(const SurfaceModel model,
                  decode_exa({static_cast<const char*>(bytes), size}, progress, {options.attributes}));
    return fill_from(model, options, surface);
  });
}

bool check_sums(const std::string& path, std::string& error) {
  return guarded(error, [&] { return check_exa_sums(path); });
}

}  // namespace dubsar_exa
