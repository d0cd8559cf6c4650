#include "app/viewer/first_document.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "app/tools/surface_tools.h"
#include "app/words/text.h"

namespace dubsar::app {
namespace {

std::vector<Part> parts_of(const TriMesh& mesh) {
  std::vector<Part> out;
  for (const Partition& partition : mesh.partitions) {
    const std::string& name = partition.body_name();
    auto at = std::find_if(out.begin(), out.end(), [&](const Part& part) { return part.name == name; });
    if (at == out.end()) at = out.insert(out.end(), Part{name});
    at->partitions = static_cast<std::uint8_t>(at->partitions | 1u << partition.id);
  }
  for (const Partition& partition : mesh.partitions)
    for (Part& part : out)
      if (!partition.within.empty() && part.name == partition.within && part.name != partition.body_name())
        part.pores = static_cast<std::uint8_t>(part.pores | 1u << partition.id);
  return out;
}

/// What was chosen of parts with the same names.
std::vector<Part> chosen(std::vector<Part> parts, const std::vector<Part>& choices) {
  for (Part& part : parts) {
    const auto same = [&](const Part& other) { return other.name == part.name; };
    const auto at = std::find_if(choices.begin(), choices.end(), same);
    if (at == choices.end()) continue;
    const Part of_mesh = part;
    part = *at;
    part.partitions = of_mesh.partitions;
    part.pores = of_mesh.pores;
  }
  return parts;
}

}  // namespace

Box surface_box(const TriMesh& mesh) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box out{glm::dvec3(kInf), glm::dvec3(-kInf)};
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      const glm::dvec3 at = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v]));
      if (!std::isfinite(at.x + at.y + at.z)) continue;
      out.min = glm::min(out.min, at);
      out.max = glm::max(out.max, at);
    }
  return out;
}

FirstDocument first_document(const ViewOptions& options, const TriMesh& mesh) {
  FirstDocument first{options.work.document, options.work.doubt};
  Document& out = first.document;
  out.parts = chosen(parts_of(mesh), out.parts);
  const Light& light = options.stage.shading.light;
  if (out.home_light == LightPlace() && out.light == LightPlace())
    out.home_light = out.light = {light.azimuth_deg, light.elevation_deg};
  if (out.scan == ScanView() && !mesh.triangles.empty()) {
    const Box box = surface_box(mesh);
    out.scan.cursor_mm = out.scan.centre_mm = 0.5 * (box.min + box.max);
  }
  if (options.work.upright && !mesh.triangles.empty()) {
    if (auto upright = upright_turn(mesh, first_turn(surface_box(mesh), options.stage.direction))) {
      out.home.rotation = out.now.rotation = upright->turn;
      first.doubt = std::move(upright->doubt);
    }
  }
  return first;
}

std::string first_words(const SessionWork& work, bool worn) {
  if (work.restored) return tr("say.restored");
  if (!work.doubt.empty()) {
    std::string doubt = work.doubt;
    if (doubt[0] >= 'a' && doubt[0] <= 'z') doubt[0] = static_cast<char>(doubt[0] - 'a' + 'A');
    return tr("say.doubt", doubt);
  }
  if (worn) return tr("say.worn");
  return tr("say.first");
}

}  // namespace dubsar::app
