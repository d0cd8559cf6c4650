// Reading a Looking Glass's calibration through its HID pages.

#include <gtest/gtest.h>

#include "devices/looking_glass/looking_glass_sim.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {

/// Advances at every look, so that waiting comes to an end without waiting.
class TickingClock final : public Clock {
 public:
  TimestampNs now() const noexcept override { return now_ += 1'000'000; }

 private:
  mutable TimestampNs now_ = 0;
};

std::string text_of(std::size_t bytes) {
  std::string text = "{\"serial\":\"";
  while (text.size() + 2 < bytes) text += static_cast<char>('a' + text.size() % 26);
  return text + "\"}";
}

TEST(LookingGlass, GoldenRequestAndReply) {
  EXPECT_EQ(to_hex(looking_glass_request(0x0102)).substr(0, 12), "000001020000");
  auto reply = from_hex("80 00 0003 41");
  reply.resize(68);
  const auto page = parse_looking_glass(reply);
  ASSERT_TRUE(page);
  EXPECT_EQ(page->buttons, 0x80);
  EXPECT_EQ(page->number, 3);
  EXPECT_EQ(page->data[0], std::byte{0x41});
  EXPECT_EQ(to_hex(format_looking_glass(*page)), to_hex(reply));
  for (std::size_t length = 0; length < 68; ++length) EXPECT_FALSE(parse_looking_glass(std::span(reply).first(length)));
  reply[1] = std::byte{1};
  EXPECT_FALSE(parse_looking_glass(reply));
}

TEST(LookingGlass, TheTextComesWholeWhateverTheManners) {
  for (const std::size_t bytes :
       {std::size_t{30}, std::size_t{60}, std::size_t{61}, std::size_t{124}, std::size_t{700}})
    for (const bool split : {true, false})
      for (const int stale : {0, 1, 20})
        for (const int ignored : {0, bytes == 124 && stale == 1 ? 2 : 0}) {
          LookingGlassSim sim(text_of(bytes), {split, stale, ignored, false});
          auto transport = sim.device().open().value();
          const TickingClock clock;
          const auto json = read_looking_glass_calibration(*transport, clock, TimestampNs{60'000'000'000});
          ASSERT_TRUE(json) << json.error().message;
          EXPECT_EQ(*json, text_of(bytes));
        }
}

TEST(LookingGlass, BlankMemoryAndHugeLengthsAreRefused) {
  const TickingClock clock;
  LookingGlassSim blank("{}", {true, 0, 0, true});
  EXPECT_EQ(read_looking_glass_calibration(*blank.device().open().value(), clock).error().kind, ErrorKind::kBadData);
  LookingGlassSim huge(std::string(20000, 'x'), {});
  EXPECT_EQ(read_looking_glass_calibration(*huge.device().open().value(), clock).error().kind, ErrorKind::kBadData);
}

TEST(LookingGlass, SilenceAndUnpluggingEndTheReading) {
  const TickingClock clock;
  LookingGlassSim sim("{}", {true, 0, 1 << 30, false});
  auto transport = sim.device().open().value();
  EXPECT_EQ(read_looking_glass_calibration(*transport, clock, 6'000'000).error().kind, ErrorKind::kUnavailable);
  sim.device().unplug();
  EXPECT_EQ(read_looking_glass_calibration(*transport, clock).error().kind, ErrorKind::kUnavailable);
}

}  // namespace
}  // namespace dubsar
