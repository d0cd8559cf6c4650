// Recordings of devices that grow: what stands on the disk when the program ends at a bad moment.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/base/system/second.h"
#include "devices/transport/record_transport.h"
#include "devices/transport/replay_transport.h"
#include "devices/transport/sim_transport.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {

namespace fs = std::filesystem;

class RecordingOnDisk : public testing::Test {
 protected:
  RecordingOnDisk() : folder_(fs::path(testing::TempDir()) / ("dubsar_recording_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(path()) << "the old one";
  }
  ~RecordingOnDisk() override { fs::remove_all(folder_); }

  fs::path path() const { return folder_ / "turn.txt"; }
  std::string old_text() const {
    std::ifstream file(path());
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// The recording that grows beside the old one.
  fs::path partial() const {
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path() != path()) return entry.path();
    return {};
  }
  fs::path folder_;
};

TEST_F(RecordingOnDisk, TakesTheOldOnesPlaceOnlyWhenItIsWhole) {
  ManualClock clock;
  const auto writer = RecordingWriter::create(path(), "spacemouse", "", clock).value();
  writer->add(WireEventKind::kRead, from_hex("0102"));
  EXPECT_EQ(old_text(), "the old one");
  ASSERT_TRUE(writer->finish());
  EXPECT_EQ(read_recording(path())->events.size(), 1U);
  EXPECT_EQ(partial(), fs::path());
}

TEST_F(RecordingOnDisk, WhatIsOlderThanHalfASecondIsOnTheDiskAlsoWhenNothingMoreComes) {
  ManualClock clock;
  const auto writer = RecordingWriter::create(path(), "spacemouse", "", clock).value();
  SimDevice device("sim");
  const auto transport = make_record_transport(device.open().value(), writer);
  device.send(from_hex("0102"));
  std::array<std::byte, 8> buffer;
  ASSERT_EQ(transport->read(buffer, milliseconds(0)), std::size_t{2});
  clock.advance(kSecondNs / 2);
  ASSERT_EQ(transport->read(buffer, milliseconds(0)), std::size_t{0});
  const auto so_far = read_recording(partial());
  ASSERT_TRUE(so_far) << so_far.error().message;
  EXPECT_EQ(so_far->events.size(), 2U);
}

TEST_F(RecordingOnDisk, AKilledProgramLosesAtMostTheLastHalfSecondAndNeverTheOldOne) {
  std::array<int, 2> ready{};
  ASSERT_EQ(::pipe(ready.data()), 0);
  const ::pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {  // a report every 100 ms of its clock for 20 s, then it waits to be killed
    ManualClock clock;
    const auto writer = RecordingWriter::create(path(), "spacemouse", "", clock).value();
    for (int i = 0; i < 200; ++i) {
      writer->add(WireEventKind::kRead, from_hex("01020304"));
      clock.advance(kSecondNs / 10);
    }
    (void)!::write(ready[1], "x", 1);
    for (;;) ::pause();
  }
  char told = 0;
  ASSERT_EQ(::read(ready[0], &told, 1), 1);
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  ::close(ready[0]);
  ::close(ready[1]);
  EXPECT_EQ(old_text(), "the old one");
  const auto left = read_recording(partial());
  ASSERT_TRUE(left) << left.error().message;
  EXPECT_GE(left->events.back().time, 19 * kSecondNs + 9 * kSecondNs / 10 - kSecondNs / 2);
}

TEST_F(RecordingOnDisk, AFullDiskIsAnErrorAndLeavesTheOldOne) {
  const ::pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, 4096};  // writes beyond fail as on a full disk
    ::setrlimit(RLIMIT_FSIZE, &small);
    ManualClock clock;
    const auto writer = RecordingWriter::create(path(), "spacemouse", "", clock).value();
    const std::vector<std::byte> report(1000);
    for (int i = 0; i < 100; ++i) writer->add(WireEventKind::kRead, report);
    if (writer->status()) ::_exit(3);  // told before the end
    const auto finished = writer->finish();
    ::_exit(finished ? 1 : finished.error().message.empty() ? 2 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(old_text(), "the old one");
}

TEST_F(RecordingOnDisk, LinksStayLinksAndFoldersAreRefused) {
  ManualClock clock;
  const fs::path link = folder_ / "link.txt";
  fs::create_symlink("turn.txt", link);
  ASSERT_TRUE(RecordingWriter::create(link, "spacemouse", "", clock).value()->finish());
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_recording(path())->driver, "spacemouse");
  EXPECT_EQ(RecordingWriter::create(folder_, "spacemouse", "", clock).error().kind, ErrorKind::kCannotCreate);
}

TEST(Replay, ATimeStampFarInTheFutureIsNotWaitedFor) {
  const TimestampNs far = TimestampNs{200} * 86'400 * kSecondNs;
  Recording recording{"spacemouse", "", {}, false};
  recording.events = {{kSecondNs, WireEventKind::kRead, {}, from_hex("01")},
                      {far, WireEventKind::kRead, {}, from_hex("02")},
                      {far + kSecondNs, WireEventKind::kRead, {}, from_hex("03")}};
  for (const double factor : {1.0, 4.0}) {
    ManualClock clock;
    ReplaySession session(recording, clock, factor);
    const auto transport = session.open().value();
    std::array<std::byte, 8> buffer;
    std::vector<double> came_s;
    for (int i = 0; i < 2000 && came_s.size() < 3; ++i, clock.advance(kSecondNs / 100))
      if (const auto length = transport->read(buffer, milliseconds(0)); length && *length > 0)
        came_s.push_back(1e-9 * static_cast<double>(clock.now()));
    ASSERT_EQ(came_s.size(), 3U);
    EXPECT_NEAR(came_s[0], 1.0 / factor, 0.02);
    EXPECT_NEAR(came_s[1] - came_s[0], 5.0 / factor, 0.02);
    EXPECT_NEAR(came_s[2] - came_s[1], 1.0 / factor, 0.02);
    EXPECT_EQ(session.recorded_clock().now() / kSecondNs, (far + kSecondNs) / kSecondNs);
  }
  EXPECT_EQ(parse_recording("dubsar-recording 1\ndriver spacemouse\n9000000000000000000 r 01\n").error().kind,
            ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
