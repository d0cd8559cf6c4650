#include "core/image_io/tiff_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/core/image_io/tiff_fixture.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {

class TiffFiles : public testing_tools::TempFolder {};

TEST_F(TiffFiles, GrayPagesOfBothByteOrdersAndBigTiffAreRead) {
  for (const bool big_endian : {false, true})
    for (const bool big_tiff : {false, true}) {
      testing_tools::TiffFixture fixture{
          .width = 3, .height = 2, .bits = 16, .big_endian = big_endian, .big_tiff = big_tiff};
      fixture.x_pixels = 500;
      fixture.unit = 3;
      fixture.description = "a long description";
      write_bytes(in("a.tif"), fixture.bytes({{1, 2, 3, 4, 5, 65535}, {7, 8, 9, 10, 11, 12}}));
      auto file = TiffFile::open(in("a.tif"));
      ASSERT_TRUE(file) << file.error().message;
      const auto pages = file->pages();
      ASSERT_TRUE(pages) << pages.error().message;
      ASSERT_EQ(pages->size(), 2u);
      const TiffPage& page = pages->front();
      EXPECT_EQ(page.width, 3);
      EXPECT_EQ(page.height, 2);
      EXPECT_EQ(page.bits, 16);
      EXPECT_EQ(page.resolution.x_per_unit, 500.0);
      EXPECT_EQ(page.resolution.unit_mm, 10.0);
      EXPECT_EQ(page.texts.description, "a long description");
      EXPECT_EQ(page.big_endian, big_endian);
      std::vector<std::uint16_t> out(6);
      ASSERT_TRUE(file->select(page.offset));
      ASSERT_TRUE(file->read_gray(std::as_writable_bytes(std::span(out))));
      EXPECT_EQ(out, (std::vector<std::uint16_t>{1, 2, 3, 4, 5, 65535}));
      ASSERT_TRUE(file->select((*pages)[1].offset));
      ASSERT_TRUE(file->read_gray(std::as_writable_bytes(std::span(out))));
      EXPECT_EQ(out.back(), 12);
    }
}

TEST_F(TiffFiles, WhiteIsZeroPagesAreInverted) {
  testing_tools::TiffFixture fixture{.width = 2, .height = 1, .bits = 8, .photometric = 0};
  write_bytes(in("a.tif"), fixture.bytes({{0, 200}}));
  auto file = TiffFile::open(in("a.tif"));
  ASSERT_TRUE(file && file->select(0));
  std::vector<std::uint8_t> out(2);
  ASSERT_TRUE(file->read_gray(std::as_writable_bytes(std::span(out))));
  EXPECT_EQ(out, (std::vector<std::uint8_t>{255, 55}));
}

TEST_F(TiffFiles, EveryTruncationIsRefusedOrReadWhole) {
  testing_tools::TiffFixture fixture{.width = 5, .height = 4, .bits = 8};
  const std::string bytes = fixture.bytes({std::vector<std::uint64_t>(20, 9), std::vector<std::uint64_t>(20, 9)});
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_bytes(in("a.tif"), bytes.substr(0, length));
    auto file = TiffFile::open(in("a.tif"));
    if (!file) continue;
    const auto pages = file->pages();
    if (!pages) {
      EXPECT_EQ(pages.error().kind, ErrorKind::kBadData);
      continue;
    }
    for (const TiffPage& page : *pages) {
      std::vector<std::uint8_t> out(20);
      if (page.width != 5 || page.height != 4 || page.bits != 8 || page.channels != 1) continue;
      if (file->select(page.offset) && file->read_gray(std::as_writable_bytes(std::span(out)))) {
        EXPECT_EQ(out, std::vector<std::uint8_t>(20, 9)) << length;
      }
    }
  }
}

TEST_F(TiffFiles, BitFlipsNeverCrash) {
  testing_tools::TiffFixture fixture{.width = 5, .height = 4, .bits = 8};
  fixture.x_pixels = 72;
  const std::string bytes = fixture.bytes({std::vector<std::uint64_t>(20, 9)});
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write_bytes(in("a.tif"), flipped);
    auto file = TiffFile::open(in("a.tif"));
    if (!file) continue;
    const auto pages = file->pages();
    if (!pages) continue;
    const TiffPage& page = pages->front();
    if (page.channels != 1 || page.bits % 8 != 0 || page.bits == 0 || page.width * page.height > 1 << 20) continue;
    std::vector<std::byte> out(static_cast<std::size_t>(page.width * page.height * page.bits / 8));
    if (file->select(page.offset)) static_cast<void>(file->read_gray(out));
  }
}

TEST_F(TiffFiles, APictureIsWrittenWithItsResolution) {
  for (const int channels : {3, 4}) {
    Image image(150, 131, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<std::uint8_t>(i * 7 + i / 450);
    const Image before = image;
    ASSERT_TRUE(write_tiff(in("a.tif"), image, 600.0));
    ASSERT_TRUE(write_tiff(in("b.tif"), image, 600.0));
    EXPECT_EQ(image.pixels, before.pixels);
    EXPECT_EQ(bytes_of(in("a.tif")), bytes_of(in("b.tif")));
    auto file = TiffFile::open(in("a.tif"));
    ASSERT_TRUE(file);
    const auto page = file->select(0);
    ASSERT_TRUE(page);
    EXPECT_EQ(page->width, 150);
    EXPECT_EQ(page->height, 131);
    EXPECT_EQ(page->channels, channels);
    EXPECT_EQ(page->resolution.x_per_unit, 600.0);
    EXPECT_EQ(page->resolution.unit_mm, 25.4);
    EXPECT_EQ(page->compression, "LZW");
  }
  EXPECT_EQ(write_tiff(in("no/folder.tif"), Image(2, 2, 3), 72.0).error().kind, ErrorKind::kCannotCreate);
}

TEST_F(TiffFiles, LayersArePagesWithNamesAndTheFirstIsThePicture) {
  const auto colour = [](int k) {
    Image image(90, 70, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<std::uint8_t>(i * 3 + 50 * k);
    return image;
  };
  const std::vector<std::string> names{"phong", "raking", "sky-sun-ao"};
  const auto layer = [&](int k) -> Result<TiffLayer> {
    return TiffLayer{colour(k), names[static_cast<std::size_t>(k)]};
  };
  ASSERT_TRUE(write_tiff_layers(in("layers.tif"), 3, layer, 600.0, {"AO 8295", "CC BY 4.0", "<xmp/>"}));
  auto file = TiffFile::open(in("layers.tif"));
  ASSERT_TRUE(file);
  const auto pages = file->pages();
  ASSERT_TRUE(pages);
  ASSERT_EQ(pages->size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const TiffPage& page = (*pages)[static_cast<std::size_t>(k)];
    EXPECT_EQ(page.texts.name, names[static_cast<std::size_t>(k)]);
    EXPECT_EQ(page.resolution.x_per_unit, 600.0);
    ASSERT_TRUE(file->select(page.offset));
    EXPECT_EQ(file->read_picture({}).value().pixels, colour(k).pixels) << k;
  }
  EXPECT_EQ(pages->front().texts.description, "AO 8295");
  EXPECT_EQ(read_tiff_picture(in("layers.tif")).value().pixels, colour(0).pixels);
  const auto fails = [](int k) -> Result<TiffLayer> {
    if (k == 1) return fail(ErrorKind::kCancelled, "stopped");
    return TiffLayer{Image(4, 4, 3), "one"};
  };
  EXPECT_EQ(write_tiff_layers(in("half.tif"), 2, fails, 0.0).error().kind, ErrorKind::kCancelled);
  EXPECT_FALSE(std::filesystem::exists(in("half.tif")));
}

}  // namespace
}  // namespace dubsar
