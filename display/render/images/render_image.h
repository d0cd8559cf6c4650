#pragma once
// One picture of a mesh, without a window: `dubsar render`, the fat-cross.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image_io/image.h"
#include "core/mesh/tri_mesh.h"
#include "display/render/camera.h"
#include "display/render/shading.h"

namespace dubsar {

struct RenderOptions {
  CameraOptions camera{};  ///< view, size, scale
  Shading shading{};       ///< colouring, light, partitions, background
  int samples = 3;         ///< samples x samples a pixel, 1..8
};

struct Picture {
  Image image;                   ///< RGB, or RGBA with a transparent background
  double mm_per_pixel = 0.0;     ///< orthographic: everywhere; perspective: in the plane through the object's centre
  glm::dmat4 clip_from_mm{1.0};  ///< where a place of the mesh is seen: -1 to 1, y up
  glm::dvec3 to_viewer{0.0, 0.0, 1.0};  ///< unit, of an orthographic view
  double bar_mm = 0.0;                  ///< of a scale bar that somebody drew in it; 0: none
  int bar_px = 0;
  /// For the dpi tag of a file: 25.4 / mm_per_pixel.
  double dpi() const { return 25.4 / mm_per_pixel; }
};

/// A mesh in graphics memory with its own offscreen context, for several pictures of it. One thread.
class PictureRenderer {
 public:
  /// `mesh` outlives it. kUnavailable without GL 4.5, kBadData when the mesh contradicts itself or has no triangles.
  static Result<PictureRenderer> create(const TriMesh& mesh);
  PictureRenderer(PictureRenderer&&) noexcept;
  PictureRenderer& operator=(PictureRenderer&&) noexcept;
  ~PictureRenderer();

  /// Box in mm of the partitions whose bit is set.
  Box box_mm(std::uint8_t partitions = 0xff) const;

  /// Measures what a shading shows of the surface and the mesh does not carry (curvature, MSII): long work, done once;
  /// render() does it where nobody asked before. Errors: kCancelled, kTryAgain (memory), kUnavailable.
  Result<void> prepare(const Shading& shading, Progress& progress);

  /// The camera frames the partitions that are drawn. Large pictures are drawn in tiles. Errors: kUsage (options,
  /// nothing to draw), kTryAgain (memory), kUnavailable (the driver drew nothing), kCancelled.
  Result<Picture> render(const RenderOptions& options, Progress& progress);

 private:
  struct Parts;
  explicit PictureRenderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// One picture: makes a context, draws, and takes everything down again.
Result<Picture> render_picture(const TriMesh& mesh, const RenderOptions& options, Progress& progress);

}  // namespace dubsar
