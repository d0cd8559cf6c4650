#include "app/viewer/presenter/window_presenter.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "app/viewer/presenter/window_place.h"
#include "core/base/system/second.h"
#include "display/sinks/sink_window.h"

namespace dubsar::app {
namespace {
constexpr double kIdleS = 0.008;  // how long input may wait while nothing moves
constexpr TimestampNs kLookEveryNs = kSecondNs / 2;
}  // namespace

Result<std::unique_ptr<WindowPresenter>> WindowPresenter::create(ViewOptions& options,
                                                                 std::unique_ptr<OutputSink>& sink, std::string& note) {
  WindowOptions place = *options.window;
  StageOptions& stage = options.stage;
  DUBSAR_ASSIGN(sink, stage.catalog->make(stage.display));
  DUBSAR_TRY(choose_place(sink->traits(), options.fullscreen, place));
  DUBSAR_ASSIGN(SinkWindow shown, open_sink_window(*stage.catalog, stage.display, std::move(sink), place));
  stage.display = shown.display;
  note = shown.note;
  sink = std::move(shown.sink);
  std::unique_ptr<WindowPresenter> out(new WindowPresenter(std::move(shown.window)));
  stage.screen = out->window_->screen(stage.screen);
  stage.stereo_window = out->window_->stereo();
  return out;
}

Result<void> WindowPresenter::fit(const SinkTraits& traits) {
  clock_.set_refresh(window_->refresh_hz());
  cadence_.set_refresh(window_->refresh_hz());
  fields_ = traits.fields;
  worn_ = traits.worn;
  window_->wait_for_monitor(!worn_);
  whole_.reset();
  if (!traits.exact_pixels && traits.output != window_->size() && traits.output.width > 0 && traits.output.height > 0) {
    DUBSAR_ASSIGN(whole_, OffscreenSurface::create(traits.output));
  }
  return {};
}

bool WindowPresenter::visible() const {
  const PixelSize size = window_->size();
  return worn_ || (size.width > 0 && size.height > 0);  // a headset goes on when its window is minimised
}

void WindowPresenter::look_after(bool keyboard) {
  const TimestampNs now = SteadyClock().now();
  if (worn_ || (seen_.at >= 0 && now - seen_.at < kLookEveryNs)) return;
  const bool first = std::exchange(seen_.at, now) < 0;
  seen_.on_screen = window_->on_screen();
  seen_.focused = window_->focused();
  const bool away = !seen_.on_screen || !window_->covers_monitor() || (keyboard && !seen_.focused);
  if (window_->fullscreen() && (away || first)) window_->come_back(keyboard);  // at first: onto all desktops
}

Field WindowPresenter::turn() {
  if (fields_ < 2) return Field::kFirst;
  const SteadyClock clock;
  const TimestampNs turn = cadence_.turn(clock.now());
  std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<TimestampNs>(0, turn - clock.now())));
  return cadence_.next(std::max(turn, clock.now()));
}

Surface WindowPresenter::surface() {
  begun_ = SteadyClock().now();
  composed_ = false;
  return whole_ ? whole_->surface() : window_->surface();
}

Result<Image> WindowPresenter::picture() {
  if (whole_ && !composed_) DUBSAR_TRY(fit_into(whole_->surface(), window_->surface()));
  composed_ = true;
  return window_->read();
}

Result<void> WindowPresenter::present() {
  if (whole_ && !composed_) DUBSAR_TRY(fit_into(whole_->surface(), window_->surface()));
  const TimestampNs drawn = SteadyClock().now();
  window_->present();
  if (fields_ > 1) glFinish();  // the beat is over when the call is, not when the driver has queued it
  const TimestampNs presented = SteadyClock().now();
  clock_.presented(begun_, drawn, presented);
  cadence_.presented(presented);
  return {};
}

void WindowPresenter::wait(bool moving) {
  if (fields_ > 1 || worn_) return;  // the next present waits for the monitor, the next cameras for the headset
  if (!moving) return window_->wait_events(kIdleS);
  const SteadyClock clock;
  for (TimestampNs now = clock.now(); now < clock_.next_start() && !window_->should_close(); now = clock.now())
    window_->wait_events(1e-9 * static_cast<double>(clock_.next_start() - now));
}

Result<void> WindowPresenter::toggle_fullscreen() {
  if (!window_->fullscreen()) return window_->set_fullscreen();
  window_->set_windowed();
  return {};
}

}  // namespace dubsar::app
