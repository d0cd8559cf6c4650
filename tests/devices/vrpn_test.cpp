// VRPN: our client on bytes of its server, our simulated server on bytes of its client, sockets as both use them.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <thread>

#include "core/base/system/second.h"
#include "devices/driver.h"
#include "devices/head_tracker/vrpn_server.h"
#include "devices/transport/sim_transport.h"
#include "devices/transport/socket_server.h"
#include "devices/transport/socket_transport.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {

double angle_between(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

/// What another program wrote, see tests/devices/captured/README.md.
std::vector<std::byte> captured(const char* name) {
  std::ifstream file(std::string(DUBSAR_CAPTURED) + "/" + name, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_GT(bytes.size(), 1000U) << name;
  const auto* const begin = reinterpret_cast<const std::byte*>(bytes.data());
  return {begin, begin + bytes.size()};
}

/// All messages of a stream that starts with a cookie.
std::vector<VrpnMessage> messages_of(std::span<const std::byte> bytes) {
  VrpnStream stream;
  stream.feed(bytes);
  std::vector<VrpnMessage> messages;
  while (auto message = stream.next()) messages.push_back(*std::move(message));
  EXPECT_TRUE(stream.greeted());
  return messages;
}

std::vector<std::byte> vrpn_session(const Pose& pose) {
  std::vector<std::byte> stream;
  const auto add = [&](std::span<const std::byte> bytes) { stream.insert(stream.end(), bytes.begin(), bytes.end()); };
  add(vrpn_cookie());
  add(format_vrpn(vrpn_name_message(-1, 4, "Tracker0")));
  add(format_vrpn(vrpn_name_message(-2, 7, "vrpn_Tracker Pos_Quat")));
  add(format_vrpn(vrpn_name_message(-2, 8, "vrpn_Button Change")));
  add(format_vrpn({0, 0, 4, 8, from_hex("0000000000000001")}));
  add(format_vrpn(vrpn_pose_message(4, 7, 0, pose)));
  add(format_vrpn(vrpn_pose_message(4, 7, 1, {})));  // another sensor
  return stream;
}

TEST(Vrpn, GoldenMessage) {
  EXPECT_EQ(to_hex(vrpn_cookie()),
            "7672706e3a207665722e2030372e3338202030"
            "0000000000");
  EXPECT_EQ(to_hex(format_vrpn(vrpn_name_message(-1, 4, "T"))),
            "0000001e"
            "00000000"
            "00000000"
            "00000004"
            "ffffffff"
            "00000000"
            "00000002"
            "5400"
            "0000");
  const auto pose = vrpn_pose_message(0, 0, 3, {{1.0, 0, 0}, {1, 0, 0, 0}});
  EXPECT_EQ(to_hex(pose.payload),
            "0000000300000000"
            "3ff0000000000000"
            "0000000000000000"
            "0000000000000000"
            "0000000000000000"
            "0000000000000000"
            "0000000000000000"
            "3ff0000000000000");
}

TEST(Vrpn, ThePoseIsFoundHoweverTheStreamIsCut) {
  const Pose pose{{0.1, 0.2, 0.3}, glm::angleAxis(0.5, glm::dvec3(0, 1, 0))};
  const auto stream = vrpn_session(pose);
  for (std::size_t piece = 1; piece < stream.size(); piece += 1 + piece / 8) {
    SimDevice device("vrpn", false);
    Driver<VrpnProtocol> driver([&] { return device.open(); }, VrpnProtocol({"Tracker0", 0}));
    driver.poll(0);
    std::optional<HeadSample> sample;
    for (std::size_t at = 0; at < stream.size(); at += piece)
      device.send(std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
    sample = driver.poll(7);
    ASSERT_TRUE(sample) << piece;
    EXPECT_EQ(sample->pose.position_m, pose.position_m);
    EXPECT_LT(angle_between(sample->pose.rotation, pose.rotation), 1e-7);
    EXPECT_EQ(driver.counts().refused, 0U);
  }
}

TEST(Vrpn, AnotherTrackersPosesAreNotTaken) {
  SimDevice device("vrpn", false);
  Driver<VrpnProtocol> driver([&] { return device.open(); }, VrpnProtocol({"Wand", 0}));
  driver.poll(0);
  device.send(vrpn_session({}));
  EXPECT_FALSE(driver.poll(1));
  EXPECT_TRUE(driver.connected());
}

TEST(Vrpn, AWrongVersionADamagedLengthAndAGoodbyeEndTheConnection) {
  auto wrong = vrpn_session({});
  wrong[12] = std::byte{'6'};
  auto damaged = vrpn_session({});
  damaged[24] = std::byte{0x7f};
  std::vector<std::byte> goodbye = vrpn_session({});
  const auto end = format_vrpn({0, 0, 0, -5, {}});
  goodbye.insert(goodbye.end(), end.begin(), end.end());
  for (const auto& stream : {wrong, damaged, goodbye}) {
    SimDevice device("vrpn", false);
    Driver<VrpnProtocol> driver([&] { return device.open(); }, VrpnProtocol());
    driver.poll(0);
    device.send(stream);
    driver.poll(1);
    driver.poll(2);
    EXPECT_FALSE(driver.connected());
    EXPECT_NE(driver.reason().find("vrpn: "), std::string::npos);
  }
}

TEST(Vrpn, PosesHaveTheTimeOfTheServersMeasurement) {
  SimDevice server("vrpn", false);
  Driver<VrpnProtocol> driver([&] { return server.open(); }, VrpnProtocol());
  driver.poll(0);
  server.send(vrpn_cookie());
  server.send(format_vrpn(vrpn_name_message(-1, 0, "Tracker0")));
  server.send(format_vrpn(vrpn_name_message(-2, 4, "vrpn_Tracker Pos_Quat")));
  const auto measured = [&](std::uint32_t ms) {
    VrpnMessage message = vrpn_pose_message(0, 4, 0, {{0, 0, 0.6}, {1, 0, 0, 0}});
    message.seconds = 1'700'000'000U + ms / 1000;
    message.microseconds = 1000 * (ms % 1000);
    server.send(format_vrpn(message));
  };
  measured(10);
  EXPECT_EQ(driver.poll(kSecondNs)->time, kSecondNs);
  measured(20);
  EXPECT_NEAR(static_cast<double>(driver.poll(kSecondNs + 50'000'000)->time), kSecondNs + 10e6,
              1e4);  // 40 ms on its way
}

// vrpn_server 07.38 with a null tracker (two sensors, 60 Hz) and one that spins about (0, 1, 0) at 0.1 Hz, 100 times a
// second: neighbouring poses are 0.36 degrees apart for 10 ms by the server's clock.
TEST(VrpnServer0738, ItsSpinningTrackerTurnsAtItsRate) {
  const auto bytes = captured("vrpn_server_07.38_spin.bin");
  for (const std::size_t piece : {std::size_t{1}, std::size_t{137}, bytes.size()}) {
    SimDevice server("vrpn", false);
    Driver<VrpnProtocol> driver([&] { return server.open(); }, VrpnProtocol({"Spin0", 0}));
    driver.poll(0);
    std::vector<HeadSample> samples;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      server.send(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
      if (piece < bytes.size() && server.open_count() == 1)
        if (const auto sample = driver.poll(kSecondNs)) samples.push_back(*sample);
    }
    if (const auto sample = driver.poll(kSecondNs)) samples.push_back(*sample);
    EXPECT_EQ(driver.counts().refused, 0U);
    EXPECT_EQ(driver.note(), "");
    ASSERT_FALSE(samples.empty());
    EXPECT_EQ(samples.back().pose.position_m, glm::dvec3(0.0));
    EXPECT_EQ(samples.back().pose.rotation.x, 0.0);
    EXPECT_EQ(samples.back().pose.rotation.z, 0.0);
    if (piece != 1) continue;
    EXPECT_GE(samples.size(), 20U);
    const double turned = angle_between(samples.front().pose.rotation, samples.back().pose.rotation);
    const auto messages = messages_of(bytes);
    std::vector<double> times;
    for (const VrpnMessage& m : messages)
      if (m.sender == 2 && m.type == 4) times.push_back(m.seconds + 1e-6 * m.microseconds);
    ASSERT_EQ(times.size(), samples.size());
    EXPECT_NEAR(turned, 2.0 * std::numbers::pi * 0.1 * (times.back() - times.front()), 2e-3);
  }
}

TEST(VrpnServer0738, AWrongTrackerOrSensorIsToldWhatWasHeard) {
  const auto bytes = captured("vrpn_server_07.38_spin.bin");
  const auto told = [&](VrpnChoice choice) {
    SimDevice server("vrpn", false);
    Driver<VrpnProtocol> driver([&] { return server.open(); }, VrpnProtocol(std::move(choice)));
    driver.poll(0);
    server.send(bytes);
    const bool any = driver.poll(1).has_value();
    EXPECT_EQ(any, driver.note().empty());
    return driver.note();
  };
  EXPECT_EQ(told({"Head", 0}), "vrpn: no poses of Head, sensor 0; heard are: Spin0 (sensor 0), Tracker0 (sensor 0, 1)");
  EXPECT_EQ(told({"Spin0", 1}),
            "vrpn: no poses of Spin0, sensor 1; heard are: Spin0 (sensor 0), Tracker0 (sensor 0, 1)");
  EXPECT_EQ(told({"Tracker0", 1}), "");
  EXPECT_EQ(told({"", 0}), "");
  EXPECT_NE(told({"", 7}).find("any tracker, sensor 7"), std::string::npos);
}

TEST(VrpnPrintDevices0738, IsServedHoweverItsWritesAreCutAndItsPingsAreAnswered) {
  const auto bytes = captured("vrpn_print_devices_07.38_client.bin");
  for (const std::size_t piece : {std::size_t{1}, std::size_t{24}, std::size_t{100}, bytes.size()}) {
    VrpnServerSide side("Spin0");
    EXPECT_TRUE(side.pose(kSecondNs, {}).empty());
    std::vector<std::byte> answers;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      const auto answer = side.accept(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
      ASSERT_TRUE(answer) << answer.error().message;
      answers.insert(answers.end(), answer->begin(), answer->end());
    }
    const auto pose = side.pose(5 * kSecondNs, {{0.1, 0.2, 0.3}, {1, 0, 0, 0}});
    answers.insert(answers.end(), pose.begin(), pose.end());
    const auto messages = messages_of(answers);
    std::int32_t pong = -100, tracker = -100, pos_quat = -100;
    int pongs = 0, poses = 0;
    for (const VrpnMessage& m : messages) {
      const std::string text(reinterpret_cast<const char*>(m.payload.data()), m.payload.size());
      if (m.type == -1 && text.find("Spin0") != std::string::npos) tracker = m.sender;
      if (m.type == -2 && text.find("vrpn_Base pong_message") != std::string::npos) pong = m.sender;
      if (m.type == -2 && text.find("vrpn_Tracker Pos_Quat") != std::string::npos) pos_quat = m.sender;
      if (m.type == pong && m.sender == tracker) ++pongs;
      if (m.type == pos_quat && m.sender == tracker) ++poses;
    }
    EXPECT_EQ(pongs, 5) << piece;  // that client pinged five times
    EXPECT_EQ(poses, 1);
  }
  VrpnServerSide other("Tracker0");
  for (const VrpnMessage& m : messages_of(other.accept(bytes).value())) EXPECT_LT(m.type, 0);  // pings of others
  auto wrong = bytes;
  wrong[12] = std::byte{'6'};
  EXPECT_EQ(VrpnServerSide("Spin0").accept(wrong).error().kind, ErrorKind::kBadData);
}

TEST(VrpnCall, IsHostPortAndAZeroByte) {
  const auto port = [](std::string_view text) { return parse_vrpn_call(std::as_bytes(std::span(text))); };
  using std::literals::string_view_literals::operator""sv;
  EXPECT_EQ(port("127.0.0.1 51679\0"sv), 51679);
  EXPECT_EQ(port("some.host 1\0"sv), 1);
  for (const auto bad : {""sv, "\0"sv, "127.0.0.1 51679"sv, "127.0.0.1\0"sv, " 51679\0"sv, "h 65536\0"sv, "h 0\0"sv,
                         "h 12x\0"sv, "h 1 2\0"sv})
    EXPECT_FALSE(port(bad)) << bad;
}

TEST(VrpnCall, TheCallerIsConnectedToAtTheAddressItCalledFrom) {
  const auto server = listen_tcp_and_calls("127.0.0.1", 0, false, parse_vrpn_call).value();
  const auto client = listen_tcp("127.0.0.1", 0, false).value();  // as VRPN's client waits for its server
  const auto call = open_udp_sender("127.0.0.1", server->port()).value();
  const std::string junk = "hello";
  ASSERT_TRUE(call->write(std::as_bytes(std::span(junk))));
  EXPECT_FALSE(server->accept(milliseconds(100)));
  const std::string text = "192.0.2.1 " + std::to_string(client->port()) + std::string(1, '\0');
  ASSERT_TRUE(call->write(std::as_bytes(std::span(text))));
  const auto to_client = server->accept(milliseconds(1000));
  ASSERT_TRUE(to_client);
  const auto from_server = client->accept(milliseconds(1000));
  ASSERT_TRUE(from_server);
  ASSERT_TRUE(to_client->write(vrpn_cookie()));
  std::array<std::byte, 64> buffer;
  EXPECT_EQ(from_server->read(buffer, milliseconds(1000)).value(), kVrpnCookieBytes);
  // and over TCP as before
  const auto direct = open_tcp_stream("localhost", server->port(), milliseconds(1000));
  ASSERT_TRUE(direct) << direct.error().message;
  EXPECT_TRUE(server->accept(milliseconds(1000)));
}

/// A socket of this machine in TIME_WAIT (state 06) with this port at either end.
bool in_time_wait(unsigned port) {
  for (const char* const table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(table);
    std::string line;
    while (std::getline(file, line)) {
      int number = 0;
      unsigned local = 0, remote = 0, state = 0;
      char local_address[40], remote_address[40];
      if (std::sscanf(line.c_str(), " %d: %39[0-9A-F]:%x %39[0-9A-F]:%x %x", &number, local_address, &local,
                      remote_address, &remote, &state) == 6 &&
          state == 6 && (local == port || remote == port))
        return true;
    }
  }
  return false;
}

TEST(VrpnClient, LeavesNoTimeWaitOnTheServersPortWhenItClosesFirst) {
  for (const TcpClosing closing : {TcpClosing::kOrderly, TcpClosing::kAtOnce}) {
    auto server = listen_tcp("127.0.0.1", 0, false).value();
    const unsigned port = server->port();
    auto client = open_tcp_stream("127.0.0.1", server->port(), milliseconds(1000), closing).value();
    auto accepted = server->accept(milliseconds(1000));
    ASSERT_TRUE(accepted);
    client.reset();
    std::array<std::byte, 8> buffer;
    EXPECT_FALSE(accepted->read(buffer, milliseconds(1000)));
    accepted.reset();
    server.reset();
    EXPECT_EQ(in_time_wait(port), closing == TcpClosing::kOrderly);
  }
}

TEST(VrpnClient, HostsAreTakenByNameAndWhatIsNoneIsRefused) {
  EXPECT_TRUE(check_host("localhost"));
  EXPECT_TRUE(check_host("tracker-7.lab_net.example"));
  EXPECT_TRUE(check_host("::1"));
  for (const char* bad : {"", "no host", "a/b", "host:3883"})
    EXPECT_EQ(check_host(bad).error().kind, ErrorKind::kUsage) << bad;
  const auto nowhere = open_tcp_stream("no-such-host.invalid", 3883, milliseconds(100));
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().kind, ErrorKind::kUnavailable);
  EXPECT_NE(nowhere.error().message.find("no-such-host.invalid"), std::string::npos);
}

}  // namespace
}  // namespace dubsar
