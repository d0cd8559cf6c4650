// Every file under tests/recordings, through the driver that it names: a bug report is a file there.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>

#include "app/monitor/device_monitor.h"
#include "devices/drivers.h"
#include "devices/transport/replay_transport.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

std::vector<fs::path> recordings() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(DUBSAR_RECORDINGS)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// The third line of a recording says what is in it: "note ...: 15 reports, 1 refused". Of a camera, pictures count.
class EveryRecording : public ::testing::TestWithParam<fs::path> {};

TEST_P(EveryRecording, GivesWhatItsNoteSays) {
  SCOPED_TRACE("to see it: dubsar devices replay tests/recordings/" + GetParam().filename().string());
  const auto recording = read_recording(GetParam());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_FALSE(recording->cut_off);
  std::smatch said;
  ASSERT_TRUE(std::regex_search(recording->note, said, std::regex("(\\d+) reports, (\\d+) refused$")))
      << "note \"" << recording->note << "\" found, expected one that ends with \"N reports, N refused\"";
  const TimestampNs end = recording->events.back().time;
  ManualClock clock;
  ReplaySession session(*recording, clock);
  DeviceSpec spec;
  spec.driver = recording->driver;
  const auto device = monitor_device(
      spec, [&] { return session.open(); }, clock, false);
  ASSERT_TRUE(device) << device.error().message;
  int samples = 0;
  for (; !session.finished() && clock.now() < end + 20'000'000'000; clock.advance(4'000'000))
    samples += (*device)->poll(clock.now(), milliseconds(0)) ? 1 : 0;
  EXPECT_TRUE(session.finished());
  samples += (*device)->poll(clock.now(), milliseconds(0)) ? 1 : 0;
  EXPECT_GT(samples, 0);
  const DriverCounts counts = (*device)->counts();
  EXPECT_EQ(fmt::format("{} reports, {} refused", counts.accepted, counts.refused), said.str());
}

INSTANTIATE_TEST_SUITE_P(Recordings, EveryRecording, ::testing::ValuesIn(recordings()), [](const auto& tested) {
  return std::regex_replace(tested.param.stem().string(), std::regex("[^A-Za-z0-9]"), "_");
});

TEST(Recordings, ThereIsOneOfEveryDeviceThatSendsBytes) {
  std::set<std::string> drivers;
  for (const fs::path& file : recordings()) drivers.insert(read_recording(file).value().driver);
  for (const DriverEntry& driver : driver_table())
    if (can_be_simulated(driver)) {
      EXPECT_TRUE(drivers.contains(std::string(driver.name)))
          << "make one: dubsar devices simulate " << driver.name << " tests/recordings/" << driver.name << ".txt";
    }
}

}  // namespace
}  // namespace dubsar::app
