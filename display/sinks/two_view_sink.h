#pragma once
// What displays share that put the left and the right view of a window together in a way of their own.

#include <array>

#include "display/sinks/output_sink.h"
#include "display/sinks/stereo_views.h"

namespace dubsar {

class TwoViewSink : public OutputSink {
 public:
  SinkTraits traits() const noexcept override {
    SinkTraits traits = own_;
    traits.views = 2;
    traits.view = traits.output = {screen_.window_w, screen_.window_h};
    traits.tracked = true;
    return traits;
  }
  Result<void> configure(const Screen& screen) override {
    DUBSAR_TRY(check_screen(screen));
    screen_ = screen;
    return {};
  }
  std::span<const View> views(const Observer& viewer) override { return views_ = stereo_views(screen_, viewer); }

 protected:
  /// `own`: its name and what it needs of a window. `right_first`: the first of two places is the right eye's.
  TwoViewSink(const SinkTraits& own, bool right_first) : own_(own), right_first_(right_first) {}

  const Screen& screen() const noexcept { return screen_; }
  bool right_first() const noexcept { return right_first_; }

 private:
  SinkTraits own_;
  bool right_first_;
  Screen screen_;
  std::array<View, 2> views_;
};

}  // namespace dubsar
