#pragma once
// A labelled mesh in place of a model's own: what the model knows of its vertices goes to those that took their place.

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/extract/labelled/labelled_mesh.h"
#include "core/parts/surface_model.h"

namespace dubsar {

/// Which vertices have an x-quad between clay and air.
std::vector<bool> vertices_at_air(const LabelledMesh& labelled);

/// Where the model has them: a vertex of a cell with clay of both lies where the model's vertex of the same crossings
/// does, if that has no others; else at the mean of its crossings, as those that are not at the air.
std::vector<glm::vec3> places_at_air(const LabelledMesh& labelled, const SurfaceModel& model);

struct DrawnModel {
  int rounds = 0;
  std::int64_t taken_back = 0, crossing_pairs = 0;
};

/// The model's mesh must be that of the same samples without labels. `contact`: where the contact crosses its edges.
/// `evidence_at`: of a place of the contact.
Result<DrawnModel> put_labelled_mesh(SurfaceModel& model, const LabelledMesh& labelled,
                                     const std::vector<std::uint16_t>& contact,
                                     const std::function<std::uint8_t(const glm::vec3&)>& evidence_at,
                                     Progress& progress);

}  // namespace dubsar
