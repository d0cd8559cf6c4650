#pragma once
// Slices of the scan in a session: beside the surface, and on it.

#include <memory>

#include "app/tools/slice_desk.h"
#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"

namespace dubsar::app {

class SlicesTool final : public Tool {
 public:
  explicit SlicesTool(ToolScene& scene) : scene_(scene) {}
  /// Another surface: its scan, if there is one.
  void begin(std::optional<ScanLink> link);
  void end() { desk_.reset(); }
  bool shown() const { return scene_.desk().panels && scene_.desk().drawer == "slices" && scene_.has_surface(); }
  /// The surface stands to the right of the window's middle while slices are beside it.
  void update(TimestampNs now) override;
  void contribute(Shown& shown) override;
  const SlicePanelState& state() const noexcept { return desk_->state(); }
  Result<Image> whole(std::size_t which) { return desk_->whole(scene_.document().scan, which); }

 private:
  ToolScene& scene_;
  std::unique_ptr<SliceDesk> desk_;
};

}  // namespace dubsar::app
