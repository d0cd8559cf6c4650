// What a kiosk tells those who are not there: the service manager, and whoever reads its journal.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/kiosk/led_kiosk.h"
#include "tests/app/kiosk/service_manager.h"

namespace dubsar::app {
namespace {

TEST(WatchedKiosk, TheJournalSaysWhatTheTroubleIsAndWhatTheOperatorDid) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / fmt::format("guide_journal_{}", ::getpid());
  KioskProfile profile;
  profile.objects = {{.file = "a.exa"}, {.file = "b.exa"}};
  profile.journal = folder;
  {
    Kiosk kiosk(profile);
    kiosk.guide().set_trouble("no monitor's name contains \"HDMI-1\"", false);
    kiosk.guide().set_trouble("no monitor's name contains \"HDMI-1\"", false);  // said once
    const std::vector<SourceRow> present{{"leap", SourceHealth::kPresent, ""}};
    for (int i = 0; i < 3; ++i) {  // a plug with a loose contact
      kiosk.set_sources({{"leap", SourceHealth::kLost, "no Leap is plugged in"}});
      kiosk.go_on(1);
      kiosk.set_sources(present);
      kiosk.go_on(1);
    }
    kiosk.type("8302");
    kiosk.press("2");
    kiosk.go_on(0.1);
    kiosk.guide().leave_out(1, "b.exa: damaged");
  }
  std::vector<std::string> said;
  for (const auto& day : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(day.path());
    for (std::string line; std::getline(in, line);) {
      const auto entry = nlohmann::json::parse(line);
      std::string text = entry.at("what");
      for (const char* name : {"says", "key", "does"})
        if (entry.contains(name)) text += ": " + entry.at(name).get<std::string>();
      said.push_back(text);
    }
  }
  std::filesystem::remove_all(folder);
  EXPECT_EQ(said, (std::vector<std::string>{"start", "trouble: no monitor's name contains \"HDMI-1\"",
                                            "trouble: leap: no Leap is plugged in", "operator: 2: next language",
                                            "trouble: b.exa: damaged", "end"}));
}

/// A session of which the manager starts the watchdog's time again at each sign of life; what is drawn is not asked.
struct Watched {
  explicit Watched(KioskProfile profile = {}) : kiosk(std::move(profile), 12 * 60, manager.path(), 20'000'000) {
    kiosk.go_on(0.1);
    kiosk.guide().presented(0);
  }
  void go_on(double seconds, const Steered& steered = {}) {
    for (double t = 0.0; t < seconds; t += 1.0) {
      kiosk.go_on(1.0, steered);
      manager.watch(kiosk.now_s(), 20.0);
    }
  }
  test::ServiceManager manager;
  Kiosk kiosk;
};

TEST(WatchedKiosk, AServiceManagerHasNoReasonToRestartItInEightHoursOfQuietAndOfVisits) {
  KioskProfile profile;
  profile.quiet = {{22 * 60, 6 * 60}};
  Watched night(profile);
  night.kiosk.set_minute(23 * 60);
  night.go_on(4 * 3600.0);
  EXPECT_EQ(night.manager.restarts(), 0) << "in quiet hours nothing is drawn";
  EXPECT_GT(night.manager.longest_silence_s(), 0.0);
  EXPECT_LT(night.manager.longest_silence_s(), 10.0) << "half of what is granted: a slow machine";
  Watched day;
  for (int visit = 0; visit < 24; ++visit) {
    day.go_on(60, with_hand(HandState::kReady));
    day.go_on(30, with_hand(HandState::kHolding, Control::kHands, 2.0 * visit));
    day.go_on(510);
  }
  EXPECT_EQ(day.manager.restarts(), 0) << "after a visit nothing moves";
  EXPECT_LT(day.manager.longest_silence_s(), 10.0);
}

TEST(WatchedKiosk, WhatNobodyCanSeeIsNoSignOfLife) {
  Watched hidden;
  hidden.go_on(60);
  EXPECT_EQ(hidden.manager.restarts(), 0);
  hidden.kiosk.set_on_screen(false);
  hidden.go_on(50);
  EXPECT_EQ(hidden.manager.restarts(), 2) << "each 20 s";
  hidden.kiosk.set_on_screen(true);
  hidden.go_on(60);
  EXPECT_EQ(hidden.manager.restarts(), 2);
}

}  // namespace
}  // namespace dubsar::app
