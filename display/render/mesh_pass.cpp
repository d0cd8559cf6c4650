#include "display/render/mesh_pass.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "display/optics/srgb.h"
#include "display/render/lod_mesh.h"

namespace dubsar {
namespace {

constexpr GLint kViewIndex = 0, kPartColor = 1, kPartOffset = 2;  // shaders/mesh.vert
constexpr GLuint kViewsBinding = 0, kStyleBinding = 1, kForeignColor = 3;
constexpr std::size_t kMostTables = 8;

struct ViewData {  // std430, as in shaders/mesh.vert
  glm::mat4 view_from_unit, clip_from_view, view_from_normal;
};

struct StyleData {  // std140, as in shaders/mesh.vert
  glm::vec4 light, weights, back_color, shininess;
  std::array<glm::vec4, kMostClipPlanes> clip_plane;
};

ViewData view_data(const View& view, const glm::dmat4& world_from_unit, int layer) {
  glm::dmat4 normals(glm::inverseTranspose(glm::dmat3(view.view_from_world)));
  normals[3][0] = layer;
  normals[3][3] = view.orthographic() ? 1.0 : 0.0;
  return {glm::mat4(view.view_from_world * world_from_unit), glm::mat4(view.clip_from_view), glm::mat4(normals)};
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

StyleData style_data(const Style& s, const Light& light, std::span<const ClipPlane> clips,
                     const glm::dmat4& world_from_unit) {
  StyleData out{};
  out.light = glm::vec4(glm::vec3(light_direction(light)), s.lit ? 1.0f : 0.0f);
  out.weights = glm::vec4(glm::dvec4(light.ambient, light.key, light.fill, light.specular));
  out.back_color = glm::vec4(linear_color(s.back_color), s.back_faces == BackFaces::kTint ? 1.0f : 0.0f);
  out.shininess = glm::vec4(static_cast<float>(light.shininess));
  out.clip_plane.fill(glm::vec4(0, 0, 0, 1));
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const glm::dvec4 plane(clips[i].normal, -glm::dot(clips[i].normal, clips[i].point_mm));
    out.clip_plane[i] = glm::vec4(plane * world_from_unit);  // row vector: plane . (world_from_unit * unit)
  }
  return out;
}

void draw_ranges(const std::vector<std::pair<std::int64_t, std::int64_t>>& ranges, GLsizei instances) {
  constexpr std::int64_t kMostAtOnce = std::numeric_limits<GLsizei>::max() / 3;
  for (auto [first, count] : ranges)
    for (; count > 0; first += kMostAtOnce, count -= kMostAtOnce)
      glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(3 * std::min(count, kMostAtOnce)), GL_UNSIGNED_INT,
                              reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * sizeof(Triangle)),
                              instances);
}

void set_state(const MeshItem& item, bool mirrored, std::size_t clips) {
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(mirrored != (glm::determinant(glm::dmat3(item.world_from_model)) < 0) ? GL_CW : GL_CCW);
  glCullFace(GL_BACK);
  (item.style.back_faces == BackFaces::kCull ? glEnable : glDisable)(GL_CULL_FACE);
  for (GLuint i = 0; i < static_cast<GLuint>(kMostClipPlanes); ++i)
    (i < clips ? glEnable : glDisable)(GL_CLIP_DISTANCE0 + i);
}

}  // namespace

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
  DUBSAR_TRY(out.program(false, false));
  return out;
}

Result<GLuint> MeshPass::program(bool layered, bool clipped) {
  const int key = (layered ? 1 : 0) | (clipped ? 2 : 0);
  if (const auto found = programs_.find(key); found != programs_.end()) return GLuint{found->second};
  std::string lines;
  if (layered) lines += "#extension GL_ARB_shader_viewport_layer_array : require\n#define LAYERED\n";
  if (clipped) lines += "#define CLIPPED\n";
  DUBSAR_ASSIGN(GlProgram made, make_program("mesh.vert", "mesh.frag", lines));
  return GLuint{programs_.emplace(key, std::move(made)).first->second};
}

GLuint MeshPass::table_of(const Style& style) {
  const auto same = [&](const Table& t) {
    return t.style.map == style.map && t.style.contrast == style.contrast && t.style.base_color == style.base_color &&
           t.style.ambient_occlusion == style.ambient_occlusion && t.style.occlusion_power == style.occlusion_power;
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

Result<void> MeshPass::draw(const MeshItem& item, const SceneView& scene, const PassViews& target, double coarse_px) {
  DUBSAR_CHECK(target.layers.empty() ? target.views.size() == 1
                                     : layered_ && target.layers.size() == target.views.size());
  const LodMesh& mesh = *item.mesh;
  const Box& box = mesh.box_mm();
  double finest = std::numeric_limits<double>::infinity();
  std::vector<View> views;
  for (const View& view : target.views) {
    views.push_back(model_view(view, item.world_from_model));
    if (coarse_px > 0) finest = std::min(finest, mm_per_pixel_at(views.back(), box.centre(), target.width_px));
  }
  const GpuMesh& level = mesh.level(coarse_px > 0 ? mesh.level_for(coarse_px * finest) : 0);

  const glm::dmat4 from_unit = model_from_unit(box);
  std::vector<ViewData> data;
  for (std::size_t i = 0; i < views.size(); ++i)
    data.push_back(view_data(views[i], from_unit, target.layers.empty() ? 0 : target.layers[i]));
  stream(views_, std::as_bytes(std::span(data)));
  const StyleData style = style_data(item.style, scene.light, scene.clips, item.world_from_model * from_unit);
  stream(style_, std::as_bytes(std::span(&style, 1)));
  DUBSAR_ASSIGN(const GLuint shader, program(!target.layers.empty(), !scene.clips.empty()));
  glUseProgram(shader);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kViewsBinding, views_);
  glBindBufferBase(GL_UNIFORM_BUFFER, kStyleBinding, style_);
  glVertexAttrib4f(kForeignColor, 1, 1, 1, 1);
  glBindTextureUnit(0, table_of(item.style));
  set_state(item, level.mirrored(), scene.clips.size());
  glUniform1i(kViewIndex, 0);
  glBindVertexArray(level.vertex_array());
  const glm::dvec3 unit_per_mm = 1.0 / glm::max(box.size(), glm::dvec3(std::numeric_limits<float>::min()));
  for (std::size_t p = 0; p < item.parts.size(); ++p) {
    const PartLook& part = item.parts[p];
    if (!part.visible) continue;
    std::vector<View> moved;
    for (const View& view : views) moved.push_back(model_view(view, glm::translate(glm::dmat4(1.0), part.offset_mm)));
    const auto ranges = level.visible_ranges(static_cast<std::uint8_t>(1 << p), moved);
    if (ranges.empty()) continue;
    const glm::vec3 color = linear_color(part.color), offset(part.offset_mm * unit_per_mm);
    glUniform3f(kPartColor, color.x, color.y, color.z);
    glUniform3f(kPartOffset, offset.x, offset.y, offset.z);
    draw_ranges(ranges, static_cast<GLsizei>(views.size()));
  }
  glDisable(GL_CULL_FACE);
  for (GLuint i = 0; i < scene.clips.size(); ++i) glDisable(GL_CLIP_DISTANCE0 + i);
  return check_gl("drawing a surface");
}

}  // namespace dubsar
