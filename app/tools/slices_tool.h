#pragma once
// Slices of the scan in a session: beside the surface, and on it.

#include <memory>

#include "app/tools/slice_pictures.h"
#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"

namespace dubsar::app {

class SlicesTool final : public Tool {
 public:
  explicit SlicesTool(ToolScene& scene) : scene_(scene) {}
  /// Another surface: its scan, if there is one.
  void begin(std::optional<ScanLink> link);
  void end() { pictures_.reset(); }
  bool shown() const { return scene_.ui().panels && scene_.ui().drawer == "slices" && scene_.has_surface(); }
  /// The surface stands to the right of the window's middle while slices are beside it.
  void update(TimestampNs now) override;
  void contribute(Shown& shown) override;
  const SlicePanelState& state() const noexcept { return pictures_->state(); }
  Result<Image> whole(std::size_t which) { return pictures_->whole(scene_.document().scan, which); }

 private:
  ToolScene& scene_;
  std::unique_ptr<SlicePictures> pictures_;
};

}  // namespace dubsar::app
