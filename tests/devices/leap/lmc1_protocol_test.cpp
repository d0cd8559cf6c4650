#include "devices/leap/lmc1_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "devices/leap/hand_renderer.h"
#include "devices/leap/lmc1_calibration.h"
#include "devices/leap/lmc1_simulator.h"
#include "devices/leap/uvc_payload.h"

namespace dubsar {
namespace {

using lmc1::Calibration;

// Bytes 100 to 255 of a device made in 2013, as published by its owner.
constexpr std::array<unsigned char, 156> kRealBlob{
    0x43, 0x41, 0x00, 0x87, 0x50, 0x6a, 0x4c, 0x51, 0xdd, 0x5a, 0x20, 0x42, 0x66, 0x0c, 0x29, 0x3d, 0xbb, 0xe7,
    0x05, 0x43, 0x27, 0x9c, 0x0e, 0xbf, 0x3f, 0x9d, 0x89, 0x40, 0x15, 0x88, 0x32, 0x3a, 0xb1, 0xa2, 0x5a, 0xbb,
    0xe5, 0xd0, 0xa2, 0x3f, 0xac, 0xad, 0x98, 0x3e, 0x97, 0xff, 0x90, 0x3c, 0x5a, 0x64, 0xbb, 0x3f, 0xe9, 0xb7,
    0xaf, 0x3e, 0x9e, 0xb5, 0xdb, 0xbb, 0x58, 0x5d, 0x03, 0x43, 0x34, 0x21, 0x2a, 0x40, 0x78, 0xdf, 0x9c, 0x40,
    0x65, 0xcb, 0xb6, 0xb9, 0xc6, 0xfe, 0x73, 0xbb, 0x6e, 0xfa, 0x85, 0xbb, 0x3a, 0xee, 0x05, 0x43, 0x61, 0x9a,
    0x70, 0x3f, 0x9a, 0x84, 0xca, 0x40, 0xf6, 0x49, 0x0e, 0x3a, 0xdc, 0xac, 0x8c, 0xbb, 0xe5, 0xd0, 0xa2, 0x3f,
    0xac, 0xad, 0x98, 0x3e, 0x97, 0xff, 0x90, 0x3c, 0x5a, 0x64, 0xbb, 0x3f, 0xe9, 0xb7, 0xaf, 0x3e, 0x9e, 0xb5,
    0xdb, 0xbb, 0x58, 0x5d, 0x03, 0x43, 0x49, 0x02, 0x8a, 0x40, 0x78, 0xdf, 0x9c, 0x40, 0x1c, 0xa8, 0xa5, 0xbb,
    0xa3, 0x81, 0xcd, 0xba, 0x30, 0x98, 0x85, 0x3b, 0x7b, 0x26, 0x62, 0x9d};

std::vector<std::byte> bytes_of(std::span<const unsigned char> from) {
  std::vector<std::byte> bytes(from.size());
  std::transform(from.begin(), from.end(), bytes.begin(), [](unsigned char b) { return std::byte{b}; });
  return bytes;
}

TEST(Lmc1Calibration, TheBlobOfARealDeviceDecodesToItsOptics) {
  const auto calibration = lmc1::decode_calibration(bytes_of(kRealBlob));
  ASSERT_TRUE(calibration) << calibration.error().message;
  EXPECT_EQ(calibration->score, 135);
  EXPECT_EQ(calibration->unix_time / 86400, 15786U);  // 2013-03-22
  EXPECT_NEAR(calibration->baseline_mm, 40.089, 5e-4);
  EXPECT_NEAR(calibration->left.focal_px, 133.905, 5e-4);
  EXPECT_NEAR(calibration->right.focal_px, 133.931, 5e-4);
  EXPECT_NEAR(calibration->left.offset_x_px, -0.557, 5e-4);
  EXPECT_NEAR(calibration->right.offset_y_px, 6.329, 5e-4);
  EXPECT_NEAR(calibration->left.radial[3], 1.464, 5e-4);
  EXPECT_EQ(calibration->left.radial, calibration->right.radial);
  EXPECT_NE(calibration->left.tangential, calibration->right.tangential);
  EXPECT_NEAR(calibration->right.old_focal_px, 131.365, 5e-4);
  EXPECT_EQ(calibration->checksum, 0x9d62267bU);
  const auto again = lmc1::encode(*calibration);
  EXPECT_TRUE(std::ranges::equal(again, bytes_of(kRealBlob)));
}

TEST(Lmc1Calibration, TruncatedForeignOrInfiniteBlobsAreRefused) {
  const auto good = bytes_of(kRealBlob);
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_FALSE(lmc1::decode_calibration(std::span(good).first(length))) << length;
  auto bad = good;
  bad[0] = std::byte{'B'};
  EXPECT_THAT(lmc1::decode_calibration(bad).error().message, testing::HasSubstr("expected \"CA\""));
  bad = good;
  bad[11] = std::byte{0x7f};  // baseline of 2e38 mm
  EXPECT_THAT(lmc1::decode_calibration(bad).error().message, testing::HasSubstr("baseline"));
  bad = good;
  bad[19] = std::byte{0x7f}, bad[18] = std::byte{0x80}, bad[17] = std::byte{0}, bad[16] = std::byte{0};  // infinity
  EXPECT_THAT(lmc1::decode_calibration(bad).error().message, testing::HasSubstr("not finite"));
}

TEST(Lmc1Lens, PixelAndRayAreInversesAlsoAtTheRim) {
  const auto calibration = lmc1::decode_calibration(bytes_of(kRealBlob));
  for (const int height : {480, 240, 120})
    for (const lmc1::EyeCalibration& eye : {calibration->left, calibration->right}) {
      const lmc1::Lens lens(eye, 640, height);
      for (double x = 20; x <= 620; x += 50)
        for (double y = 0; y < height; y += 0.1 * height) {
          const auto pixel = lens.pixel_from_ray(lens.ray_from_pixel({x, y}));
          ASSERT_TRUE(pixel) << x << " " << y;
          EXPECT_NEAR(pixel->x, x, 2e-3);
          EXPECT_NEAR(pixel->y, y, 2e-3);
        }
    }
}

// leapuvc.py undistorts with R = CayleyTransform(-rotation), which cv::initUndistortRectifyMap applies to the eye's
// rays; its formula, written out for a rotation of (0, c, 0): R = [[1 - cc, 0, 2c], [0, 1 + cc, 0], [-2c, 0, 1 - cc]] /
// (1 + cc) with -c for c.
TEST(Lmc1Lens, TheEyesAreTurnedAsTheMakersSampleTurnsThem) {
  auto eye = lmc1::decode_calibration(bytes_of(kRealBlob))->left;
  eye.radial = {};
  eye.tangential = {};
  const glm::dvec2 centre(320.0 + double{eye.offset_x_px}, 240.0 + double{eye.offset_y_px});
  const double c = 0.01;
  const auto ray_with = [&](float x, float y, float z) {
    eye.cayley = {x, y, z};
    return lmc1::Lens(eye, 640, 480).ray_from_pixel(centre);
  };
  EXPECT_NEAR(ray_with(0, 0.01F, 0).x, -2.0 * c / (1.0 - c * c), 1e-8);
  EXPECT_NEAR(ray_with(0, 0.01F, 0).y, 0.0, 1e-12);
  EXPECT_NEAR(ray_with(0.01F, 0, 0).y, 2.0 * c / (1.0 - c * c), 1e-8);
  // about the axis itself a point beside it moves: z of -c, so clockwise from x to -y
  eye.cayley = {0, 0, 0.01F};
  const auto beside = lmc1::Lens(eye, 640, 480).ray_from_pixel(centre + glm::dvec2(double{eye.focal_px}, 0.0));
  EXPECT_NEAR(beside.y, -2.0 * c / (1.0 + c * c), 1e-8);
}

TEST(Lmc1Lens, SeesAbout140DegreesAndBinningHalvesTheRows) {
  const auto calibration = lmc1::decode_calibration(bytes_of(kRealBlob));
  const lmc1::Lens full(calibration->left, 640, 480), binned(calibration->left, 640, 240);
  const double half_angle = std::atan(glm::length(full.ray_from_pixel({639, 244})));
  EXPECT_NEAR(half_angle * 180 / 3.14159265, 69.0, 2.0);
  const auto a = full.ray_from_pixel({400, 300}), b = binned.ray_from_pixel({400, 150});
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_FALSE(full.pixel_from_ray({30.0, 0.0}));
}

TEST(Lmc1Protocol, ControlWritesAreTheBytesOfTheManual) {
  const auto exposure = lmc1::exposure_us(0x0123);
  EXPECT_EQ(exposure->request, (ControlRequest{0x21, 0x01, 0x0b00, 0x0200}));
  EXPECT_EQ(exposure->bytes, 2U);
  EXPECT_EQ(exposure->data[0], std::byte{0x23});
  EXPECT_EQ(exposure->data[1], std::byte{0x01});
  EXPECT_EQ(lmc1::analog_gain(63)->request, (ControlRequest{0x21, 0x01, 0x0400, 0x0500}));
  EXPECT_EQ(lmc1::gamma(true).request.value, 0x0900);
  EXPECT_EQ(lmc1::dark_frame_interval(2)->request.value, 0x0a00);
  EXPECT_EQ(lmc1::switch_on(lmc1::Switch::kLedLeft, true).data[0], std::byte{0x42});
  EXPECT_EQ(lmc1::switch_on(lmc1::Switch::kLedCentre, true).data[0], std::byte{0x43});
  EXPECT_EQ(lmc1::switch_on(lmc1::Switch::kLedRight, true).data[0], std::byte{0x44});
  EXPECT_EQ(lmc1::switch_on(lmc1::Switch::kHdr, false).data[0], std::byte{0x00});
  EXPECT_EQ(lmc1::get_current(5, 7), (ControlRequest{0xa1, 0x81, 0x0700, 0x0500}));
  EXPECT_EQ(uvc::set_current(lmc1::kStreamInterface, 0, lmc1::kCommitControl),
            (ControlRequest{0x21, 0x01, 0x0200, 0x0001}));
}

TEST(Lmc1Protocol, SettingsOutsideTheirRangeAreRefused) {
  for (const int us : {-1, 9, 65536}) EXPECT_FALSE(lmc1::exposure_us(us));
  for (const int gain : {15, 64}) EXPECT_FALSE(lmc1::analog_gain(gain));
  EXPECT_FALSE(lmc1::dark_frame_interval(0x4000));
  EXPECT_EQ(lmc1::dark_frame_interval(-1).error().kind, ErrorKind::kUsage);
}

TEST(Lmc1Protocol, TheProbeBlockHas26BytesInTheOrderOfUvc) {
  const auto bytes = lmc1::encode(lmc1::request_mode(*lmc1::find_mode(640, 240)));
  const std::array<unsigned char, 26> expected{1, 0, 1, 2, 0xac, 0x53, 0x01, 0,    0, 0,    0,    0, 0,
                                               0, 0, 0, 0, 0,    0x00, 0xb0, 0x04, 0, 0x00, 0x40, 0, 0};
  EXPECT_TRUE(std::ranges::equal(bytes, bytes_of(expected)));
  EXPECT_EQ(*lmc1::decode_stream_block(bytes), lmc1::request_mode(*lmc1::find_mode(640, 240)));
  EXPECT_FALSE(lmc1::decode_stream_block(std::span(bytes).first(25)));
}

TEST(Lmc1Protocol, EvenBytesAreTheLeftEye) {
  const std::vector<std::byte> frame{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};
  std::array<std::uint8_t, 2> left{}, right{};
  lmc1::deinterleave(frame, left, right);
  EXPECT_THAT(left, testing::ElementsAre(1, 3));
  EXPECT_THAT(right, testing::ElementsAre(2, 4));
}

TEST(Lmc1Protocol, MetadataSurvivesItsScatteredBitsAndTouchesNoOthers) {
  std::array<std::byte, 12> tail;
  tail.fill(std::byte{0xff});
  lmc1::encode_metadata({0x155, 21, 0x2a}, tail);
  const auto metadata = lmc1::decode_metadata(tail);
  EXPECT_EQ(metadata, (lmc1::FrameMetadata{0x155, 21, 0x2a}));
  for (const std::size_t i : {0U, 1U, 3U, 5U, 7U, 9U, 11U}) EXPECT_EQ(tail[i], std::byte{0xff});
  EXPECT_EQ(tail[2] & std::byte{0xf0}, std::byte{0xf0});
}

TEST(Lmc1Descriptors, LengthsAddUpAndEndpointsAreWhereTheListingHasThem) {
  const auto all = Lmc1Simulator::configuration_descriptor();
  ASSERT_EQ(all.size(), 355U);
  EXPECT_EQ(all[2] | all[3] << 8, 355);
  std::vector<int> endpoints;
  int frames = 0;
  std::size_t at = 0;
  while (at < all.size()) {
    ASSERT_GE(all[at], 2U);
    if (all[at + 1] == 5) endpoints.push_back(all[at + 2]);
    if (all[at + 1] == 36 && all[at] == 30) ++frames;
    at += all[at];
  }
  EXPECT_EQ(at, all.size());
  EXPECT_THAT(endpoints, testing::ElementsAre(0x82, 0x83));
  EXPECT_EQ(frames, 6);
}

// --- payloads ---

std::vector<std::vector<std::byte>> transfers_of(std::span<const std::byte> frame, bool id, std::size_t limit) {
  std::vector<std::vector<std::byte>> transfers;
  while (!frame.empty()) {
    std::vector<std::byte> transfer(limit);
    UvcHeader header;
    header.frame_id = id;
    header.end_of_frame = frame.size() + kUvcHeaderBytes <= limit;
    header.presentation_time = 77;
    transfer.resize(encode_uvc_transfer(header, frame, transfer));
    frame = frame.subspan(transfer.size() - kUvcHeaderBytes);
    transfers.push_back(std::move(transfer));
  }
  return transfers;
}

std::vector<std::byte> numbered(std::size_t size, int first) {
  std::vector<std::byte> frame(size);
  for (std::size_t i = 0; i < size; ++i) frame[i] = std::byte((i + static_cast<std::size_t>(first)) & 0xffU);
  return frame;
}

TEST(UvcAssembler, FramesComeBackWhole) {
  for (const std::size_t limit : {13U, 64U, 512U, 16384U}) {
    UvcAssembler assembler(1000);
    for (int n = 0; n < 5; ++n) {
      const auto frame = numbered(1000, n);
      bool done = false;
      for (const auto& transfer : transfers_of(frame, n % 2 != 0, limit)) {
        EXPECT_FALSE(done);
        done = assembler.add(transfer);
      }
      ASSERT_TRUE(done);
      EXPECT_TRUE(std::ranges::equal(assembler.frame(), frame));
    }
    EXPECT_EQ(assembler.frames(), 5U);
    EXPECT_EQ(assembler.dropped_frames(), 0U);
  }
}

TEST(UvcAssembler, AnyLostTransferDropsThatFrameAndOnlyThat) {
  const std::size_t pieces = transfers_of(numbered(1000, 0), false, 112).size();
  ASSERT_EQ(pieces, 10U);
  for (std::size_t lost = 0; lost < pieces; ++lost) {
    UvcAssembler assembler(1000);
    std::vector<int> whole;
    for (int n = 0; n < 4; ++n) {
      const auto transfers = transfers_of(numbered(1000, n), n % 2 != 0, 112);
      for (std::size_t i = 0; i < transfers.size(); ++i)
        if (!(n == 1 && i == lost) && assembler.add(transfers[i])) {
          EXPECT_TRUE(std::ranges::equal(assembler.frame(), numbered(1000, n)));
          whole.push_back(n);
        }
    }
    EXPECT_THAT(whole, testing::ElementsAre(0, 2, 3)) << "transfer " << lost;
    EXPECT_EQ(assembler.dropped_frames(), 1U);
  }
}

TEST(UvcAssembler, LongFramesAndErrorFlagsAreDropped) {
  UvcAssembler assembler(1000);
  for (const auto& transfer : transfers_of(numbered(1001, 0), false, 512)) EXPECT_FALSE(assembler.add(transfer));
  auto flagged = transfers_of(numbered(1000, 0), true, 512);
  flagged[0][1] |= std::byte{0x40};
  for (const auto& transfer : flagged) EXPECT_FALSE(assembler.add(transfer));
  EXPECT_EQ(assembler.dropped_frames(), 2U);
  bool done = false;
  for (const auto& transfer : transfers_of(numbered(1000, 5), false, 512)) done = assembler.add(transfer);
  EXPECT_TRUE(done);
}

TEST(UvcAssembler, RandomBytesNeverGiveAFrameOfAnotherLength) {
  std::mt19937 random(7);
  UvcAssembler assembler(300);
  for (int i = 0; i < 200000; ++i) {
    std::vector<std::byte> transfer(random() % 200);
    for (auto& b : transfer) b = std::byte(random() & 0xffU);
    if (!transfer.empty() && random() % 2 == 0) transfer[0] = std::byte{12};
    if (assembler.add(transfer)) {
      ASSERT_EQ(assembler.frame().size(), 300U);
    }
  }
  EXPECT_GT(assembler.bad_transfers(), 1000U);
}

}  // namespace
}  // namespace dubsar
