#include "core/script/marks/script_marks.h"

#include <algorithm>

#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr double kMarksContact = 0.01;  // of the vertices

bool touches_another(const TriMesh& mesh) {
  const auto touching = std::count_if(mesh.evidence.begin(), mesh.evidence.end(),
                                      [](std::uint8_t e) { return e != evidence_byte(Evidence::kMeasured); });
  return static_cast<double>(touching) > kMarksContact * static_cast<double>(mesh.evidence.size());
}

}  // namespace

ScriptMarks find_marks(const TriMesh& mesh, const TextSides& sides, std::span<const ScriptWedge> wedges) {
  ScriptMarks out;
  out.rulings = find_rulings(mesh, sides, wedges);
  if (touches_another(mesh)) return out;
  out.cracks = find_cracks(mesh, sides);
  out.sealings = find_sealings(mesh, sides, wedges);
  return out;
}

}  // namespace dubsar
