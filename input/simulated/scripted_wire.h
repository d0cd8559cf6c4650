#pragma once
// What the wires of scripted people have in common: the script is sampled at its rate and told to the device.

#include "input/simulated/scripted_source.h"
#include "input/simulated/simulated_device.h"

namespace dubsar {

class ScriptedWire : public SimulatedDevice {
 public:
  void advance(TimestampNs now) override {
    if (!next_) next_ = now;
    *next_ = std::max(*next_, now - kMostBehindNs);
    for (; *next_ <= now; *next_ += step_) {
      if (seen_) view_ = seen_->look();
      if (actor_->poll(*next_, frame_) == Freshness::kNew) say(frame_);
      if (actor_->finished()) end();
    }
  }

 protected:
  explicit ScriptedWire(WireOptions options)
      : step_(static_cast<TimestampNs>(1e9 / options.script.rate_hz)), seen_(std::move(options.seen)) {
    actor_ = play_script(std::move(options.script), [this] { return view_; }).value();
  }
  virtual void say(const InputFrame& frame) = 0;
  const ViewState& view() const noexcept { return view_; }

 private:
  static constexpr TimestampNs kMostBehindNs = 1'000'000'000;
  TimestampNs step_;
  std::shared_ptr<const SeenView> seen_;
  ViewState view_{};
  std::unique_ptr<InputSource> actor_;
  InputFrame frame_;
  std::optional<TimestampNs> next_;
};

// The makers that make_wire_person() chooses from; the options have been checked.
std::unique_ptr<SimulatedDevice> make_spacemouse_wire(WireOptions options);
std::unique_ptr<SimulatedDevice> make_spacenav_wire(WireOptions options);
std::unique_ptr<SimulatedDevice> make_opentrack_wire(WireOptions options);
std::unique_ptr<SimulatedDevice> make_vrpn_wire(WireOptions options);
std::unique_ptr<SimulatedDevice> make_rift_wire(WireOptions options);
std::unique_ptr<SimulatedDevice> make_xreal_wire(WireOptions options);
std::unique_ptr<SimulatedDevice> make_leap_wire(WireOptions options, const Clock& clock);

}  // namespace dubsar
