#include "core/exa/chunks.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <zlib.h>

#include <random>
#include <string>

namespace dubsar {
namespace {

TEST(ExaSums, AreZlibsForAnyLengthAnyPlaceAndAnyVectorUnit) {
  std::mt19937 generator(3);
  const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
  std::string bytes(5000, ' ');
  for (char& c : bytes) c = static_cast<char>(random());
  const auto expect_zlibs = [&](std::size_t from, std::size_t size, std::uint32_t before, const char* unit) {
    const std::string_view part = std::string_view(bytes).substr(from, size);
    EXPECT_EQ(crc32_of(part, before), ::crc32(before, reinterpret_cast<const Bytef*>(part.data()), uInt(part.size())))
        << size << " bytes from " << from << ' ' << unit;
  };
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (std::size_t size = 0; size < 700; ++size)
      expect_zlibs(size % 17, size, size % 2 ? 0u : random(), hwy::TargetName(target));
    for (int i = 0; i < 200; ++i) expect_zlibs(random() % 1000, random() % 4000, random(), hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace
}  // namespace dubsar
