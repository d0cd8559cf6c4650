#include "core/parts/labelled_model.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel.h"
#include "core/mesh/evidence.h"
#include "core/mesh/vertex_attributes.h"

namespace dubsar {
namespace {

/// The number that each vertex of a labelled mesh has in a model: of those at the air in its mesh, then of the others.
/// Those of cells without clay of both keep theirs.
class NumbersInModel {
 public:
  explicit NumbersInModel(const LabelledMesh& labelled)
      : first_mixed_(labelled.first_mixed), mixed_(labelled.at_air.size()) {
    std::uint32_t next = first_mixed_;
    for (const bool air : {true, false})
      for (std::size_t i = 0; i < mixed_.size(); ++i)
        if ((labelled.at_air[i] != 0) == air) mixed_[i] = next++;
  }
  std::uint32_t operator[](std::size_t v) const {
    return v < first_mixed_ ? static_cast<std::uint32_t>(v) : mixed_[v - first_mixed_];
  }

 private:
  std::uint32_t first_mixed_;
  std::vector<std::uint32_t> mixed_;
};

std::size_t vertices_at_air(const LabelledMesh& labelled) {
  return labelled.first_mixed + static_cast<std::size_t>(std::ranges::count(labelled.at_air, std::uint8_t{1}));
}

/// Puts the first `count` items of one vector into another, which gets room for `size`, on large pages.
template <class T>
void copy_first(const std::vector<T>& from, std::size_t count, std::size_t size, std::vector<T>& to) {
  to.reserve(size);
  ask_for_large_pages(to.data(), size * sizeof(T));
  to.assign(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
}

/// What lies at the air: vertices below `dual`, by their numbers.
QuadMesh mesh_at_air(const LabelledMesh& labelled, const NumbersInModel& number, std::size_t dual) {
  const QuadMesh& from = labelled.mesh;
  const std::uint32_t first_mixed = labelled.first_mixed, first_contact = labelled.first_contact;
  QuadMesh mesh;
  mesh.embedded = from.embedded;
  copy_first(from.positions, first_mixed, dual, mesh.positions);
  copy_first(from.quads, first_contact, first_contact, mesh.quads);
  copy_first(from.first_incident, first_mixed + std::size_t{1}, dual + 1, mesh.first_incident);
  copy_first(from.incident, from.first_incident[first_mixed], from.incident.size(), mesh.incident);
  for (std::uint32_t v = first_mixed; v < from.positions.size(); ++v) {
    if (!labelled.is_at_air(v)) continue;
    const auto around = from.quads_of(v);
    mesh.positions.push_back(from.positions[v]);
    mesh.incident.insert(mesh.incident.end(), around.begin(), std::ranges::lower_bound(around, first_contact));
    mesh.first_incident.push_back(static_cast<std::uint32_t>(mesh.incident.size()));
  }
  parallel_for(mesh.quad_count(), 1 << 14, [&](std::int64_t q) {
    for (std::uint32_t& v : mesh.quads[static_cast<std::size_t>(q)])
      if (v >= first_mixed) v = number[v];
  });
  for (const DoubledCorner& d : from.doubled)
    if (d.quad < first_contact) mesh.doubled.push_back({d.quad, number[d.vertex], d.corner});
  mesh.mark_doubled();
  return mesh;
}

/// The triangles of a labelled mesh, taken apart.
class Divided {
 public:
  Divided(const LabelledMesh& labelled, Triangulation cut)
      : labelled_(labelled),
        cut_(std::move(cut)),
        number_(labelled),
        vertices_(static_cast<std::uint32_t>(labelled.mesh.positions.size())),
        dual_(static_cast<std::uint32_t>(vertices_at_air(labelled))),
        centres_(static_cast<std::uint32_t>(cut_.steiner.size() - cut_.face_points.size())),
        first_contact_triangle_(cut_.first_triangle[labelled.first_contact]),
        point_at_air_(cut_.face_points.size(), false) {
    centres_at_air_ = centres_;
    for (std::size_t t = 0; t < cut_.triangles.size(); ++t)
      for (const std::uint32_t v : cut_.triangles[t]) {
        if (v < vertices_) continue;
        if (v - vertices_ >= centres_) {
          if (t < first_contact_triangle_) point_at_air_[v - vertices_ - centres_] = true;
        } else if (t >= first_contact_triangle_) {
          centres_at_air_ = std::min(centres_at_air_, v - vertices_);
        }
      }
  }

  void contact(const SurfaceModel& model, FillPatch& patch) {
    const std::uint32_t own = vertices_ - dual_;
    patch.extra_positions.resize(own);
    patch.evidence.resize(own);
    added_.assign(cut_.steiner.size(), kNowhere);
    for (std::uint32_t q = labelled_.first_contact; q < labelled_.mesh.quads.size(); ++q) {
      const std::uint8_t evidence = evidence_of(model, q);
      for (std::size_t t = cut_.first_triangle[q]; t < cut_.first_triangle[q + 1]; ++t) {
        Triangle corners = cut_.triangles[t];
        if (is_shared_point(corners[1])) {  // patches bend at it by themselves
          corners[1] = cut_.triangles[++t][1];
        }
        for (std::uint32_t& v : corners) v = id_in_patch(v, evidence, patch);
        patch.triangles.push_back({corners[0], corners[2], corners[1]});  // out of the tablet
      }
    }
  }

  Triangulation at_air() {
    Triangulation drawing;
    std::vector<std::uint32_t> number_of_point(point_at_air_.size(), 0);
    drawing.steiner.assign(cut_.steiner.begin(), cut_.steiner.begin() + centres_at_air_);
    for (std::size_t k = 0; k < point_at_air_.size(); ++k) {
      if (!point_at_air_[k]) continue;
      number_of_point[k] = static_cast<std::uint32_t>(drawing.steiner.size());
      drawing.steiner.push_back(cut_.steiner[centres_ + k]);
      FacePoint point = cut_.face_points[k];
      point.a = number_[point.a];
      point.b = number_[point.b];
      drawing.face_points.push_back(point);
    }
    cut_.triangles.resize(first_contact_triangle_);
    parallel_for(first_contact_triangle_, 1 << 14, [&](std::int64_t t) {
      for (std::uint32_t& v : cut_.triangles[static_cast<std::size_t>(t)]) {
        if (v < vertices_) {
          v = number_[v];
        } else {
          const std::uint32_t added = v - vertices_;
          v = dual_ + (added < centres_ ? added : number_of_point[added - centres_]);
        }
      }
    });
    cut_.first_triangle.resize(labelled_.first_contact + std::size_t{1});
    drawing.triangles = std::move(cut_.triangles);
    drawing.first_triangle = std::move(cut_.first_triangle);
    return drawing;
  }

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  bool is_shared_point(std::uint32_t v) const {
    return v >= vertices_ + centres_ && point_at_air_[v - vertices_ - centres_];
  }
  std::uint8_t evidence_of(const SurfaceModel& model, std::uint32_t q) const {
    const Polygon polygon = labelled_.mesh.polygon(q);
    for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size); ++k)
      if (number_[polygon.vertex[k]] >= dual_) return model.labelled->evidence[number_[polygon.vertex[k]] - dual_];
    return evidence_byte(Evidence::kInferred);
  }
  std::uint32_t id_in_patch(std::uint32_t v, std::uint8_t evidence, FillPatch& patch) {
    if (v < vertices_) return number_[v];
    std::uint32_t& id = added_[v - vertices_];
    if (id == kNowhere) {
      id = dual_ + static_cast<std::uint32_t>(patch.extra_positions.size());
      patch.extra_positions.push_back(cut_.steiner[v - vertices_]);
      patch.evidence.push_back(evidence);
    }
    return id;
  }

  const LabelledMesh& labelled_;
  Triangulation cut_;
  NumbersInModel number_;
  std::uint32_t vertices_, dual_, centres_, centres_at_air_ = 0;
  std::uint32_t first_contact_triangle_;
  std::vector<bool> point_at_air_;  ///< of the points on faces
  std::vector<std::uint32_t> added_;
};

}  // namespace

Result<void> put_labelled_mesh(SurfaceModel& model, const LabelledMesh& labelled) {
  DUBSAR_CHECK(model.labelled.has_value());
  const std::size_t vertices = labelled.mesh.positions.size(), dual = vertices_at_air(labelled);
  if (model.labelled->evidence.size() != vertices - dual)
    return fail(ErrorKind::kBadData, "surface_model: evidence for {} vertices of the contact found, {} expected",
                model.labelled->evidence.size(), vertices - dual);
  const Partition *const tablet = model.partitions.find(PartitionKind::kTablet),
                         *const envelope = model.partitions.find(PartitionKind::kEnvelopeInside);
  if (tablet == nullptr || envelope == nullptr)
    return fail(ErrorKind::kBadData, "surface_model: labels found, but no tablet in an envelope");
  const NumbersInModel number(labelled);

  FillPatch patch;
  patch.partition = tablet->id;
  patch.reverse_partition = envelope->id;
  patch.evidence = model.labelled->evidence;
  patch.extra_positions.reserve(vertices - dual);
  std::vector<std::uint32_t> source;
  copy_first(labelled.unlabelled, labelled.first_mixed, dual, source);
  for (std::size_t v = labelled.first_mixed; v < vertices; ++v)
    if (labelled.is_at_air(v))
      source.push_back(labelled.unlabelled[v]);
    else
      patch.extra_positions.push_back(labelled.mesh.positions[v]);
  model.mesh = mesh_at_air(labelled, number, dual);
  for_each_attribute([&](const auto& a) {
    auto& values = model.attributes.*a.values;
    if (values.empty()) return;
    std::remove_reference_t<decltype(values)> gathered;
    resize_large(gathered, source.size());
    parallel_for(static_cast<std::int64_t>(source.size()), 1 << 14, [&](std::int64_t i) {
      const auto v = static_cast<std::size_t>(i);
      gathered[v] = values[source[v]];
    });
    values = std::move(gathered);
  });
  model.patches.clear();
  model.patches.push_back(std::move(patch));
  model.drawing.reset();
  model.settled_sum = 0;
  return {};
}

bool is_mesh_at_air(const QuadMesh& mesh, const LabelledMesh& labelled) {
  const std::size_t quads = labelled.first_contact;
  if (mesh.positions.size() != vertices_at_air(labelled) || mesh.quads.size() != quads) return false;
  const NumbersInModel number(labelled);
  for (std::size_t q = 0; q < quads; ++q)
    for (std::size_t k = 0; k < 4; ++k)
      if (mesh.quads[q][k] != number[labelled.mesh.quads[q][k]]) return false;
  std::size_t found = 0;
  for (const DoubledCorner& d : labelled.mesh.doubled)
    if (d.quad < quads &&
        (found == mesh.doubled.size() || mesh.doubled[found++] != DoubledCorner{d.quad, number[d.vertex], d.corner}))
      return false;
  return found == mesh.doubled.size();
}

void draw_labelled_mesh(SurfaceModel& model, LabelledMesh labelled, std::optional<QuadCuts> cuts) {
  std::vector<glm::vec3> normals;
  if (const std::vector<glm::vec3>& known = model.attributes.normals; !known.empty()) {
    copy_first(known, labelled.first_mixed, labelled.mesh.positions.size(), normals);
    const NumbersInModel number(labelled);
    for (std::size_t v = labelled.first_mixed; v < labelled.mesh.positions.size(); ++v)
      normals.push_back(labelled.is_at_air(v) ? known[number[v]] : glm::vec3(0.0f));
  }
  Triangulation cut = triangulate(labelled.mesh, normals, 0, labelled.first_contact, std::move(cuts));
  normals = {};
  labelled.mesh.first_incident = {};
  labelled.mesh.incident = {};
  Divided divided(labelled, std::move(cut));
  divided.contact(model, model.patches.front());
  model.drawing = divided.at_air();
}

std::vector<glm::vec3> labelled_places(const SurfaceModel& model, const LabelledMesh& labelled) {
  const NumbersInModel number(labelled);
  const std::size_t dual = model.mesh.positions.size();
  std::vector<glm::vec3> places(labelled.mesh.positions.size());
  for (std::size_t v = 0; v < places.size(); ++v)
    places[v] =
        number[v] < dual ? model.mesh.positions[number[v]] : model.patches.front().extra_positions[number[v] - dual];
  return places;
}

}  // namespace dubsar
