#pragma once
// Windows and monitors through GLFW; the only source that includes it. All of this belongs to the main thread.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image_io/image.h"
#include "display/gl_context.h"
#include "display/output_sink.h"

namespace dubsar {

struct Monitor {
  std::string name;
  int x = 0, y = 0;                         ///< place on the desktop
  int width_px = 0, height_px = 0;          ///< of its current mode
  double width_mm = 0.0, height_mm = 0.0;   ///< 0 when the monitor does not say
  double refresh_hz = 0.0;
  bool primary = false;
};

/// kUnavailable, with the reason, when there is no display server.
Result<std::vector<Monitor>> list_monitors();

struct WindowOptions {
  std::string title = "dubsar";
  int width = 1280, height = 720;         ///< physical pixels of the drawing area
  std::optional<int> x, y;                ///< upper left corner of the drawing area, from the monitor's; both or none
  std::string monitor;                    ///< part of a monitor's name; empty: the primary one
  bool fullscreen = false;                ///< the monitor's size and mode; width, height, x and y are not used
  bool decorated = true;                  ///< false: no title bar and borders, as panels with lenses need it
  bool visible = true;
  bool stereo = false;                    ///< a quad-buffered visual, or the call fails
};

/// A window with a current GL 4.5 core context and vertical synchronisation.
class GlfwWindow final : public GlContext {
 public:
  /// Errors: kUnavailable (no display server, no GL 4.5, no stereo visual), kUsage (no such monitor).
  static Result<std::unique_ptr<GlfwWindow>> create(const WindowOptions& options);
  ~GlfwWindow() override;

  Result<void> make_current() override;
  /// What compose() draws into; carries eye buffers when the context is quad-buffered.
  Surface surface() const;
  /// True when the context has a left and a right back buffer.
  bool stereo() const noexcept { return stereo_; }
  PixelSize size() const;
  /// The monitor that holds the middle of the window, and where the window is on it, as a sink wants to know. Sizes that
  /// the monitor does not tell come from `fallback`.
  Screen screen(const Screen& fallback = {}) const;

  void present();  ///< swaps buffers
  void poll_events();
  bool should_close() const;
  /// RGB, top row first: what was drawn since the last present(). `eye` 1 reads the right buffer of a stereo window.
  Result<Image> read(int eye = 0) const;

  /// The GLFWwindow, for user interface libraries that want it.
  void* handle() const noexcept { return window_; }

 private:
  explicit GlfwWindow(void* window) : window_(window) {}
  void* window_;
  bool stereo_ = false;
};

}  // namespace dubsar
