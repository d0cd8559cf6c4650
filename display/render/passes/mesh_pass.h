#pragma once
// The part of the renderer that draws surfaces: programs, tables of colours, and what the shaders read.

#include <map>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "display/optics/view.h"
#include "display/render/context/gl_objects.h"
#include "display/render/mesh/gpu_mesh.h"
#include "display/render/scene.h"

namespace dubsar {

class Instalments;
class ShadowMap;

/// What a pass draws into: the current frame buffer, whose viewport and depth test are set.
struct PassViews {
  std::span<const View> views;  ///< world: the scene's
  std::span<const int> layers;  ///< one for each view: all are drawn in one instanced draw. Empty: one view, no layers
  int width_px = 1;             ///< of a view
  int height_px = 1;
  double coarse_px = 0.0;  ///< details smaller than this may be merged
};

/// Which parts are drawn, and how.
struct MeshPassMode {
  const ShadowMap* shadows = nullptr;  ///< of the scene's light; null: none fall
  /// Transparent parts alone, and of them only what lies before `opaque_depth` and behind `peeled_depth` (2D textures
  /// of the target's size). 0: opaque parts alone.
  GLuint opaque_depth = 0, peeled_depth = 0;
  Instalments* pieces = nullptr;  ///< null: all at once
};

class MeshPass {
 public:
  /// `layered` false: as on a driver that cannot choose layers in vertex shaders.
  static Result<MeshPass> create(bool layered);
  /// Whether draw() can choose layers.
  bool layered() const noexcept { return layered_; }

  Result<void> draw(const MeshItem& item, const SceneView& scene, const PassViews& target, const MeshPassMode& mode);

 private:
  struct Table {
    Style style;
    GlTexture texture;
  };
  Result<GLuint> program(unsigned variant);
  GLuint table_of(const Style& style);
  void bind_tables(const MeshItem& item, bool colors);
  Result<void> draw_part(const GpuMesh& level, const MeshItem& item, std::size_t p, std::span<const View> views,
                         unsigned variant, Instalments* pieces);

  bool layered_ = false;
  std::map<unsigned, GlProgram> programs_;  ///< made at their first use
  std::vector<Table> tables_;               ///< used last at the end
  GlBuffer views_, style_;
};

/// The view of the item's model: world of the result is the model's frame.
View model_view(const View& view, const glm::dmat4& world_from_model);

/// The level of detail of the item's mesh that merges nothing larger than `coarse_px` pixels of the finest of the
/// views.
int level_for_views(const MeshItem& item, std::span<const View> views, double coarse_px, int width_px);

/// Positions in the buffers of a mesh are those in its box, 0..1.
glm::dmat4 model_from_unit(const Box& box);
glm::dvec3 unit_offset(const glm::dvec3& offset_mm, const Box& box);
/// plane . (unit, 1) < 0 is cut away.
glm::dvec4 unit_plane(const ClipPlane& clip, const glm::dmat4& world_from_unit);
void draw_ranges(const TriangleRanges& ranges, GLsizei instances);

/// How much of the world one pixel of the view shows at `point`, in mm.
double mm_per_pixel_at(const View& view, const glm::dvec3& point, int width_px);

glm::vec3 linear_color(const Rgb8& color);

}  // namespace dubsar
