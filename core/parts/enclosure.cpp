#include "core/parts/enclosure.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/numbers/sort_unique.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

using Volumes = std::array<double, PartitionTable::kMost>;
constexpr std::int64_t kEnclosureGrain = 1 << 14;

/// A side of a face beyond which another partition begins.
struct BorderSide {
  std::uint32_t from, to;
  PartitionId partition;
};

/// Six times the volume of the cones from `origin` over the faces of each partition.
Volumes cones(const SurfaceModel& model, const FaceGraph& graph, const glm::dvec3& origin) {
  return parallel_reduce<Volumes>(
      graph.faces(), kEnclosureGrain, {},
      [&](std::int64_t begin, std::int64_t end) {
        Volumes sum{};
        for (auto f = static_cast<std::size_t>(begin); f < static_cast<std::size_t>(end); ++f)
          sum[model.quad_partition[f]] += 2.0 * static_cast<double>(graph.area[f]) *
                                          glm::dot(glm::dvec3(graph.centre[f]) - origin, glm::dvec3(graph.normal[f]));
        return sum;
      },
      [](Volumes a, const Volumes& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
        return a;
      });
}

std::vector<BorderSide> find_border(const SurfaceModel& model, const FaceGraph& graph) {
  return parallel_reduce<std::vector<BorderSide>>(
      graph.faces(), kEnclosureGrain, {},
      [&](std::int64_t begin, std::int64_t end) {
        std::vector<BorderSide> sides;
        for (auto f = static_cast<std::uint32_t>(begin); f < static_cast<std::uint32_t>(end); ++f)
          for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
            const std::uint32_t g = graph.neighbour[s];
            if (g == FaceGraph::kNone || model.quad_partition[g] == model.quad_partition[f]) continue;
            const Polygon polygon = model.mesh.polygon(f);
            const auto i = static_cast<std::size_t>(s - graph.first_side[f]);
            sides.push_back({polygon.vertex[i], polygon.vertex[(i + 1) % static_cast<std::size_t>(polygon.size)],
                             model.quad_partition[f]});
          }
        return sides;
      },
      [](std::vector<BorderSide> a, const std::vector<BorderSide>& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
}

}  // namespace

std::vector<double> enclosed_volumes(const SurfaceModel& model, const FaceGraph& graph) {
  std::vector<double> result(model.partitions.size(), 0.0);
  if (graph.faces() == 0) return result;
  const glm::dvec3 origin(graph.centre[0]);  // near the surface, so that the volume does not cancel
  Volumes six_fold = cones(model, graph, origin);

  const std::vector<BorderSide> border = find_border(model, graph);
  std::vector<std::uint32_t> vertices;
  for (const BorderSide& side : border) vertices.push_back(side.from);
  sort_unique(vertices);
  const auto place = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  };
  // Borders that touch are closed by one fan: its middle only has to be the same for both sides.
  DisjointSets loops(vertices.size());
  for (const BorderSide& side : border) loops.join(place(side.from), place(side.to));
  std::vector<glm::dvec3> middle(vertices.size(), glm::dvec3(0.0));
  std::vector<double> count(vertices.size(), 0.0);
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t loop = loops.root(i);
    middle[loop] += glm::dvec3(model.mesh.positions[vertices[i]]) - origin;
    count[loop] += 1.0;
  }
  for (const BorderSide& side : border) {
    const std::uint32_t loop = loops.root(place(side.from));
    const glm::dvec3 a = glm::dvec3(model.mesh.positions[side.from]) - origin;
    const glm::dvec3 b = glm::dvec3(model.mesh.positions[side.to]) - origin;
    six_fold[side.partition] += glm::dot(middle[loop] / count[loop], glm::cross(b, a));
  }
  for (std::size_t row = 0; row < result.size(); ++row) result[row] = six_fold[model.partitions[row].id] / 6.0;
  return result;
}

bool plausible_enclosure(double tablet, double cavity, double outside) noexcept {
  constexpr double kLeastFilling = 0.5;
  return tablet > kLeastFilling * cavity && cavity > 0.0 && tablet < cavity && cavity < outside;
}

bool plausible_enclosure(const SurfaceModel& model, const FaceGraph& graph) {
  const PartitionTable& partitions = model.partitions;
  const std::vector<double> volume = enclosed_volumes(model, graph);
  const auto volume_of = [&](PartitionKind kind) -> const double* {
    const Partition* const found = partitions.find(kind);
    return found == nullptr ? nullptr : &volume[static_cast<std::size_t>(found - &partitions[0])];
  };
  const double* const tablet = volume_of(PartitionKind::kTablet);
  const double* const outside = volume_of(PartitionKind::kEnvelopeOutside);
  const double* const inside = volume_of(PartitionKind::kEnvelopeInside);
  if (tablet == nullptr || outside == nullptr || inside == nullptr) return true;
  return plausible_enclosure(*tablet, -*inside, *outside);
}

bool plausible_enclosure(const PartitionTable& measured) {
  constexpr double kLeastRound = 0.06;
  const Partition* const tablet = measured.find(PartitionKind::kTablet);
  const Partition* const outside = measured.find(PartitionKind::kEnvelopeOutside);
  const Partition* const inside = measured.find(PartitionKind::kEnvelopeInside);
  if (tablet == nullptr || outside == nullptr || inside == nullptr) return true;
  const double area = tablet->area_mm2, volume = tablet->volume_mm3;
  return plausible_enclosure(volume, -inside->volume_mm3, outside->volume_mm3) &&
         36.0 * std::numbers::pi * volume * volume >= kLeastRound * area * area * area;
}

}  // namespace dubsar
