#include "display/render/multi_view.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "display/render/lod.h"

namespace dubsar {
namespace {

constexpr double kFinestGrid = 1024, kCoarsestGrid = 63.9, kGridStep = 0.70710678118654752;  // half the triangles each
constexpr double kMostShiftPx = 16;   // between drawn views; more leaves wide holes
constexpr double kWorthwhile = 0.75;  // of the triangles of the finer level

}  // namespace

double mm_per_pixel_at(const View& view, const glm::dvec3& point, int width_px) {
  const glm::dvec4 at = view.view_from_world * glm::dvec4(point, 1.0);
  const double w = (view.clip_from_view * at).w;
  const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(view.view_from_world))));
  return 2.0 * std::abs(w) / (std::abs(view.clip_from_view[0][0]) * width_px * scale);
}

std::vector<int> key_views(int count, int keys) {
  if (keys <= 0 || keys >= count) keys = count;
  std::vector<int> out(static_cast<std::size_t>(keys));
  for (int i = 0; i < keys; ++i)
    out[static_cast<std::size_t>(i)] =
        keys == 1 ? count / 2
                  : static_cast<int>((2 * static_cast<std::int64_t>(i) * (count - 1) + keys - 1) / (2 * (keys - 1)));
  return out;
}

Result<MultiView> MultiView::create(PackedMesh mesh, const MultiViewOptions& options) {
  MultiView out;
  out.options_ = options;
  DUBSAR_ASSIGN(out.renderer_, Renderer::create());
  DUBSAR_ASSIGN(out.reprojector_, Reprojector::create());
  const glm::dvec3 size = mesh.box_mm.size();
  const double longest = std::max({size.x, size.y, size.z});
  const auto add = [&](PackedMesh& level, double cell_mm) -> Result<void> {
    sort_into_chunks(level);
    DUBSAR_ASSIGN(GpuMesh gpu, GpuMesh::upload(level));
    out.levels_.push_back({std::move(gpu), cell_mm, static_cast<std::int64_t>(level.triangles.size())});
    return {};
  };
  DUBSAR_TRY(add(mesh, 0.0));
  for (double grid = kFinestGrid; options.cell_px > 0 && grid >= kCoarsestGrid && longest > 0; grid *= kGridStep) {
    PackedMesh coarser = cluster_vertices(mesh, longest / grid);
    if (coarser.triangles.empty()) break;
    if (static_cast<double>(coarser.triangles.size()) > kWorthwhile * static_cast<double>(mesh.triangles.size()))
      continue;
    DUBSAR_TRY(add(coarser, longest / grid));
    mesh = std::move(coarser);
  }
  return out;
}

int MultiView::level_for(double mm_per_pixel) const noexcept {
  int best = 0;
  for (int i = 1; i < levels(); ++i)
    if (levels_[static_cast<std::size_t>(i)].cell_mm <= options_.cell_px * mm_per_pixel) best = i;
  return best;
}

Result<void> MultiView::draw_moving(const Shading& shading, std::span<const View> views, ViewArray& target) {
  DUBSAR_CHECK(static_cast<int>(views.size()) <= target.layers());
  coarse_ = static_cast<int>(views.size());
  if (views.empty()) return {};
  const Box& box = levels_[0].mesh.box_mm();
  const std::vector<int> layers = key_views(coarse_, keys_for(views, target, box));
  std::vector<View> drawn;
  double finest = mm_per_pixel_at(views[0], box.centre(), target.width());
  for (const int layer : layers) {
    drawn.push_back(views[static_cast<std::size_t>(layer)]);
    finest = std::min(finest, mm_per_pixel_at(drawn.back(), box.centre(), target.width()));
  }
  const Level& level = levels_[static_cast<std::size_t>(level_for(finest))];
  DUBSAR_TRY(renderer_.render_layers(level.mesh, shading, drawn, layers, target));
  if (static_cast<int>(layers.size()) == coarse_) return {};
  return reprojector_.fill(target, renderer_.layer_depths(), views, layers, box);
}

int MultiView::keys_for(std::span<const View> views, const ViewArray& target, const Box& box) const {
  const int all = static_cast<int>(views.size());
  if (options_.key_views <= 0 || options_.key_views >= all) return all;
  for (std::size_t i = 1; i < views.size(); ++i)
    if (!row_shift(views[0], views[i], target.width(), target.height())) return all;
  const DepthRange depth = depth_range(views[0], box);
  const RowShift shift = *row_shift(views[0], views.back(), target.width(), target.height());
  const double apart = std::abs(shift.at(depth.farthest) - shift.at(depth.nearest));
  return std::min(all, std::max(options_.key_views, 1 + static_cast<int>(std::ceil(apart / kMostShiftPx))));
}

Result<int> MultiView::refine(const Shading& shading, std::span<const View> views, int samples, ViewArray& target,
                              int most) {
  const int count = static_cast<int>(views.size());
  DUBSAR_CHECK(coarse_ <= count && count <= target.layers());
  for (; most > 0 && coarse_ > 0; --most, --coarse_) {
    const int done = count - coarse_;  // 0, 1, 2, 3 are the middle, one to the right, one to the left, ...
    const int index = (count - 1) / 2 + (done % 2 == 1 ? (done + 1) / 2 : -(done / 2));
    DUBSAR_TRY(renderer_.render(levels_[0].mesh, shading, views.subspan(static_cast<std::size_t>(index), 1), samples,
                                target, index));
  }
  return coarse_;
}

Result<void> MultiView::draw_exact(const Shading& shading, std::span<const View> views, int samples,
                                   ViewArray& target) {
  coarse_ = 0;
  return renderer_.render(levels_[0].mesh, shading, views, samples, target);
}

}  // namespace dubsar
