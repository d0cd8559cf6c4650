#pragma once
// What the renderer fills and a sink composes: one layer of a texture array per view.

#include "core/base/result.h"
#include "core/image_io/image.h"
#include "display/render/context/gl_objects.h"

namespace dubsar {

/// Layer k shows view k; row 0 is the bottom row, as in GL. Colours are sRGB-coded with straight alpha. Two names for
/// the same memory: coded() gives the bytes as they are (exact copies), linear() decodes them when sampled, for
/// mixing in linear light.
class ViewArray {
 public:
  /// kUsage beyond the limits of the context (llvmpipe: 16384 pixels, 2048 layers), kTryAgain without memory.
  static Result<ViewArray> create(int width, int height, int layers);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  int layers() const noexcept { return layers_; }
  bool measures(int width, int height, int layers) const noexcept {
    return width == width_ && height == height_ && layers == layers_;
  }
  GLuint coded() const noexcept { return coded_; }
  GLuint linear() const noexcept { return linear_; }

  /// RGBA, top row first. Waits for the GPU.
  Result<Image> read_layer(int layer) const;
  /// Puts an RGBA picture of the same size into a layer (test patterns, pictures from files).
  Result<void> write_layer(int layer, const Image& image);

 private:
  int width_ = 0, height_ = 0, layers_ = 0;
  GlTexture coded_, linear_;
};

}  // namespace dubsar
