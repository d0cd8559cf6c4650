#pragma once
// Where the key light of a scene does not come: depths of its surfaces as the light sees them.

#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "display/optics/view.h"
#include "display/render/context/gl_objects.h"
#include "display/render/scene.h"

namespace dubsar {

class Instalments;

class ShadowMap {
 public:
  static Result<ShadowMap> create();

  /// Draws the opaque parts of the scene's meshes as the light sees them, unless that is what was drawn last. All views
  /// must look the same way (same_direction()): the light turns with the picture. The map covers what the views can see
  /// of the scene, `size` x `size` texels. Where details may be merged and nothing is cut, faces that turn away from
  /// the light are left out: of a closed surface they cast what its other side casts anyway. Changes the current frame
  /// buffer and viewport. `pieces`: as much of it as there is time for; while they are paused the map is not complete.
  Result<void> draw(const SceneView& scene, std::span<const View> views, int size, double coarse_px, int width_px,
                    Instalments* pieces = nullptr);

  /// Depths, for a sampler2DShadow.
  GLuint texture() const noexcept { return depth_; }
  /// Texture coordinates and depth, 0..1.
  const glm::dmat4& map_from_world() const noexcept { return drawn_.map_from_world; }
  double texel_mm() const noexcept { return drawn_.texel_mm; }

 private:
  struct Caster {
    const LodMesh* mesh = nullptr;
    int level = 0;
    std::uint64_t version = 0;  ///< of the level's triangles: another mesh may be where one was
    glm::dmat4 world_from_model{1.0};
    PartLooks parts{};
    bool operator==(const Caster&) const = default;
  };
  struct Drawn {  ///< all that the map depends on
    glm::dmat4 map_from_world{1.0};
    double texel_mm = 1.0;
    int size = 0;
    bool lit_side_only = false;
    std::vector<Caster> casters;
    std::vector<ClipPlane> clips;
    bool operator==(const Drawn&) const = default;
  };
  Result<void> use_texture(int size);
  void draw_caster(const Caster& caster, std::span<const ClipPlane> clips, const glm::dmat4& clip_from_world,
                   Instalments* pieces);

  GlProgram program_;
  GlTexture depth_;
  GlFramebuffer framebuffer_;
  int size_ = 0;
  Drawn drawn_;
};

/// Whether a direction in the frame of one view is the same in the frames of all others.
bool same_direction(std::span<const View> views);

/// Unit vector in the world towards the scene's key light, for views that look as this one.
glm::dvec3 light_in_world(const Light& light, const View& view);

}  // namespace dubsar
