#pragma once
// Where pictures go, and when the next one is wanted. One loop serves all of them (run_view.h): windows, and pictures
// in memory that become files.

#include <memory>
#include <string>
#include <vector>

#include "app/viewer/view_options.h"
#include "display/render/passes/compose_pass.h"

namespace dubsar::app {

/// One thread, which has the GL context.
class Presenter {
 public:
  virtual ~Presenter() = default;
  /// Its GL context is that of the thread from now on.
  virtual Result<void> make_current() = 0;
  /// The stage may have another display or place now: makes surfaces that fit it.
  virtual Result<void> fit(const SinkTraits& traits) = 0;
  virtual Surface surface() = 0;
  /// False while there is nothing to draw on, such as a window that is minimised.
  virtual bool visible() const { return true; }
  /// What is presented can be seen: its window is mapped. As it was at the last look_after().
  virtual bool on_screen() const { return true; }
  /// Keys come to it. As on_screen().
  virtual bool focused() const { return true; }
  /// For places where nobody is who could bring a hidden window back: one that covers a monitor and was hidden,
  /// uncovered, or, where `keyboard`, lost the keys, is asked back. Looks twice a second, in real time.
  virtual void look_after(bool /*keyboard*/) {}
  /// RGB, of what was drawn into surface() and is not presented yet, as it will be.
  virtual Result<Image> picture() = 0;
  virtual Result<void> present() = 0;

  /// Where a display shows fields in turn: waits where a beat is too near, and says whose turn it is behind it.
  virtual Field turn() { return Field::kFirst; }

  virtual void take_events() {}
  virtual bool take_place_changed() { return false; }
  /// What was presented last is lost, in part or whole.
  virtual bool take_damaged() { return false; }
  /// Where the stage's surface is on its panel.
  virtual Screen screen(const Screen& fallback) const { return fallback; }
  /// In real time: when the light of a picture that is begun at `now` reaches the eye.
  virtual TimestampNs light(TimestampNs now) const { return now; }
  /// In real time: until the next picture is due, or while nothing moves until something happens.
  virtual void wait(bool /*moving*/) {}
  virtual bool ended() const = 0;
  virtual void end() = 0;
  /// Whoever wanted to close the window may not.
  virtual void keep_open() {}
  virtual Result<void> toggle_fullscreen() {
    return fail(ErrorKind::kUnavailable, "there is no window that could cover a monitor");
  }
  virtual GlfwWindow* window() { return nullptr; }
};

/// Draws into memory.
class FilePresenter final : public Presenter {
 public:
  /// kUnavailable without EGL.
  static Result<std::unique_ptr<FilePresenter>> create();
  Result<void> make_current() override { return context_->make_current(); }
  Result<void> fit(const SinkTraits& traits) override;
  Surface surface() override { return surface_->surface(); }
  Result<Image> picture() override { return surface_->read(); }
  Result<void> present() override {
    field_ = field_ == Field::kFirst && fields_ > 1 ? Field::kSecond : Field::kFirst;
    return {};
  }
  Field turn() override { return field_; }
  bool ended() const override { return ended_; }
  void end() override { ended_ = true; }

 private:
  explicit FilePresenter(std::unique_ptr<GlContext> context) : context_(std::move(context)) {}
  std::unique_ptr<GlContext> context_;  // goes last
  std::optional<OffscreenSurface> surface_;
  bool ended_ = false;
  int fields_ = 1;
  Field field_ = Field::kFirst;
};

}  // namespace dubsar::app
