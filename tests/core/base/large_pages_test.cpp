#include "core/base/system/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace dubsar {
namespace {

TEST(LargePages, AnArrayHasItsSizeAndItsZerosWhateverThatIs) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{5000}, std::size_t{3} << 20}) {
    const auto items = large_array<std::vector<int>>(size);
    EXPECT_EQ(items.size(), size);
    EXPECT_EQ(std::accumulate(items.begin(), items.end(), 0), 0);
  }
}

TEST(LargePages, AreAWishThatAnyMemoryMayGet) {
  std::vector<char> items(std::size_t{9} << 20, 'a');
  ask_for_large_pages(nullptr, 0);
  ask_for_large_pages(items.data() + 1, 100);
  ask_for_large_pages(items.data() + 1, items.size() - 1);
  EXPECT_EQ(std::count(items.begin(), items.end(), 'a'), std::ptrdiff_t{9} << 20) << "what was there stays";
}

}  // namespace
}  // namespace dubsar
