#include "display/render/passes/mesh_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <string>

#include "display/optics/srgb.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/passes/instalments.h"
#include "display/render/passes/shadow_map.h"
#include "display/render/passes/views_binding.h"

namespace dubsar {
namespace {

constexpr GLint kViewIndex = 0, kPartColor = 1, kPartOffset = 2;  // shaders/mesh.vert
constexpr GLuint kStyleBinding = 1, kForeignColor = 3, kCarried = 4;
constexpr GLuint kTableUnit = 0, kShadowUnit = 1, kOpaqueUnit = 2, kPeeledUnit = 3, kOtherTableUnit = 4;
constexpr std::size_t kMostTables = 8;
constexpr double kHatchStripes = 90;         // along the longest side of a mesh
constexpr double kLeastSineEven = 0.12;      // Light::even: 7 degrees
constexpr double kSameBorder = 5e-5;         // of the longest side: what is no farther apart lies at one place
constexpr double kShadowOffsetTexels = 1.5;  // along the normal, before the map is asked

enum Variant : unsigned {
  kLayered = 1,
  kClipped = 2,
  kShadowed = 4,
  kPeeled = 8,
  kInferredSurface = 16,
  kFoggy = 32,
  kQuick = 64,
  kBent = 128,
  kBlended = 256,
  kFilled = 512,
  kGlowing = 1024,
  kLit = 2048,
  kGlossy = 4096,
  kKneed = 8192,
};

struct ViewData {  // std430, as in shaders/style.glsl
  glm::mat4 view_from_unit, clip_from_view, view_from_normal;
};

struct LookData {  // std140, as in shaders/style.glsl
  glm::vec4 light, weights, back_color, gloss, field;
};

struct StyleData {
  std::array<LookData, 2> looks;
  glm::vec4 blend, inferred_color, inferred_stripe, hatch;
  glm::vec4 fog_color, background, fog_depth, glow;
  glm::mat4 map_from_unit, map_from_normal;
  std::array<glm::vec4, kMostClipPlanes> clip_plane;
};

ViewData view_data(const View& view, const glm::dmat4& world_from_unit, int layer) {
  glm::dmat4 normals(glm::inverseTranspose(glm::dmat3(view.view_from_world)));
  normals[3][0] = layer;
  normals[3][3] = view.orthographic() ? 1.0 : 0.0;
  return {glm::mat4(view.view_from_world * world_from_unit), glm::mat4(view.clip_from_view), glm::mat4(normals)};
}

/// Depths before the eye between which the fog grows, of the first view.
glm::dvec2 fog_depths(const SceneView& scene, const View& view) {
  const Box box = scene_box_mm(scene);
  glm::dvec2 out(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (int corner = 0; corner < 8; ++corner) {
    const double depth = -(view.view_from_world * glm::dvec4(box.corner(corner), 1.0)).z;
    out = {std::min(out.x, depth), std::max(out.y, depth)};
  }
  return out;
}

LookData look_data(const Style& style, const Light& light, const glm::dvec3& direction) {
  LookData out{};
  out.light = glm::vec4(glm::vec3(direction), style.lit ? 1.0f : 0.0f);
  const double key = light.even ? light.key / std::max(direction.z, kLeastSineEven) : light.key;
  out.weights = glm::vec4(glm::dvec4(light.ambient, key, light.fill, light.specular));
  out.back_color = glm::vec4(linear_color(style.back_color), style.back_faces == BackFaces::kTint ? 1.0f : 0.0f);
  out.gloss = glm::vec4(glm::dvec4(light.shininess, light.knee, style.radiance, light.shadows ? 1.0 : 0.0));
  if (is_field(style.map)) {
    const FieldScale scale = field_scale(style);
    const double slope = 1.0 / (scale.to - scale.from);
    const int which = 1 + static_cast<int>(style.map) - static_cast<int>(ColorMap::kIntegral);
    out.field = glm::vec4(glm::dvec4(which, slope, -scale.from * slope, 0.0));
  }
  return out;
}

/// What the shader works out for this look: without a GPU it costs as much where it comes to nothing.
unsigned look_variant(const Style& style, const Light& light) {
  if (!style.lit) return 0;
  return kLit | (light.specular > 0 ? kGlossy : 0u) | (light.knee < 1.0 ? kKneed : 0u);
}

/// `cell_mm` of the level of detail: borders that bodies share have moved apart by as much.
StyleData style_data(const MeshItem& item, const SceneView& scene, const View& view, const ShadowMap* shadows,
                     double cell_mm) {
  const Style& s = item.style;
  const Box& box = item.mesh->box_mm();
  const glm::dmat4 world_from_unit = item.world_from_model * model_from_unit(box);
  const glm::dvec3 direction = light_direction(scene.light);
  StyleData out{};
  out.looks = {look_data(s, scene.light, direction), look_data(item.other.style, item.other.light, direction)};
  const glm::dvec3 size = box.size();
  const double longest = std::max({size.x, size.y, size.z, 1e-9});
  const double shown_scale =
      std::cbrt(std::abs(glm::determinant(glm::dmat3(view.view_from_world * item.world_from_model))));
  out.blend = glm::vec4(
      glm::dvec4(item.other.share, shown_scale * (kSameBorder * longest + cell_mm), cell_mm == 0.0 ? 1.0 : 0.0, 0.0));
  out.inferred_color = glm::vec4(linear_color(s.hatch.ground), 1.0f);
  out.inferred_stripe = glm::vec4(linear_color(s.hatch.stripe), 1.0f);
  out.hatch = glm::vec4(glm::vec3(size * (kHatchStripes / longest)), 0.0f);
  out.background = scene.background.transparent ? glm::vec4(0.0f) : glm::vec4(linear_color(scene.background.color), 1);
  if (scene.fog.strength > 0) {
    const glm::dvec2 depth = fog_depths(scene, view);
    out.fog_color = out.background;
    out.fog_depth = glm::vec4(glm::vec2(depth), static_cast<float>(scene.fog.strength), 0.0f);
  }
  if (scene.glow.strength > 0)
    out.glow = glm::vec4(glm::vec3(glm::inverse(world_from_unit) * glm::dvec4(scene.glow.at_mm, 1.0)), 0.0f);
  out.fog_depth.w = static_cast<float>(scene.glow.radius_mm);
  out.glow.w = static_cast<float>(scene.glow.strength);
  if (shadows != nullptr) {
    out.map_from_unit = glm::mat4(shadows->map_from_world() * world_from_unit);
    const glm::dmat3 turn = glm::inverseTranspose(glm::dmat3(item.world_from_model));
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(item.world_from_model))));
    out.map_from_normal = glm::mat4(
        glm::mat3(glm::dmat3(shadows->map_from_world()) * turn * scale * (kShadowOffsetTexels * shadows->texel_mm())));
  }
  out.clip_plane.fill(glm::vec4(0, 0, 0, 1));
  for (std::size_t i = 0; i < scene.clips.size(); ++i)
    out.clip_plane[i] = glm::vec4(unit_plane(scene.clips[i], world_from_unit));
  return out;
}

/// An envelope before its tablet, so that what it hides is not drawn.
std::array<std::size_t, kMaxPartitions> outermost_first(const LodMesh& mesh) {
  std::array<std::size_t, kMaxPartitions> out{};
  std::array<double, kMaxPartitions> size{};
  for (std::size_t p = 0; p < out.size(); ++p) {
    out[p] = p;
    size[p] = glm::length(mesh.box_of(static_cast<std::uint8_t>(1 << p)).size());
  }
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
  return out;
}

void set_state(const MeshItem& item, bool mirrored, std::size_t clips) {
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(mirrored != (glm::determinant(glm::dmat3(item.world_from_model)) < 0) ? GL_CW : GL_CCW);
  glCullFace(GL_BACK);
  const bool inside = item.style.section && clips > 0;  // seen as the filling of what is cut through
  (item.style.back_faces == BackFaces::kCull && !inside ? glEnable : glDisable)(GL_CULL_FACE);
  for (GLuint i = 0; i < static_cast<GLuint>(kMostClipPlanes); ++i)
    (i < clips ? glEnable : glDisable)(GL_CLIP_DISTANCE0 + i);
}

}  // namespace

void draw_ranges(const TriangleRanges& ranges, GLsizei instances) {
  constexpr std::int64_t kMostAtOnce = std::numeric_limits<GLsizei>::max() / 3;
  for (auto [first, count] : ranges)
    for (; count > 0; first += kMostAtOnce, count -= kMostAtOnce)
      glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(3 * std::min(count, kMostAtOnce)), GL_UNSIGNED_INT,
                              // NOLINTNEXTLINE(performance-no-int-to-ptr): an offset, as GL wants it
                              reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * sizeof(Triangle)),
                              instances);
}

glm::dmat4 model_from_unit(const Box& box) {
  glm::dmat4 out(1.0);
  const glm::dvec3 size = box.size();
  for (int a = 0; a < 3; ++a) {
    out[a][a] = size[a];
    out[3][a] = box.min[a];
  }
  return out;
}

glm::dvec3 unit_offset(const glm::dvec3& offset_mm, const Box& box) {
  return offset_mm / glm::max(box.size(), glm::dvec3(std::numeric_limits<float>::min()));
}

glm::dvec4 unit_plane(const ClipPlane& clip, const glm::dmat4& world_from_unit) {
  return glm::dvec4(clip.normal, -glm::dot(clip.normal, clip.point_mm)) * world_from_unit;  // a row
}

int level_for_views(const MeshItem& item, std::span<const View> views, double coarse_px, int width_px) {
  if (!(coarse_px > 0)) return 0;
  double finest = std::numeric_limits<double>::infinity();
  for (const View& view : views)
    finest = std::min(finest,
                      mm_per_pixel_at(model_view(view, item.world_from_model), item.mesh->box_mm().centre(), width_px));
  return item.mesh->level_for(coarse_px * finest);
}

View model_view(const View& view, const glm::dmat4& world_from_model) {
  return {view.view_from_world * world_from_model, view.clip_from_view};
}

double mm_per_pixel_at(const View& view, const glm::dvec3& point, int width_px) {
  const glm::dvec4 at = view.view_from_world * glm::dvec4(point, 1.0);
  const double w = (view.clip_from_view * at).w;
  const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(view.view_from_world))));
  return 2.0 * std::abs(w) / (std::abs(view.clip_from_view[0][0]) * width_px * scale);
}

glm::vec3 linear_color(const Rgb8& c) {
  return glm::vec3(glm::dvec3(linear_from_srgb(c[0]), linear_from_srgb(c[1]), linear_from_srgb(c[2])));
}

Result<MeshPass> MeshPass::create(bool layered) {
  MeshPass out;
  out.layered_ = layered && epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array");
  out.views_ = make_stream_buffer();
  out.style_ = make_stream_buffer();
  DUBSAR_TRY(out.program(0));
  return out;
}

Result<GLuint> MeshPass::program(unsigned variant) {
  if (const auto found = programs_.find(variant); found != programs_.end()) return GLuint{found->second};
  std::string lines;
  const auto define = [&](Variant bit, std::string_view name) {
    if ((variant & bit) != 0) lines += fmt::format("#define {}\n", name);
  };
  define(kLayered, "LAYERED");
  define(kClipped, "CLIPPED");
  define(kShadowed, "SHADOWED");
  define(kPeeled, "PEELED");
  define(kInferredSurface, "INFERRED");
  define(kFoggy, "FOGGY");
  define(kQuick, "QUICK");
  define(kBent, "BENT");
  define(kBlended, "BLENDED");
  define(kFilled, "FILLED");
  define(kGlowing, "GLOWING");
  define(kLit, "LIT");
  define(kGlossy, "GLOSSY");
  define(kKneed, "KNEED");
  const std::string_view extension =
      (variant & kLayered) != 0 ? "#extension GL_ARB_shader_viewport_layer_array : require\n" : "";
  DUBSAR_ASSIGN(GlProgram made, make_program("mesh.vert", "mesh.frag", std::string(extension) + lines, lines));
  return GLuint{programs_.emplace(variant, std::move(made)).first->second};
}

GLuint MeshPass::table_of(const Style& style) {
  const auto same = [&](const Table& t) {
    return t.style.map == style.map && t.style.contrast == style.contrast && t.style.base_color == style.base_color &&
           t.style.ambient_occlusion == style.ambient_occlusion && t.style.occlusion_power == style.occlusion_power &&
           t.style.shoulder == style.shoulder && t.style.field_colors == style.field_colors;
  };
  if (const auto found = std::find_if(tables_.begin(), tables_.end(), same); found != tables_.end()) {
    std::rotate(found, found + 1, tables_.end());
    return tables_.back().texture;
  }
  if (tables_.size() == kMostTables) tables_.erase(tables_.begin());
  std::vector<glm::vec4> linear;
  for (const auto& c : color_table(style)) linear.emplace_back(linear_color({c[0], c[1], c[2]}), 1.0f);
  GlTexture texture = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture, 1, GL_RGBA32F, kShapeRows, kAoColumns);
  glTextureSubImage2D(texture, 0, 0, 0, kShapeRows, kAoColumns, GL_RGBA, GL_FLOAT, linear.data());
  tables_.push_back({style, std::move(texture)});
  return tables_.back().texture;
}

/// A surface with colours of its own is not of clay besides.
void MeshPass::bind_tables(const MeshItem& item, bool colors) {
  const auto seen = [&](Style style) {
    if (colors && style.lit) style.base_color = {255, 255, 255};
    return style;
  };
  glBindTextureUnit(kTableUnit, table_of(seen(item.style)));
  if (item.other.share > 0) glBindTextureUnit(kOtherTableUnit, table_of(seen(item.other.style)));
}

Result<void> MeshPass::draw(const MeshItem& item, const SceneView& scene, const PassViews& target,
                            const MeshPassMode& mode) {
  DUBSAR_CHECK(target.layers.empty() ? target.views.size() == 1
                                     : layered_ && target.layers.size() == target.views.size());
  const bool transparent = mode.opaque_depth != 0;
  const auto drawn = [&](const PartLook& p) { return p.visible && p.opacity > 0 && (p.opacity < 1.0) == transparent; };
  if (std::none_of(item.parts.begin(), item.parts.end(), drawn)) return {};
  const Box& box = item.mesh->box_mm();
  const int fineness = level_for_views(item, target.views, target.coarse_px, target.width_px);
  const GpuMesh& level = item.mesh->level(fineness);
  std::vector<View> views;
  std::vector<ViewData> data;
  for (std::size_t i = 0; i < target.views.size(); ++i) {
    views.push_back(model_view(target.views[i], item.world_from_model));
    data.push_back(view_data(views.back(), model_from_unit(box), target.layers.empty() ? 0 : target.layers[i]));
  }
  stream(views_, std::as_bytes(std::span(data)));
  const bool blended = item.other.share > 0;
  const bool cast =
      (item.style.lit && scene.light.shadows) || (blended && item.other.style.lit && item.other.light.shadows);
  const ShadowMap* const shadows = cast ? mode.shadows : nullptr;
  const bool filled = item.style.section && !scene.clips.empty();
  const bool bent = item.style.radiance > 0 || (blended && item.other.style.radiance > 0);
  const StyleData style = style_data(item, scene, target.views[0], shadows, item.mesh->cell_mm(fineness));
  stream(style_, std::as_bytes(std::span(&style, 1)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsBinding, views_);
  glBindBufferBase(GL_UNIFORM_BUFFER, kStyleBinding, style_);
  glVertexAttrib4f(kForeignColor, 1, 1, 1, 1);
  glVertexAttrib4f(kCarried, 0, 0, 0, 0);
  bind_tables(item, level.has_colors());
  if (shadows != nullptr) glBindTextureUnit(kShadowUnit, shadows->texture());
  if (transparent) {
    glBindTextureUnit(kOpaqueUnit, mode.opaque_depth);
    glBindTextureUnit(kPeeledUnit, mode.peeled_depth);
  }
  set_state(item, level.mirrored(), scene.clips.size());
  glBindVertexArray(level.vertex_array());
  const unsigned variant = (target.layers.empty() ? 0u : kLayered) | (scene.clips.empty() ? 0u : kClipped) |
                           (shadows == nullptr ? 0u : kShadowed) | (transparent ? kPeeled : 0u) |
                           (scene.fog.strength > 0 ? kFoggy : 0u) | (target.coarse_px > 0 ? kQuick : 0u) |
                           (bent ? kBent : 0u) | (blended ? kBlended : 0u) | (filled ? kFilled : 0u) |
                           (scene.glow.strength > 0 ? kGlowing : 0u) | look_variant(item.style, scene.light) |
                           (blended ? look_variant(item.other.style, item.other.light) : 0u);
  for (const std::size_t p : outermost_first(*item.mesh))
    if (drawn(item.parts[p])) DUBSAR_TRY(draw_part(level, item, p, views, variant, mode.pieces));
  glDisable(GL_CULL_FACE);
  for (GLuint i = 0; i < scene.clips.size(); ++i) glDisable(GL_CLIP_DISTANCE0 + i);
  return check_gl("drawing a surface");
}

Result<void> MeshPass::draw_part(const GpuMesh& level, const MeshItem& item, std::size_t p, std::span<const View> views,
                                 unsigned variant, Instalments* pieces) {
  const PartLook& part = item.parts[p];
  std::vector<View> moved;
  for (const View& view : views) moved.push_back(model_view(view, glm::translate(glm::dmat4(1.0), part.offset_mm)));
  for (const bool inferred : {false, true}) {
    const auto evidence = !item.style.mark_inferred ? ShownEvidence::kBoth
                          : inferred                ? ShownEvidence::kInferred
                                                    : ShownEvidence::kMeasured;
    if (inferred && !item.style.mark_inferred) continue;
    const TriangleRanges ranges = level.visible_ranges(static_cast<std::uint8_t>(1 << p), moved, evidence);
    if (ranges.empty()) continue;
    DUBSAR_ASSIGN(const GLuint shader, program(variant | (inferred ? kInferredSurface : 0u)));
    glUseProgram(shader);
    glUniform1i(kViewIndex, 0);
    const glm::vec3 color = linear_color(part.color), offset(unit_offset(part.offset_mm, item.mesh->box_mm()));
    glUniform4f(kPartColor, color.x, color.y, color.z, static_cast<float>(part.opacity));
    glUniform3f(kPartOffset, offset.x, offset.y, offset.z);
    if (pieces != nullptr)
      pieces->draw(ranges, static_cast<GLsizei>(views.size()));
    else
      draw_ranges(ranges, static_cast<GLsizei>(views.size()));
  }
  return {};
}

}  // namespace dubsar
