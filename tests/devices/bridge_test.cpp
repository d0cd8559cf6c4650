// The maker's service: its answers, and a client that meets good and bad servers.

#include <gtest/gtest.h>

#include <string>

#include "devices/looking_glass/bridge_client.h"
#include "devices/transport/http_exchange.h"
#include "tests/devices/fake_bridge.h"

namespace dubsar {
namespace {

constexpr const char* kCalibration = R"({"serial": "LKG-P00671", "pitch": {"value": 52.5}})";

std::vector<test::FakeBridgeDevice> two_devices() {
  return {{"LKG-P00671", "portrait", kCalibration}, {"DELL-1", "thirdparty", ""}};
}

TEST(HttpReply, BodiesByLengthByChunksAndUpToTheEndAreTheSame) {
  for (const char* text :
       {"HTTP/1.1 200 OK\r\nContent-Length: 11\r\n\r\nhello world", "HTTP/1.0 200\r\n\r\nhello world",
        "HTTP/1.1 200 OK\r\ntransfer-encoding: Chunked\r\n\r\n6;x=1\r\nhello \r\n5\r\nworld\r\n0\r\n\r\n",
        "HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200 OK\r\nCONTENT-LENGTH:11\r\n\r\nhello world"}) {
    const auto reply = parse_http_reply(text, true);
    ASSERT_TRUE(reply && *reply) << text;
    EXPECT_EQ((*reply)->status, 200);
    EXPECT_EQ((*reply)->body, "hello world");
  }
}

TEST(HttpReply, AnswersBeforeTheAnswerAreCounted) {
  const auto preceded = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "HTTP/1.1 100\r\n\r\n";
    return parse_http_reply(text + "HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nhi", true);
  };
  EXPECT_EQ((*preceded(8))->body, "hi");
  EXPECT_EQ(preceded(9).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(preceded(60'000).error().kind, ErrorKind::kBadData);  // each one was a stack frame once
}

TEST(HttpReply, EveryTruncationWaitsForMoreOrIsAnError) {
  for (const std::string text :
       {"HTTP/1.1 200 OK\r\nContent-Length: 11\r\n\r\nhello world",
        "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n6\r\nhello \r\n5\r\nworld\r\n0\r\n\r\n"})
    for (std::size_t length = 0; length < text.size(); ++length) {
      const auto more = parse_http_reply(text.substr(0, length), false);
      ASSERT_TRUE(more) << length << more.error().message;
      EXPECT_FALSE(*more) << length;
      EXPECT_EQ(parse_http_reply(text.substr(0, length), true).error().kind, ErrorKind::kBadData) << length;
    }
}

TEST(HttpReply, WhatIsNotHttpOrContradictsItselfIsRefused) {
  for (const char* text :
       {"SSH-2.0-OpenSSH\r\n\r\n", "HTTP/2 200 OK\r\n\r\n", "HTTP/1.1 abc OK\r\n\r\n",
        "HTTP/1.1 200 OK\r\nno colon\r\n\r\n", "HTTP/1.1 200 OK\r\nContent-Length: -1\r\n\r\n",
        "HTTP/1.1 200 OK\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab",
        "HTTP/1.1 200 OK\r\nContent-Length: 99999999999\r\n\r\n", "HTTP/1.1 200 OK\r\nTransfer-Encoding: gzip\r\n\r\n",
        "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\nContent-Length: 1\r\n\r\n",
        "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
        "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n2\r\nabcd\r\n"})
    EXPECT_EQ(parse_http_reply(text, false).error().kind, ErrorKind::kBadData) << text;
  EXPECT_EQ(parse_http_reply(std::string(kMaxHttpBytes + 1, 'x'), false).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(parse_http_reply("HTTP/1.1 200 OK\r\nx: " + std::string(20000, 'x'), false).error().kind,
            ErrorKind::kBadData);
}

TEST(Bridge, DisplaysComeWithTheirCalibrationsHoweverTheServerSendsThem) {
  for (const test::BridgeManners manners : {test::BridgeManners{}, {.chunked = true}, {.until_close = true}}) {
    test::FakeBridge bridge(two_devices(), manners);
    const auto devices = read_bridge_devices(bridge_opener(bridge.port()), SteadyClock());
    ASSERT_TRUE(devices) << devices.error().message;
    ASSERT_EQ(devices->size(), 2u);
    EXPECT_EQ(devices->at(0).id, "LKG-P00671");
    EXPECT_EQ(devices->at(0).hardware, "portrait");
    EXPECT_EQ(devices->at(0).calibration, kCalibration);
    EXPECT_EQ(devices->at(1).calibration, "");
    EXPECT_EQ(bridge.asked(),
              (std::vector<std::string>{"enter_orchestration", "available_output_devices", "exit_orchestration"}));
  }
}

TEST(Bridge, ServersThatAreNotThereSilentOrBrokenAreErrorsInTime) {
  std::uint16_t closed = 0;
  {
    const test::FakeBridge gone({});
    closed = gone.port();
  }
  EXPECT_EQ(read_bridge_devices(bridge_opener(closed), SteadyClock()).error().kind, ErrorKind::kUnavailable);
  const test::FakeBridge silent({}, {.silent = true});
  EXPECT_EQ(read_bridge_devices(bridge_opener(silent.port()), SteadyClock(), 100'000'000).error().kind,
            ErrorKind::kUnavailable);
  const test::FakeBridge cut(two_devices(), {.cut_short = true});
  EXPECT_EQ(read_bridge_devices(bridge_opener(cut.port()), SteadyClock()).error().kind, ErrorKind::kBadData);
}

TEST(Bridge, AnswersOfAnotherShapeAreRefused) {
  EXPECT_EQ(parse_bridge_token(R"({"payload": {"value": "abc"}})").value(), "abc");
  for (const char* text :
       {"", "[]", "{}", R"({"payload": {}})", R"({"payload": {"value": ""}})", R"({"payload": {"value": 7}})"})
    EXPECT_EQ(parse_bridge_token(text).error().kind, ErrorKind::kBadData) << text;
  EXPECT_TRUE(parse_bridge_devices(R"({"payload": {"value": {}}})")->empty());
  for (const char* text : {R"({"payload": {"value": [1]}})", R"({"payload": {"value": {"0": {}}}})",
                           R"({"payload": {"value": {"0": 1}}})"})
    EXPECT_EQ(parse_bridge_devices(text).error().kind, ErrorKind::kBadData) << text;
}

TEST(Bridge, RandomBytesInTheAnswersNeverDoMoreThanFail) {
  const std::string listed =
      R"({"payload": {"value": {"0": {"value": {"hwid": {"value": "LKG-P1"}, "calibration": {"value": "{}"}}}}}})";
  const std::string chunked =
      "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n6;x=1\r\nhello \r\n5\r\nworld\r\n0\r\n\r\n";
  std::uint32_t state = 1;
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
  const auto damaged = [&](std::string text) {
    for (std::uint32_t changes = 1 + next() % 4; changes > 0; --changes) {
      const std::size_t at = next() % text.size();
      if (next() % 3 == 0)
        text.erase(at, 1 + next() % 5);
      else
        text[at] = static_cast<char>(next());
      if (text.empty()) text.push_back('x');
    }
    return text;
  };
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto reply = parse_http_reply(damaged(chunked), i % 2 == 0);
    if (reply && *reply) {
      EXPECT_LE((*reply)->body.size(), chunked.size());
    }
    refused += !reply;
    const auto devices = parse_bridge_devices(damaged(listed));
    if (devices) {
      EXPECT_LE(devices->size(), 2u);
    }
    refused += !devices;
  }
  EXPECT_GT(refused, 5000);
}

}  // namespace
}  // namespace dubsar
