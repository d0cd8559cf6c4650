#pragma once

#include <epoxy/gl.h>

namespace dubsar {

inline constexpr GLint kLayerLocation = 0, kOriginLocation = 1;  ///< uniforms of shaders/copy.frag

}  // namespace dubsar
