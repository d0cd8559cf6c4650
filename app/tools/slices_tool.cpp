#include "app/tools/slices_tool.h"

#include <algorithm>

namespace dubsar::app {
namespace {

constexpr double kToolsWidth = 82.0, kTabWidth = 90.0;  // what stands at the sides besides

}  // namespace

void SlicesTool::begin(std::optional<ScanLink> link) {
  pictures_ = std::make_unique<SlicePictures>(*scene_.mesh, scene_.stage->box_mm(), std::move(link));
}

void SlicesTool::update(TimestampNs) {
  const glm::dvec2& layout = scene_.window.layout;
  const double taken = static_cast<double>(slices_width(static_cast<float>(layout.x))) + kTabWidth - kToolsWidth;
  scene_.window.aside = shown() ? -0.5 * taken / layout.y : 0.0;
}

void SlicesTool::contribute(Shown& shown) {
  if (!this->shown()) return;
  const SinkTraits traits = scene_.stage->traits();
  const glm::dvec2& layout = scene_.window.layout;
  const ScanView& view = scene_.document().scan;
  const glm::dvec2 px = glm::dvec2(traits.view.width, traits.view.height) / layout;
  pictures_->update(view, scene_.window.slices, px);
  if (scene_.window.waits) {  // the same script gives the same pictures
    pictures_->wait();
    pictures_->update(view, scene_.window.slices, px);
  }
  const double left =
      layout.x - static_cast<double>(slices_width(static_cast<float>(layout.x))) - kTabWidth - kToolsWidth;
  shown.view.pan.x += scene_.window.aside;
  shown.fit *= std::min(1.0, left / std::min(layout.x, layout.y));
  for (LinesItem& lines : pictures_->lines(view, shown.parts)) shown.marks.lines.push_back(std::move(lines));
}

}  // namespace dubsar::app
