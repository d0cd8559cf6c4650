#pragma once
// What is drawn, as values: the items of a scene, its light and the planes that cut it. Whoever shows something makes
// a SceneView for each picture; the renderer draws it for any number of views and keeps nothing of it.

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "display/render/camera.h"
#include "display/render/shading.h"

namespace dubsar {

class LodMesh;    // display/render/mesh/lod_mesh.h
class LabelFont;  // display/render/images/label_font.h

/// A surface in graphics memory. Outlives the pictures of it.
struct MeshItem {
  const LodMesh* mesh = nullptr;
  glm::dmat4 world_from_model{1.0};  ///< rotation, one scale for all axes, translation
  Style style;
  PartLooks parts{};
  OtherLook other{};
};

/// Lines of constant width: measures, scale bars, pointers, boxes.
struct LinesItem {
  std::vector<glm::dvec3> points_mm;  ///< two for each segment
  double width_px = 2.0;              ///< of the picture; ends are square
  Rgb8 color{255, 255, 255};
  double opacity = 1.0;  ///< 0..1
  /// Opacity of what lies behind surfaces, times `opacity`: 0 hides it, 1 shows it as if nothing were before it.
  double hidden_opacity = 0.0;
  double lift_mm = 0.05;  ///< towards the eye, so that lines on a surface are seen

  bool operator==(const LinesItem&) const = default;
};

/// A line of text at a place of the world, of constant size in the picture. In each view, or in all as the scene's
/// judge sees it, it is seen as a whole, before everything, where its place is seen, and fades where surfaces hide
/// that; of a place outside of the picture letters are hidden one by one.
struct LabelItem {
  LabelFont* font = nullptr;  ///< outlives the pictures of it
  std::string text;           ///< UTF-8, one line
  glm::dvec3 at_mm{0.0};
  glm::dvec3 along_mm{0.0};  ///< the text runs towards at_mm + along_mm; 0: to the right of the picture
  glm::dvec2 shift_px{0.0};  ///< from the place to the text's base line, right and up
  double anchor = 0.0;       ///< what of the text stands at the place: 0 its beginning, 0.5 its middle, 1 its end
  double height_px = 16.0;   ///< of the letters, of the picture
  Rgb8 color{232, 228, 220}, border{23, 24, 27};
  double plate = 0.0;           ///< 0..1: how much of what lies behind the text its ground covers, in `border`
  glm::dvec3 normal{0.0};       ///< of the surface that the place lies on; 0: not known, or on none
  double opacity = 1.0;         ///< 0..1
  double hidden_opacity = 0.0;  ///< as of lines, of the whole label
  double lift_mm = 3.0;         ///< towards the eye: what is rough around the place does not hide it

  bool operator==(const LabelItem&) const = default;
};

using DrawItem = std::variant<MeshItem, LinesItem, LabelItem>;

/// Warm light on surfaces around a line through a place towards the eye, such as where a hand would take hold: it lies
/// on what is seen there, in its depth.
struct Glow {
  glm::dvec3 at_mm{0.0};   ///< in the world
  double radius_mm = 0.0;  ///< where it has faded
  double strength = 0.0;   ///< 0: none, 1: as bright as it gets
  bool operator==(const Glow&) const = default;
};

/// A moment's view of what there is to draw; borrows all of it for the time of one call.
struct SceneView {
  std::span<const DrawItem> items;
  Light light;
  std::span<const ClipPlane> clips;  ///< in the world; they cut meshes, not lines and labels. At most kMostClipPlanes
  Background background;
  Fog fog{};
  Glow glow{};
  const View* judge = nullptr;  ///< decides for all views which labels are seen; null: each for itself
};

/// Planes of a model's frame in the world.
std::vector<ClipPlane> moved(std::span<const ClipPlane> clips, const glm::dmat4& world_from_model);

/// The plane that cuts a share (0..1) of the box away from one side of its object_frame(): "front", "back", "left",
/// "right", "top" or "bottom". kUsage for another side or share.
Result<ClipPlane> cut_from_side(const Box& box, std::string_view side, double share);

/// A scene of one mesh, for pictures of it. `mesh` outlives it.
class MeshScene {
 public:
  MeshScene(const LodMesh& mesh, const Shading& shading, const glm::dmat4& world_from_model = glm::dmat4(1.0))
      : item_(MeshItem{&mesh, world_from_model, shading.style, shading.parts, shading.other}),
        light_(shading.light),
        clips_(moved(shading.clips, world_from_model)),
        background_(shading.background),
        fog_(shading.fog) {}
  operator SceneView() const { return {std::span(&item_, 1), light_, clips_, background_, fog_, {}, nullptr}; }

 private:
  DrawItem item_;
  Light light_;
  std::vector<ClipPlane> clips_;
  Background background_;
  Fog fog_;
};

/// True when parts of a mesh are drawn with an opacity below 1.
bool has_transparency(const SceneView& scene);

/// Whether the light of a look casts shadows in this scene.
bool casts_shadows(const SceneView& scene);

/// World box of everything that is drawn; clip planes are not looked at. A box of size 0 for an empty scene.
Box scene_box_mm(const SceneView& scene);

/// kUsage for what cannot be drawn: numbers that are not finite, opacities beyond 0..1, an odd number of line points,
/// missing meshes, too many planes.
Result<void> check_scene(const SceneView& scene);

}  // namespace dubsar
