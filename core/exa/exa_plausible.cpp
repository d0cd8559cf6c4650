#include "core/exa/exa_plausible.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/exa/labels/labelled_code.h"
#include "core/extract/extract.h"
#include "core/parts/labelled_model.h"

namespace dubsar {
namespace {

/// Grid steps that smoothing and quantising move a vertex from its crossings: phantoms have 2 at most.
constexpr float kMostMove = 8.0F;
/// Of a patch outside of the grid: relaxed patches stay within their rims.
constexpr float kPlausibleMargin = 16.0F;
/// Of a unit vector that was rounded to floats, or to the steps of an octahedron.
constexpr float kUnitError = 0.01F;
/// A curve of less than a thousandth of a grid step.
constexpr float kMostCurvature = 1000.0F;
/// Millimetres: atoms, and more than a room.
constexpr double kLeastVoxel = 1e-7, kMostVoxel = 1e4, kFarthestOrigin = 1e7;

Result<void> check_places(const SurfaceModel& model, const std::vector<glm::vec3>& places, const QuadMesh& base) {
  const Dims& d = model.samples.dims;
  const glm::vec3 low(-kPlausibleMargin),
      high(glm::vec3(static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)) + kPlausibleMargin);
  const auto inside = [&](const glm::vec3& p) {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
  };
  for (std::size_t v = 0; v < places.size(); ++v)
    if (const float moved = glm::length(places[v] - base.positions[v]); !(moved <= kMostMove))
      return fail(ErrorKind::kBadData, "exa: vertex {} lies {:g} grid steps from its crossings, expected at most {}", v,
                  moved, kMostMove);
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    for (const glm::vec3& p : model.patches[i].extra_positions)
      if (!inside(p))
        return fail(ErrorKind::kBadData, "exa: fill patch {} has a vertex at {:g} {:g} {:g}, far outside of the grid",
                    i, p.x, p.y, p.z);
    for (const Triangle& t : model.patches[i].triangles)
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
        return fail(ErrorKind::kBadData, "exa: fill patch {} has a triangle with the corners {} {} {}", i, t[0], t[1],
                    t[2]);
  }
  return {};
}

Result<void> check_attributes(const VertexAttributes& a) {
  for (std::size_t v = 0; v < a.normals.size(); ++v)
    if (const float length = glm::length(a.normals[v]); !(std::abs(length - 1.0F) <= kUnitError))
      return fail(ErrorKind::kBadData, "exa: the normal of vertex {} has length {:g}, expected 1", v, length);
  for (const std::vector<float>* const k : {&a.k_min, &a.k_max})
    for (std::size_t v = 0; v < k->size(); ++v)
      if (!(std::abs((*k)[v]) <= kMostCurvature))
        return fail(ErrorKind::kBadData,
                    "exa: vertex {} has a curvature of {:g} for each grid step, expected {} at most", v, (*k)[v],
                    kMostCurvature);
  return {};
}

Result<void> check_frame(const GridFrame& frame) {
  for (int a = 0; a < 3; ++a) {
    const double voxel = frame.input_voxel.known() ? frame.input_voxel.mm[a] : 1.0;
    if (!(voxel >= kLeastVoxel && voxel <= kMostVoxel) || !(frame.scale[a] > 0.0 && frame.scale[a] <= kMostVoxel) ||
        !(std::abs(frame.origin_vox[a] * voxel) <= kFarthestOrigin))
      return fail(ErrorKind::kBadData, "exa: a voxel of {:g} mm, {:g} of it a grid step, from voxel {:g} on is no scan",
                  voxel, frame.scale[a], frame.origin_vox[a]);
  }
  return {};
}

}  // namespace

Result<void> check_plausible(const SurfaceModel& model, const ExaHeader& header, Progress& progress) {
  if (header.normals == ExaNormals::kExact && model.attributes.normals.empty() && model.mesh.vertex_count() > 0)
    return fail(ErrorKind::kBadData, "exa: the header announces exact normals, and there are none");
  if (!model.provenance.empty() && nlohmann::json::parse(model.provenance, nullptr, false).is_discarded())
    return fail(ErrorKind::kBadData, "exa: block \"provenance\" is no JSON");
  DUBSAR_TRY(check_frame(model.frame));
  DUBSAR_TRY(check_attributes(model.attributes));
  if (!model.labelled) {
    DUBSAR_ASSIGN(const QuadMesh base, build_quad_mesh(model.samples, progress));
    return check_places(model, model.mesh.positions, base);
  }
  DUBSAR_ASSIGN(const EdgeIndex index, EdgeIndex::create(model.samples));
  DUBSAR_ASSIGN(const LabelledMesh base, labelled_base(model, index, progress));
  return check_places(model, labelled_places(model, base), base.mesh);
}

}  // namespace dubsar
