#include "core/image_io/picture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/image_io/srgb_profile.h"
#include "tests/core/image_io/tiff_fixture.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;

/// Smooth and coloured, as pictures of tablets are; with transparency where there are four channels.
Image picture(int width, int height, int channels) {
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double wave = std::sin(x * 0.11) * std::cos(y * 0.07);
      std::uint8_t* const pixel = image.at(x, y);
      pixel[0] = static_cast<std::uint8_t>(120 + 90 * wave);
      pixel[1] = static_cast<std::uint8_t>(110 + 80 * wave);
      pixel[2] = static_cast<std::uint8_t>(200 - 150 * x / width);
      if (channels == 4) pixel[3] = static_cast<std::uint8_t>(x * 255 / (width - 1));
    }
  return image;
}

std::string profile_bytes() {
  std::string bytes;
  for (const std::byte b : srgb_profile()) bytes.push_back(static_cast<char>(b));
  return bytes;
}

/// Entries of the first directory of a little-endian TIFF: tag to {count, value or offset}.
std::map<int, std::pair<std::uint32_t, std::uint32_t>> tiff_entries(const std::string& file) {
  const auto number = [&](std::size_t at, int bytes) {
    std::uint32_t value = 0;
    for (int k = bytes - 1; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(file.at(at + k));
    return value;
  };
  std::map<int, std::pair<std::uint32_t, std::uint32_t>> entries;
  const std::size_t at = number(4, 4);
  for (std::size_t k = 0; k < number(at, 2); ++k) {
    const std::size_t entry = at + 2 + 12 * k;
    entries[static_cast<int>(number(entry, 2))] = {number(entry + 4, 4), number(entry + 8, 4)};
  }
  return entries;
}

class PictureFiles : public testing_tools::TempFolder {};

TEST_F(PictureFiles, WhatIsWrittenWithoutLossIsReadBackByItsContent) {
  for (const char* name : {"a.png", "a.tif", "A.TIFF"})
    for (const int channels : {3, 4}) {
      const Image image = picture(150, 131, channels);
      ASSERT_TRUE(write_picture(in(name), image, {.dpi = 300}));
      std::filesystem::rename(in(name), in("nameless"));
      const auto back = read_picture(in("nameless"));
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->channels, channels);
      EXPECT_EQ(back->pixels, image.pixels) << name;
    }
}

TEST_F(PictureFiles, JpegKeepsThePictureItsColoursItsScaleAndItsWords) {
  const Image image = picture(203, 97, 3);
  ASSERT_TRUE(write_picture(in("a.jpg"), image, {.dpi = 600, .xmp = "<x:xmpmeta/>"}));
  const auto back = read_picture(in("a.jpg"));
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->pixels.size(), image.pixels.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double difference = double(back->pixels[i]) - image.pixels[i];
    squares += difference * difference;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(image.pixels.size())), 2.0);
  const std::string bytes = bytes_of(in("a.jpg"));
  EXPECT_EQ(bytes.substr(6, 5), std::string("JFIF\0", 5));
  EXPECT_EQ(bytes.substr(13, 5), std::string("\1\x02\x58\x02\x58", 5)) << "600 dots an inch";
  EXPECT_THAT(bytes, HasSubstr(profile_bytes()));
  EXPECT_THAT(bytes, HasSubstr(std::string("http://ns.adobe.com/xap/1.0/\0<x:xmpmeta/>", 41)));
  ASSERT_TRUE(write_picture(in("b.jpeg"), image, {.dpi = 600, .xmp = "<x:xmpmeta/>"}));
  EXPECT_EQ(bytes_of(in("b.jpeg")), bytes);
}

TEST_F(PictureFiles, TiffHasTheProfileAndPngTheChunkThatSayTheColoursAreSrgb) {
  ASSERT_TRUE(write_picture(in("a.tif"), picture(40, 30, 3), {.dpi = 600}));
  const std::string tiff = bytes_of(in("a.tif"));
  const auto [count, offset] = tiff_entries(tiff).at(34675);
  EXPECT_EQ(tiff.substr(offset, count), profile_bytes());
  ASSERT_TRUE(write_picture(in("a.png"), picture(40, 30, 3)));
  EXPECT_THAT(bytes_of(in("a.png")), HasSubstr("sRGB"));
}

TEST_F(PictureFiles, PngCarriesAnXmpPacketAsAdobeSaysItDoes) {
  const std::string packet =
      "<x:xmpmeta>Mus\xc3\xa9"
      "e</x:xmpmeta>";
  ASSERT_TRUE(write_picture(in("a.png"), picture(40, 30, 3), {.dpi = 600, .xmp = packet}));
  // Key, end of it, not compressed, method 0, no language, no translated key, text (XMP specification part 3, 1.1.5).
  EXPECT_THAT(bytes_of(in("a.png")), HasSubstr(std::string("iTXtXML:com.adobe.xmp\0\0\0\0\0", 26) + packet));
  EXPECT_EQ(read_picture(in("a.png")).value().pixels, picture(40, 30, 3).pixels);
}

TEST_F(PictureFiles, TransparencyIsNotLostInAJpegUnseen) {
  const auto refused = write_picture(in("a.jpg"), picture(20, 10, 4));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(refused.error().message, HasSubstr("PNG or TIFF"));
  Image opaque = picture(20, 10, 4);
  for (std::size_t i = 3; i < opaque.pixels.size(); i += 4) opaque.pixels[i] = 255;
  EXPECT_TRUE(write_picture(in("a.jpg"), opaque));
}

TEST_F(PictureFiles, WhatIsNoPictureIsRefusedWithASentence) {
  EXPECT_EQ(write_picture(in("a.bmp"), picture(4, 4, 3)).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(write_picture(in("a.png"), Image()).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(write_picture(in("a.tif"), Image()).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(write_picture(in("no/a.jpg"), picture(4, 4, 3)).error().kind, ErrorKind::kCannotCreate);
  EXPECT_EQ(read_picture(in("none.png")).error().kind, ErrorKind::kNoInput);
  write_bytes(in("words.png"), "no picture at all");
  EXPECT_EQ(read_picture(in("words.png")).error().kind, ErrorKind::kBadData);
  write_bytes(in("empty.jpg"), "");
  EXPECT_EQ(read_picture(in("empty.jpg")).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(read_picture(folder()).error().kind, ErrorKind::kBadData);
}

TEST_F(PictureFiles, OtherPeoplesTiffsAreShownAsTheyMeanThem) {
  testing_tools::TiffFixture grey{.width = 2, .height = 2, .bits = 8, .big_endian = true};
  write_bytes(in("grey.tif"), grey.bytes({{0, 100, 200, 255}}));
  const auto shown = read_picture(in("grey.tif"));
  ASSERT_TRUE(shown) << shown.error().message;
  EXPECT_EQ(shown->pixels, (std::vector<std::uint8_t>{0, 0, 0, 100, 100, 100, 200, 200, 200, 255, 255, 255}));
  testing_tools::TiffFixture inverse{.width = 2, .height = 1, .bits = 8, .photometric = 0};
  write_bytes(in("inverse.tif"), inverse.bytes({{0, 255}}));
  EXPECT_EQ(read_picture(in("inverse.tif"))->pixels, (std::vector<std::uint8_t>{255, 255, 255, 0, 0, 0}));
}

// Of a TIFF, what is cut off may be only the words and the profile, which libtiff puts last.
TEST_F(PictureFiles, NoTruncationGivesAnotherPicture) {
  for (const char* name : {"a.png", "a.jpg", "a.tif"}) {
    ASSERT_TRUE(write_picture(in(name), picture(33, 21, 3)));
    const std::string bytes = bytes_of(in(name));
    const Image whole = *read_picture(in(name));
    for (std::size_t length = 0; length + 2 < bytes.size(); length += length < 200 ? 1 : 37) {
      write_bytes(in("cut"), bytes.substr(0, length));
      const auto cut = read_picture(in("cut"));
      if (cut) {
        EXPECT_EQ(std::string(name), "a.tif") << length;
        EXPECT_EQ(cut->pixels, whole.pixels) << name << " cut to " << length;
        continue;
      }
      EXPECT_EQ(cut.error().kind, ErrorKind::kBadData) << cut.error().message;
    }
  }
}

TEST_F(PictureFiles, FlippedBitsOfATiffGiveAPictureOrAnErrorAndNothingElse) {
  ASSERT_TRUE(write_picture(in("a.tif"), picture(9, 7, 4)));
  const std::string bytes = bytes_of(in("a.tif"));
  Budget budget;
  budget.max_dimension = 4096;
  budget.memory_bytes = 64 << 20;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    if (bit / 8 > 700 && bit / 8 + 400 < bytes.size()) continue;  // the profile's curve
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write_bytes(in("flipped.tif"), flipped);
    if (const auto image = read_picture(in("flipped.tif"), budget)) {
      EXPECT_EQ(image->pixels.size(), static_cast<std::size_t>(image->width) * image->height * image->channels);
    }
  }
}

}  // namespace
}  // namespace dubsar
