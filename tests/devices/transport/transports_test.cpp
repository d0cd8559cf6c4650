// Transports without devices: simulated, faulty, recorded, replayed, sockets; and reconnection.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "core/base/files/atomic_file.h"
#include "core/base/system/second.h"
#include "devices/transport/hotplug_watch.h"
#include "devices/transport/reconnector.h"
#include "devices/transport/record_transport.h"
#include "devices/transport/replay_transport.h"
#include "devices/transport/sim_transport.h"
#include "devices/transport/socket_transport.h"
#include "tests/devices/device_bytes.h"
#include "tests/devices/transport/fault_transport.h"

namespace dubsar {
namespace {

constexpr milliseconds kNoWait{0};

std::string read_hex(Transport& transport, milliseconds timeout = kNoWait) {
  std::array<std::byte, 64> buffer;
  const auto length = transport.read(buffer, timeout);
  if (!length) return std::string("error ") + std::to_string(exit_code(length.error().kind));
  return to_hex(std::span(buffer).first(*length));
}

TEST(SimTransport, ReportsKeepTheirBoundaries) {
  SimDevice device("sim");
  auto transport = device.open().value();
  device.send(from_hex("0102"));
  device.send(from_hex("030405"));
  EXPECT_EQ(read_hex(*transport), "0102");
  EXPECT_EQ(read_hex(*transport), "030405");
  EXPECT_EQ(read_hex(*transport), "");
}

TEST(SimTransport, AnUnpluggedTransportIsLostEvenWhenTheDeviceIsBack) {
  SimDevice device("sim");
  auto transport = device.open().value();
  device.unplug();
  EXPECT_EQ(device.open().error().kind, ErrorKind::kUnavailable);
  device.plug();
  EXPECT_EQ(read_hex(*transport), "error 69");
  EXPECT_EQ(transport->write({}).error().kind, ErrorKind::kUnavailable);
  auto again = device.open().value();
  device.send(from_hex("07"));
  EXPECT_EQ(read_hex(*again), "07");
}

TEST(SimTransport, OutlivesItsDevice) {
  auto device = std::make_unique<SimDevice>("sim");
  auto transport = device->open().value();
  device.reset();
  EXPECT_EQ(read_hex(*transport, milliseconds(5)), "error 69");
}

TEST(FaultTransport, DoesWhatTheScriptSaysAndNothingElse) {
  SimDevice device("sim");
  auto faults = parse_faults("drop@1,truncate@2:1,garbage@3,stall@4x2,unplug@5");
  ASSERT_TRUE(faults);
  auto transport = make_fault_transport(device.open().value(), *faults);
  for (int i = 0; i < 8; ++i) device.send(from_hex("a0a1a2"));
  EXPECT_EQ(read_hex(*transport), "a0a1a2");
  EXPECT_EQ(read_hex(*transport), "");
  EXPECT_EQ(read_hex(*transport), "a0");
  const std::string garbage = read_hex(*transport);
  EXPECT_EQ(garbage.size(), 6U);
  EXPECT_NE(garbage, "a0a1a2");
  EXPECT_EQ(read_hex(*transport), "");
  EXPECT_EQ(read_hex(*transport), "");
  EXPECT_EQ(read_hex(*transport), "a0a1a2");
  EXPECT_EQ(read_hex(*transport), "error 69");
  EXPECT_EQ(read_hex(*transport), "error 69");
}

TEST(FaultTransport, RefusesScriptsItCannotRead) {
  for (const char* text : {"drop", "drop@", "drop@x", "melt@3", "drop@3y", "@3", "drop@99999999999999999999999"})
    EXPECT_EQ(parse_faults(text).error().kind, ErrorKind::kUsage) << text;
  EXPECT_TRUE(parse_faults("")->empty());
  const std::vector<Fault> expected{{FaultKind::kTruncate, 3, 4, 5}};
  EXPECT_EQ(*parse_faults("truncate@3x4:5"), expected);
}

TEST(Recording, EveryKindOfEventSurvivesTheFile) {
  Recording recording{"leap", "first light", {}, false};
  recording.events = {{0, WireEventKind::kOpened, {}, {}},
                      {5, WireEventKind::kRead, {}, from_hex("00ff10")},
                      {6, WireEventKind::kWritten, {}, from_hex("0401")},
                      {7, WireEventKind::kFeatureSet, {}, from_hex("02")},
                      {7, WireEventKind::kFeatureGot, {}, from_hex("0203")},
                      {9, WireEventKind::kControl, {0xa1, 0x81, 0x0300, 0x0500}, from_hex("4243")},
                      {9, WireEventKind::kControl, {0x21, 0x01, 0x0300, 0x0500}, {}},
                      {11, WireEventKind::kLost, {}, {}}};
  const std::string text = format_recording(recording);
  const auto read = parse_recording(text);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->driver, "leap");
  EXPECT_EQ(read->note, "first light");
  EXPECT_EQ(read->events, recording.events);
  EXPECT_EQ(format_recording(*read), text);
}

TEST(Recording, WhatCamerasSendIsKeptAsItIsWhateverItsBytesAre) {
  std::vector<std::byte> picture(100'000);
  for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = static_cast<std::byte>((i * 7919) >> 3);
  picture[0] = picture[17] = std::byte{'\n'};
  Recording recording{"leap", "", {}, true};
  recording.events = {{0, WireEventKind::kOpened, {}, from_hex("2936120a")},
                      {5, WireEventKind::kRead, {}, picture},
                      {6, WireEventKind::kControl, {0xa1, 0x81, 0x0300, 0x0500}, picture},
                      {7, WireEventKind::kRead, {}, from_hex("00ff10")},
                      {11, WireEventKind::kLost, {}, {}}};
  const std::string text = format_recording(recording);
  EXPECT_LT(text.size(), 2 * picture.size() + 300) << "twice that as text";
  const auto read = parse_recording(text);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->raw);
  EXPECT_FALSE(read->cut_off);
  EXPECT_EQ(read->events, recording.events);
  for (const std::size_t length : {std::size_t{40}, std::size_t{70}, std::size_t{5'000}, picture.size() + 60}) {
    const auto cut = parse_recording(std::string_view(text).substr(0, length));
    EXPECT_TRUE(!cut || (cut->cut_off && cut->events.size() <= 2)) << length;
  }
  for (const char* line : {"5 r =3\n0123\n", "5 r =0\n\n", "5 r 01 =1\n1\n", "5 x =1\n1\n", "5 r =99999999999\n"})
    EXPECT_EQ(parse_recording(std::string("dubsar-recording 2\ndriver x\n") + line).error().kind, ErrorKind::kBadData)
        << line;
  EXPECT_FALSE(parse_recording("dubsar-recording 1\ndriver x\n5 r =1\n1\n")) << "version 1 has none";
}

TEST(Recording, EveryTruncationIsReadUpToItsLastWholeLineOrRefused) {
  const std::string text = "dubsar-recording 1\ndriver x\n0 o\n5 r 0102\n7 c a1 81 0300 0500 42\n9 x\n";
  for (std::size_t length = 0; length < text.size(); ++length) {
    const std::string cut = text.substr(0, length);
    const auto read = parse_recording(cut);
    const auto lines = std::count(cut.begin(), cut.end(), '\n');
    ASSERT_EQ(read.has_value(), lines >= 2) << length;
    if (!read) continue;
    EXPECT_EQ(static_cast<std::int64_t>(read->events.size()), lines - 2) << length;
    EXPECT_EQ(read->cut_off, cut.back() != '\n') << length;
  }
}

TEST(Recording, RefusesWhatItDoesNotUnderstand) {
  const std::string head = "dubsar-recording 1\ndriver x\n";
  for (const char* line : {"5 r 012", "5 q 01", "x r 01", "-5 r 01", "5 r 0g", "5 r 01 02", "5 o 01", "", "5",
                           "5 c a1 81 0300 05 42", "99999999999999999999 r 01", "5 r 0A"}) {
    EXPECT_EQ(parse_recording(head + line + "\n").error().kind, ErrorKind::kBadData) << line;
  }
  EXPECT_FALSE(parse_recording(head + "5 r 01\n4 r 01\n"));
  const auto newer = parse_recording("dubsar-recording 3\ndriver x\n");
  EXPECT_NE(newer.error().message.find("version 3 found"), std::string::npos);
  EXPECT_FALSE(parse_recording("hello\ndriver x\n"));
}

TEST(Replay, GivesBackWhatWasRecordedThroughALoss) {
  const auto path = std::filesystem::temp_directory_path() / ("dubsar_replay_" + std::to_string(::getpid()));
  ManualClock clock(1000);
  SimDevice device("sim");
  SimBehaviour behaviour;
  behaviour.on_get_feature = [](std::uint8_t id) -> Result<std::vector<std::byte>> {
    return std::vector<std::byte>{static_cast<std::byte>(id), std::byte{0x77}};
  };
  behaviour.on_control = [](const ControlRequest& request, std::span<std::byte> data) -> Result<std::size_t> {
    if (request.to_host()) data[0] = static_cast<std::byte>(request.value & 0xFFU);
    return data.size();
  };
  device.set_behaviour(behaviour);
  {
    auto writer = RecordingWriter::create(path, "spacemouse", "a note", clock).value();
    auto transport = make_record_transport(device.open().value(), writer);
    std::array<std::byte, 8> buffer;
    EXPECT_EQ(transport->get_feature(3, buffer).value(), 2U);
    device.send(from_hex("0102"));
    clock.advance(50);
    EXPECT_EQ(read_hex(*transport), "0102");
    EXPECT_EQ(transport->control({0xa1, 1, 0x55, 0}, std::span(buffer).first(1), kNoWait).value(), 1U);
    device.unplug();
    clock.advance(50);
    EXPECT_EQ(read_hex(*transport), "error 69");
    device.plug();
    transport = make_record_transport(device.open().value(), writer);
    device.send(from_hex("09"));
    clock.advance(50);
    EXPECT_EQ(read_hex(*transport), "09");
    EXPECT_TRUE(writer->finish());
    EXPECT_EQ(writer->event_count(), 7);
  }
  auto recording = read_recording(path);
  ASSERT_TRUE(recording) << recording.error().message;
  std::filesystem::remove(path);

  ReplaySession session(*recording, clock, 0.0);
  auto transport = session.open().value();
  std::array<std::byte, 8> buffer;
  ASSERT_EQ(transport->get_feature(3, buffer).value(), 2U);
  EXPECT_EQ(to_hex(std::span(buffer).first(2)), "0377");
  EXPECT_EQ(transport->get_feature(3, buffer).error().kind, ErrorKind::kBadData);
  EXPECT_TRUE(transport->write(from_hex("00")));
  EXPECT_EQ(read_hex(*transport), "0102");
  EXPECT_EQ(session.recorded_clock().now(), 50);
  ASSERT_EQ(transport->control({0xa1, 1, 0x55, 0}, std::span(buffer).first(1), kNoWait).value(), 1U);
  EXPECT_EQ(buffer[0], std::byte{0x55});
  EXPECT_EQ(read_hex(*transport), "error 69");
  transport = session.open().value();
  EXPECT_EQ(read_hex(*transport), "09");
  EXPECT_EQ(read_hex(*transport), "error 69");
  EXPECT_EQ(session.open().error().kind, ErrorKind::kUnavailable);
}

TEST(Replay, ReportsComeWhenTheyAreDueAtTheFactor) {
  ManualClock clock(500);
  auto recording = parse_recording("dubsar-recording 1\ndriver x\n0 r 01\n1000 r 02\n2000 r 03\n").value();
  ReplaySession session(recording, clock, 2.0);
  auto transport = session.open().value();
  EXPECT_EQ(read_hex(*transport), "01");
  clock.advance(499);
  EXPECT_EQ(read_hex(*transport), "");
  clock.advance(1);
  EXPECT_EQ(read_hex(*transport), "02");
  clock.advance(500);
  EXPECT_EQ(read_hex(*transport), "03");
}

TEST(Reconnector, PausesGrowFromHalfASecondToTen) {
  std::vector<TimestampNs> attempts;
  TimestampNs now = 0;
  Reconnector reconnector([&]() -> Result<std::unique_ptr<Transport>> {
    attempts.push_back(now);
    return fail(ErrorKind::kUnavailable, "not there");
  });
  for (; now <= 46 * kSecondNs; now += kSecondNs / 10) EXPECT_EQ(reconnector.transport(now), nullptr);
  const std::vector<double> expected{0, 0.5, 1.5, 3.5, 7.5, 15.5, 25.5, 35.5, 45.5};
  ASSERT_EQ(attempts.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(static_cast<double>(attempts[i]) * 1e-9, expected[i], 1e-9);
  EXPECT_EQ(reconnector.reason(), "not there");
  reconnector.wake();
  now = 46 * kSecondNs + 1;
  reconnector.transport(now);
  EXPECT_EQ(attempts.back(), now);
}

TEST(HotplugWatch, SeesNodesComeAndGo) {
  const auto folder = std::filesystem::temp_directory_path() / ("dubsar_watch_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  auto watch = HotplugWatch::create(std::vector{folder});
  ASSERT_TRUE(watch);
  EXPECT_FALSE(watch->changed());
  ASSERT_TRUE(write_file_atomically(folder / "hidraw0", std::string_view("x")));
  EXPECT_TRUE(watch->changed());
  EXPECT_FALSE(watch->changed());
  std::filesystem::remove(folder / "hidraw0");
  EXPECT_TRUE(watch->changed());
  std::filesystem::remove_all(folder);
  EXPECT_EQ(HotplugWatch::create(std::vector<std::filesystem::path>{"/no/such/folder"}).error().kind,
            ErrorKind::kUnavailable);
}

class UdpSender {
 public:
  explicit UdpSender(std::uint16_t port) : descriptor_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~UdpSender() { ::close(descriptor_); }
  void send(std::span<const std::byte> bytes) {
    ASSERT_EQ(::sendto(descriptor_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to_), sizeof to_),
              static_cast<ssize_t>(bytes.size()));
  }

 private:
  int descriptor_;
  sockaddr_in to_{};
};

TEST(Udp, HearsOnlyTheFirstSenderUntilItFallsSilent) {
  ManualClock clock(kSecondNs);
  UdpOptions options;
  options.port = 0;
  options.accept = [](std::span<const std::byte> d) { return d.size() == 2; };
  auto udp = open_udp(options, clock);
  ASSERT_TRUE(udp) << udp.error().message;
  UdpSender first((*udp)->port()), second((*udp)->port());
  second.send(from_hex("010203"));  // not taken, so that it locks nothing
  first.send(from_hex("0102"));
  second.send(from_hex("0909"));
  EXPECT_EQ(read_hex(**udp, milliseconds(200)), "0102");
  EXPECT_EQ(read_hex(**udp, milliseconds(20)), "");
  EXPECT_EQ((*udp)->counts().refused, 1U);
  EXPECT_EQ((*udp)->counts().foreign, 1U);
  clock.advance(options.lock_ns);
  second.send(from_hex("0909"));
  EXPECT_EQ(read_hex(**udp, milliseconds(200)), "0909");
}

TEST(Udp, DropsWhatComesFasterThanTheRate) {
  ManualClock clock(kSecondNs);
  UdpOptions options;
  options.port = 0;
  auto udp = open_udp(options, clock).value();
  UdpSender sender(udp->port());
  for (int i = 0; i < 80; ++i) sender.send(from_hex("01"));
  int taken = 0;
  while (read_hex(*udp, milliseconds(5)) == "01") ++taken;
  EXPECT_EQ(taken, 50);  // the burst; the clock stands still
  EXPECT_EQ(udp->counts().too_fast, 30U);
  clock.advance(3'000'000);
  for (int i = 0; i < 5; ++i) sender.send(from_hex("02"));
  taken = 0;
  while (read_hex(*udp, milliseconds(5)) == "02") ++taken;
  EXPECT_EQ(taken, 3);  // 1 kHz for 3 ms
}

TEST(Udp, ListensOnTheLoopbackUnlessToldOtherwise) {
  ManualClock clock;
  UdpOptions options;
  options.port = 0;
  options.address = "0.0.0.0";
  EXPECT_EQ(open_udp(options, clock).error().kind, ErrorKind::kUsage);
  options.allow_remote = true;
  EXPECT_TRUE(open_udp(options, clock));
  options = {};
  options.address = "localhost";
  EXPECT_EQ(open_udp(options, clock).error().kind, ErrorKind::kUsage);
  options = {};
  options.port = 0;
  auto held = open_udp(options, clock).value();
  options.port = held->port();
  EXPECT_EQ(open_udp(options, clock).error().kind, ErrorKind::kUnavailable);
}

TEST(UnixStream, CarriesBytesAndTellsTheEnd) {
  const auto path = (std::filesystem::temp_directory_path() / ("dubsar_stream_" + std::to_string(::getpid()))).string();
  EXPECT_EQ(open_unix_stream(path).error().kind, ErrorKind::kUnavailable);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listener, 1), 0);
  auto transport = open_unix_stream(path);
  ASSERT_TRUE(transport) << transport.error().message;
  const int peer = ::accept(listener, nullptr, nullptr);
  EXPECT_EQ(read_hex(**transport), "");
  ASSERT_EQ(::write(peer, "ab", 2), 2);
  EXPECT_EQ(read_hex(**transport, milliseconds(500)), "6162");
  ASSERT_TRUE((*transport)->write(from_hex("4344")));
  char got[2];
  ASSERT_EQ(::read(peer, got, 2), 2);
  EXPECT_EQ(std::string_view(got, 2), "CD");
  ::close(peer);
  EXPECT_EQ(read_hex(**transport, milliseconds(500)), "error 69");
  EXPECT_EQ((*transport)->write(from_hex("00")).error().kind, ErrorKind::kUnavailable);
  ::close(listener);
  ::unlink(path.c_str());
}

}  // namespace
}  // namespace dubsar
