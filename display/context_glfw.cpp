#include "display/context_glfw.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

#include "core/base/log.h"

namespace dubsar {
namespace {

GLFWwindow* as_window(void* handle) { return static_cast<GLFWwindow*>(handle); }

std::string last_error() {
  const char* text = nullptr;
  return glfwGetError(&text) != GLFW_NO_ERROR && text != nullptr ? text : "no reason given";
}

/// Started once, and ended with the process: GLFW keeps process-wide state.
Result<void> start_glfw() {
  static bool started = false;
  if (started) return {};
  glfwInitHint(GLFW_JOYSTICK_HAT_BUTTONS, GLFW_FALSE);
  if (glfwInit() != GLFW_TRUE)
    return fail(ErrorKind::kUnavailable, "window: no display server can be reached ({}); expected DISPLAY or WAYLAND_DISPLAY of a session",
                last_error());
  started = true;
  return {};
}

std::vector<GLFWmonitor*> monitor_handles() {
  int count = 0;
  GLFWmonitor** const handles = glfwGetMonitors(&count);
  return {handles, handles + count};
}

Monitor describe(GLFWmonitor* handle) {
  Monitor out;
  const char* const name = glfwGetMonitorName(handle);
  out.name = name != nullptr ? name : "";
  glfwGetMonitorPos(handle, &out.x, &out.y);
  if (const GLFWvidmode* const mode = glfwGetVideoMode(handle)) {
    out.width_px = mode->width;
    out.height_px = mode->height;
    out.refresh_hz = mode->refreshRate;
  }
  int width_mm = 0, height_mm = 0;
  glfwGetMonitorPhysicalSize(handle, &width_mm, &height_mm);
  out.width_mm = width_mm;
  out.height_mm = height_mm;
  out.primary = handle == glfwGetPrimaryMonitor();
  return out;
}

Result<GLFWmonitor*> choose_monitor(const std::string& part) {
  std::string names;
  for (GLFWmonitor* const handle : monitor_handles()) {
    const Monitor monitor = describe(handle);
    if (part.empty() ? monitor.primary : monitor.name.find(part) != std::string::npos) return handle;
    names += (names.empty() ? "" : ", ") + monitor.name;
  }
  if (part.empty()) return fail(ErrorKind::kUnavailable, "window: the display server has no monitor");
  return fail(ErrorKind::kUsage, "window: no monitor's name contains \"{}\", expected one of: {}", part, names);
}

void set_hints(const WindowOptions& options) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_STEREO, options.stereo ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_SAMPLES, 0);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SRGB_CAPABLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_FALSE);
  glfwWindowHint(GLFW_DECORATED, options.decorated && !options.fullscreen ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_RESIZABLE, options.decorated ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
}

}  // namespace

Result<std::vector<Monitor>> list_monitors() {
  DUBSAR_TRY(start_glfw());
  std::vector<Monitor> out;
  for (GLFWmonitor* const handle : monitor_handles()) out.push_back(describe(handle));
  return out;
}

Result<std::unique_ptr<GlfwWindow>> GlfwWindow::create(const WindowOptions& options) {
  DUBSAR_TRY(start_glfw());
  DUBSAR_CHECK(options.x.has_value() == options.y.has_value());
  if (options.width < 1 || options.height < 1 || options.width > 16384 || options.height > 16384)
    return fail(ErrorKind::kUsage, "window: {} x {} pixels asked for, expected 1 to 16384 a side", options.width, options.height);
  DUBSAR_ASSIGN(GLFWmonitor* const monitor, choose_monitor(options.monitor));
  const Monitor place = describe(monitor);
  set_hints(options);
  const int width = options.fullscreen ? place.width_px : options.width;
  const int height = options.fullscreen ? place.height_px : options.height;
  static_cast<void>(glfwGetError(nullptr));
  GLFWwindow* const handle = glfwCreateWindow(width, height, options.title.c_str(), options.fullscreen ? monitor : nullptr, nullptr);
  if (handle == nullptr)
    return fail(ErrorKind::kUnavailable, "window: the driver has no {}OpenGL 4.5 window ({})", options.stereo ? "quad-buffered (stereo) " : "",
                last_error());
  std::unique_ptr<GlfwWindow> window(new GlfwWindow(handle));
  if (!options.fullscreen && (options.x || !options.monitor.empty()))
    glfwSetWindowPos(handle, place.x + options.x.value_or(0), place.y + options.y.value_or(0));
  glfwMakeContextCurrent(handle);
  if (!has_gl45()) return fail(ErrorKind::kUnavailable, "window: {} found, expected OpenGL 4.5", describe_gl());
  GLboolean two = GL_FALSE;
  glGetBooleanv(GL_STEREO, &two);
  window->stereo_ = two == GL_TRUE;
  if (options.stereo && !window->stereo_)
    return fail(ErrorKind::kUnavailable, "window: the driver promised a quad-buffered (stereo) window and gave one with a single buffer");
  log_gl_messages();
  glfwSwapInterval(1);
  if (options.visible) glfwShowWindow(handle);
  glfwPollEvents();
  return window;
}

GlfwWindow::~GlfwWindow() { glfwDestroyWindow(as_window(window_)); }

Result<void> GlfwWindow::make_current() {
  glfwMakeContextCurrent(as_window(window_));
  if (glfwGetCurrentContext() == as_window(window_)) return {};
  return fail(ErrorKind::kUnavailable, "window: its context cannot be made current ({})", last_error());
}

PixelSize GlfwWindow::size() const {
  PixelSize out;
  glfwGetFramebufferSize(as_window(window_), &out.width, &out.height);
  return out;
}

Surface GlfwWindow::surface() const {
  const PixelSize pixels = size();
  Surface out{.framebuffer = 0, .width = pixels.width, .height = pixels.height};
  if (stereo_) out.eye_buffers = {GL_BACK_LEFT, GL_BACK_RIGHT};
  return out;
}

Screen GlfwWindow::screen(const Screen& fallback) const {
  int x = 0, y = 0;
  glfwGetWindowPos(as_window(window_), &x, &y);
  const PixelSize pixels = size();
  Monitor on;
  for (GLFWmonitor* const handle : monitor_handles()) {
    const Monitor candidate = describe(handle);
    const int middle_x = x + pixels.width / 2 - candidate.x, middle_y = y + pixels.height / 2 - candidate.y;
    const bool holds = middle_x >= 0 && middle_y >= 0 && middle_x < candidate.width_px && middle_y < candidate.height_px;
    if (holds || (candidate.primary && on.width_px == 0)) on = candidate;
    if (holds) break;
  }
  Screen out = fallback;
  if (on.width_px > 0 && on.height_px > 0) {
    out.width_px = on.width_px;
    out.height_px = on.height_px;
  }
  if (on.width_mm > 0 && on.height_mm > 0) {
    out.width_mm = on.width_mm;
    out.height_mm = on.height_mm;
  }
  out.window_x = x - on.x;
  out.window_y = y - on.y;
  out.window_w = pixels.width;
  out.window_h = pixels.height;
  return out;
}

void GlfwWindow::present() { glfwSwapBuffers(as_window(window_)); }
void GlfwWindow::poll_events() { glfwPollEvents(); }
bool GlfwWindow::should_close() const { return glfwWindowShouldClose(as_window(window_)) == GLFW_TRUE; }

Result<Image> GlfwWindow::read(int eye) const {
  DUBSAR_CHECK(eye == 0 || (eye == 1 && stereo_));
  const PixelSize pixels = size();
  Image image(pixels.width, pixels.height, 3);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(stereo_ ? (eye == 0 ? GL_BACK_LEFT : GL_BACK_RIGHT) : GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, pixels.width, pixels.height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    return fail(ErrorKind::kInternal, "window: error 0x{:04x} while reading the picture back", error);
  for (int y = 0; y < pixels.height / 2; ++y)
    std::swap_ranges(image.at(0, y), image.at(0, y) + 3 * pixels.width, image.at(0, pixels.height - 1 - y));
  return image;
}

}  // namespace dubsar
