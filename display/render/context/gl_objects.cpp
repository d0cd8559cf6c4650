#include "display/render/context/gl_objects.h"

#include <algorithm>
#include <array>
#include <string>

#include "display/render/context/embedded_shaders.h"

namespace dubsar {
namespace {

std::string_view shader_source(std::string_view name) {
  for (const auto& [file, text] : embedded_shaders())
    if (file == name) return text;
  return {};
}

struct Shader {
  explicit Shader(GLenum kind) : name(glCreateShader(kind)) {}
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  ~Shader() { glDeleteShader(name); }
  GLuint name;
};

/// The text with each line `#include "NAME"` replaced by the shader file of that name.
std::string with_includes(std::string_view source) {
  constexpr std::string_view kInclude = "#include \"";
  std::string out;
  for (std::size_t at = 0; at < source.size();) {
    const std::size_t end = std::min(source.find('\n', at), source.size());
    const std::string_view line = source.substr(at, end - at);
    at = end + 1;
    if (line.starts_with(kInclude)) {
      const std::string_view text = shader_source(line.substr(kInclude.size(), line.rfind('"') - kInclude.size()));
      DUBSAR_CHECK(!text.empty());
      out += with_includes(text);
    } else {
      out += line;
      out += '\n';
    }
  }
  return out;
}

Result<void> compile(const Shader& shader, std::string_view file, std::string_view lines = {}) {
  DUBSAR_CHECK(!shader_source(file).empty());
  const std::string source = with_includes(shader_source(file));
  const std::size_t version = source.find('\n') + 1;  // #version has to be the first line
  const std::array<const GLchar*, 3> texts{source.data(), lines.empty() ? "" : lines.data(), source.data() + version};
  const std::array<GLint, 3> lengths{static_cast<GLint>(version), static_cast<GLint>(lines.size()),
                                     static_cast<GLint>(source.size() - version)};
  glShaderSource(shader.name, 3, texts.data(), lengths.data());
  glCompileShader(shader.name);
  GLint good = GL_FALSE;
  glGetShaderiv(shader.name, GL_COMPILE_STATUS, &good);
  if (good == GL_TRUE) return {};
  GLint size = 0;
  glGetShaderiv(shader.name, GL_INFO_LOG_LENGTH, &size);
  std::string log(static_cast<std::size_t>(size) + 1, '\0');
  glGetShaderInfoLog(shader.name, size + 1, &size, log.data());
  log.resize(static_cast<std::size_t>(size));
  return fail(ErrorKind::kInternal, "gl: the driver refuses shader {}: {}", file, log);
}

}  // namespace

void ProgramKind::destroy(GLuint name) {
  GLint used = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &used);
  if (static_cast<GLuint>(used) == name) glUseProgram(0);
  glDeleteProgram(name);
}

GlBuffer make_buffer(std::span<const std::byte> bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  return GlBuffer(name);
}

GlBuffer make_room(std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  return GlBuffer(name);
}

GlBuffer make_stream_buffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return GlBuffer(name);
}

void stream(const GlBuffer& buffer, std::span<const std::byte> bytes) {
  glNamedBufferData(buffer, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_DRAW);
}

GlFramebuffer make_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return GlFramebuffer(name);
}

GlVertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlTexture make_texture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return GlTexture(name);
}

Result<GlProgram> make_program(std::string_view vertex_name, std::string_view fragment_name,
                               std::string_view vertex_lines, std::string_view fragment_lines) {
  const Shader vertex(GL_VERTEX_SHADER), fragment(GL_FRAGMENT_SHADER);
  DUBSAR_TRY(compile(vertex, vertex_name, vertex_lines));
  DUBSAR_TRY(compile(fragment, fragment_name, fragment_lines));
  GlProgram program(glCreateProgram());
  glAttachShader(program, vertex.name);
  glAttachShader(program, fragment.name);
  glLinkProgram(program);
  glDetachShader(program, vertex.name);
  glDetachShader(program, fragment.name);
  GLint good = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (good == GL_TRUE) return program;
  GLint size = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &size);
  std::string log(static_cast<std::size_t>(size) + 1, '\0');
  glGetProgramInfoLog(program, size + 1, &size, log.data());
  log.resize(static_cast<std::size_t>(size));
  return fail(ErrorKind::kInternal, "gl: {} and {} do not link: {}", vertex_name, fragment_name, log);
}

Result<void> check_gl(std::string_view what) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return {};
  while (glGetError() != GL_NO_ERROR) {
  }
  if (error == GL_OUT_OF_MEMORY) return fail(ErrorKind::kTryAgain, "gl: out of graphics memory while {}", what);
  return fail(ErrorKind::kInternal, "gl: error 0x{:04x} while {}", error, what);
}

}  // namespace dubsar
