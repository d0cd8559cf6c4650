#pragma once
// What the sinks' GL halves share: one fragment shader over the whole target, and a target without a window.

#include <string_view>

#include "core/image_io/image.h"
#include "display/render/context/gl_objects.h"
#include "display/render/images/surface.h"

namespace dubsar {

class ViewArray;

/// A fragment shader of shaders/ drawn over a surface. Compiled at its first use.
class ComposePass {
 public:
  explicit ComposePass(std::string_view fragment_shader) : fragment_shader_(fragment_shader) {}

  /// Makes the target, its viewport and the program current, and binds `texture` to unit 0. Then set uniforms
  /// (glUniform*), then draw().
  Result<void> begin(const Surface& target, GLuint texture);
  Result<void> draw();

 private:
  std::string_view fragment_shader_;
  GlProgram program_;
  GlVertexArray no_vertices_;
};

/// Puts one layer of a view array into a surface as it is, from its lower left corner; where the surface is larger it
/// is black. Without a GPU this takes a third of the time of a pass that looks every pixel up.
class LayerCopy {
 public:
  Result<void> draw(const ViewArray& views, int layer, const Surface& target);

 private:
  GlFramebuffer framebuffer_;
};

/// A frame buffer of 8-bit RGBA to compose into, and to read back.
class OffscreenSurface {
 public:
  static Result<OffscreenSurface> create(PixelSize size);
  Surface surface() const noexcept { return {framebuffer_, size_.width, size_.height}; }
  /// RGB, top row first.
  Result<Image> read() const;

 private:
  PixelSize size_;
  GlTexture color_;
  GlFramebuffer framebuffer_;
};

/// Copies a picture scaled into the middle of another, with black borders where the proportions differ.
Result<void> fit_into(const Surface& picture, const Surface& target);

}  // namespace dubsar
