#include "core/parts/fill/holes.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <iterator>
#include <unordered_map>
#include <unordered_set>

#include "core/base/system/log.h"
#include "core/base/system/parallel_gather.h"
#include "core/parts/border_loops.h"
#include "core/parts/face_graph.h"
#include "core/parts/face_roles.h"
#include "core/parts/fill/bridges.h"
#include "core/parts/fill/rim_normals.h"

namespace dubsar {
namespace {

constexpr std::int64_t kHoleGrain = 1 << 14;

std::uint64_t key(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
}

/// The body of each partition.
std::vector<PartitionId> bodies_of(const PartitionTable& partitions) {
  std::vector<PartitionId> bodies;
  for (const Partition& p : partitions) bodies.push_back(partitions.body_of(p.id));
  return bodies;
}

/// Most frequent value, ties to the smaller.
std::uint8_t majority(const std::vector<BorderEdge>& edges, const std::vector<std::uint32_t>& loop, bool left) {
  std::array<int, 256> count{};
  for (const std::uint32_t e : loop) ++count[left ? edges[e].left : edges[e].right];
  return static_cast<std::uint8_t>(std::max_element(count.begin(), count.end()) - count.begin());
}

class HoleFiller {
 public:
  HoleFiller(SurfaceModel& model, const FaceGraph& graph, const HoleOptions& options, Progress& progress)
      : model_(model), graph_(graph), options_(options), progress_(progress), group_(bodies_of(model.partitions)) {}

  Result<HoleReport> run() {
    DUBSAR_TRY(fill_between_groups());
    for (const FillPatch& patch : model_.patches)
      report_.triangles += static_cast<std::int64_t>(patch.triangles.size());
    return report_;
  }

 private:
  struct Task {
    HoleRim rim;
    std::vector<HoleRim> apart{};  ///< its rims, where bridges join several
    PartitionId partition = 0, reverse_partition = PartitionTable::kNone;
  };
  /// What fills a task, or one of its rims.
  struct Filled {
    std::vector<std::uint32_t> vertices{};  ///< of the mesh, by those of the loop
    LoopFill fill{};
  };
  using RimsOf = std::unordered_map<std::uint32_t, int>;  ///< on how many rims a vertex of the mesh lies

  /// One more than the highest id of a partition.
  PartitionId ids() const { return static_cast<PartitionId>(group_.size()); }

  /// Sides of faces whose neighbour `differs` from them.
  template <class Differs>
  std::vector<BorderEdge> collect(const Differs& differs) const {
    return parallel_gather<BorderEdge>(
        graph_.faces(), kHoleGrain, [&](std::int64_t begin, std::int64_t end, std::vector<BorderEdge>& edges) {
          for (auto f = static_cast<std::uint32_t>(begin); f < static_cast<std::uint64_t>(end); ++f)
            for (std::uint32_t s = graph_.first_side[f]; s < graph_.first_side[f + 1]; ++s) {
              const std::uint32_t g = graph_.neighbour[s];
              if (g == FaceGraph::kNone) continue;
              const std::uint8_t left = model_.quad_partition[f], right = model_.quad_partition[g];
              if (left == right || !differs(left, right)) continue;
              const Polygon polygon = model_.mesh.polygon(f);
              const auto i = static_cast<std::size_t>(s - graph_.first_side[f]);
              edges.push_back({polygon.vertex[i], polygon.vertex[(i + 1) % static_cast<std::size_t>(polygon.size)], f,
                               left, right, g});
            }
        });
  }

  /// A hole is walked against the sense of the part's border, so that the patch continues the surface.
  Task make_task(const std::vector<BorderEdge>& edges, const std::vector<std::uint32_t>& loop) const {
    Task task;
    for (auto e = loop.rbegin(); e != loop.rend(); ++e) task.rim.vertices.push_back(edges[*e].to);
    task.rim.normals = rim_normals(model_, graph_, group_, edges, loop);
    std::reverse(task.rim.normals.begin(), task.rim.normals.end());
    return task;
  }

  /// Holes of the tablet with islands of it in them become one task each. `faces`: one beside each task's rim.
  std::vector<Task> with_islands(std::vector<Task> tasks, const std::vector<std::uint32_t>& faces) const {
    constexpr double kThin = 0.01;  // of the volume of the largest piece, when each is closed by itself
    const FaceComponents pieces = find_components(model_, FaceScene{.graph = graph_}, labels_by_group());
    std::vector<bool> island(pieces.info.size());
    double largest = 0.0;
    for (const std::uint32_t f : faces) largest = std::max(largest, pieces.info[pieces.of_face[f]].volume);
    std::vector<HoleRim> rims;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const std::uint32_t piece = pieces.of_face[faces[i]];
      island[piece] = pieces.info[piece].volume < kThin * largest;
      rims.push_back(tasks[i].rim);
      rims.back().piece = piece;
    }
    std::unordered_map<std::uint32_t, int> visits;
    for (const HoleRim& rim : rims)
      for (const std::uint32_t v : rim.vertices) ++visits[v];
    const auto may_bridge = [&](std::uint32_t a, std::uint32_t b) {
      return visits[a] == 1 && visits[b] == 1 && !share_face(a, b);
    };
    std::vector<Task> joined;
    for (JoinedRims& one : join_islands(std::move(rims), island, model_.mesh.positions, may_bridge)) {
      joined.push_back({.rim = std::move(one.rim),
                        .partition = tasks[one.members.front()].partition,
                        .reverse_partition = tasks[one.members.front()].reverse_partition});
      if (one.members.size() > 1)
        for (const std::uint32_t r : one.members) joined.back().apart.push_back(std::move(tasks[r].rim));
    }
    return joined;
  }

  std::vector<std::uint8_t> labels_by_group() const {
    std::vector<std::uint8_t> labels(graph_.faces());
    parallel_for(graph_.faces(), kHoleGrain, [&](std::int64_t f) {
      labels[static_cast<std::size_t>(f)] = group_[model_.quad_partition[static_cast<std::size_t>(f)]];
    });
    return labels;
  }

  PartitionKind kind_of(PartitionId id) const { return model_.partitions.find(id)->kind; }

  bool share_face(std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t q : model_.mesh.quads_of(a)) {
      const Polygon polygon = model_.mesh.polygon(q);
      for (std::size_t c = 0; c < static_cast<std::size_t>(polygon.size); ++c)
        if (polygon.vertex[c] == b) return true;
    }
    return false;
  }

  Result<void> fill_between_groups() {
    std::vector<BorderEdge> all =
        collect([&](std::uint8_t left, std::uint8_t right) { return group_[left] != group_[right]; });
    std::unordered_set<std::uint64_t> shared;  // sides whose hole was filled for both
    std::vector<Task> tasks;
    for (PartitionId group = 0; group < ids(); ++group) {
      std::vector<BorderEdge> edges;
      for (const BorderEdge& e : all)
        if (group_[e.left] == group && shared.count(key(e.from, e.to)) == 0) edges.push_back(e);
      const bool tablet = kind_of(group) == PartitionKind::kTablet;
      std::vector<Task> contacts;
      std::vector<std::uint32_t> faces;  // one beside each of them
      for (const auto& loop : join_loops(edges)) {
        Task task = make_task(edges, loop);
        task.partition = majority(edges, loop, true);
        const std::uint8_t beyond = group_[edges[loop.front()].right];
        if (std::all_of(loop.begin(), loop.end(), [&](std::uint32_t e) { return group_[edges[e].right] == beyond; })) {
          task.reverse_partition = majority(edges, loop, false);
          for (const std::uint32_t e : loop) shared.insert(key(edges[e].from, edges[e].to));
        } else {
          ++report_.unshared;
        }
        if (tablet && task.reverse_partition != PartitionTable::kNone &&
            kind_of(task.reverse_partition) == PartitionKind::kEnvelopeInside) {
          contacts.push_back(std::move(task));
          faces.push_back(edges[loop.front()].face);
        } else {
          tasks.push_back(std::move(task));
        }
      }
      if (contacts.size() > 1) contacts = with_islands(std::move(contacts), faces);
      std::move(contacts.begin(), contacts.end(), std::back_inserter(tasks));
    }
    report_.loops = static_cast<std::int64_t>(tasks.size());
    DUBSAR_ASSIGN(report_.area, fill(tasks));
    return {};
  }

  /// Fills all holes and appends their patches; returns the area of the patches.
  Result<double> fill(const std::vector<Task>& tasks) {
    // Pairs of vertices that lie on more than one rim get no inner edge, since the patch of the other one could make it
    // too.
    RimsOf rims_of;
    for (const Task& task : tasks)
      each_rim(task, [&](const HoleRim& rim) {
        for (const std::uint32_t v : rim.vertices) ++rims_of[v];
      });
    std::vector<std::vector<Filled>> filled(tasks.size());
    std::vector<Error> errors(tasks.size());
    parallel_for(static_cast<std::int64_t>(tasks.size()), 1, [&](std::int64_t i) {
      const auto at = static_cast<std::size_t>(i);
      if (Result<std::vector<Filled>> one = fill_task(tasks[at], rims_of))
        filled[at] = std::move(*one);
      else
        errors[at] = one.error();
      progress_.advance(static_cast<std::int64_t>(tasks[at].rim.vertices.size()));
    });
    if (progress_.cancelled()) return cancelled_error();
    for (const Error& error : errors)
      if (!error.message.empty()) return tl::unexpected<Error>(error);

    double area = 0.0;
    const auto dual = static_cast<std::uint32_t>(model_.mesh.positions.size());
    for (std::size_t i = 0; i < tasks.size(); ++i)
      for (Filled& one : filled[i]) {
        const auto n = static_cast<std::uint32_t>(one.vertices.size());
        FillPatch patch{tasks[i].partition, tasks[i].reverse_partition, std::move(one.fill.added),
                        std::move(one.fill.triangles)};
        for (Triangle& t : patch.triangles)
          for (std::uint32_t& v : t) v = v < n ? one.vertices[v] : v - n + dual;
        model_.patches.push_back(std::move(patch));
        area += one.fill.area;
        report_.longest_loop = std::max(report_.longest_loop, static_cast<std::int64_t>(n));
      }
    return area;
  }

  template <class Visit>
  static void each_rim(const Task& task, const Visit& visit) {
    if (task.apart.empty()) visit(task.rim);
    for (const HoleRim& rim : task.apart) visit(rim);
  }

  /// One patch, or one for each rim where bridges between them gave no surface.
  Result<std::vector<Filled>> fill_task(const Task& task, const RimsOf& rims_of) const {
    std::vector<Filled> all;
    const auto add = [&](const HoleRim& rim) -> Result<void> {
      Filled one;
      const Loop loop = make_loop(rim, rims_of, one.vertices);
      DUBSAR_ASSIGN(one.fill, fill_loop(loop, options_.fill, progress_));
      if (!one.fill.doubled) all.push_back(std::move(one));
      return {};
    };
    DUBSAR_TRY(add(task.rim));
    if (all.empty())
      for (const HoleRim& rim : task.apart) DUBSAR_TRY(add(rim));
    return all;
  }

  Loop make_loop(const HoleRim& rim, const RimsOf& rims_of, std::vector<std::uint32_t>& vertices) const {
    Loop loop;
    loop.rim_normals = rim.normals;
    std::unordered_map<std::uint32_t, std::uint32_t> place;
    for (const std::uint32_t v : rim.vertices) {
      const auto [at, is_new] = place.emplace(v, static_cast<std::uint32_t>(vertices.size()));
      if (is_new) {
        vertices.push_back(v);
        loop.positions.push_back(model_.mesh.positions[v]);
      }
      loop.walk.push_back(at->second);
    }
    auto taken = std::make_shared<std::unordered_set<std::uint64_t>>();
    auto crossing = std::make_shared<std::vector<bool>>();
    if (vertices.size() == loop.walk.size()) {
      loop.walk.clear();
    } else {  // the edges of bridges, too
      for (std::size_t i = 0; i < loop.walk.size(); ++i)
        taken->insert(key(loop.walk[i], loop.walk[(i + 1) % loop.walk.size()]));
    }
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      crossing->push_back(rims_of.at(vertices[i]) > 1);
      for (const std::uint32_t q : model_.mesh.quads_of(vertices[i])) {
        const Polygon polygon = model_.mesh.polygon(q);
        for (std::size_t c = 0; c < static_cast<std::size_t>(polygon.size); ++c)
          if (const auto other = place.find(polygon.vertex[c]); other != place.end())
            taken->insert(key(i, other->second));
      }
    }
    loop.forbidden = [taken, crossing](std::uint32_t a, std::uint32_t b) {
      return ((*crossing)[a] && (*crossing)[b]) || taken->count(key(a, b)) != 0;
    };
    return loop;
  }

  SurfaceModel& model_;
  const FaceGraph& graph_;
  const HoleOptions& options_;
  Progress& progress_;
  std::vector<std::uint8_t> group_;
  HoleReport report_;
};

}  // namespace

Result<HoleReport> fill_holes(SurfaceModel& model, const HoleOptions& options, Progress& progress) {
  DUBSAR_ASSIGN(const FaceGraph graph, FaceGraph::build(model.mesh, progress));
  return fill_holes(model, graph, options, progress);
}

Result<HoleReport> fill_holes(SurfaceModel& model, const FaceGraph& graph, const HoleOptions& options,
                              Progress& progress) {
  if (model.quad_partition.size() != model.mesh.quads.size() || model.partitions.empty())
    return fail(ErrorKind::kBadData,
                "holes: {} partition ids and {} partitions found, expected a segmented model of {} x-quads",
                model.quad_partition.size(), model.partitions.size(), model.mesh.quads.size());
  DUBSAR_TRY(model.partitions.check_complete(model.quad_partition, "holes", "an x-quad"));
  model.patches.clear();
  progress.begin("fill holes", 0, "vertex");
  DUBSAR_ASSIGN(HoleReport report, HoleFiller(model, graph, options, progress).run());
  DUBSAR_TRY(measure_partitions(model));
  progress.end();
  return report;
}

}  // namespace dubsar
