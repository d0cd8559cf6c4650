#include "core/contact/band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "core/base/system/large_pages.h"
#include "core/base/system/parallel_gather.h"
#include "core/contact/nearest_samples.h"

namespace dubsar {
bool is_contact_patch(const SurfaceModel& model, const FillPatch& patch) {
  if (patch.reverse_partition == PartitionTable::kNone) return false;
  const auto is_tablet = [&](PartitionId id) { return model.partitions[id].kind == PartitionKind::kTablet; };
  return is_tablet(patch.partition) != is_tablet(patch.reverse_partition);
}

std::vector<PatchPoint> sample_patches(const SurfaceModel& model, float spacing) {
  std::vector<PatchPoint> points;
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  std::vector<glm::vec3> normals(dual, glm::vec3(0.0f)), added;
  for (const FillPatch& patch : model.patches) {
    if (!is_contact_patch(model, patch)) continue;
    const float sense = model.partitions[patch.partition].kind == PartitionKind::kTablet ? 1.0f : -1.0f;
    added.assign(patch.extra_positions.size(), glm::vec3(0.0f));
    const auto position = [&](std::uint32_t v) {
      return v < dual ? model.mesh.positions[v] : patch.extra_positions[v - dual];
    };
    const auto normal = [&](std::uint32_t v) -> glm::vec3& { return v < dual ? normals[v] : added[v - dual]; };
    for (const Triangle& t : patch.triangles)
      for (const std::uint32_t v : t) normal(v) = glm::vec3(0.0f);
    for (const Triangle& t : patch.triangles) {
      const glm::vec3 a = position(t[0]), n = sense * glm::cross(position(t[1]) - a, position(t[2]) - a);
      for (const std::uint32_t v : t) normal(v) += n;
    }
    for (const Triangle& t : patch.triangles) {
      const glm::vec3 a = position(t[0]), b = position(t[1]), c = position(t[2]);
      const std::array<bool, 3> rim{t[0] < dual, t[1] < dual, t[2] < dual};
      const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
      const int steps = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          const float u = static_cast<float>(i) / static_cast<float>(steps),
                      v = static_cast<float>(j) / static_cast<float>(steps), w = 1.0f - u - v;
          const glm::vec3 n = w * normal(t[0]) + u * normal(t[1]) + v * normal(t[2]);
          const float length = glm::length(n);
          const float of_rim = (rim[0] ? w : 0.0f) + (rim[1] ? u : 0.0f) + (rim[2] ? v : 0.0f);
          if (length > 0.0f) points.push_back({w * a + u * b + v * c, n / length, of_rim > 0.5f});
        }
    }
  }
  return thinned(points, spacing);
}

glm::vec3 middle_of(const std::vector<PatchPoint>& samples) {
  glm::vec3 least(INFINITY), most(-INFINITY);
  for (const PatchPoint& sample : samples) {
    least = glm::min(least, sample.position);
    most = glm::max(most, sample.position);
  }
  return samples.empty() ? glm::vec3(0.0f) : 0.5f * (least + most);
}

SampleCubes::SampleCubes(const std::vector<PatchPoint>& samples, float edge) : side(edge), middle(middle_of(samples)) {
  glm::vec3 half(0.0f);
  for (const PatchPoint& sample : samples) half = glm::max(half, glm::abs(sample.position - middle));
  middle_cube = glm::ivec3(glm::ceil(half / side));
}

std::vector<PatchPoint> thinned(const std::vector<PatchPoint>& samples, float side) {
  const SampleCubes cubes(samples, side);
  BrickMap<std::uint32_t> nearest(cubes.dims(), ContactBand::kNone);
  const auto nearest_of = [&](std::uint32_t i) -> std::uint32_t& {
    const glm::ivec3 cube = cubes.cube(samples[i]);
    return nearest.at(cube.x, cube.y, cube.z);
  };
  const auto square_off = [&](std::uint32_t i) {
    const glm::vec3 place = cubes.place(samples[i]), off = place - glm::round(place);
    return glm::dot(off, off);
  };
  constexpr float kSame = 1e-3f;  // of two as near it is not rounding that chooses
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    if (std::uint32_t& known = nearest_of(i); known == ContactBand::kNone || square_off(i) < square_off(known) - kSame)
      known = i;
  std::vector<PatchPoint> few;
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    if (nearest_of(i) == i) few.push_back(samples[i]);
  return few;
}

Result<ContactBand> ContactBand::make(const BitVolume& inside, std::vector<PatchPoint> samples, float reach,
                                      Progress& progress) {
  ContactBand band{std::move(samples), {}, BrickMap<std::uint32_t>(inside.dims(), kNone), reach, reach};
  DUBSAR_ASSIGN(const NearestSamples nearest, NearestSamples::find(band.samples, inside.dims(), reach, progress));
  const std::vector<glm::ivec3> bricks = nearest.bricks();
  constexpr std::size_t kTogether = 16;  ///< bricks whose nodes one thread finds
  std::vector<std::vector<Node>> found((bricks.size() + kTogether - 1) / kTogether);
  std::vector<std::uint8_t> has_nodes(bricks.size(), 0);
  parallel_for(static_cast<std::int64_t>(found.size()), 1, [&](std::int64_t f) {
    if (progress.cancelled()) return;
    const auto some = static_cast<std::size_t>(f);
    for (std::size_t b = some * kTogether; b < std::min((some + 1) * kTogether, bricks.size()); ++b) {
      const std::size_t before = found[some].size();
      nearest.add_nodes(bricks[b], inside, found[some]);
      has_nodes[b] = found[some].size() > before;
    }
  });
  if (progress.cancelled()) return cancelled_error();
  band.node_at.reserve(static_cast<std::size_t>(std::ranges::count(has_nodes, std::uint8_t{1})));
  for (std::size_t b = 0; b < bricks.size(); ++b)
    if (has_nodes[b] != 0) band.node_at.add_brick(bricks[b].x, bricks[b].y, bricks[b].z);
  std::vector<std::int64_t> first(found.size());
  for (std::size_t f = 0; f < found.size(); ++f) first[f] = static_cast<std::int64_t>(found[f].size());
  band.nodes.resize(static_cast<std::size_t>(exclusive_scan(first)));
  parallel_for(static_cast<std::int64_t>(found.size()), 1, [&](std::int64_t f) {
    auto n = static_cast<std::size_t>(first[static_cast<std::size_t>(f)]);
    for (const Node& node : std::exchange(found[static_cast<std::size_t>(f)], {})) {
      band.node_at.at(node.x, node.y, node.z) = static_cast<std::uint32_t>(n);
      band.nodes[n++] = node;
    }
  });
  return band;
}

void ContactBand::trim_envelope(float reach) {
  envelope_reach = reach;
  constexpr std::int64_t kTogether = 1 << 16;  ///< nodes of which one thread drops some
  const auto stays = [&](const Node& node) { return node.distance <= reach_at(node.height); };
  std::vector<std::int64_t> first((nodes.size() + kTogether - 1) / kTogether);
  const auto each_range = [&](const auto& visit) {
    parallel_chunks(static_cast<std::int64_t>(nodes.size()), kTogether, [&](std::int64_t begin, std::int64_t end) {
      visit(std::span(nodes).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)),
            first[static_cast<std::size_t>(begin / kTogether)]);
    });
  };
  each_range([&](std::span<const Node> some, std::int64_t& count) { count = std::ranges::count_if(some, stays); });
  const auto left = static_cast<std::size_t>(exclusive_scan(first));
  auto kept = large_array<std::vector<Node>>(left);
  each_range(
      [&](std::span<const Node> some, std::int64_t begin) { std::ranges::copy_if(some, kept.begin() + begin, stays); });
  nodes = std::move(kept);
  const auto brick_of = [](const Node& node) {
    return glm::ivec3(node.x, node.y, node.z) / static_cast<int>(BrickMap<std::uint32_t>::kEdge);
  };
  const std::vector<glm::ivec3> bricks = parallel_gather<glm::ivec3>(
      static_cast<std::int64_t>(left), kTogether, [&](std::int64_t begin, std::int64_t end, auto& found) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
          if (n == 0 || brick_of(nodes[n]) != brick_of(nodes[n - 1])) found.push_back(brick_of(nodes[n]));
      });
  node_at = BrickMap<std::uint32_t>(node_at.dims(), kNone);
  node_at.reserve(bricks.size());
  for (const glm::ivec3& brick : bricks) node_at.add_brick(brick.x, brick.y, brick.z);
  parallel_for(static_cast<std::int64_t>(left), kTogether, [&](std::int64_t n) {
    const Node& node = nodes[static_cast<std::size_t>(n)];
    node_at.at(node.x, node.y, node.z) = static_cast<std::uint32_t>(n);
  });
}

}  // namespace dubsar
