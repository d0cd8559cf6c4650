// PNG: what is written is read back; foreign kinds of PNG; damaged files.

#include "core/image_io/png_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/base/files/atomic_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

// Made with a few lines of Python zlib and struct.
// 2 x 1, 16-bit grey 0x8000, 0xffff.
constexpr auto kGrey16 = std::to_array<std::uint8_t>(
    {137, 80, 78, 71, 13, 10,  26,  10,  0,   0,   0, 13, 73, 72, 68, 82, 0,  0,   0,   2,  0,   0,  0,   1,
     16,  0,  0,  0,  0,  129, 217, 252, 21,  0,   0, 0,  13, 73, 68, 65, 84, 120, 218, 99, 104, 96, 248, 255,
     31,  0,  5,  2,  2,  127, 201, 0,   214, 117, 0, 0,  0,  0,  73, 69, 78, 68,  174, 66, 96,  130});
// 3 x 1, 2-bit palette indices 0 1 2; entry 1 has alpha 128.
constexpr auto kPalette = std::to_array<std::uint8_t>(
    {137, 80, 78,  71,  13,  10,  26, 10,  0,   0,   0,   13,  73, 72,  68,  82, 0,   0,  0,  3,  0,
     0,   0,  1,   2,   3,   0,   0,  0,   102, 142, 252, 39,  0,  0,   0,   9,  80,  76, 84, 69, 255,
     0,   0,  0,   255, 0,   0,   0,  255, 45,  74,  205, 138, 0,  0,   0,   2,  116, 82, 78, 83, 255,
     128, 8,  15,  179, 106, 0,   0,  0,   10,  73,  68,  65,  84, 120, 218, 99, 144, 0,  0,  0,  26,
     0,   25, 128, 0,   142, 187, 0,  0,   0,   0,   73,  69,  78, 68,  174, 66, 96,  130});
// 3 x 3 RGB, Adam7; pixel = (10 x, 20 y, 7).
constexpr auto kInterlaced = std::to_array<std::uint8_t>(
    {137, 80, 78,  71, 13,  10,  26,  10,  0,   0,   0,  13,  73, 72,  68, 82,  0,   0,   0,   3,   0,   0,   0,   3,
     8,   2,  0,   0,  1,   174, 77,  18,  126, 0,   0,  0,   36, 73,  68, 65,  84,  120, 218, 13,  198, 177, 13,  0,
     0,   12, 131, 48, 182, 72,  153, 57,  162, 255, 95, 216, 12, 200, 0,  193, 197, 197, 11,  221, 118, 98,  106, 52,
     15,  19, 14,  1,  78,  188, 32,  204, 231, 0,   0,  0,   0,  73,  69, 78,  68,  174, 66,  96,  130});
// Announces 60000 x 60000 RGB, carries 100 bytes.
constexpr auto kHuge = std::to_array<std::uint8_t>(
    {137, 80, 78, 71, 13,  10, 26, 10,  0,   0,   0,   13, 73, 72, 68, 82, 0,  0,  234, 96,  0,  0,  234,
     96,  8,  2,  0,  0,   0,  15, 176, 226, 21,  0,   0,  0,  12, 73, 68, 65, 84, 120, 218, 99, 96, 160,
     61,  0,  0,  0,  100, 0,  1,  184, 153, 239, 153, 0,  0,  0,  0,  73, 69, 78, 68,  174, 66, 96, 130});

class PngFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("dubsar_png_{}", ::getpid());
    fs::create_directories(folder_);
    path_ = folder_ / "a.png";
  }
  void TearDown() override { fs::remove_all(folder_); }
  Result<Image> read_bytes(std::span<const std::uint8_t> bytes, const Budget& budget = {}) {
    EXPECT_TRUE(write_file_atomically(path_, std::as_bytes(bytes)));
    return read_png(path_, budget);
  }
  std::vector<std::uint8_t> file_bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  fs::path folder_, path_;
};

Image noise(int width, int height, int channels) {
  Image image(width, height, channels);
  std::uint32_t state = 1;
  for (auto& value : image.pixels) value = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  return image;
}

TEST_F(PngFile, ReadsBackWhatWasWritten) {
  for (const int channels : {3, 4})
    for (const int width : {1, 2, 7, 64}) {
      const Image image = noise(width, 5, channels);
      ASSERT_TRUE(write_png(path_, image));
      const auto back = read_png(path_);
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->width, width);
      EXPECT_EQ(back->height, 5);
      EXPECT_EQ(back->channels, channels);
      EXPECT_EQ(back->pixels, image.pixels);
    }
}

TEST_F(PngFile, ResolutionIsWrittenInPixelsPerMetre) {
  ASSERT_TRUE(write_png(path_, noise(2, 2, 3), {.dpi = 600}));
  const auto bytes = file_bytes();
  const std::string text(bytes.begin(), bytes.end());
  const std::string phys("pHYs\x00\x00\x5c\x46\x00\x00\x5c\x46\x01", 13);  // 600 / 0.0254 = 23622
  EXPECT_NE(text.find(phys), std::string::npos);
}

TEST_F(PngFile, SixteenBitGreyBecomesRgb) {
  const auto image = read_bytes(kGrey16);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->channels, 3);
  EXPECT_EQ(image->pixels, (std::vector<std::uint8_t>{128, 128, 128, 255, 255, 255}));
}

TEST_F(PngFile, PaletteWithTransparencyBecomesRgba) {
  const auto image = read_bytes(kPalette);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->channels, 4);
  EXPECT_EQ(image->pixels, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 255}));
}

TEST_F(PngFile, InterlacedPixelsAreInPlace) {
  const auto image = read_bytes(kInterlaced);
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width * image->height * image->channels, 27);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      EXPECT_EQ(image->at(x, y)[0], 10 * x);
      EXPECT_EQ(image->at(x, y)[1], 20 * y);
      EXPECT_EQ(image->at(x, y)[2], 7);
    }
}

TEST_F(PngFile, EveryTruncationIsRefused) {
  ASSERT_TRUE(write_png(path_, noise(9, 9, 4)));
  const auto whole = file_bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto image = read_bytes(std::span(whole).first(size));
    ASSERT_FALSE(image) << size << " of " << whole.size() << " bytes were accepted";
    EXPECT_EQ(image.error().kind, ErrorKind::kBadData);
  }
}

TEST_F(PngFile, BitFlipsAreRefusedOrHarmless) {
  ASSERT_TRUE(write_png(path_, noise(5, 5, 3)));
  const auto whole = file_bytes();
  for (std::size_t byte = 0; byte < whole.size(); ++byte)
    for (int bit = 0; bit < 8; bit += 3) {
      auto bytes = whole;
      bytes[byte] = static_cast<std::uint8_t>(bytes[byte] ^ (1u << bit));
      const auto image = read_bytes(bytes);
      EXPECT_TRUE(!image || image->pixels.size() == 75u) << "byte " << byte << " bit " << bit;
    }
}

TEST_F(PngFile, SizesThatTheFileCannotHoldAreRefusedBeforeMemoryIsTaken) {
  auto image = read_bytes(kHuge);
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().kind, ErrorKind::kBadData);
  EXPECT_NE(image.error().message.find("60000 x 60000"), std::string::npos) << image.error().message;
  image = read_bytes(kInterlaced, {.max_dimension = 2});
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().kind, ErrorKind::kBadData);
  image = read_bytes(kInterlaced, {.memory_bytes = 20});
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().kind, ErrorKind::kTryAgain);
}

TEST_F(PngFile, WrongInputsGetTheRightKindOfError) {
  EXPECT_EQ(read_png(folder_ / "none.png").error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(read_png(folder_).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(write_png(path_, Image()).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(write_png(folder_ / "none" / "a.png", noise(2, 2, 3)).error().kind, ErrorKind::kCannotCreate);
}

}  // namespace
}  // namespace dubsar
