#pragma once
// The kiosk without its pictures: what people do goes through its recogniser and its guide, and comes back as what they
// see.

#include <string>
#include <vector>

#include "app/document/document.h"
#include "app/kiosk/hand_cursors.h"
#include "app/kiosk/kiosk_controller.h"
#include "input/navigation/navigation.h"
#include "tests/people/gallery.h"

namespace dubsar::app::test {

/// One thread.
class GallerySession {
 public:
  /// As those of KioskParts.
  explicit GallerySession(const std::string& notify_socket = {}, std::int64_t watchdog_us = 0);
  /// In place of the gallery's own, for all that are made afterwards.
  static void set_mapping(const Mapping& mapping) { mapping_ = mapping; }
  void go_on(TimestampNs now, const InputFrame& frame);
  /// The tracker is there, or not.
  void set_tracker(SourceHealth health) { rows_[0].health = health; }
  void set_on_screen(bool on_screen) { on_screen_ = on_screen; }
  /// How often the envelope was asked for, by anybody.
  std::int64_t chosen() const { return guide_.visit().counts().openings; }
  const SeenScreen& screen() const { return screen_; }
  const Navigator& navigator() const { return navigator_; }
  const KeptPerson& person() const { return person_; }
  const Visit& visit() const { return guide_.visit(); }
  /// What was led to last.
  const Guidance& guidance() const { return guidance_; }

 private:
  static HandZone entry_zone();
  static HandZone zone();
  static KioskParts parts(const std::string& notify_socket, std::int64_t watchdog_us);
  static Mapping mapping_;
  Navigator navigator_;
  PersonKeeper people_;
  KioskController guide_;
  Document document_;
  std::vector<SourceRow> rows_{{"leap", SourceHealth::kPresent, ""}};
  bool on_screen_ = true;
  KeptPerson person_;
  SeenScreen screen_;
  Guidance guidance_;
};

}  // namespace dubsar::app::test
