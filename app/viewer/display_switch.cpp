#include "app/viewer/display_switch.h"

#include "app/steering/worn_input.h"
#include "app/viewer/presenter/window_place.h"
#include "core/base/system/log.h"

namespace dubsar::app {

DisplaySwitch::DisplaySwitch(const ViewOptions& options, Presenter& presenter, Stage& stage)
    : options_(options), presenter_(presenter), stage_(stage), specs_(options.displays) {
  const StageOptions& of = options.stage;
  if (specs_.empty()) {
    const GlfwWindow* const window = presenter.window();
    specs_ = displays_for_window(of.display, *of.catalog,
                                 {of.screen, window != nullptr ? window->refresh_hz() : 0.0, of.stereo_window});
  } else {
    specs_.insert(specs_.begin(), of.display);
  }
  if (stage.traits().worn) worn_ = std::make_shared<WornFeed>();
}

Result<void> DisplaySwitch::place_changed() {
  static_cast<void>(presenter_.take_place_changed());
  if (!presenter_.visible()) return {};
  DUBSAR_TRY(stage_.set_screen(presenter_.screen(options_.stage.screen)));
  if (steering_ != nullptr) steering_->set_rest(stage_.rest_m());
  return presenter_.fit(stage_.traits());
}

void DisplaySwitch::feed_worn() {
  if (!worn_) return;
  if (steering_ != nullptr)
    steering_->set_room({1e-3 * stage_.window_mm().y, 0.5e-3 * glm::length(stage_.box_mm().size())});
  if (const auto wearer = stage_.wearer())
    worn_->put(worn_sample(*wearer));
  else
    worn_->absent(stage_.display_note());
}

Result<void> DisplaySwitch::step(int by) {
  const std::size_t count = specs_.size();
  for (std::size_t tried = 1; tried <= count; ++tried) {
    const std::size_t on = by > 0 ? tried : by < 0 ? tried * (count - 1) : tried - 1;
    const std::size_t next = (shown_ + on) % count;
    auto done = stage_.set_display(specs_[next]);
    if (done) done = place_changed();
    if (done) {
      shown_ = next;
      log_info("display {}", name());
      return {};
    }
    log_warning("{}", done.error().message);
  }
  return fail(ErrorKind::kUnavailable, "none of {} displays can be shown", count);
}

}  // namespace dubsar::app
