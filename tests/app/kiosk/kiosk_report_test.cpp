#include "app/kiosk/kiosk_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace dubsar::app {
namespace {

TEST(KioskReport, SaysADayInSentencesAndThatItWasKilled) {
  const auto folder = std::filesystem::path(testing::TempDir()) / fmt::format("report_{}", ::getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "kiosk-2026-11-26.jsonl")
      << R"({"time": "2026-11-26T09:30:01+0100", "what": "start", "version": "0.3.0"})"
         "\n"
      << R"({"time": "2026-11-26T18:00:00+0100", "what": "end", "visits": 0, "resets": 0})"
         "\n";
  std::ofstream(folder / "kiosk-2026-11-27.jsonl")
      << R"({"time": "2026-11-27T09:30:01+0100", "what": "start", "version": "0.3.0"})"
         "\n"
      << R"({"time": "2026-11-27T09:41:00+0100", "what": "visit"})"
         "\n"
      << R"({"time": "2026-11-27T09:42:00+0100", "what": "trouble", "says": "leap: no such device is plugged in"})"
         "\n"
      << R"({"time": "2026-11-27T10:00:00+0100", "what": "hour", "visits": 1, "turned": 1, "opened": 2})"
         "\n"
      << R"({"time": "2026-11-27T10:10:00+0100", "what": "trouble", "says": "leap: no such device is plugged in"})"
         "\n"
      << R"({"time": "2026-11-27T10:12)"
         "\n"  // the power failed
      << R"({"time": "2026-11-27T11:30:01+0100", "what": "start", "version": "0.3.0"})"
         "\n"
      << R"({"time": "2026-11-27T11:41:00+0100", "what": "operator", "key": "2", "does": "next language"})"
         "\n"
      << R"({"time": "2026-11-27T11:43:00+0100", "what": "visit"})"
         "\n";
  const auto report = kiosk_report(folder, 7);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->days, 2);
  EXPECT_EQ(report->visits, 2);
  EXPECT_EQ(report->killed, 1);
  EXPECT_EQ(report->troubles, 2);
  EXPECT_EQ(report->text,
            "2026-11-26, 09:30 to 18:00: 0 visits, 0 times back to the beginning, 0 tours\n"
            "  09:30 it began, dubsar 0.3.0\n"
            "  18:00 it ended\n"
            "2026-11-27, 09:30 to 11:43: 2 visits, 0 times back to the beginning, 0 tours; up to its last full hour 1 "
            "turned the object, the envelope was opened or closed 2 times; 1 lines of the journal cannot be read\n"
            "  09:30 it began, dubsar 0.3.0\n"
            "  09:42 leap: no such device is plugged in (2 times until 10:10)\n"
            "  11:30 it began, dubsar 0.3.0; it had not ended before: killed, or the power failed after 10:10\n"
            "  11:41 the operator chose: next language\n");
  EXPECT_EQ(kiosk_report(folder, 1)->days, 1);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(kiosk_report(folder, 1).error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace dubsar::app
