#include "core/contact/interface_rest.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "core/base/numbers/counting_sort.h"
#include "core/base/system/parallel_gather.h"
#include "core/mesh/edge_uses.h"
#include "core/mesh/fans.h"
#include "core/parts/border_loops.h"
#include "core/parts/fill/loop_fill.h"

namespace dubsar {
namespace {

/// Edges of a loop that is closed by a star. The triangles of a wider one are long, and cross the staircase of its rim.
constexpr std::size_t kMostStar = 8;

bool is_envelope(PartitionKind kind) {
  return kind == PartitionKind::kEnvelopeInside || kind == PartitionKind::kEnvelopeOutside;
}

/// How much more often an edge is run along from its lower vertex to the higher than back.
struct Step {
  std::uint32_t low, high;
  int times;
};
void add_step(std::uint32_t from, std::uint32_t to, int times, std::vector<Step>& steps) {
  if (from < to)
    steps.push_back({from, to, times});
  else
    steps.push_back({to, from, -times});
}

/// Sides that the tablet's faces and the contact run along once more in one direction than in the other, turned round.
std::vector<BorderEdge> unpaired(const SurfaceModel& model, const InterfaceMesh& mesh, const FaceGraph& graph) {
  using Steps = std::vector<Step>;
  Steps steps = parallel_gather<Step>(graph.faces(), 1 << 14, [&](std::int64_t begin, std::int64_t end, Steps& found) {
    for (auto f = static_cast<std::uint32_t>(begin); f < static_cast<std::uint64_t>(end); ++f) {
      if (model.partitions[model.quad_partition[f]].kind != PartitionKind::kTablet) continue;
      for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
        const std::uint32_t g = graph.neighbour[s];
        if (g == FaceGraph::kNone || !is_envelope(model.partitions[model.quad_partition[g]].kind)) continue;
        const Polygon polygon = model.mesh.polygon(f);
        const auto i = static_cast<std::size_t>(s - graph.first_side[f]);
        add_step(polygon.vertex[i], polygon.vertex[(i + 1) % static_cast<std::size_t>(polygon.size)], 1, found);
      }
    }
  });
  const std::vector<EdgeUse> uses = edge_uses(mesh.triangles);
  for (std::size_t begin = 0, end; begin < uses.size(); begin = end) {
    end = end_of_edge(uses, begin);
    int net = 0;
    for (std::size_t i = begin; i < end; ++i) net += uses[i].rising ? 1 : -1;
    if (net != 0) add_step(uses[begin].low, uses[begin].high, net, steps);
  }
  std::sort(steps.begin(), steps.end(),
            [](const Step& a, const Step& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
  std::vector<BorderEdge> edges;
  for (std::size_t begin = 0, end; begin < steps.size(); begin = end) {
    const Step& edge = steps[begin];
    int times = 0;
    for (end = begin; end < steps.size() && steps[end].low == edge.low && steps[end].high == edge.high; ++end)
      times += steps[end].times;
    for (int i = 0; i < std::abs(times); ++i)
      edges.push_back(times > 0 ? BorderEdge{edge.high, edge.low} : BorderEdge{edge.low, edge.high});
  }
  std::sort(edges.begin(), edges.end(),
            [](const BorderEdge& a, const BorderEdge& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  return edges;
}

/// Is the edge one of the surface with the same body on both sides?
bool inside_body(const SurfaceModel& model, std::uint32_t a, std::uint32_t b) {
  int sides = 0, tablet = 0;
  for (const std::uint32_t q : model.mesh.quads_of(a)) {
    const Polygon polygon = model.mesh.polygon(q);
    const auto size = static_cast<std::size_t>(polygon.size);
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t v = polygon.vertex[i], w = polygon.vertex[(i + 1) % size];
      if (!(v == a && w == b) && !(v == b && w == a)) continue;
      ++sides;
      tablet += model.partitions[model.quad_partition[q]].kind == PartitionKind::kTablet;
    }
  }
  return sides == 2 && tablet != 1;
}

/// Triangles in loops, between vertices of the loops and new ones.
class Rest {
 public:
  Rest(std::uint32_t dual, InterfaceMesh& mesh) : dual_(dual), mesh_(mesh) {}

  void add_star(const SurfaceModel& model, const std::vector<std::uint32_t>& loop) {
    glm::vec3 sum(0.0f);
    const std::uint32_t centre = next_vertex();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      sum += position(model, loop[i]);
      mesh_.triangles.push_back({centre, loop[i], loop[(i + 1) % loop.size()]});
    }
    add_vertex(sum / static_cast<float>(loop.size()));
  }

  Result<void> add_fill(const SurfaceModel& model, const std::vector<std::uint32_t>& loop, Progress& progress) {
    Loop rim;
    for (const std::uint32_t v : loop) rim.positions.push_back(position(model, v));
    // The surface may have any edge between two vertices of its own.
    rim.forbidden = [&](std::uint32_t a, std::uint32_t b) {
      return (loop[a] < dual_ && loop[b] < dual_) || taken_.count(key(loop[a], loop[b])) != 0;
    };
    DUBSAR_ASSIGN(const LoopFill fill, fill_loop(rim, {}, progress));
    const std::uint32_t first = next_vertex();
    const auto rims = static_cast<std::uint32_t>(loop.size());
    for (Triangle t : fill.triangles) {
      for (std::uint32_t& v : t) v = v < rims ? loop[v] : first + v - rims;
      mesh_.triangles.push_back(t);
      take_edges(t);
    }
    for (const glm::vec3& p : fill.added) add_vertex(p);
    return {};
  }

  /// Vertices of loops that will be filled: of edges between any of them it is known from now on whether they are
  /// there. Stars add none.
  void watch(std::vector<std::uint32_t> vertices) {
    std::sort(vertices.begin(), vertices.end());
    watched_ = std::move(vertices);
    for (const Triangle& t : mesh_.triangles) take_edges(t);
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }
  bool watched(std::uint32_t v) const { return std::binary_search(watched_.begin(), watched_.end(), v); }
  void take_edges(const Triangle& t) {
    const std::array<bool, 3> in{watched(t[0]), watched(t[1]), watched(t[2])};
    for (std::size_t i = 0; i < 3; ++i)
      if (in[i] && in[(i + 1) % 3]) taken_.insert(key(t[i], t[(i + 1) % 3]));
  }
  std::uint32_t next_vertex() const { return static_cast<std::uint32_t>(dual_ + mesh_.added.size()); }
  glm::vec3 position(const SurfaceModel& model, std::uint32_t v) const {
    return v < dual_ ? model.mesh.positions[v] : mesh_.added[v - dual_];
  }
  void add_vertex(const glm::vec3& p) {
    mesh_.added.push_back(p);
    mesh_.strength.push_back(0.0f);
  }

  std::uint32_t dual_;
  InterfaceMesh& mesh_;
  std::vector<std::uint32_t> watched_;       ///< rising
  std::unordered_set<std::uint64_t> taken_;  ///< edges between them
};

}  // namespace

void part_shared_edges(const SurfaceModel& model, InterfaceMesh& mesh) {
  const auto dual = static_cast<std::uint32_t>(model.mesh.positions.size());
  const std::vector<EdgeUse> sides = edge_uses(mesh.triangles);
  struct Cut {
    std::uint32_t a, b, first, second;  ///< edge and its two triangles
  };
  std::vector<Cut> cuts;
  for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
    end = end_of_edge(sides, begin);
    const std::size_t count = end - begin;
    const bool shared =
        count == 2 && sides[begin].high < dual && inside_body(model, sides[begin].low, sides[begin].high);
    if (!shared && count != 4) continue;
    std::size_t falling = begin, rising = end - 1;
    while (falling + 1 < end && sides[falling].rising) ++falling;
    while (rising > begin && !sides[rising].rising) --rising;
    cuts.push_back({sides[begin].low, sides[begin].high, sides[falling].side / 3, sides[rising].side / 3});
  }
  const auto position = [&](std::uint32_t v) { return v < dual ? model.mesh.positions[v] : mesh.added[v - dual]; };
  std::vector<bool> touched(mesh.triangles.size(), false);
  for (const Cut& cut : cuts) {
    if (touched[cut.first] || touched[cut.second])
      continue;  // one cut a triangle; what is left keeps the model as it was
    touched[cut.first] = touched[cut.second] = true;
    const auto middle = static_cast<std::uint32_t>(dual + mesh.added.size());
    const auto opposite = [&](std::uint32_t t) {
      for (const std::uint32_t v : mesh.triangles[t])
        if (v != cut.a && v != cut.b) return v;
      return cut.a;
    };
    const glm::vec3 edge = 0.5f * (position(cut.a) + position(cut.b));
    const glm::vec3 beside = 0.5f * (position(opposite(cut.first)) + position(opposite(cut.second)));
    mesh.added.push_back(edge + 0.25f * (beside - edge));
    mesh.strength.push_back(0.0f);
    for (const std::uint32_t t : {cut.first, cut.second})
      mesh.triangles.push_back(halve(mesh.triangles[t], cut.a, cut.b, middle));
  }
}

void part_fans(std::uint32_t first_added, InterfaceMesh& mesh) {
  constexpr float kApart = 0.25f;  ///< of the way to the middle of what is around
  struct Corner {
    std::uint32_t vertex, place;  ///< added vertex; 3 * triangle + 0, 1 or 2
  };
  std::vector<Corner> corners;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t c = 0; c < 3; ++c)
      if (const std::uint32_t v = mesh.triangles[t][c]; v >= first_added)
        corners.push_back({v - first_added, 3 * t + c});
  counting_sort(corners, mesh.added.size(), [](const Corner& corner) { return corner.vertex; });
  Fans fans;
  for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
    fans.clear();
    for (end = begin; end < corners.size() && corners[end].vertex == corners[begin].vertex; ++end) {
      const Triangle& t = mesh.triangles[corners[end].place / 3];
      fans.add(t[(corners[end].place + 1) % 3], t[(corners[end].place + 2) % 3]);
    }
    const std::uint32_t count = fans.find(), v = corners[begin].vertex;
    for (std::uint32_t fan = 1; fan < count; ++fan) {
      const auto copy = static_cast<std::uint32_t>(mesh.added.size());
      glm::vec3 sum(0.0f);
      float around = 0.0f;
      for (std::size_t i = begin; i < end; ++i) {
        if (fans.of_corner()[i - begin] != fan) continue;
        Triangle& t = mesh.triangles[corners[i].place / 3];
        t[corners[i].place % 3] = first_added + copy;
        for (const std::uint32_t w : t)
          if (w >= first_added && w != first_added + copy) {
            sum += mesh.added[w - first_added];
            around += 1.0f;
          }
      }
      const glm::vec3 here = mesh.added[v];
      mesh.added.push_back(around > 0.0f ? glm::mix(here, sum / around, kApart) : here);
      mesh.strength.push_back(mesh.strength[v]);
    }
  }
}

Result<std::int64_t> close_rest(const SurfaceModel& model, const FaceGraph& graph, InterfaceMesh& mesh,
                                Progress& progress) {
  const std::vector<BorderEdge> edges = unpaired(model, mesh, graph);
  const auto loops = join_loops(edges);
  std::vector<std::vector<std::uint32_t>> rims(loops.size());
  std::vector<std::uint32_t> filled;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (const std::uint32_t e : loops[i]) rims[i].push_back(edges[e].from);
    if (rims[i].size() > kMostStar) filled.insert(filled.end(), rims[i].begin(), rims[i].end());
  }
  Rest rest(static_cast<std::uint32_t>(model.mesh.positions.size()), mesh);
  rest.watch(std::move(filled));
  for (const auto& rim : rims) {
    if (rim.size() <= kMostStar)
      rest.add_star(model, rim);
    else
      DUBSAR_TRY(rest.add_fill(model, rim, progress));
  }
  return static_cast<std::int64_t>(loops.size());
}

}  // namespace dubsar
