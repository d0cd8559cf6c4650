#pragma once
// Grey values of a cut through the scan, in graphics memory.

#include <span>

#include "core/base/result.h"
#include "display/render/context/gl_objects.h"

namespace dubsar {

class SliceImage {
 public:
  /// `values` row after row, width x height of them, as they are in the scan. kUsage when they are not as many, or more
  /// on a side than the context allows; kTryAgain without memory.
  static Result<SliceImage> upload(int width, int height, std::span<const float> values);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  GLuint texture() const noexcept { return texture_; }

 private:
  int width_ = 0, height_ = 0;
  GlTexture texture_;
};

}  // namespace dubsar
