// Text that shows whether it was changed.

#include "core/base/files/sealed_text.h"

#include <gtest/gtest.h>

namespace dubsar {
namespace {

TEST(SealedText, AnyChangedAddedOrMissingByteShows) {
  const std::string text = sealed_text("id,side," + std::string(kUnsealed) + "\n1,obverse,\n2,reverse,\n");
  ASSERT_TRUE(is_sealed_text(text));
  EXPECT_EQ(text.find(kUnsealed), std::string::npos);
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string changed = text, shorter = text, longer = text;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(is_sealed_text(changed)) << i;
    EXPECT_FALSE(is_sealed_text(shorter.erase(i, 1))) << i;
    EXPECT_FALSE(is_sealed_text(longer.insert(i, " "))) << i;
  }
}

TEST(SealedText, WithoutASealNothingIsSealed) {
  EXPECT_EQ(sealed_text("id,side\n"), "id,side\n");
  EXPECT_FALSE(is_sealed_text("id,side\n"));
  EXPECT_FALSE(is_sealed_text(std::string(kUnsealed)));
  EXPECT_FALSE(is_sealed_text("sum_of all"));
  EXPECT_TRUE(is_sealed_text(sealed_text("a sum_of all " + std::string(kUnsealed))));
}

}  // namespace
}  // namespace dubsar
