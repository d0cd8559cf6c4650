#include "tests/core/phantom/truth_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/phantom/cell_lists.h"

namespace dubsar::phantom {
namespace {

constexpr double kSlit = 1.5;  ///< processed voxels

DistanceScore score(std::vector<float>& distances, double grid_step) {
  DistanceScore s;
  s.vertices = static_cast<std::int64_t>(distances.size());
  if (distances.empty()) return s;
  std::sort(distances.begin(), distances.end());
  double squares = 0.0;
  for (const float d : distances) squares += static_cast<double>(d) * static_cast<double>(d);
  s.rms = std::sqrt(squares / static_cast<double>(distances.size())) / grid_step;
  s.p95 = static_cast<double>(distances[distances.size() * 95 / 100]) / grid_step;
  s.largest = static_cast<double>(distances.back()) / grid_step;
  return s;
}

struct VertexTruth {
  float distance;
  Part part;
  bool slit;
};

bool in_slit(const Phantom& phantom, const glm::dvec3& p, const Fields& f, double grid_step) {
  const double reach = 2.0 * grid_step;
  const bool near_joint = std::min(std::abs(f.tablet.v), std::abs(f.wall.v)) < static_cast<float>(reach) &&
                          std::abs(f.outer.v) > static_cast<float>(reach);
  return near_joint && phantom.gap_width(p) < kSlit * grid_step;
}

double dot_normal(const std::array<glm::dvec3, 3>& t, const glm::dvec3& direction) {
  return glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), direction);
}

/// Distance along the ray to the triangle, or infinity.
double hit(const std::array<glm::dvec3, 3>& t, const glm::dvec3& origin, const glm::dvec3& direction) {
  const glm::dvec3 a = t[1] - t[0], b = t[2] - t[0], h = glm::cross(direction, b);
  const double det = glm::dot(a, h);
  if (std::abs(det) < 1e-12) return INFINITY;
  const glm::dvec3 s = origin - t[0], q = glm::cross(s, a);
  const double u = glm::dot(s, h) / det, v = glm::dot(direction, q) / det;
  constexpr double kEdge = -1e-9;
  if (u < kEdge || v < kEdge || u + v > 1.0 - kEdge) return INFINITY;
  return glm::dot(b, q) / det;
}

WedgeScore judge_wedges(const Phantom& phantom, const JudgedMesh& mesh) {
  const std::vector<double> depths = wedge_depths(phantom, mesh);
  WedgeScore result;
  double ratios = 0.0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const Wedge& w = phantom.wedges()[i];
    if (w.owner != Owner::kTablet || !w.open || phantom.gap_width(w.position) < kSlit * mesh.grid_step) continue;
    ++result.wedges;
    if (!(depths[i] < 2.5 * w.depth)) {
      ++result.missing;
      continue;
    }
    ratios += depths[i] / w.depth;
    result.kept += std::abs(depths[i] - w.depth) <= 0.2 * w.depth;
  }
  if (result.wedges > result.missing) result.mean_ratio = ratios / (result.wedges - result.missing);
  return result;
}

void judge_parts(const Phantom& phantom, const JudgedMesh& mesh, TruthComparison& result) {
  struct Patch {
    Part part = Part::kPore;
    bool slit = false;
    double area = 0.0;
  };
  std::vector<Patch> patches(mesh.triangles.size());
  parallel_for(static_cast<std::int64_t>(patches.size()), 4096, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    const auto& t = mesh.triangles[k];
    const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const glm::dvec3 p = (a + b + c) / 3.0;
    const Fields f = phantom.fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    patches[k] = {phantom.nearest_part(p), in_slit(phantom, p, f, mesh.grid_step),
                  0.5 * glm::length(glm::cross(b - a, c - a))};
  });
  std::array<std::array<double, 3>, 256> table{};
  for (std::size_t i = 0; i < patches.size(); ++i)
    if (!patches[i].slit && patches[i].part <= Part::kEnvelopeInside)
      table[mesh.partition[i]][static_cast<std::size_t>(patches[i].part)] += patches[i].area;
  for (const auto& row : table) {
    const auto part = static_cast<std::size_t>(std::max_element(row.begin(), row.end()) - row.begin());
    const double tablet = row[0], envelope = row[1] + row[2], total = tablet + envelope;
    if (!(total > 0.0)) continue;
    for (std::size_t p = 0; p < 3; ++p) result.part[p].of_part += row[p];
    result.part[part].labelled += total;
    result.part[part].both += row[part];
    result.owner[0].of_part += tablet;
    result.owner[1].of_part += envelope;
    PartScore& owner = result.owner[tablet > envelope ? 0 : 1];
    owner.labelled += total;
    owner.both += std::max(tablet, envelope);
  }
}

}  // namespace

std::vector<double> wedge_depths(const Phantom& phantom, const JudgedMesh& mesh) {
  std::vector<Ball> balls;
  balls.reserve(mesh.triangles.size());
  const auto corners = [&](std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    return std::array<glm::dvec3, 3>{glm::dvec3(mesh.positions[t[0]]), glm::dvec3(mesh.positions[t[1]]),
                                     glm::dvec3(mesh.positions[t[2]])};
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto t = corners(i);
    const glm::dvec3 centre = (t[0] + t[1] + t[2]) / 3.0;
    balls.push_back(
        {centre, std::max({glm::length(t[0] - centre), glm::length(t[1] - centre), glm::length(t[2] - centre)})});
  }
  const CellGrid grid(phantom.options().dims);
  const CellLists cells(phantom.options().dims, balls);
  std::vector<double> depths;
  for (const Wedge& w : phantom.wedges()) {
    const double start = 1.5 * mesh.grid_step;
    const glm::dvec3 origin = w.position + start * w.outward;
    double first = INFINITY;
    const auto look = [&](std::int64_t cell) {
      for (const std::uint32_t i : cells[cell]) {
        const auto t = corners(i);
        if (dot_normal(t, w.outward) <= 0.0) continue;
        const double along = hit(t, origin, -w.outward);
        if (along >= 0.0) first = std::min(first, along);
      }
    };
    std::int64_t last = -1;
    for (double along = 0.0; along < start + 2.5 * w.depth; along += 1.0) {
      const glm::dvec3 p = origin - along * w.outward;
      const std::int64_t cell = grid.index(p.x, p.y, p.z);
      if (cell != last) look(cell);
      last = cell;
    }
    depths.push_back(first - start);
  }
  return depths;
}

TruthComparison compare(const Phantom& phantom, const JudgedMesh& mesh) {
  DUBSAR_CHECK(mesh.partition.empty() || mesh.partition.size() == mesh.triangles.size());
  std::vector<VertexTruth> truth(mesh.positions.size());
  parallel_for(static_cast<std::int64_t>(truth.size()), 4096, [&](std::int64_t i) {
    const glm::dvec3 p(mesh.positions[static_cast<std::size_t>(i)]);
    const Fields f = phantom.fields(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    truth[static_cast<std::size_t>(i)] = {static_cast<float>(std::abs(phantom.signed_distance(p))),
                                          phantom.nearest_part(p), in_slit(phantom, p, f, mesh.grid_step)};
  });
  TruthComparison result;
  std::vector<float> all, resolved, pores;
  for (const VertexTruth& t : truth) {
    all.push_back(t.distance);
    if (t.part == Part::kPore)
      pores.push_back(t.distance);
    else if (t.part == Part::kOrganic)
      ++result.at_straw;
    else if (t.part == Part::kCrack)
      ++result.at_cracks;
    else if (t.slit)
      ++result.at_slits;
    else
      resolved.push_back(t.distance);
  }
  result.all = score(all, mesh.grid_step);
  result.resolved = score(resolved, mesh.grid_step);
  result.pores = score(pores, mesh.grid_step);
  if (!mesh.partition.empty()) judge_parts(phantom, mesh, result);
  if (!mesh.triangles.empty()) result.wedges = judge_wedges(phantom, mesh);
  return result;
}

std::string TruthComparison::text() const {
  const auto line = [](const char* name, const DistanceScore& s) {
    return fmt::format("{}: {} vertices, rms {:.3f}, 95 % {:.3f}, largest {:.2f} voxel\n", name, s.vertices, s.rms,
                       s.p95, s.largest);
  };
  std::string text = line("all", all) + line("resolved", resolved) + line("pores", pores);
  text += fmt::format("set apart: straw {}, cracks {}, slits {}\n", at_straw, at_cracks, at_slits);
  const char* names[] = {"tablet", "envelope", "part tablet", "part envelope outside", "part envelope inside"};
  for (std::size_t i = 0; i < 5; ++i) {
    const PartScore& s = i < 2 ? owner[i] : part[i - 2];
    text += fmt::format("{}: purity {:.4f}, recall {:.4f} of {:.0f}\n", names[i], s.purity(), s.recall(), s.of_part);
  }
  return text + fmt::format("wedges: {} of {} within 20 % ({:.3f}), {} missing, mean depth ratio {:.3f}\n", wedges.kept,
                            wedges.wedges, wedges.kept_fraction(), wedges.missing, wedges.mean_ratio);
}

}  // namespace dubsar::phantom
