#pragma once
// Pictures in a window, in step with its monitor.

#include "app/viewer/presenter/display_clock.h"
#include "app/viewer/presenter/presenter.h"
#include "display/sinks/field_cadence.h"

namespace dubsar::app {

class WindowPresenter final : public Presenter {
 public:
  /// Opens the window that the display of `options` needs, on the monitor it belongs on. Says in `options.stage` what
  /// the stage has to know of it (display, screen, stereo), gives the sink that was made, and says in `note` when the
  /// display is not the one asked for.
  static Result<std::unique_ptr<WindowPresenter>> create(ViewOptions& options, std::unique_ptr<OutputSink>& sink,
                                                         std::string& note);

  Result<void> make_current() override { return window_->make_current(); }
  Result<void> fit(const SinkTraits& traits) override;
  Surface surface() override;
  bool visible() const override;
  bool on_screen() const override { return seen_.on_screen; }
  bool focused() const override { return seen_.focused; }
  void look_after(bool keyboard) override;
  Result<Image> picture() override;
  Result<void> present() override;
  Field turn() override;
  void take_events() override { window_->poll_events(); }
  bool take_place_changed() override { return window_->take_place_changed(); }
  bool take_damaged() override { return window_->take_damaged(); }
  Screen screen(const Screen& fallback) const override { return window_->screen(fallback); }
  TimestampNs light(TimestampNs now) const override { return clock_.light(now); }
  void wait(bool moving) override;
  bool ended() const override { return window_->should_close(); }
  void end() override { window_->close(); }
  void keep_open() override { window_->keep_open(); }
  Result<void> toggle_fullscreen() override;
  GlfwWindow* window() override { return window_.get(); }

 private:
  explicit WindowPresenter(std::unique_ptr<GlfwWindow> window) : window_(std::move(window)) {}
  std::unique_ptr<GlfwWindow> window_;     // goes last
  std::optional<OffscreenSurface> whole_;  // the composed picture, where the window has another size
  DisplayClock clock_;
  FieldCadence cadence_;
  int fields_ = 1;
  TimestampNs begun_ = 0;
  bool composed_ = false, worn_ = false;
  struct Seen {  ///< when it was looked after last
    bool on_screen = true, focused = false;
    TimestampNs at = -1;
  } seen_;
};

}  // namespace dubsar::app
