#include "core/relief/smoothing/quads_around.h"

#include <algorithm>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {
constexpr std::int64_t kGroupsTogether = 16;
constexpr std::size_t kAroundMost = AroundGroup::kMostAround, kAtOnce = AroundGroup::kVertexBatch;

struct VertexRange {
  std::uint32_t begin, end;
};
VertexRange vertices_of(const QuadMesh& mesh, std::int64_t group) {
  const std::int64_t begin = group * kVertexGroup;
  return {static_cast<std::uint32_t>(begin),
          static_cast<std::uint32_t>(std::min<std::int64_t>(begin + kVertexGroup, mesh.vertex_count()))};
}

std::size_t batches(std::size_t vertices) { return (vertices + kAtOnce - 1) / kAtOnce; }

/// How many vertices there are of each size; returns how many x-quads the batches hold.
template <class Keep>
std::size_t count_vertices(const QuadMesh& mesh, const VertexRange& range, const Keep& keep, AroundGroup& group) {
  const std::uint32_t* first = mesh.first_incident.data();
  for (std::uint32_t v = range.begin; v < range.end; ++v) {
    if (!keep(v)) continue;
    const std::size_t around = first[v + 1] - first[v];
    if (around > kAroundMost)
      group.others.push_back(v);
    else
      ++group.vertices[around];
  }
  std::size_t held = 0;
  for (std::size_t k = 2; k <= kAroundMost; ++k) held += batches(group.vertices[k]) * kAtOnce * k;
  return held;
}

template <class Keep>
void fill_batches(const QuadMesh& mesh, const VertexRange& range, const Keep& keep, const AroundGroup& group,
                  std::uint32_t* quads) {
  const std::uint32_t* first = mesh.first_incident.data();
  std::array<std::size_t, kAroundMost + 1> start{}, put{};
  std::array<std::uint32_t, kAroundMost + 1> latest{};
  for (std::size_t k = 2, all = 0; k <= kAroundMost; ++k) {
    start[k] = all;
    all += batches(group.vertices[k]) * kAtOnce * k;
  }
  const auto take = [&](std::uint32_t v, std::size_t around) {
    const std::size_t place = put[around]++;
    std::uint32_t* batch = quads + start[around] + place / kAtOnce * kAtOnce * around + place % kAtOnce;
    for (std::size_t j = 0; j < around; ++j) batch[j * kAtOnce] = mesh.incident[first[v] + j];
  };
  for (std::uint32_t v = range.begin; v < range.end; ++v) {
    const std::size_t around = first[v + 1] - first[v];
    if (around < 2 || around > kAroundMost || !keep(v)) continue;
    take(v, around);
    latest[around] = v;
  }
  for (std::size_t k = 2; k <= kAroundMost; ++k)
    while (put[k] % kAtOnce != 0) take(latest[k], k);
}
constexpr auto kAllVertices = [](std::uint32_t) { return true; };
}  // namespace

QuadsAround::QuadsAround(const QuadMesh& mesh)
    : groups(static_cast<std::size_t>((mesh.vertex_count() + kVertexGroup - 1) / kVertexGroup)) {
  const auto count = static_cast<std::int64_t>(groups.size());
  parallel_for(count, kGroupsTogether, [&](std::int64_t g) {
    AroundGroup& group = groups[static_cast<std::size_t>(g)];
    const VertexRange range = vertices_of(mesh, g);
    group.begin = count_vertices(mesh, range, kAllVertices, group);
    group.touched = range_around(mesh, range.begin, range.end);
  });
  std::size_t all = 0;
  for (AroundGroup& group : groups) {
    const std::size_t held = group.begin;
    group.begin = all;
    all += held;
  }
  quads = LargeArray<std::uint32_t>(all);
  parallel_for(count, kGroupsTogether, [&](std::int64_t g) {
    const AroundGroup& group = groups[static_cast<std::size_t>(g)];
    fill_batches(mesh, vertices_of(mesh, g), kAllVertices, group, quads.data() + group.begin);
  });
}

AroundGroup group_within(const QuadMesh& mesh, std::int64_t number, std::uint32_t first, std::uint32_t size,
                         std::vector<std::uint32_t>& quads) {
  const auto is_within = [&](std::uint32_t quad) { return quad - first < size; };
  const auto touches = [&](std::uint32_t v) { return std::ranges::any_of(mesh.quads_of(v), is_within); };
  AroundGroup group;
  const VertexRange range = vertices_of(mesh, number);
  const std::size_t held = count_vertices(mesh, range, touches, group);
  group.begin = quads.size();
  quads.resize(quads.size() + held);
  fill_batches(mesh, range, touches, group, quads.data() + group.begin);
  for (const std::uint32_t quad : std::span(mesh.incident.data() + mesh.first_incident[range.begin],
                                            mesh.incident.data() + mesh.first_incident[range.end]))
    if (is_within(quad)) group.touched.add({quad, quad});
  return group;
}

}  // namespace dubsar
