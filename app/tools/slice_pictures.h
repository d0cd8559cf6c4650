#pragma once
// The slices of a session: what is asked of the scan's reader, and its pictures in graphics memory.

#include <memory>
#include <optional>

#include "app/slices/scan_link.h"
#include "app/slices/slice_state.h"
#include "core/image_io/image.h"
#include "display/render/context/gl_objects.h"
#include "display/render/scene.h"

namespace dubsar::app {

/// One thread: that of the GL context. Nothing here waits for a file but wait() and whole().
class SlicePictures {
 public:
  /// `mesh` outlives it; `box_mm` is that of the mesh. Nothing is opened before the first update().
  SlicePictures(const TriMesh& mesh, const Box& box_mm, std::optional<ScanLink> link);

  /// Asks for what `view` shows at these places of a layout whose pixels are `px` each way, and takes in what there is.
  void update(const ScanView& view, const std::array<PanelRect, kSlices>& rects, const glm::dvec2& px);
  /// Returns when update() finds everything exact.
  void wait();
  const SlicePanelState& state() const noexcept { return state_; }
  /// On the surface: the place that slices go through, and where the free slice, or the large one, cuts it. `parts`
  /// stand where they are shown.
  std::vector<LinesItem> lines(const ScanView& view, const PartLooks& parts) const;
  /// One slice, exact, a pixel for each voxel, with its outline; without a scan the outline alone. kTryAgain: larger
  /// than 8192 pixels; errors of the scan.
  Result<Image> whole(const ScanView& view, std::size_t which);

 private:
  void shade(SlicePane& pane, GlTexture& texture) const;
  void find_greys(const ScanView& view);

  const TriMesh& mesh_;
  std::optional<ScanLink> link_;
  double whole_mm_ = 1.0;
  std::unique_ptr<SliceReader> reader_;
  SlicePanelState state_;
  std::array<GlTexture, kSlices> textures_;
  std::optional<std::array<double, 2>> greys_;  ///< of the scan: black and white
  bool greys_exact_ = false;
};

}  // namespace dubsar::app
