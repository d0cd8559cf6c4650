#pragma once
// Windows and monitors through GLFW; the only source that includes it. All of this belongs to the main thread.

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/system/clock.h"
#include "core/image_io/image.h"
#include "display/optics/off_axis.h"
#include "display/panels/monitor.h"
#include "display/render/context/gl_context.h"
#include "display/render/images/surface.h"

namespace dubsar {

/// kUnavailable, with the reason, when there is no display server.
Result<std::vector<Monitor>> list_monitors();

struct WindowOptions {
  std::string title = "dubsar";
  int width = 1280, height = 720;  ///< physical pixels of the drawing area
  std::optional<int> x, y;         ///< upper left corner of the drawing area, from the monitor's; both or none
  std::string monitor;             ///< part of a monitor's name; empty: the primary one
  bool fullscreen = false;         ///< the monitor's size and mode; width, height, x and y are not used
  bool decorated = true;           ///< false: no title bar and borders, as panels with lenses need it
  bool visible = true;
  bool stereo = false;  ///< a quad-buffered visual, or the call fails
};

/// Something that happened in a window, as plain data.
struct WindowEvent {
  enum class Kind { kMotion, kButton, kWheel, kKey };
  TimestampNs time = 0;  ///< steady clock, when the window heard of it
  Kind kind = Kind::kMotion;
  double x = 0.0,
         y = 0.0;       ///< kMotion: pixels to the right and down; kWheel: notches in y, positive away from the user
  int button = 0;       ///< kButton: 0 left, 1 middle, 2 right
  bool down = false;    ///< kButton, kKey
  bool repeat = false;  ///< kKey: it is held, and nobody pressed it again
  bool shift = false, control = false, alt = false;
  /// kKey: "left", "page_up", "escape", "f5", "space" ... for keys that type nothing, else what the keyboard's layout
  /// types ("a", "+", "?"); with control or alt what the key types alone ("z").
  std::string key{};
  /// Where the pointer is: pixels from the upper left corner of the drawing area; none before it was in the window.
  std::optional<std::array<double, 2>> at{};
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
  /// The monitor that holds the middle of the window, and where the window is on it, as a sink wants to know. Sizes
  /// that the monitor does not tell come from `fallback`.
  Screen screen(const Screen& fallback = {}) const;

  void present();  ///< swaps buffers
  /// Whether present() waits for the monitor, as it does at first; else something else paces the pictures.
  void wait_for_monitor(bool waits);
  void poll_events();
  /// Returns when something happens in the window, at the latest after `timeout_s`.
  void wait_events(double timeout_s);
  /// Told every event, in order, while poll_events() or wait_events() runs. There is no queue here.
  void on_event(std::function<void(const WindowEvent&)> told) { told_ = std::move(told); }
  /// Told the names of files that somebody lets fall on the window, while events are taken.
  void on_drop(std::function<void(const std::vector<std::string>&)> told) { dropped_ = std::move(told); }
  void set_title(const std::string& title);
  /// True when the window was moved, resized or put on another monitor since the last call.
  bool take_place_changed();
  /// True when a part of what was shown is lost since the last call: another window stood before it, or it was
  /// minimised. Whoever draws presents the picture again.
  bool take_damaged();
  /// True while it is mapped: neither minimised nor hidden by whoever manages windows. Asks the window system.
  bool on_screen() const;
  bool focused() const;  ///< keys come to it. Asks the window system
  /// Mapped again, over all others and on all desktops, covering its monitor if it did, with the keyboard if
  /// `keyboard`: as far as whoever manages windows grants that (X11; elsewhere only what the window system lets a
  /// program ask for).
  void come_back(bool keyboard);
  bool should_close() const;
  void keep_open();  ///< should_close() is false again
  void close();      ///< as if the user had closed it

  /// Covers the monitor whose name contains `monitor` (empty: the one that holds the window's middle), or goes back to
  /// where the window was. kUsage when there is no such monitor.
  Result<void> set_fullscreen(const std::string& monitor = {});
  void set_windowed();
  bool fullscreen() const;
  /// It is fullscreen() and as large as its monitor, and where that is. False where a window manager made it smaller.
  bool covers_monitor() const;
  /// How many times larger than on a plain monitor things shall be here, as the desktop says: 1, 1.5, 2 ...
  double content_scale() const;
  double refresh_hz() const;  ///< of the monitor the window is on; 0 when it does not say
  /// RGB, top row first: what was drawn since the last present(). `eye` 1 reads the right buffer of a stereo window.
  Result<Image> read(int eye = 0) const;

  /// The GLFWwindow, for user interface libraries that want it.
  void* handle() const noexcept { return window_; }

 private:
  explicit GlfwWindow(void* window) : window_(window) {}
  struct Callbacks;
  struct Place {
    int x = 0, y = 0, width = 0, height = 0;
  };
  struct Typing {  ///< a key that types went down; what it types comes in the next callback
    int scancode = 0;
    bool repeat = false;
  };
  void push(WindowEvent event, int modifiers);
  void goes_down(int scancode, std::string name, bool repeat, int modifiers);

  void* window_;
  bool stereo_ = false;
  std::function<void(const WindowEvent&)> told_;
  std::function<void(const std::vector<std::string>&)> dropped_;
  std::optional<std::array<double, 2>> cursor_;  // none: the next place is no movement
  std::optional<Typing> typing_;
  std::map<int, std::string> held_;  // scan codes of keys that are down, by the names that they went down with
  bool place_changed_ = false, damaged_ = false;
  Place windowed_;  // where it was before it covered the monitor
};

}  // namespace dubsar
