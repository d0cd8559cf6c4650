#include "core/contact/labelled/labelled_model.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <utility>

#include "core/extract/labelled/taking_back.h"
#include "core/mesh/evidence.h"
#include "core/mesh/vertex_attributes.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kNobody = 0xffffffffu;

/// The model's vertex from which each vertex of the labelled mesh has what it knows; kNobody away from the air. And
/// whether it has all of its crossings.
struct Forebears {
  std::vector<std::uint32_t> of;
  std::vector<bool> same;
};

Forebears find_forebears(const LabelledMesh& labelled, const QuadMesh& before) {
  const std::size_t count = labelled.mesh.positions.size();
  Forebears found{std::vector<std::uint32_t>(count, kNobody), std::vector<bool>(count, true)};
  std::copy(labelled.unlabelled.begin(), labelled.unlabelled.end(), found.of.begin());
  for (std::uint32_t v = labelled.first_mixed; v < count; ++v) {
    std::size_t shared = 0;
    for (const std::uint32_t q : labelled.mesh.quads_of(v)) {
      if (q >= labelled.first_contact) continue;
      const Polygon now = labelled.mesh.polygon(q), then = before.polygon(q);
      std::uint8_t corner = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(now.size); ++k)
        if (now.vertex[k] == v) corner = now.corner[k];
      for (std::size_t k = 0; k < static_cast<std::size_t>(then.size); ++k)
        if (then.corner[k] == corner && (found.of[v] == kNobody || found.of[v] == then.vertex[k])) {
          found.of[v] = then.vertex[k];
          ++shared;
          break;
        }
    }
    found.same[v] = found.of[v] != kNobody && shared == before.quads_of(found.of[v]).size();
  }
  return found;
}

std::vector<glm::vec3> places_of(const LabelledMesh& labelled, const QuadMesh& before, const Forebears& forebears) {
  std::vector<glm::vec3> places = labelled.mesh.positions;
  for (std::size_t v = 0; v < places.size(); ++v)
    if (forebears.of[v] != kNobody && forebears.same[v]) places[v] = before.positions[forebears.of[v]];
  return places;
}

}  // namespace

std::vector<bool> vertices_at_air(const LabelledMesh& labelled) {
  std::vector<bool> at_air(labelled.mesh.positions.size(), true);
  for (std::uint32_t v = labelled.first_mixed; v < at_air.size(); ++v)
    at_air[v] = labelled.mesh.quads_of(v).front() < labelled.first_contact;  // rising
  return at_air;
}

std::vector<glm::vec3> places_at_air(const LabelledMesh& labelled, const SurfaceModel& model) {
  return places_of(labelled, model.mesh, find_forebears(labelled, model.mesh));
}

Result<DrawnModel> put_labelled_mesh(SurfaceModel& model, const LabelledMesh& labelled,
                                     const std::vector<std::uint16_t>& contact,
                                     const std::function<std::uint8_t(const glm::vec3&)>& evidence_at,
                                     Progress& progress) {
  const QuadMesh before = std::move(model.mesh);
  const Forebears forebears = find_forebears(labelled, before);
  const std::vector<glm::vec3> wanted = places_of(labelled, before, forebears);

  // A safe drawing, then the places that are wanted where they cross nothing.
  QuadMesh mesh = labelled.mesh;
  mesh.positions = wanted;
  const SafeDrawing safe =
      draw_safely(labelled, wanted, crossings_of(labelled, model.samples, contact), triangulate(mesh, {}));
  if (progress.cancelled()) return cancelled_error();
  std::vector<ExactPlace> places = follow_vertices(safe, exact_places(wanted));
  const TakenBack back = take_back(safe, places);
  DrawnModel drawn{back.rounds, back.points, back.left};
  if (progress.cancelled()) return cancelled_error();

  // Vertices at the air and the points of their x-quads stay in the mesh, the others belong to the patch.
  const std::size_t vertices = labelled.mesh.positions.size();
  const std::uint32_t first_contact_triangle = safe.first_triangle[labelled.first_contact];
  std::vector<bool> at_air = vertices_at_air(labelled);
  at_air.resize(places.size(), false);
  for (std::uint32_t t = 0; t < first_contact_triangle; ++t)
    for (const std::uint32_t p : safe.triangles[t]) at_air[p] = true;
  std::vector<std::uint32_t> id(places.size(), kNobody), source;
  std::uint32_t dual = 0;
  for (std::size_t p = 0; p < places.size(); ++p)
    if (at_air[p]) id[p] = dual++;
  std::vector<std::uint32_t> heir(places.size(), kNobody);  // the model's vertex whose attributes it has
  std::copy(forebears.of.begin(), forebears.of.end(), heir.begin());
  for (std::uint32_t t = 0; t < first_contact_triangle; ++t)
    for (const std::uint32_t p : safe.triangles[t])
      for (const std::uint32_t w : safe.triangles[t])
        if (p >= vertices && heir[p] == kNobody && w < vertices) heir[p] = heir[w];

  const auto place_of = [&](std::size_t p) {
    return glm::vec3(glm::dvec3(places[p]) / static_cast<double>(kExactSteps));
  };
  FillPatch patch;
  patch.partition = model.partitions.find(PartitionKind::kTablet)->id;
  patch.reverse_partition = model.partitions.find(PartitionKind::kEnvelopeInside)->id;
  QuadMesh& now = model.mesh;
  now = {};
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (at_air[p]) {
      now.positions.push_back(place_of(p));
      source.push_back(heir[p] == kNobody ? 0 : heir[p]);
    } else {
      id[p] = dual + static_cast<std::uint32_t>(patch.extra_positions.size());
      patch.extra_positions.push_back(place_of(p));
      patch.evidence.push_back(evidence_at(place_of(p)));
    }
  }
  now.quads.assign(labelled.mesh.quads.begin(), labelled.mesh.quads.begin() + labelled.first_contact);
  for (auto& quad : now.quads)
    for (std::uint32_t& v : quad) v = id[v];
  for (const DoubledCorner& d : labelled.mesh.doubled)
    if (d.quad < labelled.first_contact) now.doubled.push_back({d.quad, id[d.vertex], d.corner});
  now.build_incidence();
  Triangulation drawing;
  for (std::uint32_t t = 0; t < safe.triangles.size(); ++t) {
    Triangle corners = safe.triangles[t];
    for (std::uint32_t& p : corners) p = id[p];
    if (t < first_contact_triangle)
      drawing.triangles.push_back(corners);
    else
      patch.triangles.push_back({corners[0], corners[2], corners[1]});  // out of the tablet
  }
  drawing.first_triangle.assign(safe.first_triangle.begin(), safe.first_triangle.begin() + labelled.first_contact + 1);
  model.drawing = std::move(drawing);
  model.patches.clear();
  model.patches.push_back(std::move(patch));
  for_each_attribute([&](const auto& a) {
    auto& values = model.attributes.*a.values;
    if (values.empty()) return;
    std::remove_reference_t<decltype(values)> gathered(source.size());
    for (std::size_t i = 0; i < source.size(); ++i) gathered[i] = values[source[i]];
    values = std::move(gathered);
  });
  model.settled_sum = 0;
  DUBSAR_TRY(measure_partitions(model));
  return drawn;
}

}  // namespace dubsar
