#include "display/render/images/render_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "core/base/system/budget.h"
#include "core/base/system/log.h"
#include "display/render/context/context_egl.h"
#include "display/render/mesh/lod_mesh.h"
#include "display/render/renderer.h"

namespace dubsar {
namespace {

constexpr int kTileSamples = 4096;  // samples on a side: 200 MB of scratch

void copy_tile(const Image& tile, Image& picture, int left, int top) {
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x)
      std::memcpy(picture.at(left + x, top + y), tile.at(x, y), static_cast<std::size_t>(picture.channels));
}

bool only_background(const Image& image, const Shading& shading) {
  const std::array<std::uint8_t, 4> background{shading.background.color[0], shading.background.color[1],
                                               shading.background.color[2], 255};
  for (std::size_t i = 0; i < image.pixels.size(); i += static_cast<std::size_t>(image.channels)) {
    const std::uint8_t* pixel = image.pixels.data() + i;
    if (image.channels == 4 ? pixel[3] != 0 : !std::equal(pixel, pixel + 3, background.data())) return false;
  }
  return true;
}

/// An orthographic camera shows all that is visible.
Result<void> check_room(const TriMesh& mesh, const PartLooks& parts, const Camera& camera) {
  const glm::dmat4 clip = camera.view.clip_from_world();
  glm::dvec2 reach(0.0);  // from the middle of the picture, of half of it
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const PartLook& look = parts[mesh.partition_of(t) % parts.size()];
    if (!look.visible) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      const glm::dvec3 p = mesh.frame.mm_from_grid(glm::dvec3(mesh.positions[v])) + look.offset_mm;
      if (std::isfinite(p.x + p.y + p.z)) reach = glm::max(reach, glm::abs(glm::dvec2(clip * glm::dvec4(p, 1.0))));
    }
  }
  const glm::dvec2 needed = glm::ceil(reach * glm::dvec2(camera.width, camera.height) - 1e-6);
  if (needed.x <= camera.width && needed.y <= camera.height) return {};
  return fail(
      ErrorKind::kUsage,
      "render: a picture of {} x {} pixels found, expected at least {:.0f} x {:.0f} for the object at {:.4g} mm a "
      "pixel; without a size the picture is as large as the object needs",
      camera.width, camera.height, needed.x, needed.y, camera.mm_per_pixel);
}

}  // namespace

struct PictureRenderer::Parts {  // destroyed from the bottom to the top: the context last
  std::unique_ptr<EglContext> context;
  LodMesh mesh;
  const TriMesh* source = nullptr;  // for figures that are measured when a style asks for them
  bool has_shape = false, has_ao = false;
  std::optional<Renderer> renderer;

  ~Parts() {
    if (context != nullptr) static_cast<void>(context->make_current());
  }
};

PictureRenderer::PictureRenderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
PictureRenderer::PictureRenderer(PictureRenderer&&) noexcept = default;
PictureRenderer& PictureRenderer::operator=(PictureRenderer&&) noexcept = default;
PictureRenderer::~PictureRenderer() = default;

Result<PictureRenderer> PictureRenderer::create(const TriMesh& mesh) {
  auto parts = std::make_unique<Parts>();
  DUBSAR_ASSIGN(const PackedMesh packed, pack_mesh(mesh));
  parts->has_shape = packed.has_shape;
  parts->has_ao = packed.has_ao;
  parts->source = &mesh;
  DUBSAR_ASSIGN(parts->context, EglContext::create());
  DUBSAR_ASSIGN(parts->mesh, LodMesh::exact(packed));
  DUBSAR_ASSIGN(parts->renderer, Renderer::create());
  return PictureRenderer(std::move(parts));
}

Box PictureRenderer::box_mm(std::uint8_t partitions) const { return parts_->mesh.box_of(partitions); }

Result<void> PictureRenderer::prepare(const Shading& shading, Progress& progress) {
  DUBSAR_TRY(parts_->context->make_current());
  return carry_fields(parts_->mesh, *parts_->source, fields_needed(shading.style, shading.other), progress);
}

Result<Picture> PictureRenderer::render(const RenderOptions& options, Progress& progress) {
  const Shading& shading = options.shading;
  if (!parts_->mesh.has_any(visible_partitions(shading.parts)))
    return fail(ErrorKind::kUsage,
                "render: none of the partitions asked for has triangles, so there is nothing to draw");
  if (options.samples < 1 || options.samples > 8)
    return fail(ErrorKind::kUsage, "render: {0} x {0} samples a pixel asked for, expected 1 x 1 to 8 x 8",
                options.samples);
  if (shading.style.map != ColorMap::kPlain && !is_field(shading.style.map) && !parts_->has_shape)
    log_info("render: the mesh carries no shape classes, so it is drawn without curvature colouring");
  if (shading.style.ambient_occlusion && !parts_->has_ao)
    log_info("render: the mesh carries no ambient occlusion, so it is drawn without");
  const MeshScene scene(parts_->mesh, shading);
  DUBSAR_ASSIGN(const Camera camera, fit_camera(scene_box_mm(scene), options.camera));
  if (options.camera.whole && options.camera.mm_per_pixel > 0)
    DUBSAR_TRY(check_room(*parts_->source, shading.parts, camera));
  const int channels = shading.background.transparent ? 4 : 3;
  DUBSAR_TRY(check_memory("render", static_cast<std::uint64_t>(camera.width) * camera.height * channels));
  DUBSAR_TRY(prepare(shading, progress));

  const int side = kTileSamples / options.samples;
  Picture picture{Image(camera.width, camera.height, channels), camera.mm_per_pixel};
  picture.clip_from_mm = camera.view.clip_from_world();
  picture.to_viewer =
      picture_frame(options.camera.object.value_or(object_frame(scene_box_mm(scene))), options.camera.direction).front;
  progress.begin("render", static_cast<std::int64_t>(camera.width) * camera.height, "pixel");
  for (int top = 0; top < camera.height; top += side)
    for (int left = 0; left < camera.width; left += side) {
      if (progress.cancelled()) return cancelled_error();
      const int w = std::min(side, camera.width - left), h = std::min(side, camera.height - top);
      DUBSAR_ASSIGN(ViewArray tile, ViewArray::create(w, h, 1));
      const View view = crop_view(camera.view, left, camera.height - top - h, w, h, camera.width, camera.height);
      DUBSAR_TRY(parts_->renderer->render(scene, std::span(&view, 1), options.samples, tile));
      DUBSAR_ASSIGN(const Image pixels, tile.read_layer(0));
      copy_tile(pixels, picture.image, left, top);
      progress.advance(static_cast<std::int64_t>(w) * h);
    }
  progress.end();
  if (only_background(picture.image, shading))
    return fail(
        ErrorKind::kUnavailable,
        "render: nothing can be seen in the picture: the object is seen edge-on, or the graphics driver ({}) drew "
        "nothing",
        describe_gl());
  return picture;
}

Result<Picture> render_picture(const TriMesh& mesh, const RenderOptions& options, Progress& progress) {
  DUBSAR_ASSIGN(PictureRenderer renderer, PictureRenderer::create(mesh));
  return renderer.render(options, progress);
}

}  // namespace dubsar
