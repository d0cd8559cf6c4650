#include "display/render/context/gl_context.h"

#include <epoxy/gl.h>

#include <string_view>

#include "core/base/system/log.h"

namespace dubsar {
namespace {

void GLAPIENTRY on_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                           const void*) {
  const std::string_view message(text, length >= 0 ? static_cast<std::size_t>(length) : std::string_view(text).size());
  if (severity == GL_DEBUG_SEVERITY_HIGH || type == GL_DEBUG_TYPE_ERROR)
    log_warning("gl: {}", message);
  else
    log_debug("gl: {}", message);
}

std::string gl_text(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text != nullptr ? reinterpret_cast<const char*>(text) : "unknown";
}

}  // namespace

std::string describe_gl() {
  return gl_text(GL_VENDOR) + ", " + gl_text(GL_RENDERER) + ", OpenGL " + gl_text(GL_VERSION);
}

void log_gl_messages() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
  glDebugMessageCallback(on_message, nullptr);
}

bool has_gl45() { return epoxy_is_desktop_gl() && epoxy_gl_version() >= 45; }

}  // namespace dubsar
