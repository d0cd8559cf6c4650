#pragma once
// A kiosk without a window, for tests: what it is told and what it wants.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/document/document.h"
#include "app/kiosk/kiosk_controller.h"

namespace dubsar::app {

inline constexpr TimestampNs kStep = 50'000'000;

class Kiosk {
 public:
  explicit Kiosk(KioskProfile profile = {}, int minute = 12 * 60, const std::string& notify_socket = {},
                 std::int64_t watchdog_us = 0)
      : minute_(minute) {
    if (profile.objects.empty())
      profile.objects = {{.file = "a.exa", .title = {{"en", "A"}, {"de", "B"}}}, {.file = "b.exa"}};
    profile.pin = "8302";
    KioskParts parts;
    parts.profile = profile;
    parts.notify_socket = notify_socket;
    parts.watchdog_us = watchdog_us;
    parts.wall = [this] { return WallTime{1'790'000'000 + now_ / 1'000'000'000, minute_}; };
    guide_ = std::make_unique<KioskController>(std::move(parts));
    document_.parts = {{"tablet", 1}, {"envelope", 2}};
  }
  Guidance go_on(double seconds, Steered steered = {}) {
    Guidance last;
    for (int i = 0; i < static_cast<int>(20 * seconds); ++i, now_ += kStep) {
      last = guide_->lead({now_, steered, document_, rows_, {600, 340}, {0, 0}, {}, {}, read_, on_screen_});
      if (last.scene) {
        if (last.scene->camera) {
          fastest_deg_per_s =
              std::max(fastest_deg_per_s, turn_between_deg(last.scene->frame.camera.rotation, seen_) / 0.05);
        }
        seen_ = last.scene->frame.camera.rotation;
        if (last.scene->keep) show_keyframe(document_, last.scene->frame);
      }
      for (const std::string& command : last.commands) {
        commands.push_back(command);
        if (command.rfind("unpack ", 0) == 0) document_.unpack = 0.01 * std::stod(command.substr(7));
      }
      const double turned = turn_between_deg(last.turn, turn_);
      fastest_deg_per_s = std::max(fastest_deg_per_s, turned / 0.05);
      turn_ = last.turn;
    }
    return last;
  }
  void type(std::string_view keys) {
    for (const char c : keys) press(std::string(1, c));
    press("enter");
  }
  void press(const std::string& key) {
    InputEvent event;
    event.kind = EventKind::kKey;
    event.key = key;
    event.down = true;
    EXPECT_TRUE(guide_->takes(event, now_));
  }
  KioskController& guide() { return *guide_; }
  const Document& document() const { return document_; }
  void set_sources(std::vector<SourceRow> rows) { rows_ = std::move(rows); }
  void set_minute(int minute) { minute_ = minute; }
  void set_on_screen(bool on_screen) { on_screen_ = on_screen; }
  double now_s() const { return 1e-9 * static_cast<double>(now_); }
  /// The object's file is being read, and what is shown has no parts yet.
  void reads() {
    parts_ = std::exchange(document_.parts, {});
    read_ = false;
  }
  void has_read() {
    document_.parts = parts_;
    read_ = true;
  }
  std::vector<std::string> commands;
  double fastest_deg_per_s = 0.0;

 private:
  std::unique_ptr<KioskController> guide_;
  std::vector<SourceRow> rows_{{"leap", SourceHealth::kPresent, ""}};
  Document document_;
  std::vector<Part> parts_;  // while document_ has none
  bool read_ = true, on_screen_ = true;
  TimestampNs now_ = 3'000'000'000;
  int minute_;
  glm::dquat turn_{1, 0, 0, 0}, seen_{1, 0, 0, 0};
};

inline Steered with_hand(HandState state, Control control = Control::kNone, double turned_deg = 0.0) {
  Steered out;
  out.hands = {{{0.1, 0.0, 0.2}, state == HandState::kHolding ? 1.0 : 0.0, 0.0, state}};
  out.control = control;
  out.view.rotation = turn_of({0, turned_deg * 0.0174532925, 0});
  return out;
}

}  // namespace dubsar::app
