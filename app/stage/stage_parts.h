#pragma once
// What a stage consists of. Part of this room.

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/stage/label_layout.h"
#include "app/stage/stage.h"
#include "display/render/mesh/field_maker.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/multi_view.h"
#include "display/render/passes/page_pass.h"
#include "display/render/renderer.h"
#include "display/render/view_array.h"

namespace dubsar::app {

inline constexpr int kMostMagnifierPx = 2048, kMagnifierSamples = 2;
inline constexpr TimestampNs kRestNs = 150'000'000;  // before coarse views are made exact

struct Stage::Parts {
  struct Object {
    Box box;
    const TriMesh* source = nullptr;
    std::optional<LodMesh> mesh;
    std::shared_ptr<const TriMesh> kept, differs_from;  // of the one beside: itself; what the difference is from
    bool refused = false;                               // such a difference
    std::unique_ptr<FieldMaker> maker;                  // while figures of the surface are measured
    std::optional<Renderer> renderer;                   // kExact, and for stills
    std::optional<MultiView> multi;                     // kAdaptive
  };
  /// What a wearer reads: it stands in the room.
  struct Page {
    ViewArray text;
    PagePass pass;
  };
  struct Layers {
    std::optional<ViewArray> array, overlaid, half;
    std::optional<Page> page;
    LayerPainter* overlay = nullptr;
    bool overlay_changed = false;
    std::vector<int> chosen;  // without a mesh: what each layer shows; empty: nothing yet
  };
  struct Plane {                          // what is shown of the panel's
    glm::dvec2 window{0.0}, middle{0.0};  // size and middle, mm
    glm::dvec3 aside_mm{0.0};             // from the panel's middle to where the eyes are thought to be level with
    double magnification = 1.0;
  };
  struct Next {
    Shown shown;
    Observer viewer;
    TimestampNs now = 0;
    bool followed = false;  // somebody is seen, and the eyes are theirs
  };
  struct Painted {
    std::optional<std::pair<Shown, Observer>> of;
    std::vector<View> views;
    std::vector<DrawItem> items;
    std::vector<ClipPlane> clips;
    Light light;
    Fog fog;
    Glow glow;
    std::optional<View> judge;  // of several views: the one from between them
    TimestampNs moved_at = 0;
  };
  struct Over {
    OverlayMarks shown;
    GlProgram program;
    GlVertexArray no_vertices;
    GlFramebuffer framebuffer;
    std::optional<ViewArray> pictures, probe;  // of the glass; of one pixel
  };
  struct Cost {
    int coarse = 0;              // views of the last picture; with two states those of both
    std::optional<int> half{};   // of two states: the one that is being made exact
    double exact_view_ms = 0.0;  // what one exact view takes; 0: not known yet
    double begun_ms = 0.0;       // what the next one has taken so far
    bool worked = false;         // since show()
    bool refined = false;        // a view, since it was painted
    TimestampNs prepared_at = 0;
  };
  StageOptions options;
  std::unique_ptr<OutputSink> sink;
  Object object, beside;  // beside: another surface in the other half; nothing where there is none
  Layers layers;
  Plane plane;
  Next next;
  Painted painted;
  Cost cost;
  Over overlay_marks;
  std::array<LabelLayout, 2> layouts;  // of the halves; of one state the second

  explicit Parts(const StageOptions& given) : options(given) {}
  static Result<Object> make_object(const TriMesh& mesh, const StageOptions& options);
  Result<void> prepare(OutputSink& with);
  static Result<LodMesh> make_levels(PackedMesh packed, Quality quality);
  void take_beside();
  bool has_beside() const noexcept { return next.shown.compared && next.shown.compared->surface; }
  const Object& of(const Shown& shown) const noexcept { return shown.surface ? beside : object; }
  void measure(Object& of, FieldNeeds needs);
  Result<void> carry(Object& of, SurfaceFields made, std::shared_ptr<const TriMesh> other);
  FieldNeeds measured(const Object& of) const noexcept;
  Style ready(Style style, const Object& of) const;
  Observer viewer_at(const FollowedEyes& eyes) const;
  double depth_factor(const Observer& viewer) const;
  /// The eyes that cameras are made for; of two beside each other those of a half, 0 left or above, 1 right or below.
  Observer cameras(int half) const;
  Observer cameras() const { return cameras(own_half()); }
  /// Where what is shown stands: with another one beside it in the middle of its half.
  glm::dmat4 placed(const Shown& shown, int half) const;
  glm::dmat4 placed() const { return placed(next.shown, own_half()); }
  int own_half() const noexcept { return has_beside() ? 0 : 1; }
  const Shown& shown_in(int half) const { return half == own_half() ? next.shown : *next.shown.compared; }
  /// Worn displays show a room, in which two surfaces stand side by side.
  bool in_halves() const { return next.shown.compared && !(has_beside() && sink->traits().worn); }
  glm::dvec2 half_middle(int half) const;
  double half_scale() const;
  bool upright() const noexcept { return plane.window.y > plane.window.x; }
  PixelSize half_size(const PixelSize& whole) const {
    return upright() ? PixelSize{whole.width, whole.height / 2} : PixelSize{whole.width / 2, whole.height};
  }
  /// Its lower left pixel.
  glm::ivec2 half_corner(int half, const PixelSize& whole) const {
    const PixelSize part = half_size(whole);
    if (upright()) return {0, half == 0 ? whole.height - part.height : 0};
    return {half == 0 ? 0 : whole.width - part.width, 0};
  }
  View view_of_half(const View& whole, int half, const PixelSize& size) const;
  bool moved() const noexcept;
  double budget_ms() const;  // for the exact views of a picture
  Background background() const {
    Background out = options.shading.background;
    out.transparent = out.transparent || sink->traits().see_through;
    return out;
  }
  SceneView scene() const {
    return {painted.items,
            painted.light,
            painted.clips,
            background(),
            painted.fog,
            painted.glow,
            painted.judge ? &*painted.judge : nullptr};
  }
  bool has_mesh() const noexcept { return object.mesh.has_value(); }
  void set_scene() { set_scene(next.shown, own_half()); }
  void add_caption(const Shown& shown, int half);
  void set_scene(const Shown& shown, int half);
  std::vector<View> set_half(int half);
  Result<void> show_half(int half);
  Result<void> paint_halves();
  Result<void> refine_half(TimestampNs end);
  Result<Image> still_of(int half, int factor, const PixelSize& whole);
  Result<void> fill_layers();
  Result<void> paint_moved();
  Result<void> paint_overlay_marks(ViewArray& array);
  Result<void> stamp(ViewArray& array, int layer, const glm::dvec2& corner, int side, bool ring);
  Result<void> refine();
  Result<void> paint_page();
  bool may_refine() const noexcept {
    return cost.coarse > 0 && object.mesh->has_exact() && (!beside.mesh || beside.mesh->has_exact()) &&
           next.now - painted.moved_at >= kRestNs;
  }
  void took(double ms, std::size_t count);
};

}  // namespace dubsar::app
