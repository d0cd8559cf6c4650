#include "core/mesh/simplify.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numeric>
#include <optional>

#include "core/mesh/vertex_attributes.h"

namespace dubsar {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxValence = 24;  // keeps the cost of a merge and the worst triangle bounded
constexpr double kPi = 3.14159265358979323846;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// All directions within `half` of the axis; half < 0: empty.
struct Cone {
  glm::dvec3 axis{0.0};
  double half = -1.0;
};

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

Cone merge(const Cone& a, const Cone& b) {
  if (b.half < 0.0) return a;
  if (a.half < 0.0) return b;
  const double angle = angle_between(a.axis, b.axis);
  if (angle + b.half <= a.half) return a;
  if (angle + a.half <= b.half) return b;
  const double half = 0.5 * (a.half + angle + b.half);
  if (half >= kPi) return {a.axis, kPi};
  // Turn a's axis towards b's.
  const glm::dvec3 side = b.axis - glm::dot(a.axis, b.axis) * a.axis;
  const double length = glm::length(side);
  if (length == 0.0) return {a.axis, kPi};
  const double turn = half - a.half;
  return {std::cos(turn) * a.axis + std::sin(turn) / length * side, half};
}

struct Face {
  Triangle vertex{};
  bool alive = true;
  double error = 0.0;  ///< largest distance of the surface so far
  Cone normals;        ///< of the original triangles it stands for
};

/// The closed fan of triangles around a vertex, projected along its mean normal; the vertex is the origin.
struct Star {
  std::vector<std::uint32_t> ring;   ///< neighbours, counter-clockwise
  std::vector<std::uint32_t> faces;  ///< faces[i] holds ring[i] and ring[i + 1]
  std::vector<glm::dvec2> at;
  std::vector<double> height;
  double error = 0.0;
};

struct Merge {
  std::size_t target = 0;  ///< place in the ring
  double cost = 0.0, error = 0.0;
};

class Simplifier {
 public:
  Simplifier(const TriMesh& mesh, const SimplifyOptions& options) : mesh_(mesh), options_(options) {
    const std::size_t vertices = mesh.positions.size();
    faces_.reserve(mesh.triangles.size());
    head_.assign(vertices, kNone);
    next_.assign(3 * mesh.triangles.size(), kNone);
    for (const Triangle& t : mesh.triangles) {
      Face face;
      face.vertex = t;
      const glm::dvec3 normal = glm::cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0]));
      if (const double length = glm::length(normal); length > 0.0) face.normals = {normal / length, 0.0};
      const auto f = static_cast<std::uint32_t>(faces_.size());
      faces_.push_back(face);
      for (std::uint32_t k = 3; k-- > 0;) {
        next_[3 * f + k] = head_[t[k]];
        head_[t[k]] = 3 * f + k;
      }
    }
    removed_.assign(vertices, 0);
    idle_.assign(vertices, 0);
    lock_borders();
  }

  /// One visit of every vertex; merges do not touch each other's triangles. Returns the number of merges.
  std::size_t pass(double max_distance) {
    std::size_t merged = 0;
    std::vector<std::uint8_t> touched(head_.size(), 0);
    for (std::uint32_t u = 0; u < head_.size(); ++u) {
      if (removed_[u] || locked_[u] || touched[u] || idle_[u]) continue;
      idle_[u] = 1;
      if (!load_star(u)) continue;
      const std::optional<Merge> best = best_merge(max_distance);
      if (!best) continue;
      apply(u, *best);
      ++merged;
      for (const std::uint32_t v : star_.ring) {
        touched[v] = 1;
        idle_[v] = 0;
      }
    }
    return merged;
  }
  void wake_all() { std::fill(idle_.begin(), idle_.end(), std::uint8_t{0}); }

  TriMesh result() const {
    TriMesh out;
    std::vector<std::uint32_t> renamed(head_.size(), kNone), kept;
    for (std::uint32_t v = 0; v < head_.size(); ++v) {
      if (removed_[v]) continue;
      renamed[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
    }
    gather_vertices(mesh_, kept, out);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const Face& face = faces_[f];
      if (!face.alive) continue;
      out.triangles.push_back({renamed[face.vertex[0]], renamed[face.vertex[1]], renamed[face.vertex[2]]});
      if (!mesh_.triangle_partition.empty()) out.triangle_partition.push_back(mesh_.triangle_partition[f]);
      if (!mesh_.triangle_inferred.empty()) out.triangle_inferred.push_back(mesh_.triangle_inferred[f]);
    }
    out.frame = mesh_.frame;
    out.partitions = mesh_.partitions;
    out.provenance = mesh_.provenance;
    return out;
  }

 private:
  glm::dvec3 point(std::uint32_t v) const { return glm::dvec3(mesh_.positions[v]); }

  /// Vertices next to another part, and vertices that share their place with another one. Boundaries need no lock: the
  /// triangles around their vertices are no closed fan.
  void lock_borders() {
    locked_.assign(head_.size(), 0);
    std::vector<PartitionId> seen(head_.size(), PartitionTable::kNone);
    for (std::size_t t = 0; t < mesh_.triangle_partition.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t]) {
        if (seen[v] != PartitionTable::kNone && seen[v] != mesh_.triangle_partition[t]) locked_[v] = 1;
        seen[v] = mesh_.triangle_partition[t];
      }
    std::vector<std::uint32_t> order(head_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) {
      const glm::vec3& p = mesh_.positions[v];
      const auto bits = [](float c) { return std::bit_cast<std::uint32_t>(c + 0.0f); };  // orders NaN, too
      return std::array{bits(p.x), bits(p.y), bits(p.z)};
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (key(order[i]) == key(order[i - 1])) locked_[order[i]] = locked_[order[i - 1]] = 1;
    }
  }

  /// Calls visit(face, corner) for the living faces of a vertex and forgets the others.
  template <class Visit>
  void each_face(std::uint32_t v, const Visit& visit) {
    std::uint32_t* link = &head_[v];
    while (*link != kNone) {
      const std::uint32_t corner = *link;
      if (faces_[corner / 3].alive) {
        visit(corner / 3, corner % 3);
        link = &next_[corner];
      } else {
        *link = next_[corner];
      }
    }
  }

  bool load_star(std::uint32_t u) {
    spokes_.clear();
    each_face(u, [&](std::uint32_t f, std::uint32_t k) {
      const Triangle& t = faces_[f].vertex;
      spokes_.push_back({t[(k + 1) % 3], t[(k + 2) % 3], f});
    });
    if (spokes_.size() < 3 || spokes_.size() > kMaxValence) return false;
    std::sort(spokes_.begin(), spokes_.end());
    star_.ring.clear();
    star_.faces.clear();
    star_.error = 0.0;
    std::uint32_t at = spokes_[0][0];
    do {
      const auto spoke = std::lower_bound(spokes_.begin(), spokes_.end(), std::array<std::uint32_t, 3>{at, 0, 0});
      if (spoke == spokes_.end() || (*spoke)[0] != at || star_.ring.size() == spokes_.size()) return false;
      star_.ring.push_back(at);
      star_.faces.push_back((*spoke)[2]);
      star_.error = std::max(star_.error, faces_[(*spoke)[2]].error);
      at = (*spoke)[1];
    } while (at != spokes_[0][0]);
    if (star_.ring.size() != spokes_.size()) return false;  // two fans
    return project(u);
  }

  /// False where the triangles around the vertex do not all face one way, once around.
  bool project(std::uint32_t u) {
    const std::size_t n = star_.ring.size();
    const glm::dvec3 origin = point(u);
    glm::dvec3 normal(0.0);
    for (std::size_t i = 0; i < n; ++i) {
      normal += glm::cross(point(star_.ring[i]) - origin, point(star_.ring[(i + 1) % n]) - origin);
    }
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) return false;
    normal /= length;
    const glm::dvec3 off = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 e1 = glm::normalize(glm::cross(normal, off)), e2 = glm::cross(normal, e1);
    star_.at.resize(n);
    star_.height.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec3 p = point(star_.ring[i]) - origin;
      star_.at[i] = {glm::dot(p, e1), glm::dot(p, e2)};
      star_.height[i] = glm::dot(p, normal);
    }
    int turns = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec2 &p = star_.at[i], &q = star_.at[(i + 1) % n];
      if (!(cross(p, q) > 0.0)) return false;
      turns += p.y < 0.0 && q.y >= 0.0;
    }
    return turns == 1;
  }

  /// Lk(u) and Lk(v) share nothing but the two vertices opposite to the edge uv.
  bool link_condition(std::size_t k) {
    const std::size_t n = star_.ring.size();
    const std::uint32_t before = star_.ring[(k + n - 1) % n], after = star_.ring[(k + 1) % n];
    bool holds = true;
    std::size_t valence = 0;
    each_face(star_.ring[k], [&](std::uint32_t f, std::uint32_t corner) {
      ++valence;
      const Triangle& t = faces_[f].vertex;
      const std::uint32_t a = t[(corner + 1) % 3], b = t[(corner + 2) % 3];
      for (const std::uint32_t w : {a, b}) {
        holds = holds &&
                (w == before || w == after || std::find(star_.ring.begin(), star_.ring.end(), w) == star_.ring.end());
      }
      if (n == 3) holds = holds && !((a == before && b == after) || (a == after && b == before));
    });
    return holds && valence + n - 4 <= kMaxValence;
  }

  Cone merged_normals(std::size_t k, std::size_t i) const {
    const std::size_t n = star_.ring.size();
    Cone cone = faces_[star_.faces[i]].normals;
    if (i == (k + 1) % n) cone = merge(cone, faces_[star_.faces[k]].normals);
    if (i == (k + n - 2) % n) cone = merge(cone, faces_[star_.faces[(k + n - 1) % n]].normals);
    return cone;
  }

  /// Largest distance along the projection between the triangles around the vertex and those that replace them. Both
  /// are linear between their edges: the extreme is at the vertex or where an old edge crosses a new one.
  double deviation(std::size_t k) const {
    const std::size_t n = star_.ring.size();
    const auto& at = star_.at;
    const auto& height = star_.height;
    double worst = 0.0;
    for (std::size_t s = 1; s + 1 < n; ++s) {  // new triangle k, i, j: does it hold the origin?
      const std::size_t i = (k + s) % n, j = (k + s + 1) % n;
      const double wk = cross(at[i], at[j]), wi = cross(at[j], at[k]), wj = cross(at[k], at[i]);
      if (wk >= 0.0 && wi >= 0.0 && wj >= 0.0) {
        worst = std::max(worst, std::abs((wk * height[k] + wi * height[i] + wj * height[j]) / (wk + wi + wj)));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t s = 2; s + 1 < n; ++s) {
        const std::size_t j = (k + s) % n;
        if (i == k || i == j) continue;
        // a at[i] = at[k] + b (at[j] - at[k])
        const glm::dvec2 spoke = at[j] - at[k];
        const double det = cross(at[i], spoke);
        if (det == 0.0) continue;
        const double a = cross(at[k], spoke) / det, b = cross(at[k], at[i]) / det;
        if (a <= 0.0 || a >= 1.0 || b <= 0.0 || b >= 1.0) continue;
        worst = std::max(worst, std::abs(a * height[i] - (height[k] + b * (height[j] - height[k]))));
      }
    }
    return worst;
  }

  std::optional<Merge> best_merge(double max_distance) {
    std::optional<Merge> best;
    const std::size_t n = star_.ring.size();
    for (std::size_t k = 0; k < n; ++k) {
      double quality = 1.0;  // 1: equilateral
      bool allowed = true;
      for (std::size_t s = 1; s + 1 < n && allowed; ++s) {
        const std::size_t i = (k + s) % n, j = (k + s + 1) % n;
        const glm::dvec2 d1 = star_.at[i] - star_.at[k], d2 = star_.at[j] - star_.at[k], d3 = d2 - d1;
        const double area = cross(d1, d2);
        const double longest = std::max({glm::dot(d1, d1), glm::dot(d2, d2), glm::dot(d3, d3)});
        quality = std::min(quality, area / longest * 1.1547);
        allowed = area > 1e-4 * longest;  // neither turned over nor a needle
      }
      if (!allowed) continue;
      const double error = star_.error + deviation(k);
      if (!(error <= max_distance)) continue;
      const double cost = error / max_distance + 0.5 * (1.0 - quality);
      if (best && cost >= best->cost) continue;
      if (!link_condition(k)) continue;
      for (std::size_t s = 1; s + 1 < n && allowed; ++s) {
        const std::size_t i = (k + s) % n, j = (k + s + 1) % n;
        const Cone cone = merged_normals(k, i);
        const glm::dvec3 origin = point(star_.ring[k]);
        const glm::dvec3 normal = glm::cross(point(star_.ring[i]) - origin, point(star_.ring[j]) - origin);
        allowed = cone.half < 0.0 || angle_between(cone.axis, normal) + cone.half <= options_.max_angle_rad;
      }
      if (allowed) best = Merge{k, cost, error};
    }
    return best;
  }

  void apply(std::uint32_t u, const Merge& merge_into) {
    const std::size_t n = star_.ring.size(), k = merge_into.target;
    const std::uint32_t v = star_.ring[k];
    std::vector<Cone>& cones = cones_;
    cones.resize(n);
    for (std::size_t i = 0; i < n; ++i) cones[i] = merged_normals(k, i);
    for (std::size_t i = 0; i < n; ++i) {
      Face& face = faces_[star_.faces[i]];
      face.alive = i != k && i != (k + n - 1) % n;
      face.error = merge_into.error;
      face.normals = cones[i];
      std::replace(face.vertex.begin(), face.vertex.end(), u, v);
    }
    std::uint32_t last = head_[u];
    while (next_[last] != kNone) last = next_[last];
    next_[last] = head_[v];
    head_[v] = head_[u];
    head_[u] = kNone;
    removed_[u] = 1;
  }

  const TriMesh& mesh_;
  SimplifyOptions options_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> head_, next_;  ///< corners 3 f + k of a vertex, linked
  std::vector<std::uint8_t> locked_, removed_;
  std::vector<std::uint8_t> idle_;  ///< nothing changed around it since it was last looked at
  std::vector<std::array<std::uint32_t, 3>> spokes_;
  std::vector<Cone> cones_;
  Star star_;
};

}  // namespace

Result<TriMesh> simplify(const TriMesh& mesh, const SimplifyOptions& options, Progress& progress) {
  if (!(options.max_angle_rad >= 0.0 && options.max_angle_rad <= kPi / 2) ||
      !(options.max_distance_vox > 0.0 && std::isfinite(options.max_distance_vox))) {
    return fail(ErrorKind::kUsage,
                "simplify: angle {} rad and distance {} voxels found, expected 0 to pi/2 and more than 0",
                options.max_angle_rad, options.max_distance_vox);
  }
  for (const Triangle& t : mesh.triangles) {
    if (std::ranges::max(t) >= mesh.positions.size()) {
      return fail(ErrorKind::kBadData, "simplify: a triangle names vertex {}, the mesh has {}", std::ranges::max(t),
                  mesh.positions.size());
    }
  }
  if (mesh.triangles.size() >= kNone / 3)
    return fail(ErrorKind::kTryAgain, "simplify: {} triangles found, expected at most {}; take one part at a time",
                mesh.triangles.size(), kNone / 3);
  Simplifier simplifier(mesh, options);
  // The distance grows from pass to pass, so that merges that cost nothing come first everywhere.
  const auto vertices = static_cast<std::int64_t>(mesh.positions.size());
  for (const double part : {0.05, 0.1, 0.2, 0.4, 0.7, 1.0}) {
    simplifier.wake_all();
    for (std::size_t merged = 1; merged > 0;) {
      if (progress.cancelled()) return cancelled_error();
      merged = simplifier.pass(part * options.max_distance_vox);
      progress.advance(static_cast<std::int64_t>(merged));
    }
  }
  TriMesh result = simplifier.result();
  progress.advance(static_cast<std::int64_t>(result.positions.size()));  // merged + kept = all
  DUBSAR_CHECK(static_cast<std::int64_t>(result.positions.size()) <= vertices);
  return result;
}

}  // namespace dubsar
