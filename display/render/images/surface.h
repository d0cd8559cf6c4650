#pragma once
// What pictures are drawn on: sizes in pixels, and a GL frame buffer with its eyes.

#include <array>

namespace dubsar {

struct PixelSize {
  int width = 0, height = 0;
  friend bool operator==(const PixelSize&, const PixelSize&) = default;
};

/// Where a display's picture goes: a GL frame buffer (0: the window). Bytes are sRGB-coded.
struct Surface {
  unsigned framebuffer = 0;
  int width = 0, height = 0;
  /// Draw buffers of the left and the right eye (GL_BACK_LEFT and GL_BACK_RIGHT, or two colour attachments); 0: the
  /// surface holds one picture.
  std::array<unsigned, 2> eye_buffers{0, 0};
};

}  // namespace dubsar
