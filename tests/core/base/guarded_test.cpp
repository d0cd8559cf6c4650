#include "core/base/system/guarded.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace dubsar {
namespace {

TEST(Guarded, WhatIsThrownBecomesASentenceAndWhatIsReturnedStays) {
  const auto memory = guarded("slices", []() -> Result<int> { throw std::bad_alloc(); });
  ASSERT_FALSE(memory);
  EXPECT_EQ(memory.error().kind, ErrorKind::kTryAgain);
  EXPECT_EQ(memory.error().message, "slices: there is not enough memory for it");
  const auto mistake = guarded("slices", [] { throw std::out_of_range("no such slice"); });
  ASSERT_FALSE(mistake);
  EXPECT_EQ(mistake.error().kind, ErrorKind::kInternal);
  EXPECT_EQ(mistake.error().message, "slices: stopped by a mistake of this program: no such slice");
  EXPECT_FALSE(guarded("slices", [] { throw 7; }));
  EXPECT_EQ(guarded("slices", []() -> Result<int> { return 7; }).value(), 7);
  EXPECT_EQ(guarded("slices", []() -> Result<int> { return fail(ErrorKind::kNoInput, "gone"); }).error().message,
            "gone");
  EXPECT_TRUE(guarded("slices", [] {}));
}

}  // namespace
}  // namespace dubsar
