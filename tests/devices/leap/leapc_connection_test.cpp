#include "devices/leap/leapc_connection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <filesystem>
#include <thread>

#include "core/base/system/clock.h"
#include "devices/leap/leapc_library.h"
#include "fake_hand.h"

namespace dubsar::leapc {
namespace {

using std::chrono::steady_clock;
using ::testing::HasSubstr;

class LeapcConnection : public testing::Test {
 protected:
  void SetUp() override {
    fake_leapc_reset();
    options.library = DUBSAR_FAKE_LEAPC;
    options.poll = milliseconds(2);
  }
  template <class Condition>
  static bool eventually(const Condition& condition) {
    const auto until = steady_clock::now() + std::chrono::seconds(10);
    while (steady_clock::now() < until) {
      if (condition()) return true;
      std::this_thread::yield();
    }
    return condition();
  }
  static std::ptrdiff_t entries(const char* folder) {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  }
  bool reaches(Connection& connection, State state) {
    return eventually([&] { return connection.state() == state; });
  }

  Options options;
  SteadyClock clock;
};

TEST_F(LeapcConnection, DeliversTheNewestFrameWithItsHandsAndItsTimeOnOurClock) {
  auto connection = make_connection(options, clock);
  const auto started = connection->start();
  ASSERT_TRUE(started) << started.error().message;
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  EXPECT_EQ(connection->reason(), "");
  EXPECT_EQ(fake_leapc_counts().mode, 0U);  // desktop, asked for by us
  EXPECT_EQ(fake_leapc_counts().policies, kPolicyBackgroundFrames);

  const FakeHand hands[2] = {flat_fake_hand(3, true, 10, 200, 0), flat_fake_hand(4, false, -50, 220, 5, 1.0F)};
  const TimestampNs now = clock.now();
  fake_leapc_send_frame(900, now / 1000 + 3'600'000'000 - 20'000, hands, 2);  // measured 20 ms ago
  ServiceFrame frame;
  ASSERT_TRUE(eventually([&] { return connection->poll(frame); }));
  EXPECT_FALSE(connection->poll(frame));
  EXPECT_EQ(frame.number, 900);
  EXPECT_NEAR(static_cast<double>(frame.time - (now - 20'000'000)), 0.0, 1e6);
  ASSERT_EQ(frame.hands.size(), 2U);
  EXPECT_EQ(frame.hands[0].palm_mm, glm::dvec3(10, 200, 0));
  EXPECT_EQ(frame.hands[1].side, Side::kLeft);
  EXPECT_EQ(frame.hands[1].grab_strength, 1.0);
  EXPECT_EQ(connection->counters().frames, 1U);

  fake_leapc_send_frame(901, now / 1000 + 3'600'000'000 + 60'000'000, hands, 0);  // a minute ahead
  ASSERT_TRUE(eventually([&] { return connection->poll(frame); }));
  EXPECT_TRUE(frame.hands.empty());
  EXPECT_LE(frame.time, clock.now());
}

TEST_F(LeapcConnection, AMissingLibrarySaysWhereItWasLookedFor) {
  EXPECT_THAT(search_paths(), testing::Contains("/usr/lib/ultraleap-hand-tracking-service/libLeapC.so.5"));
  EXPECT_THAT(search_paths(), testing::Contains("/opt/ultraleap/LeapSDK/lib/libLeapC.so.6"));
  for (const std::string& path : search_paths()) EXPECT_TRUE(path.starts_with('/')) << path;
  options.library = "/nowhere/libLeapC.so.5";
  auto named = make_connection(options, clock)->start();
  ASSERT_FALSE(named);
  EXPECT_EQ(named.error().kind, ErrorKind::kUnavailable);
  EXPECT_THAT(named.error().message, HasSubstr("/nowhere/libLeapC.so.5"));
  bool installed = false;
  for (const std::string& path : search_paths()) installed = installed || std::filesystem::exists(path);
  if (installed) GTEST_SKIP() << "LeapC is installed here";
  const auto searched = Library::load();
  ASSERT_FALSE(searched);
  EXPECT_EQ(searched.error().kind, ErrorKind::kUnavailable);
  EXPECT_THAT(searched.error().message, testing::AllOf(HasSubstr("/opt/ultraleap/LeapSDK/lib"),
                                                       HasSubstr("/usr/lib/ultraleap"), HasSubstr("install")));
}

TEST_F(LeapcConnection, ALibraryBeforeVersion5OrAnotherOneIsRefused) {
  options.library = DUBSAR_FAKE_LEAPC_4;
  const auto old = make_connection(options, clock)->start();
  ASSERT_FALSE(old);
  EXPECT_EQ(old.error().kind, ErrorKind::kUnavailable);
  EXPECT_THAT(old.error().message, testing::AllOf(HasSubstr("LeapSetTrackingMode"), HasSubstr("older than version 5")));
  options.library = "/lib/x86_64-linux-gnu/libc.so.6";
  if (!std::filesystem::exists(options.library)) GTEST_SKIP() << "no such C library";
  EXPECT_THAT(make_connection(options, clock)->start().error().message, HasSubstr("LeapCreateConnection"));
}

TEST_F(LeapcConnection, WithoutTheServiceStartSaysHowToStartIt) {
  fake_leapc_set_service(false);
  options.patience = milliseconds(20);
  auto connection = make_connection(options, clock);
  const auto started = connection->start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, ErrorKind::kUnavailable);
  EXPECT_THAT(started.error().message, HasSubstr("systemctl start"));
  EXPECT_EQ(connection->state(), State::kStopped);
  EXPECT_EQ(fake_leapc_counts().open_connections, 0);
  fake_leapc_set_service(true);
  options.patience = milliseconds(10'000);
  EXPECT_TRUE(make_connection(options, clock)->start());
}

TEST_F(LeapcConnection, WithoutPatienceStartNeitherWaitsNorFailsAndSaysSoLater) {
  fake_leapc_set_service(false);
  options.patience = milliseconds(0);
  options.connecting = milliseconds(30);
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  EXPECT_EQ(connection->state(), State::kNoService);
  EXPECT_THAT(connection->reason(), HasSubstr("connecting"));
  EXPECT_TRUE(eventually([&] { return connection->reason().find("systemctl start") != std::string::npos; }));
  fake_leapc_set_service(true);
  EXPECT_TRUE(reaches(*connection, State::kTracking));
}

TEST_F(LeapcConnection, ALostServiceIsAStateAndComesBackByItself) {
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  fake_leapc_set_service(false);
  ASSERT_TRUE(reaches(*connection, State::kNoService));
  EXPECT_THAT(connection->reason(), HasSubstr("systemctl start"));
  fake_leapc_set_service(true);
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  EXPECT_EQ(connection->counters().connections, 2U);
}

TEST_F(LeapcConnection, AConnectionThatStaysDeadIsMadeAnew) {
  options.reopen = milliseconds(5);
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  fake_leapc_set_service(false);
  ASSERT_TRUE(eventually([] { return fake_leapc_counts().created >= 4; }));
  fake_leapc_set_service(true);
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  connection->stop();
  const FakeLeapcCounts counts = fake_leapc_counts();
  EXPECT_EQ(counts.created, counts.destroyed);
}

TEST_F(LeapcConnection, DevicesComeAndGoAndFailWithWhatToDo) {
  fake_leapc_set_device(false);
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  ASSERT_TRUE(reaches(*connection, State::kNoDevice));
  EXPECT_THAT(connection->reason(), HasSubstr("no device is plugged in"));
  fake_leapc_set_device(true);
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  const std::uint32_t bad_calibration = 0xe8010001;
  fake_leapc_send_event(4, &bad_calibration, 4, 7);
  ASSERT_TRUE(reaches(*connection, State::kNoDevice));
  EXPECT_THAT(connection->reason(), HasSubstr("calibration is damaged"));
  const FakeDeviceStatusEvent streaming{nullptr, 7, 2, 1};
  fake_leapc_send_event(0x107, &streaming, sizeof streaming, 7);
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  fake_leapc_set_device(false);
  EXPECT_TRUE(reaches(*connection, State::kNoDevice));
}

TEST_F(LeapcConnection, HandsOfAnotherMountingAreNotDelivered) {
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  fake_leapc_switch_mode(2);
  ASSERT_TRUE(reaches(*connection, State::kNoDevice));
  EXPECT_THAT(connection->reason(), HasSubstr("another mounting"));
  const FakeHand hand = flat_fake_hand(1, true, 0, 200, 0);
  fake_leapc_send_frame(1, 0, &hand, 1);
  fake_leapc_switch_mode(0);
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  ServiceFrame frame;
  EXPECT_FALSE(connection->poll(frame));
}

TEST_F(LeapcConnection, ImpossibleMessagesAreCountedAndTheRestGoesOn) {
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  const FakeTrackingEvent no_hands_there{nullptr, 1, 0, 1, 2, nullptr, 0.0F},
      too_many{nullptr, 1, 0, 1, 1000, nullptr, 0.0F};
  fake_leapc_send_event(0x100, &no_hands_there, sizeof no_hands_there, 7);
  fake_leapc_send_event(0x100, &too_many, sizeof too_many, 7);
  for (const std::uint32_t type : {3U, 4U, 0x100U, 0x104U, 0x107U, 0x10bU}) fake_leapc_send_event(type, nullptr, 0, 7);
  fake_leapc_send_event(0xdeadbeef, nullptr, 0, 7);  // an event of a newer library
  FakeHand hands[2] = {flat_fake_hand(1, true, 0, 200, 0), flat_fake_hand(2, true, 0, 200, 0)};
  hands[0].arm.next_joint.x = NAN;
  fake_leapc_send_frame(2, 0, hands, 2);
  ServiceFrame frame;
  ASSERT_TRUE(eventually([&] { return connection->poll(frame); }));
  ASSERT_EQ(frame.hands.size(), 1U);
  EXPECT_EQ(frame.hands[0].id, 2U);
  EXPECT_EQ(connection->counters().refused, 9U);
}

TEST_F(LeapcConnection, ErrorsOfThePollAreCountedAndAnsweredWithPatience) {
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  fake_leapc_set_poll_error(kConcurrentPoll);
  ASSERT_TRUE(eventually([&] { return connection->counters().errors >= 3; }));
  EXPECT_EQ(connection->state(), State::kTracking);  // this one says nothing about the service
  fake_leapc_set_poll_error(kNotConnected);
  ASSERT_TRUE(reaches(*connection, State::kNoService));
  fake_leapc_set_poll_error(0);
  fake_leapc_set_service(false);
  fake_leapc_set_service(true);
  EXPECT_TRUE(reaches(*connection, State::kTracking));
}

TEST_F(LeapcConnection, PollsTheLibraryInOneThreadOnly) {
  // The fake notices two polls at once, as the library does.
  void* raw = nullptr;
  ASSERT_EQ(LeapCreateConnection(nullptr, &raw), 0U);
  ASSERT_EQ(LeapOpenConnection(raw), 0U);
  fake_leapc_set_service(false);
  FakeMessage message{};
  std::thread other([&] {
    while (LeapPollConnection(raw, 10'000, &message) == kConcurrentPoll) std::this_thread::yield();
  });
  FakeMessage mine{};
  ASSERT_TRUE(eventually([&] { return LeapPollConnection(raw, 0, &mine) == kConcurrentPoll; }));
  fake_leapc_set_service(true);
  other.join();
  LeapCloseConnection(raw);
  LeapDestroyConnection(raw);
  fake_leapc_reset();
  auto connection = make_connection(options, clock);
  ASSERT_TRUE(connection->start());
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  ASSERT_TRUE(connection->start());  // again, without stop
  ASSERT_TRUE(reaches(*connection, State::kTracking));
  EXPECT_EQ(fake_leapc_counts().polls_at_once, 0);
  EXPECT_EQ(fake_leapc_counts().open_connections, 1);
}

TEST_F(LeapcConnection, AThousandCyclesLeaveNoThreadDescriptorOrConnection) {
  options.poll = milliseconds(1);
  const FakeHand hand = flat_fake_hand(1, true, 0, 200, 0);
  std::ptrdiff_t threads = 0, descriptors = 0;
  std::size_t allocated = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i == 100) {  // after the first ones, which fill caches
      threads = entries("/proc/self/task");
      descriptors = entries("/proc/self/fd");
      allocated = ::mallinfo2().uordblks;
    }
    auto connection = make_connection(options, clock);
    ASSERT_TRUE(connection->start());
    fake_leapc_send_frame(i, 0, &hand, 1);
    if (i % 2 == 0) fake_leapc_set_service(false);
    if (i % 4 == 0) {
      ASSERT_TRUE(reaches(*connection, State::kNoService));
    }
    if (i % 3 == 0) connection->stop();
    connection.reset();
    fake_leapc_set_service(true);
  }
  EXPECT_EQ(entries("/proc/self/task"), threads);
  EXPECT_EQ(entries("/proc/self/fd"), descriptors);
  EXPECT_LT(::mallinfo2().uordblks, allocated + 64 * 1024);  // 900 cycles
  const FakeLeapcCounts counts = fake_leapc_counts();
  EXPECT_EQ(counts.created, 1000);
  EXPECT_EQ(counts.destroyed, 1000);
}

}  // namespace
}  // namespace dubsar::leapc
