#include "display/render/view_array.h"

#include <algorithm>

namespace dubsar {

Result<ViewArray> ViewArray::create(int width, int height, int layers) {
  GLint max_side = 0, max_layers = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_side);
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &max_layers);
  if (width < 1 || height < 1 || width > max_side || height > max_side)
    return fail(ErrorKind::kUsage, "render: views of {} x {} pixels asked for, expected 1 to {} on each side", width,
                height, max_side);
  if (layers < 1 || layers > max_layers)
    return fail(ErrorKind::kUsage, "render: {} views asked for, expected 1 to {}", layers, max_layers);
  ViewArray out;
  out.width_ = width;
  out.height_ = height;
  out.layers_ = layers;
  out.coded_ = make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(out.coded_, 1, GL_RGBA8, width, height, layers);
  GLuint alias = 0;
  glGenTextures(1, &alias);
  out.linear_ = GlTexture(alias);
  glTextureView(alias, GL_TEXTURE_2D_ARRAY, out.coded_, GL_SRGB8_ALPHA8, 0, 1, 0, static_cast<GLuint>(layers));
  for (const GLuint texture : {out.coded(), out.linear()}) {
    glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  DUBSAR_TRY(check_gl("making the view array"));
  return out;
}

Result<Image> ViewArray::read_layer(int layer) const {
  DUBSAR_CHECK(layer >= 0 && layer < layers_);
  Image image(width_, height_, 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureSubImage(coded_, 0, 0, 0, layer, width_, height_, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                       static_cast<GLsizei>(image.pixels.size()), image.pixels.data());
  DUBSAR_TRY(check_gl("reading a view back"));
  for (int y = 0; y < height_ / 2; ++y)
    std::swap_ranges(image.at(0, y), image.at(0, y) + 4 * width_, image.at(0, height_ - 1 - y));
  return image;
}

Result<void> ViewArray::write_layer(int layer, const Image& image) {
  DUBSAR_CHECK(layer >= 0 && layer < layers_ && image.channels == 4 && image.width == width_ &&
               image.height == height_);
  Image flipped = image;
  for (int y = 0; y < height_; ++y) std::copy_n(image.at(0, y), 4 * width_, flipped.at(0, height_ - 1 - y));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(coded_, 0, 0, 0, layer, width_, height_, 1, GL_RGBA, GL_UNSIGNED_BYTE, flipped.pixels.data());
  return check_gl("writing a view");
}

}  // namespace dubsar
