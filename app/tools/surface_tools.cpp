#include "app/tools/surface_tools.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/commands/sides.h"
#include "core/base/text/json_text.h"
#include "core/mesh/surface_measure.h"
#include "core/mesh/tablet_frame.h"

namespace dubsar::app {
namespace {

constexpr std::size_t kMostPathPoints = 4000;  // a document holds at most 10000 things

void thin_out(std::vector<glm::dvec3>& path) {
  if (path.size() <= kMostPathPoints) return;
  std::vector<glm::dvec3> out;
  for (std::size_t i = 0; i < kMostPathPoints; ++i) out.push_back(path[i * (path.size() - 1) / (kMostPathPoints - 1)]);
  path = std::move(out);
}

double number_at(const nlohmann::json& object, const char* name, double otherwise) {
  return object.is_object() && object.contains(name) && object.at(name).is_number() ? object.at(name).get<double>()
                                                                                    : otherwise;
}

/// Variance of what blurred a surface, mm2, as its file says: the scan, the filters, which blur the more the more noise
/// they have to take away, and what makes a surface of voxels, which sharpening takes back. 0: the file does not say.
/// kSurface is the share with which wedges of eight phantoms (3 to 10 voxels deep, 17 to 100 dB, blurs of 0.45 to 0.75
/// voxel) keep their depth within 1.3 %; kFilters and kHalfNoise, the power of noise at which they have half of their
/// blur, were chosen on wedges of 3 voxels of four phantoms at 20 and at 25 dB.
double blur_of(const TriMesh& mesh) {
  constexpr double kSurface = 0.3, kFilters = 0.3, kHalfNoise = 1e-3;
  if (mesh.provenance.empty()) return 0.0;
  const auto all = parse_json(mesh.provenance, "provenance");
  if (!all || !all->is_object() || !all->contains("estimates") || !all->contains("parameters")) return 0.0;
  const nlohmann::json& estimates = all->at("estimates");
  if (!estimates.is_object() || !estimates.contains("blur")) return 0.0;
  double variance = number_at(estimates.at("blur"), "variance_vox2", 0.0);
  if (!(variance > 0)) return 0.0;
  const nlohmann::json& used = all->at("parameters");
  variance +=
      kSurface * (1.0 - std::clamp(number_at(used, "sharpen", 0.0) + number_at(used, "sharpen_wide", 0.0), 0.0, 1.0));
  // "raw" is the scan's sample, the next one the grid before the first pass.
  if (estimates.contains("filters") && estimates.at("filters").is_array() && estimates.at("filters").size() > 2) {
    const double noise = std::pow(10.0, -number_at(estimates.at("filters")[1], "snr_db", 100.0) / 10.0);
    variance += kFilters * noise / (noise + kHalfNoise);
  }
  const glm::dvec3 voxel = mesh.frame.grid_voxel_mm();
  return variance * std::pow(voxel.x * voxel.y * voxel.z, 2.0 / 3.0);
}

/// Where a triangle lies, whichever way it looks.
using PlaceOfTriangle = std::array<std::array<float, 3>, 3>;

PlaceOfTriangle place_of(const TriMesh& mesh, std::size_t triangle) {
  PlaceOfTriangle out;
  for (std::size_t c = 0; c < 3; ++c) {
    const glm::vec3& p = mesh.positions[mesh.triangles[triangle][c]];
    out[c] = {p.x, p.y, p.z};
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

SurfaceEvidence::SurfaceEvidence(const TriMesh& mesh) {
  struct Patch {
    std::uint8_t partitions = 0;
    double mm2 = 0.0;
  };
  std::map<PlaceOfTriangle, Patch> patches;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const PartitionId id = mesh.partition_of(t);
    const Partition* const row = mesh.partitions.find(id);
    if (id >= measured_mm2_.size() || (row != nullptr && row->kind == PartitionKind::kPores)) continue;
    const auto at = [&](std::size_t k) {
      return mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[mesh.triangles[t][k]]));
    };
    const double area = 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
    if (!std::isfinite(area)) continue;
    if (mesh.triangle_inferred.empty() || mesh.triangle_inferred[t] == 0) {
      measured_mm2_[id] += area;
      continue;
    }
    Patch& patch = patches[place_of(mesh, t)];
    patch.partitions = static_cast<std::uint8_t>(patch.partitions | 1u << id);
    patch.mm2 = area;
  }
  for (const auto& [place, patch] : patches) inferred_mm2_[patch.partitions] += patch.mm2;
}

EvidenceShares SurfaceEvidence::of(std::uint8_t partitions) const {
  EvidenceShares out;
  for (std::size_t p = 0; p < measured_mm2_.size(); ++p)
    if ((partitions >> p & 1) != 0) out.measured_mm2 += measured_mm2_[p];
  for (const auto& [closed, mm2] : inferred_mm2_)
    if ((closed & partitions) != 0) out.inferred_mm2 += mm2;
  return out;
}

Result<SurfacePin> pin_on(const TriMesh& mesh, const std::vector<Part>& parts, const glm::dvec3& at_mm) {
  DUBSAR_ASSIGN(const SurfacePlace place, nearest_place(mesh, at_mm));
  SurfacePin out{place.at_mm, place.normal, {}, {}};
  out.inferred = place.triangle < mesh.triangle_inferred.size() && mesh.triangle_inferred[place.triangle] != 0;
  const PartitionId id = mesh.partition_of(place.triangle);
  for (const Part& part : parts)
    if ((part.partitions >> id & 1) != 0) out.part = part.name;
  return out;
}

Result<MeasureFigures> figures_of(const TriMesh& mesh, const Measure& measure) {
  if (measure.points_mm.size() != points_of(measure.kind))
    return fail(ErrorKind::kUsage, "{}: {} places found, expected {}", measure_kind_name(measure.kind),
                measure.points_mm.size(), points_of(measure.kind));
  std::vector<SurfacePlace> places;
  for (const glm::dvec3& point : measure.points_mm) {
    DUBSAR_ASSIGN(const SurfacePlace place, nearest_place(mesh, point));
    places.push_back(place);
  }
  MeasureFigures out;
  if (measure.kind == MeasureKind::kAngle) {
    out.angle_deg = angle_between_deg(places[0].at_mm, places[1].at_mm, places[2].at_mm);
    return out;
  }
  if (measure.kind == MeasureKind::kDepth) {
    DUBSAR_ASSIGN(const ImpressionDepth depth, impression_depth(mesh, places[0], {.blur_mm2 = blur_of(mesh)}));
    out.depth_mm = depth.depth_mm;
    out.uncertainty_mm = depth.uncertainty_mm;
    out.path_mm = {depth.rim_mm, depth.bottom_mm};
    return out;
  }
  out.straight_mm = glm::distance(places[0].at_mm, places[1].at_mm);
  out.path_mm = section_between(mesh, places[0], places[1]);
  out.surface_mm = length_of(out.path_mm);
  if (measure.kind == MeasureKind::kProfile)
    out.depth_mm = deepest_below_chord(out.path_mm, places[0].normal + places[1].normal);
  thin_out(out.path_mm);
  return out;
}

Workplace::Reach reach_along(const TriMesh& mesh, const glm::dvec3& direction) {
  Workplace::Reach out{direction, std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      const double at = glm::dot(direction, mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])));
      out.from_mm = std::min(out.from_mm, at);
      out.to_mm = std::max(out.to_mm, at);
    }
  if (out.from_mm > out.to_mm) out.from_mm = out.to_mm = 0.0;
  return out;
}

Result<UprightTurn> upright_turn(const TriMesh& mesh, const glm::dmat3& first) {
  DUBSAR_ASSIGN(const TabletFrame frame, find_tablet_frame(mesh));
  return UprightTurn{glm::normalize(glm::quat_cast(frame.tablet_from_model() * glm::transpose(first))), frame.doubt()};
}

std::string side_of(const glm::dvec3& normal, const glm::dmat3& home) {
  const glm::dvec3 seen = home * normal;
  const std::array<glm::dvec3, 6> outward{{{0, 0, 1}, {0, -1, 0}, {0, 0, -1}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}}};
  std::size_t best = 0;
  for (std::size_t i = 1; i < outward.size(); ++i)
    if (glm::dot(seen, outward[i]) > glm::dot(seen, outward[best]) + 1e-9) best = i;
  return std::string(kSideNames[best]);
}

}  // namespace dubsar::app
