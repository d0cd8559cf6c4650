#include "display/render/images/slice_image.h"

namespace dubsar {

Result<SliceImage> SliceImage::upload(int width, int height, std::span<const float> values) {
  GLint max_side = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_side);
  if (width < 1 || height < 1 || width > max_side || height > max_side)
    return fail(ErrorKind::kUsage, "slice: {} x {} values found, expected 1 to {} on each side", width, height,
                max_side);
  if (values.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return fail(ErrorKind::kUsage, "slice: {} values found, expected {} x {}", values.size(), width, height);
  SliceImage out;
  out.width_ = width;
  out.height_ = height;
  out.texture_ = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(out.texture_, 1, GL_R32F, width, height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(out.texture_, 0, 0, 0, width, height, GL_RED, GL_FLOAT, values.data());
  glTextureParameteri(out.texture_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(out.texture_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(out.texture_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(out.texture_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  DUBSAR_TRY(check_gl("uploading a slice"));
  return out;
}

}  // namespace dubsar
