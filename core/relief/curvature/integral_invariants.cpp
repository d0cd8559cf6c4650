#include "core/relief/curvature/integral_invariants.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <string>

#include "core/base/system/parallel.h"
#include "core/relief/occlusion/surface_cells.h"

namespace dubsar {
namespace {

constexpr double kRadiusMm = 1.0, kLeastEdges = 4.0, kUnknownEdges = 12.0;
constexpr double kCells = 12.0;  // of the outer radius of a band
constexpr std::int64_t kInvariantGrain = 2048;

/// Solid angle of the triangle that three directions span, seen from their origin (A. van Oosterom, J. Strackee, 1983).
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double volume = glm::dot(a, glm::cross(b, c));
  const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
  return 2.0 * std::atan2(volume, below);
}

struct Corner {
  std::array<glm::dvec3, 3> at;  // mm
  glm::dvec3 area;               // along the normal, mm2
};
Corner corner_of(const TriMesh& mesh, const Triangle& t, bool mirrored) {
  Corner out;
  for (std::size_t c = 0; c < 3; ++c) out.at[c] = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[t[c]]));
  if (mirrored) std::swap(out.at[1], out.at[2]);
  out.area = 0.5 * glm::cross(out.at[1] - out.at[0], out.at[2] - out.at[0]);
  return out;
}
bool finite(const Corner& corner) { return std::isfinite(glm::dot(corner.area, corner.area)); }

/// What the triangles at each vertex enclose, as a share of all directions: 1/2 on a plane. A border that is open
/// counts as smooth.
std::vector<float> enclosed_shares(const TriMesh& mesh, bool mirrored) {
  const std::size_t count = mesh.positions.size();
  std::vector<glm::dvec3> inward(count, glm::dvec3(0.0));
  for (const Triangle& t : mesh.triangles) {
    const Corner corner = corner_of(mesh, t, mirrored);
    if (!finite(corner)) continue;
    for (const std::uint32_t v : t) inward[v] -= corner.area;
  }
  std::vector<double> angle(count, 0.0);
  std::vector<std::int64_t> around(count, 0);  // 0 where each neighbour is entered as often as it is left
  for (Triangle t : mesh.triangles) {
    const Corner corner = corner_of(mesh, t, mirrored);
    if (!finite(corner)) continue;
    if (mirrored) std::swap(t[1], t[2]);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = t[c], next = t[(c + 1) % 3], last = t[(c + 2) % 3];
      around[v] += static_cast<std::int64_t>(next) - static_cast<std::int64_t>(last);
      const double length = glm::length(inward[v]);
      if (!(length > 0)) continue;
      angle[v] +=
          solid_angle(inward[v] / length, corner.at[(c + 2) % 3] - corner.at[c], corner.at[(c + 1) % 3] - corner.at[c]);
    }
  }
  std::vector<float> out(count, 0.5f);
  for (std::size_t v = 0; v < count; ++v) {
    double share = angle[v] / (4.0 * std::numbers::pi);
    share -= std::floor(share);
    if (around[v] == 0 && share > 0) out[v] = static_cast<float>(share);
  }
  return out;
}

/// Body of each triangle, as a number.
std::vector<std::uint8_t> bodies_of(const TriMesh& mesh, int& count) {
  std::map<std::string, std::uint8_t> numbers;
  std::array<std::uint8_t, PartitionTable::kMost> body{};
  for (std::size_t id = 0; id < body.size(); ++id) {
    std::string name = fmt::format("#{}", id);
    for (const Partition& partition : mesh.partitions)
      if (partition.id == id) name = partition.body_name();
    body[id] = numbers.emplace(name, static_cast<std::uint8_t>(numbers.size())).first->second;
  }
  count = static_cast<int>(numbers.size());
  std::vector<std::uint8_t> out(mesh.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t) out[t] = body[mesh.partition_of(t) % body.size()];
  return out;
}

}  // namespace

double default_invariant_radius_mm(const TriMesh& mesh) {
  double sum = 0.0;
  std::int64_t edges = 0;
  for (const Triangle& t : mesh.triangles) {
    const Corner corner = corner_of(mesh, t, false);
    if (!finite(corner)) continue;
    for (std::size_t c = 0; c < 3; ++c) sum += glm::distance(corner.at[c], corner.at[(c + 1) % 3]);
    edges += 3;
  }
  const double edge = edges > 0 ? sum / static_cast<double>(edges) : kRadiusMm;
  return mesh.frame.input_voxel.known() ? std::max(kRadiusMm, kLeastEdges * edge) : kUnknownEdges * edge;
}

float distance_from_plane(const InvariantShares& shares) noexcept {
  float square = 0.0f, sum = 0.0f;
  for (const float share : shares) {
    square += (share - 0.5f) * (share - 0.5f);
    sum += 0.5f - share;
  }
  const float distance = std::sqrt(square / static_cast<float>(kInvariantScales));
  return sum < 0 ? -distance : distance;
}

Result<std::vector<InvariantShares>> integral_invariants(const TriMesh& mesh, double radius_mm, Progress& progress) {
  if (!(radius_mm > 0) || !std::isfinite(radius_mm))
    return fail(ErrorKind::kUsage, "integral invariants: radius of {} mm found, expected more than 0", radius_mm);
  const std::size_t count = mesh.positions.size();
  const glm::dvec3 step = mesh.frame.grid_voxel_mm();
  const bool mirrored = step.x * step.y * step.z < 0;
  std::vector<InvariantShares> out(count, InvariantShares{0.5f, 0.5f, 0.5f, 0.5f});
  const std::vector<float> enclosed = enclosed_shares(mesh, mirrored);
  int bodies = 0;
  const std::vector<std::uint8_t> body = bodies_of(mesh, bodies);
  progress.begin("integral invariants", static_cast<std::int64_t>(count), "vertex");
  std::array<float, kInvariantScales> cubed{};
  for (std::size_t k = 0; k < kInvariantScales; ++k)
    cubed[k] = static_cast<float>(1.0 / std::pow(radius_mm * static_cast<double>(k + 1) / kInvariantScales, 3));
  constexpr float kPerDirection = static_cast<float>(1.0 / (4.0 * std::numbers::pi));
  for (int b = 0; b < bodies; ++b) {
    std::vector<SurfaceElement> places;
    std::vector<std::uint32_t> vertices;
    std::vector<bool> taken(count);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (body[t] != b) continue;
      const Corner corner = corner_of(mesh, mesh.triangles[t], mirrored);
      if (!finite(corner)) continue;
      places.push_back({glm::vec3((corner.at[0] + corner.at[1] + corner.at[2]) / 3.0), glm::vec3(corner.area)});
      for (const std::uint32_t v : mesh.triangles[t])
        if (!taken[v]) {
          taken[v] = true;
          vertices.push_back(v);
        }
    }
    if (vertices.empty()) continue;
    const SurfaceCells far(merged_elements(places, radius_mm / kCells), radius_mm);
    const SurfaceCells middle(merged_elements(places, 0.5 * radius_mm / kCells), 0.5 * radius_mm);
    const SurfaceCells near(std::move(places), 0.25 * radius_mm);
    parallel_chunks(
        static_cast<std::int64_t>(vertices.size()), kInvariantGrain, [&](std::int64_t begin, std::int64_t end) {
          if (progress.cancelled()) return;
          for (std::int64_t i = begin; i < end; ++i) {
            const std::uint32_t v = vertices[static_cast<std::size_t>(i)];
            const glm::vec3 at(mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])));
            const auto r = static_cast<float>(radius_mm);
            const BandSums inner = near.sums(at, 0.0f, 0.25f * r, 0.25f * r);
            const BandSums band = middle.sums(at, 0.25f * r, 0.5f * r, 0.5f * r);
            const BandSums outer = far.sums(at, 0.5f * r, 0.75f * r, r);
            const float third_half = inner.third_all + band.third_all, plain_half = inner.plain_all + band.plain_all;
            const std::array<float, kInvariantScales> third{inner.third_all, third_half, third_half + outer.third_first,
                                                            third_half + outer.third_all};
            const std::array<float, kInvariantScales> plain{inner.plain_all, plain_half, plain_half + outer.plain_first,
                                                            plain_half + outer.plain_all};
            for (std::size_t k = 0; k < kInvariantScales; ++k)
              out[v][k] = std::clamp(enclosed[v] - kPerDirection * (third[k] - plain[k] * cubed[k]), 0.0f, 1.0f);
          }
          progress.advance(end - begin);
        });
    if (progress.cancelled()) return cancelled_error();
  }
  progress.end();
  return out;
}

}  // namespace dubsar
