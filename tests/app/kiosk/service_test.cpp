#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/kiosk/journal.h"
#include "app/kiosk/service_notify.h"
#include "core/base/files/atomic_file.h"
#include "tests/app/kiosk/service_manager.h"

namespace dubsar::app {
namespace {

TEST(ServiceNotify, SaysReadyAndAliveAsOftenAsTheWatchdogNeeds) {
  test::ServiceManager manager;
  ASSERT_TRUE(manager.bound());
  ServiceNotify notify(manager.path(), 3'000'000);  // 3 s
  notify.ready();
  for (int i = 0; i <= 100; ++i) {  // 10 s of turns of the loop
    notify.alive(i * TimestampNs{100'000'000});
    manager.heard();
  }
  notify.status("12 visits\nREADY=0");
  notify.stopping();
  const auto& heard = manager.heard();
  ASSERT_GE(heard.size(), 4U);
  EXPECT_EQ(heard.front(), "READY=1");
  EXPECT_EQ(std::count(heard.begin(), heard.end(), "WATCHDOG=1"), 11);
  EXPECT_EQ(heard[heard.size() - 2], "STATUS=12 visits READY=0");
  EXPECT_EQ(heard.back(), "STOPPING=1");
}

TEST(ServiceNotify, WithoutAManagerNothingHappens) {
  ServiceNotify none, gone(testing::TempDir() + "no_such_socket", 1000), odd("relative", 1000);
  for (ServiceNotify* notify : {&none, &gone, &odd}) {
    notify->ready();
    notify->alive(5);
  }
}

TEST(Journal, IsOneJsonObjectALineInAFileADay) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / fmt::format("journal_{}", ::getpid());
  Journal journal(folder);
  const std::int64_t noon = 1'790'000'000;
  ASSERT_TRUE(journal.add(noon, "visit_began"));
  ASSERT_TRUE(journal.add(noon + 60, "hour", "\"visits\": 3"));
  ASSERT_TRUE(journal.add(noon + 86'400, "visit_began"));
  EXPECT_NE(journal.file(noon), journal.file(noon + 86'400));
  const auto text = read_text_file(journal.file(noon));
  ASSERT_TRUE(text);
  const std::size_t split = text->find('\n');
  const auto first = nlohmann::json::parse(text->substr(0, split)),
             second = nlohmann::json::parse(text->substr(split + 1));
  EXPECT_EQ(first.at("what"), "visit_began");
  EXPECT_EQ(second.at("visits"), 3);
  std::filesystem::remove_all(folder);
}

TEST(Journal, ThatCannotBeWrittenSaysWhere) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "a_file_is_no_folder";
  ASSERT_TRUE(write_file_atomically(folder, std::string_view("x")));
  const auto done = Journal(folder).add(1'790'000'000, "start");
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find(folder.string()), std::string::npos);
  EXPECT_TRUE(Journal({}).add(1'790'000'000, "start"));
}

/// systemd's own judgement of the unit, where it is installed.
TEST(ServiceUnit, IsOneThatSystemdUnderstandsAndThatMayDoLittle) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / fmt::format("unit_{}", ::getpid());
  std::filesystem::create_directories(folder / "run");
  std::string unit = read_text_file(DUBSAR_UNIT).value();
  for (const char* line :
       {"Type=notify", "WatchdogSec=", "Restart=on-failure", "RestartPreventExitStatus=64 78", "NoNewPrivileges=yes",
        "SystemCallFilter=", "RestrictNamespaces=yes", "RestrictAddressFamilies="})
    EXPECT_NE(unit.find(std::string("\n") + line), std::string::npos) << line;
  const std::string program = "/usr/local/bin/dubsar";
  ASSERT_NE(unit.find(program), std::string::npos);
  unit.replace(unit.find(program), program.size(), "/bin/true");  // verify looks whether it is there
  ASSERT_TRUE(write_file_atomically(folder / "dubsar-kiosk.service", unit));
  const auto ask = [&](const std::string& what) {
    const std::string command = fmt::format(
        "cd {} && XDG_RUNTIME_DIR=$PWD/run timeout 30 systemd-analyze --user {} "
        "./dubsar-kiosk.service >answer.txt 2>&1",
        folder.string(), what);
    const int status = std::system(command.c_str());
    return std::pair(status, read_text_file(folder / "answer.txt").value_or(""));
  };
  if (std::system("command -v systemd-analyze >/dev/null 2>&1") == 0) {
    const auto [status, said] = ask("verify");
    EXPECT_EQ(status, 0) << said;
    EXPECT_EQ(said, "");
    const auto [rated, exposure] = ask("security --offline=true --threshold=70");  // 6.5 of 10; 9.1 without hardening
    EXPECT_EQ(rated, 0) << exposure;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace dubsar::app
