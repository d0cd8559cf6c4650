#pragma once
// Views as the shaders of flat things read them: lines and labels (std430).

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "display/render/passes/mesh_pass.h"

namespace dubsar {

struct FlatView {
  glm::mat4 view_from_world, clip_from_view;
  glm::vec4 layer;  // x; y: 1 for parallel projection
};

inline std::vector<FlatView> flat_views(const PassViews& target) {
  std::vector<FlatView> out;
  for (std::size_t i = 0; i < target.views.size(); ++i) {
    const View& view = target.views[i];
    out.push_back(
        {glm::mat4(view.view_from_world), glm::mat4(view.clip_from_view),
         glm::vec4(target.layers.empty() ? 0 : target.layers[i], view.orthographic() ? 1.0f : 0.0f, 0.0f, 0.0f)});
  }
  return out;
}

inline constexpr std::string_view kFlatLayered =
    "#extension GL_ARB_shader_viewport_layer_array : require\n#define LAYERED\n";

}  // namespace dubsar
