#include "core/exa/settle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/base/parallel.h"
#include "core/exa/attributes.h"
#include "core/exa/exact.h"
#include "core/extract/extract.h"
#include "core/relief/normal_filter.h"
#include "core/relief/shape_class.h"
#include "core/relief/smooth.h"

namespace dubsar {
namespace {
constexpr std::int64_t kGrain = 1 << 13;
constexpr int kFitSteps = 8;     // more than 8 change the error by less than 1 %
constexpr double kSteep = 0.15;  // cosine between edge and normal below which they hardly cross
constexpr double kDamping = 0.05;
constexpr double kOutsideHalf = 0.045;  // vertices that may lie further than half the bound
// Seven wide steps come nearer to 32 narrow ones than 16 narrow ones do: .9 degrees on a phantom of 31 dB.
constexpr int kNormalIterations = 7;
constexpr float kNormalEpsilon = 0.03f;

/// An active edge inside the grid and its x-quad.
struct FitEdge {
  std::array<std::int32_t, 3> low{};
  std::int32_t axis = 0;
  std::uint32_t offset = 0;  ///< its place in samples.offsets
};

/// One per x-quad of real edges: quad q is that of edge q.
std::vector<FitEdge> edges_of_quads(const SurfaceSamples& samples) {
  const Dims& d = samples.dims;
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z};
  std::vector<FitEdge> edges;
  edges.reserve(samples.offsets.size());
  std::uint32_t number = 0;
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y) {
      const std::uint64_t* here = samples.signs.row(y, z);
      for (std::int32_t axis = 0; axis < 3; ++axis) {
        if ((axis == 1 && y + 1 == d.y) || (axis == 2 && z + 1 == d.z)) continue;
        const std::uint64_t* other = axis == 1 ? samples.signs.row(y + 1, z) : samples.signs.row(y, z + (axis == 2));
        const std::int64_t words = samples.signs.words_per_row();
        for (std::int64_t w = 0; w < words; ++w) {
          std::uint64_t active =
              axis == 0 ? here[w] ^ (here[w] >> 1 | (w + 1 < words ? here[w + 1] << 63 : 0)) : here[w] ^ other[w];
          const std::int64_t end = axis == 0 ? d.x - 1 : d.x;
          if (end - 64 * w < 64) active &= (std::uint64_t{1} << std::max<std::int64_t>(0, end - 64 * w)) - 1;
          for (; active != 0; active &= active - 1, ++number) {
            const std::array<std::int64_t, 3> p{64 * w + std::countr_zero(active), y, z};
            bool in_face = false;  // an open mesh has no x-quad for the edges in its boundary
            for (int a = 0; a < 3 && !samples.closed; ++a) {
              const auto i = static_cast<std::size_t>(a);
              in_face = in_face || (a != axis && (p[i] == 0 || p[i] == size[i] - 1));
            }
            if (!in_face)
              edges.push_back(
                  {{static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]), static_cast<std::int32_t>(p[2])},
                   axis,
                   number});
          }
        }
      }
    }
  return edges;
}

double triangle_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, n = glm::cross(ab, ac);
  const double area = glm::dot(n, n);
  const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), n) >= 0.0;
  };
  if (area > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(glm::dot(p - a, n)) / std::sqrt(area);
  const auto side = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 along = to - from;
    const double length = glm::dot(along, along);
    const double t = length > 0.0 ? std::clamp(glm::dot(p - from, along) / length, 0.0, 1.0) : 0.0;
    return glm::length(p - from - t * along);
  };
  return std::min({side(a, b), side(b, c), side(c, a)});
}

/// From a place to the x-quads around a vertex, each cut in both ways.
double distance_to_fan(const QuadMesh& mesh, std::uint32_t v, const glm::dvec3& p) {
  double least = glm::length(p - glm::dvec3(mesh.positions[v]));
  for (const std::uint32_t q : mesh.quads_of(v)) {
    const Polygon polygon = mesh.polygon(q);
    const auto at = [&](int i) {
      return glm::dvec3(mesh.positions[polygon.vertex[static_cast<std::size_t>(i % polygon.size)]]);
    };
    for (int start = 0; start < 2; ++start)
      for (int i = 1; i + 1 < polygon.size; ++i)
        least = std::min(least, triangle_distance(p, at(start), at(start + i), at(start + i + 1)));
  }
  return least;
}

class OffsetFit {
 public:
  OffsetFit(const SurfaceModel& model, const QuadMesh& base, std::span<const glm::vec3> normals)
      : mesh_(model.mesh), base_(base), normals_(normals), edges_(edges_of_quads(model.samples)) {
    steps_ = 1 << model.samples.offset_bits;
    DUBSAR_CHECK(edges_.size() <= model.mesh.quads.size());
    before_.resize(edges_.size());
    t_.resize(edges_.size());
    parallel_for(static_cast<std::int64_t>(edges_.size()), kGrain, [&](std::int64_t i) {
      const auto e = static_cast<std::size_t>(i);
      before_[e] = static_cast<float>((model.samples.offsets[edges_[e].offset] + 0.5) / steps_);
      t_[e] = static_cast<float>(std::clamp(cut(static_cast<std::uint32_t>(e)), 0.0, 1.0));
    });
    residual_.resize(base.positions.size());
  }

  /// Moves the crossings until the vertices lie on the surface, as far as the edges reach.
  void improve() {
    parallel_for(static_cast<std::int64_t>(residual_.size()), kGrain, [&](std::int64_t i) {
      const auto v = static_cast<std::size_t>(i);
      residual_[v] = glm::dot(normals_[v], mesh_.positions[v] - place(static_cast<std::uint32_t>(v)));
    });
    parallel_for(static_cast<std::int64_t>(edges_.size()), kGrain, [&](std::int64_t i) {
      const auto e = static_cast<std::size_t>(i);
      const Polygon polygon = mesh_.polygon(static_cast<std::uint32_t>(e));
      double sum = 0.0, weight = kDamping;
      for (int k = 0; k < polygon.size; ++k) {
        const std::uint32_t v = polygon.vertex[static_cast<std::size_t>(k)];
        const double along = normals_[v][edges_[e].axis];
        sum += residual_[v] * along;
        weight += along * along;
      }
      t_[e] = static_cast<float>(std::clamp(t_[e] + sum / weight, 0.0, 1.0));
    });
  }

  void store(SurfaceSamples& samples) const {
    for (std::size_t e = 0; e < edges_.size(); ++e)
      samples.offsets[edges_[e].offset] =
          static_cast<std::uint16_t>(std::min(steps_ - 1, static_cast<int>(t_[e] * static_cast<float>(steps_))));
  }

 private:
  /// Where the mean plane of an edge's x-quad cuts it.
  double cut(std::uint32_t e) const {
    const Polygon polygon = mesh_.polygon(e);
    const auto at = [&](int i) {
      return glm::dvec3(mesh_.positions[polygon.vertex[static_cast<std::size_t>(i % polygon.size)]]);
    };
    glm::dvec3 centre(0.0), normal(0.0);
    for (int i = 0; i < polygon.size; ++i) centre += at(i);
    centre /= polygon.size;
    for (int i = 0; i < polygon.size; ++i) normal += glm::cross(at(i) - centre, at(i + 1) - centre);
    const FitEdge& edge = edges_[e];
    const glm::dvec3 from = centre - glm::dvec3(edge.low[0], edge.low[1], edge.low[2]);
    const double length = glm::length(normal), along = normal[edge.axis];
    return std::abs(along) > kSteep * length ? glm::dot(normal, from) / along : from[edge.axis];
  }
  /// The vertex that the present crossings give.
  glm::vec3 place(std::uint32_t v) const {
    glm::vec3 moved(0.0f);
    const auto quads = mesh_.quads_of(v);
    for (const std::uint32_t q : quads)
      if (q < edges_.size()) moved[edges_[q].axis] += t_[q] - before_[q];
    return base_.positions[v] + moved / static_cast<float>(quads.size());
  }

  const QuadMesh& mesh_;
  const QuadMesh& base_;
  std::span<const glm::vec3> normals_;
  std::vector<FitEdge> edges_;
  std::vector<float> before_, t_, residual_;
  int steps_ = 1;
};

/// Distances of `mesh.positions` from the surface of `wanted`; vertices out of bounds get a place of their own.
void let_escape(const QuadMesh& wanted, double bound, std::vector<glm::vec3>& positions, SettleStats& stats) {
  std::vector<float> error(positions.size());
  parallel_for(static_cast<std::int64_t>(positions.size()), kGrain, [&](std::int64_t i) {
    const auto v = static_cast<std::size_t>(i);
    error[v] = static_cast<float>(distance_to_fan(wanted, static_cast<std::uint32_t>(v), glm::dvec3(positions[v])));
  });
  std::vector<float> sorted = error;
  std::sort(sorted.begin(), sorted.end());
  const auto kept = static_cast<std::size_t>((1.0 - kOutsideHalf) * static_cast<double>(sorted.size()));
  double limit = bound;
  if (kept < sorted.size() && sorted[kept] > 0.5 * bound) {
    // The worst go first: those left between half the bound and the limit are few enough.
    const auto within = static_cast<std::size_t>(
        std::upper_bound(sorted.begin(), sorted.end(), static_cast<float>(0.5 * bound)) - sorted.begin());
    const auto spare = static_cast<std::size_t>(kOutsideHalf * static_cast<double>(sorted.size()));
    limit = std::min<double>(bound, within + spare < sorted.size() ? sorted[within + spare] : bound);
  }
  std::int64_t gone = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (!(error[v] > limit)) continue;
    const auto k = escape_to(positions[v], wanted.positions[v]);
    if (!k) continue;
    positions[v] = escaped(positions[v], *k);
    error[v] = glm::length(positions[v] - wanted.positions[v]);
    ++gone;
  }
  if (error.empty()) return;
  stats.escaped_fraction = static_cast<double>(gone) / static_cast<double>(error.size());
  double sum = 0.0;
  for (const float e : error) sum += e;
  stats.mean_error_vox = sum / static_cast<double>(error.size());
  std::sort(error.begin(), error.end());
  stats.p95_error_vox = error[error.size() * 95 / 100];
  stats.max_error_vox = error.back();
}

bool same_positions(std::span<const glm::vec3> a, std::span<const glm::vec3> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}
}  // namespace

Result<std::vector<glm::vec3>> recomputed_normals(const QuadMesh& mesh, Progress& progress) {
  std::vector<glm::vec4> faces = face_normals(mesh);
  DUBSAR_ASSIGN(const FaceNeighbours neighbours, FaceNeighbours::build(mesh, progress));
  NormalFilterOptions options;
  options.iterations = kNormalIterations;
  options.epsilon = kNormalEpsilon;
  DUBSAR_TRY(filter_normals(neighbours, options, faces, progress));
  return vertex_normals(mesh, faces);
}

Result<SettleStats> settle_for_exa(SurfaceModel& model, const SettleOptions& options, Progress& progress) {
  if (!(options.max_error > 0.0f))
    return fail(ErrorKind::kUsage, "exa: the largest error is {}, a positive number expected", options.max_error);
  SettleStats stats;
  DUBSAR_ASSIGN(QuadMesh base, build_quad_mesh(model.samples, progress));
  if (base.positions.size() != model.mesh.positions.size() || base.quads != model.mesh.quads)
    return fail(ErrorKind::kInternal, "exa: the mesh of {} vertices is not the one that the samples give ({} vertices)",
                model.mesh.positions.size(), base.positions.size());
  VertexAttributes& attributes = model.attributes;
  settle_light(model.mesh, attributes.ao, progress);
  const bool settled = same_positions(base.positions, model.mesh.positions) ||
                       encode_escapes(base, model.mesh.positions, progress).has_value();
  if (!settled) {
    progress.begin("settle", kFitSteps, "step");
    const std::vector<glm::vec3> normals =
        attributes.normals.empty() ? vertex_normals(model.mesh, face_normals(model.mesh)) : attributes.normals;
    OffsetFit fit(model, base, normals);
    for (int step = 0; step < kFitSteps; ++step) {
      if (progress.cancelled()) return cancelled_error();
      fit.improve();
      progress.advance(1);
    }
    fit.store(model.samples);
    progress.end();
    DUBSAR_ASSIGN(QuadMesh fitted, build_quad_mesh(model.samples, progress));
    let_escape(model.mesh, options.max_error, fitted.positions, stats);
    model.mesh.positions = std::move(fitted.positions);
  }
  if (options.exact_normals || attributes.normals.empty()) return stats;
  DUBSAR_ASSIGN(std::vector<glm::vec3> normals, recomputed_normals(model.mesh, progress));
  double angles = 0.0;
  for (std::size_t v = 0; v < normals.size(); ++v)
    angles += std::acos(std::clamp<double>(glm::dot(glm::dvec3(normals[v]), glm::dvec3(attributes.normals[v])), -1, 1));
  if (!normals.empty()) stats.normal_error_deg = angles / static_cast<double>(normals.size()) * 57.29577951308232;
  attributes.normals = std::move(normals);
  if (attributes.k_min.empty()) return stats;
  DUBSAR_ASSIGN(Curvatures curvatures,
                principal_curvatures(model.mesh, attributes.normals, options.curvature, progress));
  attributes.k_min = std::move(curvatures.k_min);
  attributes.k_max = std::move(curvatures.k_max);
  if (attributes.shape.empty()) return stats;
  std::vector<std::uint8_t> shape = shape_classes(attributes.k_min, attributes.k_max);
  std::size_t changed = 0;
  for (std::size_t v = 0; v < shape.size(); ++v) changed += shape[v] != attributes.shape[v] ? 1u : 0u;
  stats.shape_changed_fraction = static_cast<double>(changed) / static_cast<double>(shape.size());
  attributes.shape = std::move(shape);
  return stats;
}

}  // namespace dubsar
