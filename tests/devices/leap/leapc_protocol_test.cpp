#include "devices/leap/leapc_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include "devices/leap/leapc_clock.h"
#include "fake_hand.h"

namespace dubsar::leapc {
namespace {

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

FakeHand numbered_hand() {
  FakeHand hand = flat_fake_hand(77, true, 12.0F, 210.0F, -34.0F, 0.25F);
  hand.visible_time = 5'000'000'000;
  hand.pinch_strength = 0.75F;
  float value = 1.0F;
  for (FakeDigit& digit : hand.digits)
    for (FakeBone* bone : {&digit.metacarpal, &digit.proximal, &digit.intermediate, &digit.distal}) {
      bone->prev_joint = {value, value + 0.25F, value + 0.5F};
      bone->next_joint = {-value, -value - 0.25F, -value - 0.5F};
      bone->width = value + 0.75F;
      bone->rotation = {0.5F, -0.5F, 0.5F, -0.5F};
      value += 1.0F;
    }
  return hand;
}

TEST(LeapcProtocol, EveryFieldOfAHandIsReadFromItsPlace) {
  const FakeHand fake = numbered_hand();
  const auto hand = decode_hand(bytes_of(fake));
  ASSERT_TRUE(hand) << hand.error().message;
  EXPECT_EQ(hand->id, 77U);
  EXPECT_EQ(hand->side, Side::kRight);
  EXPECT_EQ(hand->visible_us, 5'000'000'000U);
  EXPECT_EQ(hand->pinch_strength, 0.75);
  EXPECT_EQ(hand->grab_strength, 0.25);
  EXPECT_EQ(hand->palm_mm, glm::dvec3(12, 210, -34));
  EXPECT_EQ(hand->velocity_mmps, glm::dvec3(100, 0, -50));
  EXPECT_EQ(hand->normal, glm::dvec3(0, -1, 0));
  EXPECT_EQ(hand->direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(hand->palm_width_mm, 84.0);
  double value = 1.0;
  for (const auto& digit : hand->digits)
    for (const Bone& bone : digit) {
      EXPECT_EQ(bone.base_mm, glm::dvec3(value, value + 0.25, value + 0.5));
      EXPECT_EQ(bone.end_mm, glm::dvec3(-value, -value - 0.25, -value - 0.5));
      EXPECT_EQ(bone.width_mm, value + 0.75);
      EXPECT_EQ(bone.rotation, glm::dquat(-0.5, 0.5, -0.5, 0.5));  // w first here, last in the library
      value += 1.0;
    }
  EXPECT_EQ(hand->arm.end_mm, glm::dvec3(12, 210, 16));
  EXPECT_EQ(hand->arm.width_mm, 60.0);
}

TEST(LeapcProtocol, HandsSurviveEncodingAndDecoding) {
  const auto hand = decode_hand(bytes_of(numbered_hand()));
  const auto bytes = encode(*hand);
  const auto again = decode_hand(bytes);
  ASSERT_TRUE(again);
  EXPECT_EQ(encode(*again), bytes);
  EXPECT_EQ(again->digits[4][3].width_mm, hand->digits[4][3].width_mm);
  FakeHand left = flat_fake_hand(1, false, 0, 200, 0);
  EXPECT_EQ(decode_hand(encode(*decode_hand(bytes_of(left))))->side, Side::kLeft);
  left.type = 9;
  EXPECT_EQ(decode_hand(bytes_of(left))->side, Side::kUnknown);
}

TEST(LeapcProtocol, EveryTruncationIsRefused) {
  const FakeHand fake = numbered_hand();
  for (std::size_t length = 0; length < kHandBytes; ++length)
    EXPECT_FALSE(decode_hand(bytes_of(fake).first(length))) << length;
}

TEST(LeapcProtocol, FlippedBitsNeverGiveHandsThatAreInfiniteOrFarAway) {
  const FakeHand fake = numbered_hand();
  std::array<std::byte, kHandBytes> bytes{};
  std::memcpy(bytes.data(), &fake, sizeof fake);
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * kHandBytes; ++bit) {
    bytes[bit / 8] ^= std::byte(1U << bit % 8);
    const auto hand = decode_hand(bytes);
    bytes[bit / 8] ^= std::byte(1U << bit % 8);
    if (!hand) {
      ++refused;
      continue;
    }
    for (const auto& digit : hand->digits)
      for (const Bone& bone : digit) {
        EXPECT_LE(glm::length(bone.base_mm), 1.8e4);
        EXPECT_LE(glm::length(bone.end_mm), 1.8e4);
        EXPECT_TRUE(std::isfinite(bone.rotation.x + bone.rotation.w + bone.width_mm));
      }
  }
  EXPECT_GT(refused, 130);  // the top exponent bit of 126 coordinates of 1 mm and more, and others
}

TEST(LeapcProtocol, NumbersThatAreNotFiniteAreRefusedWhereverTheyStand) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    FakeHand hand = numbered_hand();
    hand.digits[3].intermediate.rotation.z = bad;
    EXPECT_THAT(decode_hand(bytes_of(hand)).error().message, testing::HasSubstr("not finite"));
    hand = numbered_hand();
    hand.grab_strength = bad;
    EXPECT_FALSE(decode_hand(bytes_of(hand)));
  }
  FakeHand hand = numbered_hand();
  hand.digits[0].distal.next_joint.y = 10'001.0F;
  EXPECT_THAT(decode_hand(bytes_of(hand)).error().message, testing::HasSubstr("10 m"));
}

TEST(LeapcProtocol, FramesWithImpossibleHandsOrTimesAreRefused) {
  const auto decode = [](const FakeTrackingEvent& event) {
    return decode_tracking(bytes_of(event).first<kTrackingBytes>());
  };
  FakeHand hand{};
  const FakeTrackingEvent good{nullptr, 41, 123'456'789, 40, 2, &hand, 114.5F};
  const auto tracking = decode(good);
  ASSERT_TRUE(tracking);
  EXPECT_EQ(tracking->frame, 41);
  EXPECT_EQ(tracking->time_us, 123'456'789);
  EXPECT_EQ(tracking->hands, 2U);
  EXPECT_EQ(tracking->hands_at, reinterpret_cast<std::uintptr_t>(&hand));
  EXPECT_EQ(tracking->frames_per_s, 114.5);
  FakeTrackingEvent bad = good;
  bad.hand_count = kMostHands + 1;
  EXPECT_FALSE(decode(bad));
  bad = good;
  bad.hands = nullptr;
  EXPECT_FALSE(decode(bad));
  bad = good;
  bad.timestamp = std::numeric_limits<std::int64_t>::min();
  EXPECT_FALSE(decode(bad));
}

TEST(LeapcProtocol, MessagesAndDevicesAreReadFromTheirPlaces) {
  const int event = 0;
  const FakeMessage fake{20, 0x107, &event, 5};
  const Message message = decode_message(bytes_of(fake).first<kMessageBytes>());
  EXPECT_EQ(message.type, Event::kDeviceStatus);
  EXPECT_EQ(message.event, reinterpret_cast<std::uintptr_t>(&event));
  EXPECT_EQ(message.device, 5U);
  EXPECT_EQ(decode_device(bytes_of(FakeDeviceEvent{1, nullptr, 7, 0xe8010001}).first<kDeviceBytes>()).id, 7U);
  EXPECT_EQ(decode_device_status(bytes_of(FakeDeviceStatusEvent{nullptr, 8, 1, 2}).first<kDeviceBytes>()).id, 8U);
  EXPECT_EQ(decode_device_status(bytes_of(FakeDeviceStatusEvent{nullptr, 8, 1, 2}).first<kDeviceBytes>()).status, 2U);
  EXPECT_THAT(device_trouble(0xe8010003), testing::HasSubstr("cable"));
  EXPECT_THAT(device_trouble(2), testing::HasSubstr("paused"));
  EXPECT_EQ(device_trouble(1), "");
}

TEST(LeapcClock, TheTightestOfTheLastSamplesDecides) {
  ClockMap map;
  map.add(1'000'000, 500, 3'000'000);  // +-1 ms: offset 1.5 ms
  EXPECT_EQ(map.ours(500), 2'000'000);
  map.add(5'000'000, 4'000, 5'000'200);  // +-100 ns: offset 1.0001 ms
  EXPECT_EQ(map.ours(4'000), 5'000'100);
  map.add(9'000'000, 9'000, 10'000'000);  // wider again
  EXPECT_EQ(map.ours(4'000), 5'000'100);
  for (std::size_t i = 0; i < ClockMap::kSamples; ++i)
    map.add(20'000'000, 10'000, 20'001'000);  // the old ones are forgotten
  EXPECT_EQ(map.ours(10'000), 20'000'500);
}

}  // namespace
}  // namespace dubsar::leapc
