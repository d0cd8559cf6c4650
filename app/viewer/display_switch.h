#pragma once
// Which display a session shows, and the others that it can change to.

#include <memory>
#include <string>
#include <vector>

#include "app/steering/input_controller.h"
#include "app/viewer/presenter/presenter.h"
#include "input/worn_feed.h"

namespace dubsar::app {

/// One thread: that of the GL context.
class DisplaySwitch {
 public:
  /// All outlive it.
  DisplaySwitch(const ViewOptions& options, Presenter& presenter, Stage& stage);
  /// The next display (1), the one before (-1), or this one made again (0). kUnavailable: none can be shown.
  Result<void> step(int by);
  /// The window is somewhere else: the stage and the presenter follow.
  Result<void> place_changed();
  /// Whose eyes are expected where the display wants them.
  void seen_by(InputController& steering) noexcept { steering_ = &steering; }
  /// What the headset said of its wearer goes to the source of hands, and how large things are for them to steering.
  void feed_worn();
  /// Who wears the display, for the source of their hands; null: none is worn.
  const std::shared_ptr<WornFeed>& worn() const noexcept { return worn_; }
  std::string name() const { return specs_[shown_].text(); }
  bool panels_wanted() const { return options_.around.panels && stage_.traits().views == 1; }

 private:
  const ViewOptions& options_;
  Presenter& presenter_;
  Stage& stage_;
  InputController* steering_ = nullptr;
  std::vector<SinkSpec> specs_;
  std::size_t shown_ = 0;
  std::shared_ptr<WornFeed> worn_;
};

}  // namespace dubsar::app
