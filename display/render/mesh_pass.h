#pragma once
// The part of the renderer that draws surfaces: programs, tables of colours, and what the shaders read.

#include <map>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "display/optics/view.h"
#include "display/render/gl_objects.h"
#include "display/render/scene.h"

namespace dubsar {

/// What a pass draws into: the current frame buffer, whose viewport and depth test are set.
struct PassViews {
  std::span<const View> views;  ///< world: the scene's
  std::span<const int> layers;  ///< one for each view: all are drawn in one instanced draw. Empty: one view, no layers
  int width_px = 1;             ///< of a view
  int height_px = 1;
};

class MeshPass {
 public:
  /// `layered` false: as on a driver that cannot choose layers in vertex shaders.
  static Result<MeshPass> create(bool layered);
  /// Whether draw() can choose layers.
  bool layered() const noexcept { return layered_; }

  /// Triangles of the item's visible parts. Details smaller than `coarse_px` pixels of the finest view may be merged.
  Result<void> draw(const MeshItem& item, const SceneView& scene, const PassViews& target, double coarse_px);

 private:
  struct Table {
    Style style;
    GlTexture texture;
  };
  Result<GLuint> program(bool layered, bool clipped);
  GLuint table_of(const Style& style);

  bool layered_ = false;
  std::map<int, GlProgram> programs_;  ///< made at their first use
  std::vector<Table> tables_;          ///< used last at the end
  GlBuffer views_, style_;
};

/// The view of the item's model: world of the result is the model's frame.
View model_view(const View& view, const glm::dmat4& world_from_model);

/// How much of the world one pixel of the view shows at `point`, in mm.
double mm_per_pixel_at(const View& view, const glm::dvec3& point, int width_px);

glm::vec3 linear_color(const Rgb8& color);

}  // namespace dubsar
