#pragma once
// What stands on the surface and beside it: measures, notes, a second state, what follows the pointer.

#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"
#include "display/render/images/label_font.h"

namespace dubsar::app {

class MarksTool final : public Tool {
 public:
  MarksTool(ToolScene& scene, std::unique_ptr<LabelFont> font) : scene_(scene), font_(std::move(font)) {}
  void contribute(Shown& shown) override;
  /// The glass and the ring follow the pointer over the surface that the stage shows now.
  void point();

 private:
  ToolScene& scene_;
  std::unique_ptr<LabelFont> font_;
};

}  // namespace dubsar::app
