#include "core/image_io/jpeg_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/core/image_io/jpeg_picture.h"

namespace dubsar {
namespace {

TEST(JpegFile, PixelsAreWithinSixLevelsOfWhatWasEncoded) {
  const auto image = decode_jpeg(test_jpeg(), "test");
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, 24);
  ASSERT_EQ(image->height, 16);
  ASSERT_EQ(image->channels, 3);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 24; ++x) {
      if (x == 15 || x == 16) continue;  // colours have half the resolution
      const int left[] = {200, 60, 30}, right[] = {20, 180, 220};
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(image->at(x, y)[c], x < 16 ? left[c] : right[c], 6) << x << ' ' << y;
    }
}

TEST(JpegFile, EveryTruncationIsRefused) {
  const std::vector<std::byte> bytes = test_jpeg();
  for (std::size_t size = 0; size < bytes.size() - 2; ++size) {  // the end mark's loss is a warning as well
    const auto image = decode_jpeg(std::span(bytes).first(size), "test");
    ASSERT_FALSE(image) << size;
    ASSERT_EQ(image.error().kind, ErrorKind::kBadData);
  }
}

TEST(JpegFile, FlippedBitsGiveAPictureOrAnErrorAndNothingElse) {
  const std::vector<std::byte> bytes = test_jpeg();
  Budget budget;
  budget.max_dimension = 4096;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::vector<std::byte> damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
    if (const auto image = decode_jpeg(damaged, "test", budget)) {
      ASSERT_EQ(image->pixels.size(), static_cast<std::size_t>(image->width * image->height * 3));
    }
  }
}

}  // namespace
}  // namespace dubsar
