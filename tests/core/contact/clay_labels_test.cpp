#include "core/contact/labelled/clay_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "core/base/system/parallel.h"
#include "core/extract/labelled/point_labels.h"

namespace dubsar {
namespace {

constexpr std::int64_t kWide = 70, kHigh = 40;

/// Two slabs of clay that touch at z = 19.5, with a crumb beside them.
bool is_clay(std::int64_t x, std::int64_t y, std::int64_t z) {
  if (x >= 66) return x >= 67 && x < 69 && y >= 3 && y < 5 && z >= 3 && z < 5;
  return x > 0 && y > 0 && y < kHigh - 1 && z > 0 && z < kHigh - 1;
}

BitVolume slabs() {
  BitVolume inside(Dims{kWide, kHigh, kHigh});
  for (std::int64_t z = 0; z < kHigh; ++z)
    for (std::int64_t y = 0; y < kHigh; ++y)
      for (std::int64_t x = 0; x < kWide; ++x) inside.set(x, y, z, is_clay(x, y, z));
  return inside;
}

/// Six steps to both sides of where they touch.
ContactBand band_of(const BitVolume& inside) {
  std::vector<PatchPoint> samples;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < 66; ++x) samples.push_back({{static_cast<float>(x), static_cast<float>(y), 19.5f}, {0, 0, 1}});
  SilentProgress progress;
  return ContactBand::make(inside, std::move(samples), 6.0f, progress).value();
}

std::vector<ClaySide> sides_of(const ContactBand& band) {
  std::vector<ClaySide> side(band.nodes.size());
  for (std::uint32_t n = 0; n < side.size(); ++n)
    side[n] = band.nodes[n].z >= 20 ? ClaySide::kEnvelope : ClaySide::kTablet;
  return side;
}

TEST(ClayLabels, SpecksInTheMidstOfTheOtherClayAreThatClayAndLumpsAreNot) {
  const BitVolume inside = slabs();
  const ContactBand band = band_of(inside);
  for (const unsigned seed : {71u, 72u, 73u, 74u, 75u}) {
    std::mt19937 random(seed);
    std::vector<ClaySide> side = sides_of(band);
    const std::vector<ClaySide> plain = side;
    std::vector<ClaySide> wanted = side;
    for (int y = 2; y + 6 < kHigh; y += 7)
      for (int x = 2; x + 6 < 66; x += 7) {
        const int edge = std::array{1, 2, 3, 5}[random() % 4], z = random() % 2 == 0 ? 14 : 21;
        for (std::uint32_t n = 0; n < side.size(); ++n) {
          const glm::ivec3 at = band.point(n) - glm::ivec3(x, y, z);
          if (std::min({at.x, at.y, at.z}) < 0 || std::max({at.x, at.y, at.z}) >= edge) continue;
          side[n] = plain[n] == ClaySide::kTablet ? ClaySide::kEnvelope : ClaySide::kTablet;
          if (edge == 5) wanted[n] = side[n];
        }
      }
    for (const int threads : {1, 3}) {
      set_thread_count(threads);
      const EnvelopeBits envelope = ClayBeyond(inside, band).labels(side);
      const PointLabels labels(inside, envelope);
      for (std::uint32_t n = 0; n < side.size(); ++n) {
        const glm::ivec3 p = band.point(n);
        ASSERT_EQ(labels.get(p.x, p.y, p.z) == PointLabel::kEnvelope, wanted[n] == ClaySide::kEnvelope)
            << seed << ": " << p.x << " " << p.y << " " << p.z;
      }
    }
    set_thread_count(0);
  }
}

TEST(ClayLabels, ClayBeyondTheBandIsThatOfTheBandBesideIt) {
  const BitVolume inside = slabs();
  const ContactBand band = band_of(inside);
  const std::vector<ClaySide> side = sides_of(band);
  const EnvelopeBits envelope = ClayBeyond(inside, band).labels(side);
  const PointLabels labels(inside, envelope);
  for (std::int64_t z = -1; z <= kHigh; ++z)
    for (std::int64_t y = -1; y <= kHigh; ++y)
      for (std::int64_t x = -1; x <= kWide; ++x) {
        const bool in_grid = x >= 0 && y >= 0 && z >= 0 && x < kWide && y < kHigh && z < kHigh;
        const PointLabel wanted = !in_grid || !is_clay(x, y, z) ? PointLabel::kAir
                                  : x < 66 && z >= 20           ? PointLabel::kEnvelope
                                                                : PointLabel::kTablet;
        ASSERT_EQ(labels.get(x, y, z), wanted) << x << " " << y << " " << z;
      }
  // A second bit only where a tile holds clay of both: here none does, 20 is where tiles end.
  EXPECT_LT(envelope.bytes(), static_cast<std::size_t>(kWide * kHigh * kHigh / 32));
}

}  // namespace
}  // namespace dubsar
