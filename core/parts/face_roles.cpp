#include "core/parts/face_roles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/system/parallel.h"
#include "core/parts/min_cut.h"

namespace dubsar {
namespace {

constexpr std::int64_t kRoleGrain = 1 << 13;

/// One of each face; bytes, since several threads write them.
using Flags = std::vector<std::uint8_t>;

/// Relief up to this many grid steps wide does not bend the depth field.
constexpr int kSealRadius = 6;

/// The air in front of a face: the first sample along the normal that is not inside.
std::uint32_t air_in_front(const BitVolume& inside, const BitVolume& exterior, const EnclosedAir& enclosed,
                           const glm::vec3& centre, const glm::vec3& normal) {
  const Dims d = inside.dims();
  for (const float step : {0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f}) {
    const glm::vec3 p = centre + step * normal;
    const std::int64_t x = std::lround(p.x), y = std::lround(p.y), z = std::lround(p.z);
    if (x < 0 || y < 0 || z < 0 || x >= d.x || y >= d.y || z >= d.z) return FaceScene::kExterior;
    if (inside.get(x, y, z)) continue;
    return exterior.get(x, y, z) ? FaceScene::kExterior : enclosed.at(x, y, z);
  }
  return EnclosedAir::kNone;
}

/// Two labels on the faces where active[f]. preference > 0: the face wants `true`, in units of area.
/// Faces that clearly agree and meet without a crease are one node, which leaves a small graph with the same
/// cut. Faces are cut in blocks, with all threads, before the blocks are: where a node would reach beyond its block it
/// is several, which nothing separates.
Result<Flags> cut_faces(const SurfaceModel& model, const FaceScene& scene, const Flags& active,
                        const std::vector<float>& preference, Progress& progress) {
  // Crease weight exp(-(max(0, -k - 0.2) / 0.25)), lambda 2 to 4.
  constexpr float kLambda = 3.0f, kFlat = 0.2f, kFall = 0.25f;
  constexpr float kClear = 0.3f;    // preference per area
  constexpr double kUnits = 256.0;  // integer capacity per unit of area or length
  constexpr double kMostCost = 1 << 29;
  constexpr std::int32_t kInseparable = 1 << 29;
  constexpr int kBlockBits = 19;  // of a face number: layers of the surface
  const FaceGraph& graph = scene.graph;
  const std::uint32_t faces = graph.faces();
  /// The active faces across the sides of one, each pair once.
  const auto each_pair = [&](std::uint32_t f, const auto& visit) {
    for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
      const std::uint32_t g = graph.neighbour[s];
      if (g != FaceGraph::kNone && g >= f && active[g]) visit(g, s - graph.first_side[f]);
    }
  };
  const auto clear_side = [&](std::uint32_t f) {
    return preference[f] > kClear * graph.area[f] ? 1 : preference[f] < -kClear * graph.area[f] ? -1 : 0;
  };
  const auto as_one = [&](std::uint32_t f, std::uint32_t g) {
    const int side = clear_side(f);
    return side != 0 && clear_side(g) == side && graph.curvature(f, g) > -kFlat;
  };
  std::vector<std::uint32_t> node(faces, FaceGraph::kNone);
  {
    ConcurrentSets sets(faces);
    parallel_for(faces, kRoleGrain, [&](std::int64_t i) {
      const auto f = static_cast<std::uint32_t>(i);
      if (!active[f] || clear_side(f) == 0) return;
      each_pair(f, [&](std::uint32_t g, std::uint32_t) {
        if (f >> kBlockBits == g >> kBlockBits && as_one(f, g)) sets.join(f, g);
      });
    });
    if (progress.cancelled()) return cancelled_error();
    parallel_for(faces, kRoleGrain, [&](std::int64_t i) {
      const auto f = static_cast<std::uint32_t>(i);
      if (active[f]) node[f] = sets.root(f);
    });
  }
  std::vector<std::uint32_t> block;            // of each node
  for (std::uint32_t f = 0; f < faces; ++f) {  // a root is the first face of its set
    if (!active[f]) continue;
    if (node[f] == f) {
      node[f] = static_cast<std::uint32_t>(block.size());
      block.push_back(f >> kBlockBits);
    } else {
      node[f] = node[node[f]];
    }
  }
  const auto nodes = static_cast<std::uint32_t>(block.size());
  std::vector<double> wish(nodes, 0.0);
  for (std::uint32_t f = 0; f < faces; ++f)
    if (active[f]) wish[node[f]] += static_cast<double>(preference[f]);
  MinCut cut(nodes);
  for (std::uint32_t n = 0; n < nodes; ++n) {
    const auto cost = static_cast<std::int32_t>(std::lround(std::clamp(wish[n] * kUnits, -kMostCost, kMostCost)));
    cut.add_node_cost(n, cost < 0 ? -cost : 0, cost > 0 ? cost : 0);
  }
  struct Edge {
    std::uint32_t a, b;
    std::int32_t cost;
  };
  using Edges = std::vector<Edge>;
  const std::int64_t chunks = (std::int64_t{faces} + kRoleGrain - 1) / kRoleGrain;
  std::vector<Edges> edges(static_cast<std::size_t>(chunks));
  parallel_chunks(faces, kRoleGrain, [&](std::int64_t begin, std::int64_t end) {
    Edges& here = edges[static_cast<std::size_t>(begin / kRoleGrain)];
    for (auto f = static_cast<std::uint32_t>(begin); f < static_cast<std::uint64_t>(end); ++f) {
      if (!active[f]) continue;
      each_pair(f, [&](std::uint32_t g, std::uint32_t side) {
        if (node[g] == node[f]) return;
        if (f >> kBlockBits != g >> kBlockBits && as_one(f, g)) {
          here.push_back({node[f], node[g], kInseparable});
          return;
        }
        const float crease = std::exp(-std::max(0.0f, -graph.curvature(f, g) - kFlat) / kFall);
        const float length = side_length(model.mesh, f, side);
        here.push_back(
            {node[f], node[g],
             1 + static_cast<std::int32_t>(std::lround(kUnits * static_cast<double>(kLambda * crease * length)))});
      });
    }
  });
  for (const Edges& some : edges)
    for (const Edge& e : some) cut.add_edge(e.a, e.b, e.cost);
  edges = {};
  cut.set_blocks(std::move(block), faces == 0 ? 0 : ((faces - 1) >> kBlockBits) + 1);
  DUBSAR_TRY(cut.solve(progress));
  Flags result(faces, 0);
  parallel_for(faces, kRoleGrain, [&](std::int64_t i) {
    const auto f = static_cast<std::size_t>(i);
    result[f] = active[f] && cut.on_source_side(node[f]) ? 1 : 0;
  });
  return result;
}

/// Near-tangential faces say little: the vote grows with the square of the cosine up to 0.5.
float vote(float cosine) {
  const float g = std::clamp(2.0f * cosine, -1.0f, 1.0f);
  return g * std::abs(g);
}

/// Median depth of the faces at enclosed air that look inwards.
float wall_thickness(const FaceScene& scene) {
  std::vector<float> depths;
  for (std::size_t f = 0; f < scene.air.size(); ++f)
    if (scene.air[f] < FaceScene::kExterior && scene.inward[f] > 0.5f) depths.push_back(scene.depth[f]);
  if (depths.empty()) return std::numeric_limits<float>::max();
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return std::max(*middle, 1.0f);
}

}  // namespace

float side_length(const QuadMesh& mesh, std::uint32_t face, std::uint32_t side) {
  if (!mesh.has_doubled(face)) {
    const auto& v = mesh.quads[face];
    return glm::distance(mesh.positions[v[side]], mesh.positions[v[(side + 1) & 3]]);
  }
  const Polygon polygon = mesh.polygon(face);
  return glm::distance(mesh.positions[polygon.vertex[side]],
                       mesh.positions[polygon.vertex[(side + 1) % static_cast<std::uint32_t>(polygon.size)]]);
}

Result<FaceScene> observe_faces(const SurfaceModel& model, const FaceGraph& graph, const SegmentOptions& options,
                                Progress& progress) {
  FaceScene scene{.graph = graph};
  DUBSAR_ASSIGN(const Exterior exterior, find_exterior(model.samples.signs, options.largest_crack_radius, progress));
  scene.crack_radius = exterior.crack_radius;
  const EnclosedAir enclosed(model.samples.signs, exterior.air);
  DUBSAR_ASSIGN(const DepthField depth,
                DepthField::make(model.samples.signs, std::max(kSealRadius, exterior.crack_radius), progress));
  const std::uint32_t faces = scene.graph.faces();
  scene.air.resize(faces);
  scene.inward.resize(faces);
  scene.depth.resize(faces);
  parallel_chunks(faces, kRoleGrain, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    for (auto f = static_cast<std::size_t>(begin); f < static_cast<std::size_t>(end); ++f) {
      const glm::vec3 &centre = scene.graph.centre[f], &normal = scene.graph.normal[f];
      scene.air[f] = air_in_front(model.samples.signs, exterior.air, enclosed, centre, normal);
      scene.inward[f] = glm::dot(normal, depth.inwards(centre));
      scene.depth[f] = depth.depth(centre);
    }
  });
  if (progress.cancelled()) return cancelled_error();
  return scene;
}

namespace {

/// What the faces of one component in one chunk add up to.
struct ComponentSum {
  std::uint32_t component = 0;
  FaceComponents::Info info;
  glm::dvec3 area_centre{0.0};  ///< sum of area times centre
  glm::dvec3 area_normal{0.0};  ///< sum of area times normal
};

ComponentSum& sum_of(std::vector<ComponentSum>& sums, std::unordered_map<std::uint32_t, std::size_t>& place,
                     std::uint32_t component) {
  const auto [at, is_new] = place.try_emplace(component, sums.size());
  if (is_new) sums.push_back({.component = component, .info = {}});
  return sums[at->second];
}

void add(ComponentSum& a, const ComponentSum& b) {
  a.info.area += b.info.area;
  a.info.volume += b.info.volume;
  a.info.exterior_area += b.info.exterior_area;
  a.info.inward_area += b.info.inward_area;
  a.info.border += b.info.border;
  a.info.lowest = glm::min(a.info.lowest, b.info.lowest);
  a.info.highest = glm::max(a.info.highest, b.info.highest);
  a.area_centre += b.area_centre;
  a.area_normal += b.area_normal;
}

/// One face; `volume` takes the cone from the origin.
void add_face(ComponentSum& sum, const SurfaceModel& model, const FaceScene& scene,
              const std::vector<std::uint8_t>& label, std::uint32_t f) {
  const FaceGraph& graph = scene.graph;
  FaceComponents::Info& info = sum.info;
  const auto area = static_cast<double>(graph.area[f]);
  const glm::dvec3 centre(graph.centre[f]), normal(graph.normal[f]);
  info.area += area;
  info.volume += area * glm::dot(centre, normal) / 3.0;
  info.lowest = glm::min(info.lowest, graph.centre[f]);
  info.highest = glm::max(info.highest, graph.centre[f]);
  if (scene.observed()) {
    if (scene.air[f] == FaceScene::kExterior)
      info.exterior_area += area;
    else
      info.inward_area += area * static_cast<double>(vote(scene.inward[f]));
  }
  sum.area_centre += area * centre;
  sum.area_normal += area * normal;
  for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
    const std::uint32_t g = graph.neighbour[s];
    if (g == FaceGraph::kNone || label[g] != label[f])
      info.border += static_cast<double>(side_length(model.mesh, f, s - graph.first_side[f]));
  }
}

}  // namespace

FaceComponents find_components(const SurfaceModel& model, const FaceScene& scene,
                               const std::vector<std::uint8_t>& label) {
  constexpr std::int64_t kChunk = 1 << 16;
  const FaceGraph& graph = scene.graph;
  const std::uint32_t faces = graph.faces();
  ConcurrentSets sets(faces);
  parallel_for(faces, kRoleGrain, [&](std::int64_t i) {
    const auto f = static_cast<std::uint32_t>(i);
    for (std::uint32_t s = graph.first_side[f]; s < graph.first_side[f + 1]; ++s) {
      const std::uint32_t g = graph.neighbour[s];
      if (g != FaceGraph::kNone && g > f && label[g] == label[f]) sets.join(f, g);
    }
  });
  FaceComponents components;
  components.of_face.resize(faces);
  parallel_for(faces, kRoleGrain, [&](std::int64_t i) {
    components.of_face[static_cast<std::size_t>(i)] = sets.root(static_cast<std::uint32_t>(i));
  });
  for (std::uint32_t f = 0; f < faces; ++f) {  // roots come before all others of their component
    std::uint32_t& id = components.of_face[f];
    if (id == f) {
      id = static_cast<std::uint32_t>(components.info.size());
      components.info.push_back({.first_face = f});
    } else {
      id = components.of_face[id];
    }
  }
  using Sums = std::vector<ComponentSum>;
  const Sums sums = parallel_reduce<Sums>(
      faces, kChunk, Sums(),
      [&](std::int64_t begin, std::int64_t end) {
        Sums part;
        std::unordered_map<std::uint32_t, std::size_t> place;
        std::size_t last = 0;
        for (auto f = static_cast<std::uint32_t>(begin); f < static_cast<std::uint64_t>(end); ++f) {
          const std::uint32_t c = components.of_face[f];
          if (part.empty() || part[last].component != c)
            last = static_cast<std::size_t>(&sum_of(part, place, c) - part.data());
          add_face(part[last], model, scene, label, f);
        }
        return part;
      },
      [&](Sums all, const Sums& part) {
        all.resize(components.info.size());
        for (const ComponentSum& sum : part) add(all[sum.component], sum);
        return all;
      });
  for (std::size_t c = 0; c < sums.size(); ++c) {
    FaceComponents::Info& info = components.info[c];
    const std::uint32_t first = info.first_face;
    info = sums[c].info;
    info.first_face = first;
    // Cones from the centre of area: those from the origin less what the shift takes.
    if (info.area > 0.0) info.volume -= glm::dot(sums[c].area_centre / info.area, sums[c].area_normal) / 3.0;
  }
  return components;
}

Result<std::vector<FaceRole>> roles_by_cut(const SurfaceModel& model, const FaceScene& scene,
                                           const FaceComponents& whole, const SegmentOptions& options,
                                           Progress& progress) {
  const FaceGraph& graph = scene.graph;
  const std::uint32_t faces = graph.faces();
  constexpr double kStray = 0.02;  // share of a surface whose faces may have looked through a thin wall
  double total = 0.0;
  for (const auto& info : whole.info) total += info.area;

  enum class Kind : std::uint8_t { kCore, kGap, kPore, kOutside, kUndecided };
  std::vector<Kind> kind;  // of each surface
  for (const FaceComponents::Info& info : whole.info)
    kind.push_back(info.exterior_area >= (1.0 - kStray) * info.area && info.exterior_area > kStray * info.area
                       ? Kind::kOutside
                   : info.exterior_area > kStray * info.area    ? Kind::kUndecided
                   : info.volume > 0.0                          ? Kind::kCore  // a body that touches nothing
                   : info.area >= options.smallest_area * total ? Kind::kGap
                                                                : Kind::kPore);
  const auto each_face = [&](const auto& visit) {
    parallel_for(faces, kRoleGrain, [&](std::int64_t i) { visit(static_cast<std::size_t>(i)); });
  };
  std::vector<FaceRole> roles(faces, FaceRole::kInside);
  Flags undecided(faces, 0), enclosed(faces, 0);
  each_face([&](std::size_t f) {
    const Kind of_face = kind[whole.of_face[f]];
    if (of_face == Kind::kCore) roles[f] = FaceRole::kCore;
    if (of_face == Kind::kOutside) roles[f] = FaceRole::kOutside;
    enclosed[f] = of_face == Kind::kGap;
    undecided[f] = of_face == Kind::kUndecided;
  });
  std::vector<float> preference(faces, 0.0f);
  if (std::find(kind.begin(), kind.end(), Kind::kUndecided) != kind.end()) {
    // What can be seen through a crack lies deeper than the wall is thick.
    const float wall = wall_thickness(scene);
    each_face([&](std::size_t f) {
      if (undecided[f] && scene.air[f] != EnclosedAir::kNone)
        preference[f] = graph.area[f] * (scene.air[f] == FaceScene::kExterior
                                             ? std::clamp(2.0f - 2.0f * scene.depth[f] / wall, -1.0f, 1.0f)
                                             : -1.0f);
    });
    DUBSAR_ASSIGN(const Flags outside, cut_faces(model, scene, undecided, preference, progress));
    each_face([&](std::size_t f) {
      if (!undecided[f]) return;
      if (outside[f])
        roles[f] = FaceRole::kOutside;
      else
        enclosed[f] = 1;
    });
  }
  // Where the envelope's clay was pressed onto the tablet, the rim of the contact is envelope: walls across
  // the gap lean to it. On phantoms 0 to 0.35 are equal to 0.3 %, more takes tablet.
  constexpr float kLean = 0.2f;
  each_face([&](std::size_t f) { preference[f] = -graph.area[f] * vote(scene.inward[f] + kLean); });
  DUBSAR_ASSIGN(const Flags core, cut_faces(model, scene, enclosed, preference, progress));
  each_face([&](std::size_t f) {
    if (enclosed[f]) roles[f] = core[f] ? FaceRole::kCore : FaceRole::kInside;
  });
  return roles;
}

}  // namespace dubsar
