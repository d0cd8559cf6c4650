// JPEG files that know which way up they are, that are pairs, or that hold further pictures.

#include "core/image_io/jpeg_markers.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "core/base/files/atomic_file.h"
#include "core/image_io/jpeg_file.h"
#include "core/image_io/picture_file.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

/// Four quarters of other colours: red, green / blue, white.
Image quarters(int width, int height) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool right = 2 * x >= width, below = 2 * y >= height;
      image.at(x, y)[0] = (!right && !below) || (right && below) ? 250 : 5;
      image.at(x, y)[1] = right ? 250 : 5;
      image.at(x, y)[2] = below ? 250 : 5;
    }
  return image;
}

/// 'r', 'g', 'b' or 'w' of a corner's quarter.
char colour(const Image& image, bool right, bool below) {
  const std::uint8_t* p = image.at(image.width * (right ? 3 : 1) / 4, image.height * (below ? 3 : 1) / 4);
  return p[0] > 128 ? (p[1] > 128 ? 'w' : 'r') : p[1] > 128 ? 'g' : 'b';
}
std::string corners(const Image& image) {
  return {colour(image, false, false), colour(image, true, false), colour(image, false, true),
          colour(image, true, true)};
}

std::string number(std::uint32_t value, int bytes, bool big) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> 8 * (big ? bytes - 1 - i : i));
  return out;
}

std::string marker(unsigned char kind, const std::string& body) {
  return std::string("\xff") + static_cast<char>(kind) + number(static_cast<std::uint32_t>(body.size() + 2), 2, true) +
         body;
}

std::string exif(int orientation, bool big) {
  const std::string end = number(0, 2, big);
  return marker(0xE1, std::string("Exif\0\0", 6) + (big ? "MM" : "II") + number(42, 2, big) + number(8, 4, big) +
                          number(2, 2, big) + number(256, 2, big) + number(4, 2, big) + number(1, 4, big) +
                          number(7, 4, big) + number(274, 2, big) + number(3, 2, big) + number(1, 4, big) +
                          number(static_cast<std::uint32_t>(orientation), 2, big) + end + number(0, 4, big));
}

std::string with_markers(const std::string& jpeg, const std::string& markers) {
  return jpeg.substr(0, 2) + markers + jpeg.substr(2);
}

class JpegMarkersTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path put(const std::string& name, const std::string& bytes) {
    EXPECT_TRUE(write_file_atomically(folder_ / name, bytes));
    return folder_ / name;
  }
  fs::path folder_ = fs::temp_directory_path() / ("dubsar_markers_" + std::to_string(::getpid()));
};

TEST_F(JpegMarkersTest, PicturesAreReadUprightWhateverTheOrientation) {
  // What is seen of red, green / blue, white, by EXIF's table of the 0th row and column.
  const std::array<std::string, 9> seen{"rgbw", "rgbw", "grwb", "wbgr", "bwrg", "rbgw", "brwg", "wgbr", "gwrb"};
  const std::string plain = encode_jpeg(quarters(48, 32)).value();
  for (int orientation = 0; orientation <= 8; ++orientation)
    for (const bool big : {false, true}) {
      const auto image = read_picture(put("o.jpg", with_markers(plain, exif(orientation, big))));
      ASSERT_TRUE(image) << image.error().message;
      EXPECT_EQ(corners(*image), seen[static_cast<std::size_t>(orientation)]) << orientation;
      EXPECT_EQ(image->width, orientation >= 5 ? 32 : 48) << orientation;
    }
}

TEST_F(JpegMarkersTest, MultiPictureFilesGiveTheirViews) {
  const std::string left = encode_jpeg(quarters(48, 32)).value(),
                    right = with_markers(encode_jpeg(quarters(48, 32)).value(), exif(3, false)),
                    small = encode_jpeg(quarters(16, 16)).value();
  const auto made = [&](const std::string& second, std::uint32_t kind, bool big) {
    const std::uint32_t entries = 8 + 2 + 12 + 4, body = 4 + entries + 32;
    const std::uint32_t first_bytes = static_cast<std::uint32_t>(left.size()) + 4 + body;
    std::string mp = std::string("MPF\0", 4) + (big ? "MM" : "II") + number(42, 2, big) + number(8, 4, big) +
                     number(1, 2, big) + number(0xB002, 2, big) + number(7, 2, big) + number(32, 4, big) +
                     number(entries, 4, big) + number(0, 4, big);
    mp += number(kind, 4, big) + number(first_bytes, 4, big) + number(0, 4, big) + number(0, 4, big);
    mp += number(kind, 4, big) + number(static_cast<std::uint32_t>(second.size()), 4, big) +
          number(first_bytes - 2 - 4 - 4, 4, big) + number(0, 4, big);
    return with_markers(left, marker(0xE2, mp)) + second;
  };
  int others = 0;
  for (const bool big : {false, true}) {
    const auto views = read_jpeg_views(put("pair.jpg", made(right, 0x020002, big)), others);
    ASSERT_TRUE(views) << views.error().message;
    ASSERT_EQ(views->size(), 2u);
    EXPECT_EQ(others, 0);
    EXPECT_EQ(corners((*views)[0]), "rgbw");
    EXPECT_EQ(corners((*views)[1]), "wbgr") << "each upright by its own orientation";
  }
  EXPECT_EQ(read_jpeg_views(put("photo.MPO", made(right, 0, false)), others)->size(), 2u);
  // What telephones add, a smaller one, is no view.
  EXPECT_TRUE(read_jpeg_views(put("phone.jpg", made(small, 0, false)), others)->empty());
  EXPECT_EQ(others, 1);
  EXPECT_TRUE(read_jpeg_views(put("one.jpg", left), others)->empty());
  EXPECT_EQ(others, 0);
  const std::string whole = made(right, 0x020002, false);
  for (std::size_t n = 0; n < whole.size(); n += 13) {  // damaged or cut: no crash, a picture or a sentence
    read_jpeg_markers(std::as_bytes(std::span(whole.data(), n)));
    std::string bad = whole;
    bad[n] = static_cast<char>(bad[n] ^ 0x55);
    read_jpeg_markers(std::as_bytes(std::span(bad.data(), bad.size())));
  }
}

TEST_F(JpegMarkersTest, StereoscopicDescriptorsAreRead) {
  const auto pair = [](std::uint8_t layout, std::uint8_t flags) {
    const std::string body =
        "_JPSJPS_" + number(4, 2, true) + '\0' + static_cast<char>(flags) + static_cast<char>(layout) + '\x01';
    const std::string jpeg = std::string("\xff\xd8") + marker(0xE3, body) + "\xff\xd9";
    return read_jpeg_markers(std::as_bytes(std::span(jpeg.data(), jpeg.size()))).pair;
  };
  ASSERT_TRUE(pair(2, 0));
  EXPECT_TRUE(pair(2, 0)->right_first && !pair(2, 0)->half && !pair(2, 0)->top_bottom);
  EXPECT_TRUE(pair(3, 5)->top_bottom && pair(3, 5)->half && !pair(3, 5)->right_first);
  EXPECT_FALSE(pair(4, 0)) << "an anaglyph is one picture";
}

}  // namespace
}  // namespace dubsar
