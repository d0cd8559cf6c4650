#pragma once

#include <epoxy/gl.h>

namespace dubsar {

inline constexpr GLuint kViewsBinding = 0;  ///< uniform block of all shaders that draw into several views

}  // namespace dubsar
