#include "core/relief/occlusion/occlusion.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/numbers/morton_code.h"
#include "core/base/system/parallel.h"
#include "core/relief/occlusion/lit_boxes.h"
#include "core/relief/occlusion/march_kernels.h"
#include "core/relief/occlusion/ray_scene.h"
#include "core/relief/occlusion/surface_bricks.h"

namespace dubsar {
namespace {

constexpr std::int64_t kOcclusionGrain = 256;  // vertices: 41 k rays, some 10 ms
constexpr std::size_t kLanes = kernels::MarchStart::kMost;
constexpr PartitionId kNoBody = PartitionTable::kNone;

struct RayFrame {
  glm::vec3 x, y, z;
};

/// Right-handed frame about a unit vector, without branches (Duff et al. 2017).
RayFrame frame_about(glm::vec3 n) {
  const float sign = std::copysign(1.0f, n.z), p = -1.0f / (sign + n.z), q = n.x * n.y * p;
  return {{1.0f + sign * n.x * n.x * p, sign * q, -sign * n.x}, {q, sign + n.y * n.y * p, -n.y}, n};
}

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Up to 16 vertices whose rays are followed together, since neighbours look the same way.
struct VertexGroup {
  std::array<std::uint32_t, kLanes> ids{};
  std::array<glm::vec3, kLanes> origins{};
  std::array<RayFrame, kLanes> frames{};
  std::size_t count = 0;

  void add(std::uint32_t vertex, glm::vec3 origin, glm::vec3 normal) {
    ids[count] = vertex;
    origins[count] = origin;
    frames[count] = frame_about(normal);
    ++count;
  }
};

/// A sky, and its directions one axis after the other.
struct Sky {
  SkyRays rays;
  std::array<std::vector<float>, 3> along;

  explicit Sky(SkyRays all) : rays(std::move(all)) {
    for (const glm::vec3& d : rays.directions)
      for (std::size_t axis = 0; axis < 3; ++axis) along[axis].push_back(d[static_cast<int>(axis)]);
  }
};

/// What the surface takes from each of a group's vertices, summed over the rays. Any thread.
class Tracer {
 public:
  virtual ~Tracer() = default;
  virtual std::array<float, kLanes> taken(const VertexGroup& group, const Sky& sky) const = 0;
};

/// Exact, by Embree: one direction of the sky for all vertices at a time.
class TriangleTracer final : public Tracer {
 public:
  static Result<std::unique_ptr<Tracer>> create(RayDevice& device, std::span<const Triangle> triangles,
                                                float radius_vox, Progress& progress) {
    auto out = std::make_unique<TriangleTracer>(radius_vox);
    DUBSAR_ASSIGN(out->scene_, RayScene::build(device, triangles, progress));
    return out;
  }
  explicit TriangleTracer(float radius_vox) : radius_vox_(radius_vox) {}

  std::array<float, kLanes> taken(const VertexGroup& group, const Sky& sky) const override {
    std::array<float, kLanes> out{};
    for (std::size_t first = 0; first < group.count; first += RayPacket::kRays) trace(group, first, sky.rays, out);
    return out;
  }

 private:
  void trace(const VertexGroup& group, std::size_t first, const SkyRays& sky, std::array<float, kLanes>& out) const {
    const std::size_t count = std::min<std::size_t>(group.count - first, RayPacket::kRays);
    RayPacket packet;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3& origin = group.origins[first + i];
      packet.origin_x[i] = origin.x;
      packet.origin_y[i] = origin.y;
      packet.origin_z[i] = origin.z;
      packet.active[i] = true;
    }
    for (std::size_t ray = 0; ray < sky.directions.size(); ++ray) {
      const glm::vec3 local = sky.directions[ray];
      for (std::size_t i = 0; i < count; ++i) {
        const RayFrame& f = group.frames[first + i];
        packet.direction_x[i] = f.x.x * local.x + f.y.x * local.y + f.z.x * local.z;
        packet.direction_y[i] = f.x.y * local.x + f.y.y * local.y + f.z.y * local.z;
        packet.direction_z[i] = f.x.z * local.x + f.y.z * local.y + f.z.z * local.z;
      }
      packet.distance.fill(radius_vox_);
      scene_->intersect(packet);
      for (std::size_t i = 0; i < count; ++i) {
        if (!packet.hit[i]) continue;
        const float near = packet.from_behind[i] ? 1.0f : 1.0f - packet.distance[i] / radius_vox_;
        out[first + i] += sky.weights[ray] * std::max(near, 0.0f);
      }
    }
  }

  float radius_vox_;
  std::unique_ptr<RayScene> scene_;
};

/// Through distances on the voxels, several times as fast.
class BrickTracer final : public Tracer {
 public:
  static Result<std::unique_ptr<Tracer>> create(std::span<const glm::vec3> positions,
                                                std::span<const Triangle> triangles, float radius_vox,
                                                Progress& progress) {
    auto out = std::make_unique<BrickTracer>(radius_vox);
    DUBSAR_ASSIGN(out->bricks_, SurfaceBricks::build(positions, triangles, progress));
    return out;
  }
  explicit BrickTracer(float radius_vox) : radius_vox_(radius_vox) {}

  std::array<float, kLanes> taken(const VertexGroup& group, const Sky& sky) const override {
    kernels::MarchStart start;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t from = i < group.count ? i : 0;
      const RayFrame& f = group.frames[from];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        start.origin[axis][i] = group.origins[from][a];
        start.frame[axis][i] = f.x[a];
        start.frame[axis + 3][i] = f.y[a];
        start.frame[axis + 6][i] = f.z[a];
      }
    }
    std::array<float, kLanes> out{};
    const std::vector<float>& weights = sky.rays.weights;
    kernels::march(bricks_,
                   {sky.along[0].data(), sky.along[1].data(), sky.along[2].data(), weights.data(), weights.size()},
                   radius_vox_, start, out);
    return out;
  }

 private:
  float radius_vox_;
  SurfaceBricks bricks_;
};

/// Vertices `ids` in an order where neighbours lie in the same small box and look to the same side.
void sort_by_place_and_side(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                            std::vector<std::uint32_t>& ids) {
  constexpr float kBoxEdge = 4.0f;
  glm::vec3 low(INFINITY);
  for (const std::uint32_t v : ids) low = glm::min(low, positions[v]);
  struct Item {
    std::uint64_t key;
    std::uint32_t vertex;
  };
  std::vector<Item> items(ids.size());
  parallel_for(static_cast<std::int64_t>(ids.size()), 1 << 14, [&](std::int64_t i) {
    const std::uint32_t v = ids[static_cast<std::size_t>(i)];
    const glm::vec3 box = glm::min((positions[v] - low) / kBoxEdge, glm::vec3(1e6f)), n = normals[v];
    const glm::vec3 size = glm::abs(n);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto side = 2 * static_cast<std::uint64_t>(axis) + (n[axis] < 0.0f ? 1 : 0);
    items[static_cast<std::size_t>(i)] = {(morton_code(box) << 3) | side, v};
  });
  const auto before = [](const Item& a, const Item& b) { return a.key != b.key ? a.key < b.key : a.vertex < b.vertex; };
  constexpr std::int64_t kParts = 8;  // sorted each, then merged in pairs
  const auto count = static_cast<std::int64_t>(items.size());
  const auto border = [&](std::int64_t part) { return items.begin() + part * count / kParts; };
  parallel_for(kParts, 1, [&](std::int64_t part) { std::sort(border(part), border(part + 1), before); });
  for (std::int64_t width = 1; width < kParts; width *= 2)
    parallel_for(kParts / (2 * width), 1, [&](std::int64_t pair) {
      const std::int64_t first = 2 * width * pair;
      std::inplace_merge(border(first), border(first + width), border(first + 2 * width), before);
    });
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = items[i].vertex;
}

/// The vertices `ids` by the part of the sky that each looks at, in the order that they had.
std::vector<std::vector<std::uint32_t>> by_sky_part(std::span<const glm::vec3> positions,
                                                    std::span<const std::uint32_t> ids, int parts) {
  std::vector<std::vector<std::uint32_t>> out(static_cast<std::size_t>(parts));
  for (const std::uint32_t v : ids)
    out[parts == 1 ? 0 : static_cast<std::size_t>(sky_part_at(positions[v], parts))].push_back(v);
  return out;
}

Result<void> check_indices(std::span<const Triangle> triangles, std::size_t vertices) {
  const std::uint32_t largest = parallel_reduce(
      static_cast<std::int64_t>(triangles.size()), 1 << 16, 0u,
      [&](std::int64_t begin, std::int64_t end) {
        std::uint32_t part = 0;
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t)
          part = std::max({part, triangles[t][0], triangles[t][1], triangles[t][2]});
        return part;
      },
      [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); });
  if (!triangles.empty() && largest >= vertices)
    return fail(ErrorKind::kBadData, "occlusion: a triangle names vertex {}, the mesh has {}", largest, vertices);
  return {};
}

std::vector<PartitionId> bodies_of_vertices(const LitSurface& surface) {
  std::vector<PartitionId> bodies(surface.positions.size(), surface.bodies.empty() ? PartitionId{0} : kNoBody);
  for (std::size_t t = 0; t < surface.bodies.size(); ++t)
    for (const std::uint32_t v : surface.triangles[t]) bodies[v] = std::min(bodies[v], surface.bodies[t]);
  std::replace(bodies.begin(), bodies.end(), kNoBody, PartitionId{0});
  return bodies;
}

/// The triangles of a body: where they lie together as they are, else copied to `own`.
std::span<const Triangle> triangles_of(const LitSurface& surface, PartitionId id, std::vector<Triangle>& own) {
  const auto& bodies = surface.bodies;
  const auto first = std::find(bodies.begin(), bodies.end(), id);
  const auto end = std::find_if(first, bodies.end(), [&](PartitionId other) { return other != id; });
  if (std::find(end, bodies.end(), id) == bodies.end())
    return surface.triangles.subspan(static_cast<std::size_t>(first - bodies.begin()),
                                     static_cast<std::size_t>(end - first));
  own.clear();
  for (std::size_t t = 0; t < bodies.size(); ++t)
    if (bodies[t] == id) own.push_back(surface.triangles[t]);
  return own;
}

}  // namespace

Result<std::vector<float>> ambient_light(const LitSurface& surface, const OcclusionOptions& options,
                                         Progress& progress) {
  const auto& [positions, normals, triangles, bodies] = surface;
  DUBSAR_CHECK(normals.size() == positions.size());
  DUBSAR_CHECK(bodies.empty() || bodies.size() == triangles.size());
  DUBSAR_CHECK(options.radius_vox > 0.0f);
  DUBSAR_TRY(check_indices(triangles, positions.size()));
  DUBSAR_CHECK(options.shared_by >= 1 && options.shared_by <= options.rays);
  std::vector<Sky> skies;
  for (int part = 0; part < options.shared_by; ++part)
    skies.emplace_back(sky_rays_of_part(options.rays, options.shared_by, part));
  const int rays = rays_of_vertex(options);
  const auto count = static_cast<std::int64_t>(positions.size());
  progress.begin("ambient occlusion", count * rays, "ray");
  std::vector<float> light(positions.size(), 1.0f);
  std::unique_ptr<RayDevice> device;
  if (options.engine == OcclusionEngine::kTriangles) {
    DUBSAR_ASSIGN(device, RayDevice::create(positions, thread_count()));
  }

  const std::vector<PartitionId> body_of = bodies_of_vertices(surface);
  std::array<bool, 256> used{};
  for (const PartitionId id : body_of) used[id] = true;
  std::vector<Triangle> own, near;
  std::vector<std::uint32_t> ids, inside;
  const auto trace = [&](const Tracer& tracer, std::vector<std::uint32_t>& which) {
    sort_by_place_and_side(surface.positions, surface.normals, which);
    const auto end_of_all = static_cast<std::int64_t>(which.size());
    parallel_chunks(end_of_all, kOcclusionGrain * options.shared_by, [&](std::int64_t begin, std::int64_t end) {
      VertexGroup group;
      const auto follow = [&](const Sky& sky) {
        const auto sum = static_cast<float>(sky.rays.weight_sum);
        const auto taken = tracer.taken(group, sky);
        for (std::size_t k = 0; k < group.count; ++k)
          light[group.ids[k]] = std::clamp(1.0f - taken[k] / sum, 0.0f, 1.0f);
        group.count = 0;
      };
      const std::vector<std::vector<std::uint32_t>> parts = by_sky_part(
          positions, std::span(which).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)),
          options.shared_by);
      for (std::size_t part = 0; part < parts.size(); ++part) {
        const Sky& sky = skies[part];
        for (const std::uint32_t v : parts[part]) {
          group.add(v, surface.positions[v] + options.offset_vox * surface.normals[v], surface.normals[v]);
          if (group.count < kLanes) continue;
          if (progress.cancelled()) return;
          follow(sky);
        }
        if (progress.cancelled()) return;
        if (group.count > 0) follow(sky);
      }
      progress.advance((end - begin) * rays);
    });
  };
  for (std::size_t id = 0; id < used.size(); ++id) {
    if (!used[id]) continue;
    std::span<const Triangle> part = triangles;
    if (!bodies.empty()) part = triangles_of(surface, static_cast<PartitionId>(id), own);
    ids.clear();
    std::int64_t skipped = 0;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      if (body_of[v] != id) continue;
      if (finite(positions[v]) && finite(normals[v]))
        ids.push_back(v);
      else
        ++skipped;
    }
    progress.advance(skipped * rays);
    if (device) {
      DUBSAR_ASSIGN(const auto tracer, TriangleTracer::create(*device, part, options.radius_vox, progress));
      trace(*tracer, ids);
    } else if (!ids.empty()) {
      // What is further away than that no ray comes to, nor the distances that it meets.
      const float margin = options.radius_vox + std::abs(options.offset_vox) + 4.0f;
      const std::vector<LitBox> boxes = lit_boxes(positions, ids, margin, options.most_cells);
      for (const LitBox& box : boxes) {
        if (boxes.size() > 1) {
          inside = vertices_in(positions, ids, box);
          if (inside.empty()) continue;
          near = triangles_near(positions, part, box, margin);
        }
        DUBSAR_ASSIGN(const auto tracer,
                      BrickTracer::create(positions, boxes.size() > 1 ? near : part, options.radius_vox, progress));
        trace(*tracer, boxes.size() > 1 ? inside : ids);
        if (progress.cancelled()) return cancelled_error();
      }
    }
    if (progress.cancelled()) return cancelled_error();
  }
  if (options.shared_by > 1) share_light(normals, triangles, light);
  progress.end();
  return light;
}

Result<std::vector<std::uint8_t>> ambient_occlusion(const LitSurface& surface, const OcclusionOptions& options,
                                                    Progress& progress) {
  DUBSAR_ASSIGN(const std::vector<float> light, ambient_light(surface, options, progress));
  std::vector<std::uint8_t> steps(light.size());
  parallel_for(static_cast<std::int64_t>(light.size()), 1 << 16, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    steps[v] = static_cast<std::uint8_t>(std::lround(63.0f * light[v]));
  });
  return steps;
}

}  // namespace dubsar
