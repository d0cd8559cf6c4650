#include "display/render/multi_view.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "core/base/system/clock.h"

namespace dubsar {
namespace {

constexpr double kMostMergedPx = 12;
constexpr double kRoom = 0.4, kFiner = 0.8409;  // of the budget, before twice the triangles are tried in two steps
constexpr double kMostShiftPx = 16;             // between drawn views; more leaves wide holes

/// 0, 1, 2, 3 that are done are the middle, one to the right, one to the left, ...
int next_view(int count, int coarse) {
  const int done = count - coarse;
  return (count - 1) / 2 + (done % 2 == 1 ? (done + 1) / 2 : -(done / 2));
}

}  // namespace

std::vector<int> key_views(int count, int keys) {
  if (keys <= 0 || keys >= count) keys = count;
  std::vector<int> out(static_cast<std::size_t>(keys));
  for (int i = 0; i < keys; ++i)
    out[static_cast<std::size_t>(i)] =
        keys == 1 ? count / 2
                  : static_cast<int>((2 * static_cast<std::int64_t>(i) * (count - 1) + keys - 1) / (2 * (keys - 1)));
  return out;
}

Result<MultiView> MultiView::create(const MultiViewOptions& options) {
  MultiView out;
  out.options_ = options;
  out.coarse_px_ = options.budget_ms > 0 ? kMostMergedPx : options.cell_px;
  DUBSAR_ASSIGN(out.renderer_, Renderer::create());
  DUBSAR_ASSIGN(out.reprojector_, Reprojector::create());
  return out;
}

Result<void> MultiView::draw_moving(const SceneView& scene, std::span<const View> views, ViewArray& target,
                                    int pictures) {
  DUBSAR_CHECK(static_cast<int>(views.size()) <= target.layers());
  coarse_ = static_cast<int>(views.size());
  renderer_.restart_pieces();
  if (views.empty()) return {};
  DUBSAR_TRY(check_scene(scene));
  const TimestampNs start = SteadyClock().now();
  const Box box = scene_box_mm(scene);
  const std::vector<int> layers = key_views(coarse_, keys_for(views, target, box));
  std::vector<View> drawn;
  for (const int layer : layers) drawn.push_back(views[static_cast<std::size_t>(layer)]);
  DUBSAR_TRY(renderer_.render_layers(scene, drawn, layers, target, coarse_px_));
  if (static_cast<int>(layers.size()) < coarse_)
    DUBSAR_TRY(reprojector_.fill(target, renderer_.layer_depths(), views, layers, box));
  if (options_.budget_ms > 0) {
    glFinish();
    took(1e-6 * pictures * static_cast<double>(SteadyClock().now() - start));
  }
  return {};
}

/// Triangles grow with the square of what is not merged.
void MultiView::took(double ms) {
  if (ms > options_.budget_ms)
    coarse_px_ = std::min(kMostMergedPx, coarse_px_ * std::min(2.0, std::sqrt(ms / options_.budget_ms)));
  else if (ms < kRoom * options_.budget_ms)
    coarse_px_ = std::max(options_.cell_px, coarse_px_ * kFiner);
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

Result<int> MultiView::refine(const SceneView& scene, std::span<const View> views, int samples, ViewArray& target,
                              int most) {
  const int count = static_cast<int>(views.size());
  DUBSAR_CHECK(coarse_ <= count && count <= target.layers());
  for (; most > 0 && coarse_ > 0; --most, --coarse_) {
    const int index = next_view(count, coarse_);
    DUBSAR_TRY(renderer_.render(scene, views.subspan(static_cast<std::size_t>(index), 1), samples, target, index));
  }
  return coarse_;
}

Result<int> MultiView::refine_until(TimestampNs end, const SceneView& scene, std::span<const View> views, int samples,
                                    ViewArray& target) {
  const int count = static_cast<int>(views.size());
  DUBSAR_CHECK(coarse_ <= count && count <= target.layers());
  while (coarse_ > 0) {
    const int index = next_view(count, coarse_);
    DUBSAR_ASSIGN(const bool whole,
                  renderer_.render_some(scene, views[static_cast<std::size_t>(index)], samples, target, index, end));
    if (whole) {
      --coarse_;
      glFinish();
    }
    if (!whole || SteadyClock().now() >= end) break;
  }
  return coarse_;
}

void MultiView::begin_refining(int views) {
  renderer_.restart_pieces();
  coarse_ = views;
}

Result<void> MultiView::draw_exact(const SceneView& scene, std::span<const View> views, int samples,
                                   ViewArray& target) {
  coarse_ = 0;
  return renderer_.render(scene, views, samples, target);
}

}  // namespace dubsar
