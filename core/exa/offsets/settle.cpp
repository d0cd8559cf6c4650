#include "core/exa/offsets/settle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/exa/offsets/escape_choice.h"
#include "core/exa/offsets/offset_fit.h"
#include "core/exa/values/attributes.h"
#include "core/exa/values/exact.h"
#include "core/extract/cell_box.h"
#include "core/extract/extract.h"
#include "core/extract/piece_moves.h"
#include "core/extract/quad_cuts.h"
#include "core/relief/curvature/shape_class.h"
#include "core/relief/smoothing/face_median.h"
#include "core/relief/smoothing/smooth.h"

namespace dubsar {
namespace {
constexpr int kFitSteps = 8;  // more than 8 change the error by less than 1 %
// Seven wide steps come nearer to 32 narrow ones than 16 narrow ones do: .9 degrees on a phantom of 31 dB.
constexpr int kNormalIterations = 7;
constexpr float kNormalEpsilon = 0.03f;
constexpr std::int64_t kAngleGrain = 1 << 14;

/// Of some numbers, 8 bytes at a time: each step can be undone, so that no single change gets lost.
template <class T>
std::uint64_t sum_of(std::uint64_t sum, const std::vector<T>& items) {
  constexpr std::uint64_t kPrime = 0x9E3779B97F4A7C15U;
  constexpr std::int64_t kSumGrain = 1 << 16;
  const auto step = [](std::uint64_t before, std::uint64_t word) { return std::rotl((before ^ word) * kPrime, 29); };
  const auto sum_part = [&](std::int64_t begin, std::int64_t end) {
    const auto bytes =
        std::as_bytes(std::span(items))
            .subspan(static_cast<std::size_t>(begin) * sizeof(T), static_cast<std::size_t>(end - begin) * sizeof(T));
    std::uint64_t part = kPrime;
    for (std::size_t at = 0; at < bytes.size(); at += sizeof part) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
      part = step(part, word);
    }
    return part;
  };
  return parallel_reduce(static_cast<std::int64_t>(items.size()), kSumGrain, step(sum, items.size()), sum_part, step);
}

bool same_positions(std::span<const glm::vec3> a, std::span<const glm::vec3> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}
/// Gives the samples the crossings with which the vertices lie on the surface of the model. `places`: those of its
/// vertices with the crossings as they are.
Result<void> fit_offsets(SurfaceModel& model, std::span<const glm::vec3> places, std::span<const glm::vec3> normals,
                         float bound, Progress& progress) {
  progress.begin("settle", kFitSteps, "step");
  OffsetFit fit(model, places, normals, bound);
  for (int step = 0; step < kFitSteps; ++step) {
    if (progress.cancelled()) return cancelled_error();
    fit.improve();
    progress.advance(1);
  }
  DUBSAR_TRY(fit.store(model.samples, progress));
  progress.end();
  return {};
}

/// At the few cells where polygons touch vertices escape to places where they do not.
Result<PieceMoves> part_settled_pieces(SurfaceModel& model, Progress& progress) {
  if (find_cuts(model.mesh).touching.empty()) return PieceMoves{};
  DUBSAR_ASSIGN(const QuadMesh base, build_quad_mesh(model.samples, progress));
  return part_pieces(model.mesh, base.positions, [&](std::uint32_t v, const glm::vec3& wanted) {
    const glm::vec3& from = base.positions[v];
    const auto k = escape_to(from, kept_in_cell(from, wanted));
    return k ? escaped(from, *k) : from;
  });
}
}  // namespace

std::uint64_t settled_sum(const SurfaceModel& model) {
  const VertexAttributes& a = model.attributes;
  return std::max<std::uint64_t>(1,
                                 sum_of(sum_of(sum_of(sum_of(0, model.mesh.positions), a.normals), a.k_min), a.k_max));
}

Result<std::vector<glm::vec3>> recomputed_normals(const QuadMesh& mesh, Progress& progress) {
  LargeArray<glm::vec4> faces(mesh.quads.size());
  fill_face_normals(mesh, faces);
  NormalFilterOptions options;
  options.iterations = kNormalIterations;
  options.epsilon = kNormalEpsilon;
  DUBSAR_TRY(filter_face_normals(mesh, options, faces, progress));
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
  std::vector<glm::vec3> places = std::move(base.positions);
  base = {};  // memory is scarcest here: nothing stays that is not needed any more
  if (!settled) {
    std::vector<glm::vec3> made;
    if (attributes.normals.empty()) made = vertex_normals(model.mesh, face_normals(model.mesh));
    const std::span<const glm::vec3> normals = attributes.normals.empty() ? made : attributes.normals;
    DUBSAR_TRY(fit_offsets(model, places, normals, options.max_error, progress));
    places = {};
    DUBSAR_ASSIGN(QuadMesh fitted, build_quad_mesh(model.samples, progress));
    std::vector<glm::vec3> positions = std::move(fitted.positions);
    fitted = {};
    let_escape(model.mesh, normals, options.max_error, positions, stats);
    model.mesh.positions = std::move(positions);
  }
  if (model.mesh.embedded) {
    DUBSAR_ASSIGN(const PieceMoves moves, part_settled_pieces(model, progress));
    stats.touching_cells = moves.left;
  }
  if (options.exact_normals || attributes.normals.empty()) return stats;
  DUBSAR_ASSIGN(std::vector<glm::vec3> normals, recomputed_normals(model.mesh, progress));
  const double angles = parallel_reduce(
      static_cast<std::int64_t>(normals.size()), kAngleGrain, 0.0,
      [&](std::int64_t begin, std::int64_t end) {
        double sum = 0.0;
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v)
          sum += 2.0 * std::asin(std::min(  // 0 where they are the same, however rounded
                           1.0, 0.5 * glm::length(glm::dvec3(normals[v]) - glm::dvec3(attributes.normals[v]))));
        return sum;
      },
      [](double a, double b) { return a + b; });
  if (!normals.empty()) stats.normal_error_deg = angles / static_cast<double>(normals.size()) * 57.29577951308232;
  attributes.normals = std::move(normals);
  if (attributes.k_min.empty()) return stats;
  DUBSAR_ASSIGN(Curvatures curvatures,
                principal_curvatures(model.mesh, attributes.normals, options.curvature, progress));
  attributes.k_min = std::move(curvatures.k_min);
  attributes.k_max = std::move(curvatures.k_max);
  if (options.curvature == CurvatureMethod::kFit) model.settled_sum = settled_sum(model);
  if (attributes.shape.empty()) return stats;
  std::vector<std::uint8_t> shape = shape_classes(attributes.k_min, attributes.k_max);
  std::size_t changed = 0;
  for (std::size_t v = 0; v < shape.size(); ++v) changed += shape[v] != attributes.shape[v] ? 1u : 0u;
  stats.shape_changed_fraction = static_cast<double>(changed) / static_cast<double>(shape.size());
  attributes.shape = std::move(shape);
  return stats;
}

}  // namespace dubsar
