#include "display/render/context/context_glfw.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/system/log.h"
#include "display/render/context/window_recall.h"
#include "display/render/images/utf8.h"

/// Of glfw3native.h, which wants the headers of RandR besides; null in a library for Wayland alone.
extern "C" [[gnu::weak]] unsigned long glfwGetX11Window(GLFWwindow* window);

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
    return fail(ErrorKind::kUnavailable,
                "window: no display server can be reached ({}); expected DISPLAY or WAYLAND_DISPLAY of a session",
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

/// The monitor that holds the middle of the window, else the primary one; null when there is none.
GLFWmonitor* monitor_of(GLFWwindow* window) {
  int x = 0, y = 0, width = 0, height = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetFramebufferSize(window, &width, &height);
  for (GLFWmonitor* const handle : monitor_handles()) {
    const Monitor candidate = describe(handle);
    const int middle_x = x + width / 2 - candidate.x, middle_y = y + height / 2 - candidate.y;
    if (middle_x >= 0 && middle_y >= 0 && middle_x < candidate.width_px && middle_y < candidate.height_px)
      return handle;
  }
  return glfwGetPrimaryMonitor();
}

/// Keys that type nothing; what others type comes from the layout.
std::string key_name(int key) {
  static const std::map<int, const char*> kNames{{GLFW_KEY_LEFT, "left"},
                                                 {GLFW_KEY_RIGHT, "right"},
                                                 {GLFW_KEY_UP, "up"},
                                                 {GLFW_KEY_DOWN, "down"},
                                                 {GLFW_KEY_PAGE_UP, "page_up"},
                                                 {GLFW_KEY_PAGE_DOWN, "page_down"},
                                                 {GLFW_KEY_HOME, "home"},
                                                 {GLFW_KEY_END, "end"},
                                                 {GLFW_KEY_INSERT, "insert"},
                                                 {GLFW_KEY_DELETE, "delete"},
                                                 {GLFW_KEY_BACKSPACE, "backspace"},
                                                 {GLFW_KEY_TAB, "tab"},
                                                 {GLFW_KEY_ENTER, "enter"},
                                                 {GLFW_KEY_KP_ENTER, "enter"},
                                                 {GLFW_KEY_ESCAPE, "escape"},
                                                 {GLFW_KEY_SPACE, "space"},
                                                 {GLFW_KEY_PAUSE, "pause"}};
  if (const auto found = kNames.find(key); found != kNames.end()) return found->second;
  return key >= GLFW_KEY_F1 && key <= GLFW_KEY_F25 ? fmt::format("f{}", key - GLFW_KEY_F1 + 1) : std::string();
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

struct GlfwWindow::Callbacks {
  static GlfwWindow& of(GLFWwindow* handle) { return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(handle)); }

  static void key(GLFWwindow* handle, int key, int scancode, int action, int modifiers) {
    GlfwWindow& window = of(handle);
    window.typing_.reset();
    if (action == GLFW_RELEASE) {
      const auto held = window.held_.extract(scancode);
      if (!held.empty()) window.push({.kind = WindowEvent::Kind::kKey, .key = held.mapped()}, modifiers);
      return;
    }
    std::string name = key_name(key);
    const bool chord = (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
    if (const char* const typed = glfwGetKeyName(key, scancode); name.empty() && typed != nullptr && chord)
      name = typed;
    if (!name.empty()) return window.goes_down(scancode, std::move(name), action == GLFW_REPEAT, modifiers);
    window.typing_ = Typing{scancode, action == GLFW_REPEAT};
  }
  static void character(GLFWwindow* handle, unsigned code) {
    if (code <= ' ') return;
    if (code >= 'A' && code <= 'Z') code += 'a' - 'A';
    GlfwWindow& window = of(handle);
    if (!window.typing_) {  // composed of several keys: nothing is held
      window.push({.kind = WindowEvent::Kind::kKey, .down = true, .key = utf8(code)}, 0);
      window.push({.kind = WindowEvent::Kind::kKey, .key = utf8(code)}, 0);
      return;
    }
    const Typing typing = *std::exchange(window.typing_, std::nullopt);
    window.goes_down(typing.scancode, utf8(code), typing.repeat, held_modifiers(handle));
  }
  static void button(GLFWwindow* handle, int button, int action, int modifiers) {
    const int ours = button == GLFW_MOUSE_BUTTON_LEFT     ? 0
                     : button == GLFW_MOUSE_BUTTON_MIDDLE ? 1
                     : button == GLFW_MOUSE_BUTTON_RIGHT  ? 2
                                                          : -1;
    if (ours >= 0)
      of(handle).push({.kind = WindowEvent::Kind::kButton, .button = ours, .down = action == GLFW_PRESS}, modifiers);
  }
  static void wheel(GLFWwindow* handle, double, double y) {
    if (y != 0.0) of(handle).push({.kind = WindowEvent::Kind::kWheel, .y = y}, held_modifiers(handle));
  }
  static void cursor(GLFWwindow* handle, double x, double y) {
    GlfwWindow& window = of(handle);
    int width = 0, height = 0, pixels_x = 0, pixels_y = 0;  // a desktop may count in units of its own
    glfwGetWindowSize(handle, &width, &height);
    glfwGetFramebufferSize(handle, &pixels_x, &pixels_y);
    x *= width > 0 ? static_cast<double>(pixels_x) / width : 1.0;
    y *= height > 0 ? static_cast<double>(pixels_y) / height : 1.0;
    const auto before = std::exchange(window.cursor_, std::array<double, 2>{x, y});
    const std::array<double, 2> from = before.value_or(*window.cursor_);  // the first place is no movement
    window.push({.kind = WindowEvent::Kind::kMotion, .x = x - from[0], .y = y - from[1]}, held_modifiers(handle));
  }
  static void enter(GLFWwindow* handle, int) {
    for (const int button : {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_MIDDLE, GLFW_MOUSE_BUTTON_RIGHT})
      if (glfwGetMouseButton(handle, button) == GLFW_PRESS) return;  // a drag goes on outside
    of(handle).cursor_.reset();
  }
  static void drop(GLFWwindow* handle, int count, const char** paths) {
    const GlfwWindow& window = of(handle);
    if (window.dropped_) window.dropped_(std::vector<std::string>(paths, paths + count));
  }
  static void moved(GLFWwindow* handle, int, int) { of(handle).place_changed_ = true; }
  static void damaged(GLFWwindow* handle) { of(handle).damaged_ = true; }
  static void iconified(GLFWwindow* handle, int) { of(handle).damaged_ = true; }
  static int held_modifiers(GLFWwindow* handle) {
    const auto held = [&](int left, int right) {
      return glfwGetKey(handle, left) == GLFW_PRESS || glfwGetKey(handle, right) == GLFW_PRESS;
    };
    return (held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT) ? GLFW_MOD_SHIFT : 0) |
           (held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL) ? GLFW_MOD_CONTROL : 0) |
           (held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT) ? GLFW_MOD_ALT : 0);
  }
  static void install(GlfwWindow& window) {
    GLFWwindow* const handle = as_window(window.window_);
    glfwSetWindowUserPointer(handle, &window);
    glfwSetKeyCallback(handle, key);
    glfwSetCharCallback(handle, character);
    glfwSetMouseButtonCallback(handle, button);
    glfwSetScrollCallback(handle, wheel);
    glfwSetCursorPosCallback(handle, cursor);
    glfwSetCursorEnterCallback(handle, enter);
    glfwSetDropCallback(handle, drop);
    glfwSetWindowPosCallback(handle, moved);
    glfwSetFramebufferSizeCallback(handle, moved);
    glfwSetWindowRefreshCallback(handle, damaged);
    glfwSetWindowIconifyCallback(handle, iconified);
  }
};

void GlfwWindow::push(WindowEvent event, int modifiers) {
  event.time = SteadyClock().now();
  event.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
  event.control = (modifiers & GLFW_MOD_CONTROL) != 0;
  event.alt = (modifiers & GLFW_MOD_ALT) != 0;
  event.at = cursor_;
  if (told_) told_(event);
}

void GlfwWindow::goes_down(int scancode, std::string name, bool repeat, int modifiers) {
  held_[scancode] = name;
  push({.kind = WindowEvent::Kind::kKey, .down = true, .repeat = repeat, .key = std::move(name)}, modifiers);
}

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
    return fail(ErrorKind::kUsage, "window: {} x {} pixels asked for, expected 1 to 16384 a side", options.width,
                options.height);
  DUBSAR_ASSIGN(GLFWmonitor* const monitor, choose_monitor(options.monitor));
  const Monitor place = describe(monitor);
  set_hints(options);
  const int width = options.fullscreen ? place.width_px : options.width;
  const int height = options.fullscreen ? place.height_px : options.height;
  static_cast<void>(glfwGetError(nullptr));
  GLFWwindow* const handle =
      glfwCreateWindow(width, height, options.title.c_str(), options.fullscreen ? monitor : nullptr, nullptr);
  if (handle == nullptr)
    return fail(ErrorKind::kUnavailable, "window: the driver has no {}OpenGL 4.5 window ({})",
                options.stereo ? "quad-buffered (stereo) " : "", last_error());
  std::unique_ptr<GlfwWindow> window(new GlfwWindow(handle));
  Callbacks::install(*window);
  window->windowed_ = {place.x + std::max(0, (place.width_px - options.width) / 2),
                       place.y + std::max(0, (place.height_px - options.height) / 2), options.width, options.height};
  if (!options.fullscreen && (options.x || !options.monitor.empty()))
    glfwSetWindowPos(handle, place.x + options.x.value_or(0), place.y + options.y.value_or(0));
  glfwMakeContextCurrent(handle);
  if (!has_gl45()) return fail(ErrorKind::kUnavailable, "window: {} found, expected OpenGL 4.5", describe_gl());
  GLboolean two = GL_FALSE;
  glGetBooleanv(GL_STEREO, &two);
  window->stereo_ = two == GL_TRUE;
  if (options.stereo && !window->stereo_)
    return fail(ErrorKind::kUnavailable,
                "window: the driver promised a quad-buffered (stereo) window and gave one with a single buffer");
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
  GLFWmonitor* const monitor = monitor_of(as_window(window_));
  const Monitor on = monitor != nullptr ? describe(monitor) : Monitor();
  Screen out = fallback;
  if (on.width_px > 0 && on.height_px > 0) std::tie(out.width_px, out.height_px) = std::tie(on.width_px, on.height_px);
  if (on.width_mm > 0 && on.height_mm > 0) std::tie(out.width_mm, out.height_mm) = std::tie(on.width_mm, on.height_mm);
  out.window_x = x - on.x;
  out.window_y = y - on.y;
  out.window_w = pixels.width;
  out.window_h = pixels.height;
  return out;
}

void GlfwWindow::present() { glfwSwapBuffers(as_window(window_)); }
void GlfwWindow::poll_events() { glfwPollEvents(); }
void GlfwWindow::set_title(const std::string& title) { glfwSetWindowTitle(as_window(window_), title.c_str()); }
void GlfwWindow::keep_open() { glfwSetWindowShouldClose(as_window(window_), GLFW_FALSE); }
bool GlfwWindow::should_close() const { return glfwWindowShouldClose(as_window(window_)) == GLFW_TRUE; }
bool GlfwWindow::focused() const { return glfwGetWindowAttrib(as_window(window_), GLFW_FOCUSED) == GLFW_TRUE; }
void GlfwWindow::wait_for_monitor(bool waits) { glfwSwapInterval(waits ? 1 : 0); }
void GlfwWindow::wait_events(double timeout_s) { glfwWaitEventsTimeout(std::max(timeout_s, 1e-4)); }
bool GlfwWindow::take_place_changed() { return std::exchange(place_changed_, false); }
bool GlfwWindow::take_damaged() { return std::exchange(damaged_, false); }
void GlfwWindow::close() { glfwSetWindowShouldClose(as_window(window_), GLFW_TRUE); }
bool GlfwWindow::fullscreen() const { return glfwGetWindowMonitor(as_window(window_)) != nullptr; }

bool GlfwWindow::on_screen() const {
  return glfwGetWindowAttrib(as_window(window_), GLFW_VISIBLE) == GLFW_TRUE &&
         glfwGetWindowAttrib(as_window(window_), GLFW_ICONIFIED) == GLFW_FALSE;
}

void GlfwWindow::come_back(bool keyboard) {
  if (glfwGetX11Window == nullptr) return glfwRestoreWindow(as_window(window_));
  recall_window(static_cast<std::uint32_t>(glfwGetX11Window(as_window(window_))), fullscreen(), keyboard);
}

bool GlfwWindow::covers_monitor() const {
  const Screen at = screen();
  return fullscreen() && at.window_x == 0 && at.window_y == 0 && at.window_w == at.width_px &&
         at.window_h == at.height_px;
}

double GlfwWindow::content_scale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(as_window(window_), &x, &y);
  return std::isfinite(y) && y > 0 ? double{y} : 1.0;
}

double GlfwWindow::refresh_hz() const {
  GLFWmonitor* const monitor = monitor_of(as_window(window_));
  return monitor != nullptr ? describe(monitor).refresh_hz : 0.0;
}

Result<void> GlfwWindow::set_fullscreen(const std::string& monitor) {
  GLFWmonitor* target = monitor_of(as_window(window_));
  if (!monitor.empty()) {
    DUBSAR_ASSIGN(target, choose_monitor(monitor));
  }
  if (target == nullptr) return fail(ErrorKind::kUnavailable, "window: the display server has no monitor");
  if (!fullscreen()) {
    glfwGetWindowPos(as_window(window_), &windowed_.x, &windowed_.y);
    glfwGetWindowSize(as_window(window_), &windowed_.width, &windowed_.height);
  }
  const Monitor place = describe(target);
  glfwSetWindowMonitor(as_window(window_), target, 0, 0, place.width_px, place.height_px, GLFW_DONT_CARE);
  place_changed_ = true;
  return {};
}

void GlfwWindow::set_windowed() {
  if (!fullscreen()) return;
  glfwSetWindowMonitor(as_window(window_), nullptr, windowed_.x, windowed_.y, windowed_.width, windowed_.height,
                       GLFW_DONT_CARE);
  place_changed_ = true;
}

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
