#pragma once
// Wedges, drawn on the surface where they lie.

#include "app/tools/tool.h"
#include "app/tools/tool_scene.h"

namespace dubsar::app {

class WedgesTool final : public Tool {
 public:
  explicit WedgesTool(ToolScene& scene) : scene_(scene) {}
  void contribute(Shown& shown) override;

 private:
  ToolScene& scene_;
};

}  // namespace dubsar::app
