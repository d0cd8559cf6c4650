#include "core/image_io/srgb_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <string>

namespace dubsar {
namespace {

std::uint32_t big(std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < bytes; ++k) value = value << 8 | std::to_integer<std::uint32_t>(srgb_profile()[at + k]);
  return value;
}
std::string letters(std::size_t at) {
  std::string text;
  for (std::size_t k = 0; k < 4; ++k) text.push_back(static_cast<char>(srgb_profile()[at + k]));
  return text;
}
/// Offset of each tag's data (ICC.1:2001-04, 6.2).
std::map<std::string, std::size_t> tags() {
  std::map<std::string, std::size_t> found;
  for (std::uint32_t k = 0; k < big(128, 4); ++k) found[letters(132 + 12 * k)] = big(136 + 12 * k, 4);
  return found;
}
glm::dvec3 xyz(const std::string& name) {
  const std::size_t at = tags().at(name) + 8;
  return glm::dvec3(big(at, 4), big(at + 4, 4), big(at + 8, 4)) / 65536.0;
}

TEST(SrgbProfile, HasTheHeadAndTheTagsOfADisplayProfile) {
  EXPECT_EQ(big(0, 4), srgb_profile().size());
  EXPECT_EQ(letters(12) + letters(16) + letters(20), "mntrRGB XYZ ");
  EXPECT_EQ(letters(36), "acsp");
  for (const char* name : {"desc", "cprt", "wtpt", "rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC"}) {
    ASSERT_TRUE(tags().contains(name)) << name;
    EXPECT_EQ(tags().at(name) % 4, 0u) << name;
  }
  for (std::uint32_t k = 0; k < big(128, 4); ++k) EXPECT_LE(big(136 + 12 * k, 4) + big(140 + 12 * k, 4), big(0, 4));
}

// From the chromaticities of IEC 61966-2-1 and Bradford's cone responses, not from anybody's profile.
TEST(SrgbProfile, ItsPrimariesAreThoseOfSrgbUnderD50) {
  const auto white_of = [](double x, double y) { return glm::dvec3(x / y, 1.0, (1.0 - x - y) / y); };
  const glm::dmat3 primaries(white_of(0.64, 0.33), white_of(0.30, 0.60), white_of(0.15, 0.06));
  const glm::dvec3 d65 = white_of(0.3127, 0.3290), d50(0.9642, 1.0, 0.8249);
  const glm::dvec3 scale = glm::inverse(primaries) * d65;
  const glm::dmat3 rgb(primaries[0] * scale[0], primaries[1] * scale[1], primaries[2] * scale[2]);
  const glm::dmat3 cones =
      glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const glm::dvec3 gain = (cones * d50) / (cones * d65);
  const glm::dmat3 adapt = glm::inverse(cones) * glm::dmat3(gain[0], 0, 0, 0, gain[1], 0, 0, 0, gain[2]) * cones;
  const char* names[] = {"rXYZ", "gXYZ", "bXYZ"};
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(xyz(names[k])[axis], (adapt * rgb[k])[axis], 5e-4) << names[k];
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(xyz("wtpt")[axis], d50[axis], 1e-4);
}

TEST(SrgbProfile, ItsCurveIsTheStandardsWithinAQuarterOfAnEightBitStep) {
  const std::size_t at = tags().at("gTRC");
  EXPECT_EQ(letters(at), "curv");
  const double points = big(at + 8, 4);
  for (int v = 0; v < 256; ++v) {
    const double place = v / 255.0 * (points - 1), whole = std::min(std::floor(place), points - 2);
    const auto value = [&](double k) { return big(at + 12 + 2 * static_cast<std::size_t>(k), 2) / 65535.0; };
    const double light = value(whole) + (place - whole) * (value(whole + 1) - value(whole));
    const double coded = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    EXPECT_NEAR(255.0 * coded, v, 0.25);
  }
}

}  // namespace
}  // namespace dubsar
