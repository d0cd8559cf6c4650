#include "core/hdf5/chunk_filters.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace dubsar {
namespace {

std::vector<std::byte> bytes(const std::string& text) {
  std::vector<std::byte> out;
  for (const char c : text) out.push_back(static_cast<std::byte>(c));
  return out;
}

TEST(ChunkFilters, LzfFollowsItsFormat) {
  // "abc", then 6 bytes from 3 back, then 11 bytes from 1 back (long form), then "z"
  const auto packed =
      bytes(std::string("\x02"
                        "abc"
                        "\x80\x02"
                        "\xe0\x02\x00"
                        "\x00z",
                        11));
  std::vector<std::byte> out(64);
  const auto size = lzf_decode(packed, out);
  ASSERT_TRUE(size);
  out.resize(*size);
  EXPECT_EQ(out, bytes("abcabcabc" + std::string(11, 'c') + "z"));
}

TEST(ChunkFilters, LzfNeverWritesOutsideAndNeverReadsBefore) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<std::byte> packed(random() % 40), out(random() % 50);
    for (auto& byte : packed) byte = static_cast<std::byte>(random());
    if (const auto size = lzf_decode(packed, out)) {
      EXPECT_LE(*size, out.size());
    }
  }
  std::vector<std::byte> out(8);
  EXPECT_FALSE(lzf_decode(bytes("\x20\x05"), out)) << "a reference before the beginning";
  EXPECT_FALSE(lzf_decode(bytes("\x05"
                                "ab"),
                          out))
      << "a literal run cut short";
  EXPECT_FALSE(lzf_decode(bytes("\xe0"), out)) << "a length cut short";
  EXPECT_EQ(lzf_decode({}, out), 0u);
}

TEST(ChunkFilters, Fletcher32IsTheSumOfBigEndianWords) {
  // sums 0x6162 + 0x6364 = 0xc4c6 and 0x6162 + 0xc4c6 = 0x12628, in ones' complement 0x2629
  EXPECT_EQ(hdf5_fletcher32(bytes("abcd")), 0x2629c4c6U);
  EXPECT_EQ(hdf5_fletcher32({}), 0u);
}

TEST(ChunkFilters, WrongLengthsAreDamage) {
  ChunkScratch scratch;
  const std::vector<int> none;
  scratch.packed.resize(10);
  EXPECT_TRUE(undo_filters(none, 0, 4, 10, scratch));
  EXPECT_FALSE(undo_filters(none, 0, 4, 12, scratch));
  const std::vector<int> deflate{1};
  EXPECT_FALSE(undo_filters(deflate, 0, 4, 10, scratch)) << "zeros are no zlib stream";
  EXPECT_TRUE(undo_filters(deflate, 1, 4, 10, scratch)) << "this chunk was stored without it";
}

}  // namespace
}  // namespace dubsar
