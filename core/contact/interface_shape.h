#pragma once
// The traced contact in its final shape: which of it is a film, where its vertices lie.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/contact/clays.h"
#include "core/contact/dips.h"
#include "core/contact/interface_mesh.h"
#include "core/contact/rules.h"

namespace dubsar {

struct ShapeOptions {
  float most = 1.5f;            ///< steps that inferred contact is moved
  float blur_variance = 0.42f;  ///< of the scan
  std::optional<ClayContrast> clays = std::nullopt;
  float dip_deviation = 0.0f;  ///< density that a strength of 1 stands for; read where clays differ
  PlainClay plain{};
  ContactRules rules{};
};

/// Evidence of the added vertices (evidence.h): film where the dips, averaged far along the contact and without its
/// rim, are likelier those of a faint film than of plain clay, in a region whose log_likelihood_of_film() (dips.h) is
/// more than chance makes anywhere, or, less strictly, in a patch whose is so as a whole; or where the clays differ and
/// their densities around it say so; else inferred. Films are followed in the density (film_refine.h); what is inferred
/// becomes a membrane between them and the surface, no farther than `most` steps from where it was.
std::vector<std::uint8_t> shape_interface(InterfaceMesh& mesh, const std::vector<glm::vec3>& dual_positions,
                                          const BandDensity& density, const ShapeOptions& options);

}  // namespace dubsar
