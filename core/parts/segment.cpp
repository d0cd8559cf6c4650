#include "core/parts/segment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <map>

#include "core/base/numbers/sort_unique.h"
#include "core/base/system/log.h"
#include "core/base/system/parallel.h"
#include "core/parts/enclosure.h"
#include "core/parts/face_roles.h"

namespace dubsar {
namespace {

/// The hidden body fills at least this share of what the outer surface encloses; smaller ones are loose
/// pieces.
constexpr double kSmallestCore = 0.03;

constexpr std::int64_t kPartGrain = 1 << 14;

using Infos = std::vector<FaceComponents::Info>;

double total_area(const Infos& infos) {
  double sum = 0.0;
  for (const auto& info : infos) sum += info.area;
  return sum;
}

/// For each component the role of the neighbour with the longest common border; its own role where it has
/// none.
std::vector<FaceRole> strongest_neighbours(const SurfaceModel& model, const FaceScene& scene,
                                           const FaceComponents& components, const std::vector<FaceRole>& roles,
                                           const std::vector<bool>& wanted) {
  std::vector<std::map<std::uint32_t, double>> border(components.info.size());
  const FaceGraph& graph = scene.graph;
  for (std::uint32_t f = 0; f < graph.faces(); ++f) {  // of small components only: few
    const std::uint32_t c = components.of_face[f];
    if (!wanted[c]) continue;
    for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
      const std::uint32_t g = graph.neighbour[s];
      if (g != FaceGraph::kNone && components.of_face[g] != c)
        border[c][components.of_face[g]] += static_cast<double>(side_length(model.mesh, f, s - graph.first_side[f]));
    }
  }
  std::vector<FaceRole> result(components.info.size());
  for (std::size_t c = 0; c < result.size(); ++c) {
    double longest = 0.0;
    result[c] = roles[components.info[c].first_face];
    for (const auto& [other, length] : border[c])
      if (length > longest) {
        longest = length;
        result[c] = roles[components.info[other].first_face];
      }
  }
  return result;
}

/// Pieces that were cut off but are too small to be parts go to their strongest neighbour. Returns what hangs together
/// then.
FaceComponents merge_small(const SurfaceModel& model, const FaceScene& scene, const SegmentOptions& options,
                           std::vector<FaceRole>& roles) {
  constexpr int kRounds = 4;  // a merged piece may free its neighbour to be merged; more rounds never changed anything
  for (int round = 0;; ++round) {
    FaceComponents components = role_components(model, scene, roles);
    if (round == kRounds) return components;
    const double smallest = options.smallest_area * total_area(components.info);
    std::vector<bool> small(components.info.size());
    bool any = false;
    for (std::size_t c = 0; c < small.size(); ++c) {
      small[c] = components.info[c].border > 0.0 && components.info[c].area < smallest;
      any = any || small[c];
    }
    if (!any) return components;
    const std::vector<FaceRole> target = strongest_neighbours(model, scene, components, roles, small);
    parallel_for(scene.graph.faces(), kPartGrain, [&](std::int64_t i) {
      const auto f = static_cast<std::size_t>(i);
      if (small[components.of_face[f]]) roles[f] = target[components.of_face[f]];
    });
  }
}

bool contains(const FaceComponents::Info& outer, const FaceComponents::Info& inner) {
  return glm::all(glm::lessThan(outer.lowest, inner.lowest)) &&
         glm::all(glm::greaterThan(outer.highest, inner.highest));
}

/// Does a piece of the surface lie as deep as `body` does around it? So does the hidden body's part of a gap that has
/// contact all round it; the wall of a cavity in the clay does not.
bool is_level_with(const FaceComponents& components, const FaceScene& scene, std::size_t piece, std::size_t body) {
  constexpr float kOff = 0.1f;  // of how wide the piece is; of a pore beside the gap it is a quarter
  const FaceComponents::Info& info = components.info[piece];
  const glm::vec3 middle = 0.5f * (info.lowest + info.highest), size = info.highest - info.lowest;
  const glm::vec3 reach(std::max({size.x, size.y, size.z}));
  std::vector<float> own, around;  // depths
  for (std::uint32_t f = 0; f < scene.graph.faces(); ++f)
    if (components.of_face[f] == piece)
      own.push_back(scene.depth[f]);
    else if (components.of_face[f] == body && glm::all(glm::lessThan(glm::abs(scene.graph.centre[f] - middle), reach)))
      around.push_back(scene.depth[f]);
  if (own.empty() || around.empty()) return false;
  const auto median = [](std::vector<float>& values) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  return std::abs(median(own) - median(around)) < kOff * static_cast<float>(std::sqrt(info.area));
}

/// Which core components are the hidden body. Walls of pores that look outwards enclose a negative volume,
/// loose pieces a small one, and a body whose neighbours merely stand close has no wall around it. Empty
/// result: nothing is nested.
std::vector<bool> accept_core(const FaceComponents& components, const std::vector<FaceRole>& role,
                              const FaceScene& scene, const SegmentOptions& options) {
  constexpr double kSmallestPart = 0.01;  // of the volume of the largest
  const Infos& infos = components.info;
  constexpr double kSmallestWall =
      0.4;  // share of the core's area that an inner wall has, glued places left out of both
  const double smallest_area = options.smallest_area * total_area(infos);
  std::size_t shell = infos.size(), largest = infos.size();
  const auto larger = [&](std::size_t c, std::size_t best) {
    return best == infos.size() || infos[c].volume > infos[best].volume;
  };
  for (std::size_t c = 0; c < infos.size(); ++c)
    if (role[c] == FaceRole::kOutside && larger(c, shell)) shell = c;
  if (shell == infos.size() || infos[shell].volume <= 0.0) return {};
  double core_area = 0.0, wall_area = 0.0;
  for (std::size_t c = 0; c < infos.size(); ++c) {
    if (!contains(infos[shell], infos[c])) continue;
    if (role[c] == FaceRole::kCore && larger(c, largest)) largest = c;
    if (role[c] == FaceRole::kInside) wall_area = std::max(wall_area, infos[c].area);
  }
  if (largest == infos.size() || infos[largest].volume < kSmallestCore * infos[shell].volume) return {};
  std::vector<bool> accepted(infos.size(), false);
  for (std::size_t c = 0; c < infos.size(); ++c) {
    // What the cut separated belongs to the body if it has substance; what touches nothing must be the body
    // itself.
    const bool attached = infos[c].border > 0.0;
    accepted[c] =
        c == largest ||
        (role[c] == FaceRole::kCore && attached && infos[c].area >= smallest_area && contains(infos[shell], infos[c]) &&
         (infos[c].volume >= kSmallestPart * infos[largest].volume || is_level_with(components, scene, c, largest)));
    if (accepted[c]) core_area += infos[c].area;
  }
  if (wall_area < kSmallestWall * core_area) return {};
  return accepted;
}

class Partitioning {
 public:
  Partitioning(const FaceComponents& components, const SegmentOptions& options)
      : components_(components), options_(options), id_(components.info.size(), PartitionTable::kNone) {}

  PartitionId add(PartitionKind kind, std::string_view body = {}) { return partitions_.add(kind, body); }
  void assign(std::size_t component, PartitionId id) { id_[component] = id; }
  bool free(std::size_t component) const { return id_[component] == PartitionTable::kNone; }

  /// Closed bodies by falling volume: `first`, then fragments.
  void add_bodies(PartitionKind first) {
    std::vector<std::size_t> bodies;
    const double smallest = options_.smallest_area * total_area(components_.info);
    for (std::size_t c = 0; c < id_.size(); ++c) {
      const FaceComponents::Info& info = components_.info[c];
      if (free(c) && info.volume >= options_.smallest_volume && info.area >= smallest) bodies.push_back(c);
    }
    std::stable_sort(bodies.begin(), bodies.end(), [&](std::size_t a, std::size_t b) {
      return components_.info[a].volume > components_.info[b].volume;
    });
    int fragment = 0;
    for (const std::size_t c : bodies) {
      if (partitions_.size() + 1 == PartitionTable::kMost) break;  // one place is kept for what is left
      if (c == bodies.front() && first != PartitionKind::kFragment)
        assign(c, partitions_.add(first));
      else
        assign(c, partitions_.add(PartitionKind::kFragment, {}, fmt::format("fragment {}", ++fragment)));
    }
  }

  /// All that is left. Returns the number of components.
  std::int64_t add_rest() {
    const auto rest = std::count(id_.begin(), id_.end(), PartitionTable::kNone);
    if (rest > 0) {
      const PartitionId id = add(partitions_.empty() ? PartitionKind::kObject : PartitionKind::kPores);
      std::replace(id_.begin(), id_.end(), PartitionTable::kNone, id);
    }
    return rest;
  }

  void store(SurfaceModel& model) && {
    model.quad_partition.resize(components_.of_face.size());
    parallel_for(static_cast<std::int64_t>(components_.of_face.size()), kPartGrain, [&](std::int64_t i) {
      const auto f = static_cast<std::size_t>(i);
      model.quad_partition[f] = id_[components_.of_face[f]];
    });
    model.partitions = std::move(partitions_);
  }

 private:
  const FaceComponents& components_;
  const SegmentOptions& options_;
  std::vector<PartitionId> id_;  ///< of each component
  PartitionTable partitions_;
};

/// Faces of one role that hang together, and which of them are the hidden body; `core` is empty when nothing is nested.
struct Nesting {
  FaceComponents components;
  std::vector<FaceRole> role;  ///< of each component
  std::vector<bool> core;
};

Nesting find_nesting(FaceComponents components, const FaceScene& scene, const SegmentOptions& options,
                     const std::vector<FaceRole>& roles) {
  Nesting nesting{std::move(components), {}, {}};
  for (const FaceComponents::Info& info : nesting.components.info) nesting.role.push_back(roles[info.first_face]);
  nesting.core = accept_core(nesting.components, nesting.role, scene, options);
  return nesting;
}

/// Partitions of a nested object.
void store_nested(SurfaceModel& model, const FaceScene& scene, const SegmentOptions& options, const Nesting& nesting,
                  SegmentReport& report) {
  const auto& [components, role, core] = nesting;
  const Infos& infos = components.info;
  Partitioning partitioning(components, options);
  const PartitionId tablet = partitioning.add(PartitionKind::kTablet);
  const PartitionId outside = partitioning.add(PartitionKind::kEnvelopeOutside, "envelope");
  const PartitionId inside = partitioning.add(PartitionKind::kEnvelopeInside, "envelope");

  std::size_t shell = infos.size();
  std::vector<std::uint32_t> tablet_air;
  for (std::size_t c = 0; c < infos.size(); ++c) {
    if (core[c]) partitioning.assign(c, tablet);
    if (role[c] == FaceRole::kOutside && (shell == infos.size() || infos[c].volume > infos[shell].volume)) shell = c;
  }
  partitioning.assign(shell, outside);
  for (std::size_t f = 0; f < components.of_face.size(); ++f)
    if (core[components.of_face[f]] && scene.air[f] < FaceScene::kExterior &&
        (tablet_air.empty() || tablet_air.back() != scene.air[f]))
      tablet_air.push_back(scene.air[f]);
  sort_unique(tablet_air);
  // The inner wall: whatever was cut from the tablet or the outer wall, and walls around the tablet's air. Of the other
  // components nothing is asked.
  std::vector<double> at_tablet_air(infos.size(), 0.0);
  std::vector<bool> asked(infos.size());
  for (std::size_t c = 0; c < asked.size(); ++c)
    asked[c] = partitioning.free(c) && infos[c].volume < 0.0 && infos[c].border == 0.0;
  for (std::size_t f = 0; f < components.of_face.size(); ++f)
    if (asked[components.of_face[f]] && std::binary_search(tablet_air.begin(), tablet_air.end(), scene.air[f]))
      at_tablet_air[components.of_face[f]] += static_cast<double>(scene.graph.area[f]);
  for (std::size_t c = 0; c < infos.size(); ++c) {
    if (!partitioning.free(c)) continue;
    const bool wall = infos[c].volume < 0.0 && at_tablet_air[c] > 0.5 * infos[c].area;
    if (infos[c].border > 0.0)
      partitioning.assign(c, role[c] == FaceRole::kOutside ? outside : inside);
    else if (wall)
      partitioning.assign(c, inside);
  }
  partitioning.add_bodies(PartitionKind::kFragment);
  report.small_pieces = partitioning.add_rest();
  std::move(partitioning).store(model);
}

double length_of_cuts(const SurfaceModel& model, const FaceGraph& graph) {
  return parallel_reduce<double>(
      graph.faces(), kPartGrain, 0.0,
      [&](std::int64_t begin, std::int64_t end) {
        double length = 0.0;
        for (auto f = static_cast<std::uint32_t>(begin); f < static_cast<std::uint64_t>(end); ++f)
          for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
            const std::uint32_t g = graph.neighbour[s];
            if (g != FaceGraph::kNone && g > f && model.quad_partition[g] != model.quad_partition[f])
              length += static_cast<double>(side_length(model.mesh, f, s - graph.first_side[f]));
          }
        return length;
      },
      [](double a, double b) { return a + b; });
}

/// Partitions of closed bodies as they are.
void store_bodies(SurfaceModel& model, const FaceComponents& whole, const SegmentOptions& options,
                  SegmentReport& report) {
  Partitioning partitioning(whole, options);
  partitioning.add_bodies(PartitionKind::kObject);
  report.small_pieces = partitioning.add_rest();
  std::move(partitioning).store(model);
}

}  // namespace

FaceComponents role_components(const SurfaceModel& model, const FaceScene& scene, const std::vector<FaceRole>& roles) {
  std::vector<std::uint8_t> labels(roles.size());
  std::transform(roles.begin(), roles.end(), labels.begin(), [](FaceRole r) { return static_cast<std::uint8_t>(r); });
  return find_components(model, scene, labels);
}

bool partition_by_roles(SurfaceModel& model, const FaceScene& scene, const SegmentOptions& options,
                        std::vector<FaceRole> roles, FaceComponents components, SegmentReport& report) {
  Nesting nesting = find_nesting(std::move(components), scene, options, roles);
  if (!nesting.core.empty()) {
    // Core pieces that are not the hidden body fall back to the wall around them. The wall may then reach beyond the
    // shell, so that nothing is nested any more.
    bool others = false;
    for (std::size_t c = 0; c < nesting.role.size(); ++c)
      others = others || (nesting.role[c] == FaceRole::kCore && !nesting.core[c]);
    if (others) {
      parallel_for(static_cast<std::int64_t>(roles.size()), kPartGrain, [&](std::int64_t i) {
        const auto f = static_cast<std::size_t>(i);
        const std::uint32_t c = nesting.components.of_face[f];
        if (nesting.role[c] == FaceRole::kCore && !nesting.core[c]) roles[f] = FaceRole::kInside;
      });
      nesting = find_nesting(role_components(model, scene, roles), scene, options, roles);
    }
  }
  if (nesting.core.empty()) {
    store_bodies(model, find_components(model, scene, std::vector<std::uint8_t>(roles.size(), 0)), options, report);
    return false;
  }
  store_nested(model, scene, options, nesting, report);
  report.cut_length = length_of_cuts(model, scene.graph);
  return true;
}

Result<SegmentReport> segment(SurfaceModel& model, const SegmentOptions& options, Progress& progress) {
  DUBSAR_ASSIGN(const FaceGraph graph, FaceGraph::build(model.mesh, progress));
  return segment(model, graph, options, progress);
}

Result<SegmentReport> segment(SurfaceModel& model, const FaceGraph& graph, const SegmentOptions& options,
                              Progress& progress) {
  const bool looks = options.method == SegmentMethod::kNested || options.method == SegmentMethod::kConcavity;
  SegmentReport report;
  progress.begin("segment", 3, "step");
  DUBSAR_ASSIGN(const FaceScene scene,
                looks ? observe_faces(model, graph, options, progress) : Result<FaceScene>(FaceScene{.graph = graph}));
  progress.advance(1);
  const FaceComponents whole = find_components(model, scene, std::vector<std::uint8_t>(scene.graph.faces(), 0));
  report.components = static_cast<std::int64_t>(whole.info.size());
  report.crack_radius = scene.crack_radius;

  model.patches.clear();
  if (options.method == SegmentMethod::kNone) {
    model.quad_partition.assign(scene.graph.faces(), 0);
    model.partitions.clear();
    model.partitions.add(PartitionKind::kObject);
    progress.end();
    return report;
  }
  if (options.method == SegmentMethod::kBodies) {
    store_bodies(model, whole, options, report);
    progress.end();
    return report;
  }
  DUBSAR_ASSIGN(std::vector<FaceRole> roles, options.method == SegmentMethod::kNested
                                                 ? roles_by_cut(model, scene, whole, options, progress)
                                                 : roles_by_concavity(model, scene, options, progress));
  progress.advance(1);
  FaceComponents components = merge_small(model, scene, options, roles);
  if (progress.cancelled()) return cancelled_error();
  report.nested = partition_by_roles(model, scene, options, std::move(roles), std::move(components), report);
  if (report.nested && options.method == SegmentMethod::kNested && !plausible_enclosure(model, scene.graph)) {
    log_info("segment: the inner body does not fill a cavity as an enclosed tablet would; the bodies stay whole");
    report.enclosure_refused = true;
    report.nested = false;
    report.cut_length = 0.0;
    store_bodies(model, whole, options, report);
  }
  log_debug("segment: {} surfaces, {} partitions, {}, cracks up to {} steps closed", report.components,
            model.partitions.size(), report.nested ? "a body inside another" : "no body inside another",
            report.crack_radius > 0 ? 2 * report.crack_radius + 1 : 0);
  progress.advance(1);
  progress.end();
  return report;
}

}  // namespace dubsar
