#pragma once
// Owners of GL names, and programs built from the embedded shaders. Include only in sources that draw.

#include <epoxy/gl.h>

#include <span>
#include <string_view>
#include <utility>

#include "core/base/result.h"

namespace dubsar {

/// Owns one GL name; made and destroyed with the same context current. 0 owns nothing.
template <class Kind>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) Kind::destroy(name_);
  }
  operator GLuint() const noexcept { return name_; }

 private:
  GLuint name_ = 0;
};

struct BufferKind {
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct TextureKind {
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct FramebufferKind {
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct VertexArrayKind {
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct ProgramKind {
  /// One that is in use would live on until another is used, and whoever restores it then names what is gone.
  static void destroy(GLuint name);
};
using GlBuffer = GlName<BufferKind>;
using GlTexture = GlName<TextureKind>;
using GlFramebuffer = GlName<FramebufferKind>;
using GlVertexArray = GlName<VertexArrayKind>;
using GlProgram = GlName<ProgramKind>;

GlBuffer make_buffer(std::span<const std::byte> bytes);
/// Without contents; glNamedBufferSubData brings them.
GlBuffer make_room(std::size_t bytes);
/// A buffer whose contents change: stream() puts them in, whatever the GPU still reads of the old ones.
GlBuffer make_stream_buffer();
void stream(const GlBuffer& buffer, std::span<const std::byte> bytes);
GlFramebuffer make_framebuffer();
GlVertexArray make_vertex_array();
GlTexture make_texture(GLenum target);

/// Compiles and links two embedded shaders (names of files in shaders/). kInternal with the driver's log when it
/// refuses them: they are ours. The lines go below the #version line of either shader (switches). A line
/// `#include "NAME"` of a shader stands for another file of shaders/.
Result<GlProgram> make_program(std::string_view vertex_name, std::string_view fragment_name,
                               std::string_view vertex_lines = {}, std::string_view fragment_lines = {});

/// kTryAgain for GL_OUT_OF_MEMORY, kInternal for any other GL error since the last check. `what` was being done.
Result<void> check_gl(std::string_view what);

}  // namespace dubsar
