// dubsar devices: what a developer without any device can do, and what is said when there is none.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/app/cli/run_program.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

std::string file_text(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(DevicesCommand, ASimulatedRecordingReplaysThroughItsDriverAndDependsOnItsSeedOnly) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("dubsar_devices_{}", ::getpid());
  fs::create_directories(folder);
  for (const char* driver : {"spacemouse", "spacenav", "opentrack", "vrpn", "rift", "xreal"}) {
    const std::string first = (folder / "first.txt").string(), second = (folder / "second.txt").string();
    ASSERT_EQ(run_dubsar({"devices", "simulate", driver, first, "--seconds", "1", "--seed", "4"}).exit_code, 0);
    ASSERT_EQ(run_dubsar({"devices", "simulate", driver, second, "--seconds", "1", "--seed", "4"}).exit_code, 0);
    EXPECT_EQ(file_text(first), file_text(second)) << driver;
    ASSERT_EQ(run_dubsar({"devices", "simulate", driver, second, "--seconds", "1", "--seed", "5"}).exit_code, 0);
    EXPECT_NE(file_text(first), file_text(second)) << driver;
    const ProgramRun run = run_dubsar({"devices", "replay", first, "--speed", "10", "--json", "-"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json result = json::parse(run.out);
    const std::string text = file_text(first);
    std::size_t reports = 0;
    for (std::size_t at = text.find(" r "); at != std::string::npos; at = text.find(" r ", at + 1)) ++reports;
    EXPECT_EQ(result["reports"], reports) << driver;
    EXPECT_EQ(result["refused"], 0) << driver;
  }
  fs::remove_all(folder);
}

TEST(DevicesCommand, AVrpnTrackerThatIsNotThereEndsWith69AndTheNamesThatAre) {
  const std::string port = std::to_string(42000 + ::getpid() % 9000);
  std::thread server([&] {
    EXPECT_EQ(run_dubsar({"devices", "simulate", "vrpn", "--live", "--port", port, "--seconds", "8"}).exit_code, 0);
  });
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const ProgramRun wrong =
      run_dubsar({"devices", "monitor", "vrpn", "--port", port, "--tracker", "Nobody0", "--seconds", "4"});
  EXPECT_EQ(wrong.exit_code, 69) << wrong.out;
  EXPECT_NE(wrong.err.find("Tracker0"), std::string::npos) << wrong.err;
  server.join();
}

TEST(DevicesCommand, DatagramsOfAnotherLengthAreCountedAndTold) {
  const int port = 41000 + ::getpid() % 900;
  std::thread sender([&] {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const std::array<char, 24> floats{};  // six floats: what telephone programs send by mistake
    for (int i = 0; i < 20; ++i) {
      ::sendto(socket, floats.data(), floats.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
    }
    ::close(socket);
  });
  const ProgramRun run = run_dubsar(
      {"devices", "monitor", "opentrack", "--port", std::to_string(port), "--seconds", "1.2", "--json", "-"});
  sender.join();
  EXPECT_EQ(run.exit_code, 69);
  EXPECT_NE(run.err.find("error: opentrack: 24 bytes came, 48 expected"), std::string::npos) << run.err;
  EXPECT_GE(json::parse(run.out)["refused"].get<int>(), 3) << run.out;
}

TEST(DevicesCommand, SaysWhatIsMissing) {
  const ProgramRun list = run_dubsar({"devices", "list", "--json", "-"});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_TRUE(json::parse(list.out)["devices"].is_array());
  const ProgramRun vrpn = run_dubsar({"devices", "monitor", "vrpn", "--port", "1", "--seconds", "0.1"});
  EXPECT_EQ(vrpn.exit_code, 69);
  EXPECT_NE(vrpn.err.find("error: 127.0.0.1 port 1: cannot connect"), std::string::npos) << vrpn.err;
  const ProgramRun leapc = run_dubsar({"devices", "probe", "leapc", "--library", "/no/such/libLeapC.so"});
  EXPECT_EQ(leapc.exit_code, 69);
  EXPECT_NE(leapc.err.find("/no/such/libLeapC.so"), std::string::npos) << leapc.err;
  EXPECT_EQ(run_dubsar({"devices", "record", "leapc", "/tmp/never.txt"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"devices", "monitor", "melt"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"devices", "simulate", "melt", "/tmp/never.txt"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"devices", "simulate", "opentrack"}).exit_code, 64);  // neither a file nor --live
  EXPECT_EQ(run_dubsar({"devices", "simulate", "rift", "--live"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"devices", "simulate", "leap", "/tmp/never.txt", "--seconds", "60"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"devices", "monitor", "opentrack", "--invert", "up"}).exit_code, 64);
  EXPECT_EQ(run_dubsar({"devices", "replay", "/no/such/file"}).exit_code, 66);
  EXPECT_EQ(run_dubsar({"devices", "monitor", "opentrack", "--address", "0.0.0.0", "--seconds", "0.1"}).exit_code, 64);
}

TEST(DevicesCommand, ARecordingWhoseAnswersRunOutEndsWithASentence) {
  const fs::path whole = fs::temp_directory_path() / fmt::format("dubsar_whole_{}", ::getpid()),
                 dry = fs::temp_directory_path() / fmt::format("dubsar_dry_{}", ::getpid());
  ASSERT_EQ(run_dubsar({"devices", "simulate", "leap", whole.string(), "--seconds", "0.1"}).exit_code, 0);
  RunOptions soon;
  soon.timeout_s = 20;
  for (const int kept : {3, 40}) {  // control transfers of those that the recording has before its first report
    std::istringstream lines(file_text(whole));
    std::ofstream out(dry);
    int controls = 0;
    for (std::string line; std::getline(lines, line);)
      if (line.find(" c ") == std::string::npos || ++controls <= kept) out << line << '\n';
    out.close();
    for (const char* speed : {"0.05", "10"}) {
      const ProgramRun run = run_dubsar({"devices", "replay", dry.string(), "--speed", speed, "-q"}, soon);
      EXPECT_TRUE(run.exit_code == 69 || run.exit_code == 65) << kept << " " << speed << ": " << run.exit_code;
      EXPECT_NE(run.err.find("error: "), std::string::npos) << run.err;
      EXPECT_NE(run.err.find("has no more answers"), std::string::npos) << run.err;
      EXPECT_EQ(run.out, "");
    }
  }
  fs::remove(whole);
  fs::remove(dry);
}

TEST(DevicesCommand, HandsOfARecordedLeapAreShown) {
  const fs::path file = fs::temp_directory_path() / fmt::format("dubsar_leap_{}", ::getpid());
  ASSERT_EQ(run_dubsar({"devices", "simulate", "leap", file.string(), "--seconds", "0.1"}).exit_code, 0);
  const ProgramRun run = run_dubsar({"devices", "replay", file.string(), "--speed", "0.5"});
  fs::remove(file);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json first = json::parse(run.out.substr(0, run.out.find('\n')));
  ASSERT_EQ(first["hands"].size(), 1u) << run.out;
  EXPECT_NEAR(first["hands"][0]["palm_m"][1].get<double>(), 0.2, 0.08);  // above the device, as somebody() holds it
  EXPECT_NE(run.out.find("age when read: median"), std::string::npos);
}

}  // namespace
}  // namespace dubsar::test
