#include "display/render/passes/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "display/render/mesh/lod_mesh.h"
#include "display/render/passes/instalments.h"
#include "display/render/passes/mesh_pass.h"

namespace dubsar {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMargin = 1e-3;     // of the box, so that its sides are inside
constexpr double kBorderTexels = 4;  // for the filter
constexpr float kSlopeBias = 2.0f, kUnitBias = 4.0f;

/// Rows: two directions across the light, and towards it.
glm::dmat4 light_from_world(const glm::dvec3& light) {
  const glm::dvec3 aside = std::abs(light.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(aside, light)), y = glm::cross(light, x);
  glm::dmat4 out(1.0);
  for (int c = 0; c < 3; ++c) {
    out[c][0] = x[c];
    out[c][1] = y[c];
    out[c][2] = light[c];
  }
  return out;
}

void widen(Box& box, const glm::dvec3& p) {
  box.min = glm::min(box.min, p);
  box.max = glm::max(box.max, p);
}

/// The scene in the light's frame, across the light no larger than what the views can see.
Box box_for_light(const glm::dmat4& from_world, const SceneView& scene, std::span<const View> views) {
  Box out{glm::dvec3(kInf), glm::dvec3(-kInf)}, seen = out;
  const Box box = scene_box_mm(scene);
  for (int corner = 0; corner < 8; ++corner) widen(out, glm::dvec3(from_world * glm::dvec4(box.corner(corner), 1.0)));
  const Box clip{glm::dvec3(-1.0), glm::dvec3(1.0)};
  for (const View& view : views) {
    const glm::dmat4 light_from_clip = from_world * glm::inverse(view.clip_from_world());
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p = light_from_clip * glm::dvec4(clip.corner(corner), 1.0);
      widen(seen, glm::dvec3(p) / p.w);
    }
  }
  for (int a = 0; a < 2; ++a) {
    if (!(seen.min[a] < out.max[a] && seen.max[a] > out.min[a])) continue;  // nothing is seen at all
    out.min[a] = std::max(out.min[a], seen.min[a]);
    out.max[a] = std::min(out.max[a], seen.max[a]);
  }
  const glm::dvec3 more = glm::max(kMargin * out.size(), glm::dvec3(1e-6));
  return {out.min - more, out.max + more};
}

}  // namespace

bool same_direction(std::span<const View> views) {
  for (const View& view : views)
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        if (!(std::abs(view.view_from_world[c][r] - views[0].view_from_world[c][r]) < 1e-9)) return false;
  return true;
}

glm::dvec3 light_in_world(const Light& light, const View& view) {
  return glm::normalize(glm::transpose(glm::dmat3(view.view_from_world)) * light_direction(light));
}

Result<ShadowMap> ShadowMap::create() {
  ShadowMap out;
  DUBSAR_ASSIGN(out.program_, make_program("shadow.vert", "shadow.frag"));
  out.framebuffer_ = make_framebuffer();
  return out;
}

Result<void> ShadowMap::use_texture(int size) {
  if (size_ == size) return {};
  depth_ = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(depth_, 1, GL_DEPTH_COMPONENT32F, size, size);
  glTextureParameteri(depth_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(depth_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(depth_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(depth_, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glTextureParameteri(depth_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(depth_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glNamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, depth_, 0);
  size_ = size;
  return check_gl("making the shadow map");
}

void ShadowMap::draw_caster(const Caster& caster, std::span<const ClipPlane> clips, const glm::dmat4& clip_from_world,
                            Instalments* pieces) {
  const GpuMesh& level = caster.mesh->level(caster.level);
  const Box& box = caster.mesh->box_mm();
  const glm::dmat4 world_from_unit = caster.world_from_model * model_from_unit(box);
  const bool mirrored = glm::determinant(glm::dmat3(caster.world_from_model)) < 0;
  glFrontFace(level.mirrored() != mirrored ? GL_CW : GL_CCW);
  glUniform1i(2, static_cast<GLint>(clips.size()));
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const glm::vec4 plane(unit_plane(clips[i], world_from_unit));
    glUniform4f(3 + static_cast<GLint>(i), plane.x, plane.y, plane.z, plane.w);
    glEnable(GL_CLIP_DISTANCE0 + static_cast<GLuint>(i));
  }
  const glm::mat4 clip_from_unit(clip_from_world * world_from_unit);
  glUniformMatrix4fv(0, 1, GL_FALSE, &clip_from_unit[0][0]);
  glBindVertexArray(level.vertex_array());
  for (std::size_t p = 0; p < caster.parts.size(); ++p) {
    const PartLook& part = caster.parts[p];
    if (!part.visible || part.opacity < 1.0) continue;
    const glm::vec3 offset(unit_offset(part.offset_mm, box));
    glUniform3f(1, offset.x, offset.y, offset.z);
    const View light{caster.world_from_model * glm::translate(glm::dmat4(1.0), part.offset_mm), clip_from_world};
    const TriangleRanges ranges = level.visible_ranges(static_cast<std::uint8_t>(1 << p), std::span(&light, 1));
    if (pieces != nullptr)
      pieces->draw(ranges, 1);
    else
      draw_ranges(ranges, 1);
  }
  for (GLuint i = 0; i < clips.size(); ++i) glDisable(GL_CLIP_DISTANCE0 + i);
}

Result<void> ShadowMap::draw(const SceneView& scene, std::span<const View> views, int size, double coarse_px,
                             int width_px, Instalments* pieces) {
  DUBSAR_CHECK(same_direction(views));
  const glm::dmat4 from_world = light_from_world(light_in_world(scene.light, views[0]));
  const Box box = box_for_light(from_world, scene, views);
  Drawn wanted;
  wanted.size = size;
  wanted.texel_mm = std::max(box.size().x, box.size().y) / (size - 2 * kBorderTexels);
  const double border = kBorderTexels * wanted.texel_mm;
  const glm::dmat4 clip_from_world = glm::ortho(box.min.x - border, box.max.x + border, box.min.y - border,
                                                box.max.y + border, -box.max.z, -box.min.z) *
                                     from_world;
  wanted.map_from_world =
      glm::translate(glm::dmat4(1.0), glm::dvec3(0.5)) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.5)) * clip_from_world;
  wanted.clips.assign(scene.clips.begin(), scene.clips.end());
  // Half of a closed surface; what is cut open lets the light in to the faces behind.
  wanted.lit_side_only = coarse_px > 0 && scene.clips.empty();
  for (const DrawItem& item : scene.items)
    if (const auto* mesh = std::get_if<MeshItem>(&item)) {
      const int level = level_for_views(*mesh, views, coarse_px, width_px);
      wanted.casters.push_back(
          {mesh->mesh, level, mesh->mesh->level(level).version(), mesh->world_from_model, mesh->parts});
    }
  if (wanted == drawn_) return {};
  DUBSAR_TRY(use_texture(size));
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, size, size);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  (wanted.lit_side_only ? glEnable : glDisable)(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kSlopeBias, kUnitBias);
  const auto clear = [&]() -> Result<void> {
    const float far_depth = 1.0f;
    glClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &far_depth);
    return {};
  };
  DUBSAR_TRY(once(pieces, clear));
  glUseProgram(program_);
  for (const Caster& caster : wanted.casters) draw_caster(caster, wanted.clips, clip_from_world, pieces);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
  drawn_ = pieces == nullptr || !pieces->paused() ? std::move(wanted) : Drawn();
  return check_gl("drawing shadows");
}

}  // namespace dubsar
