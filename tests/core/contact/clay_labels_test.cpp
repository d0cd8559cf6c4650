#include "core/contact/labelled/clay_labels.h"

#include <gtest/gtest.h>

#include "core/extract/labelled/point_labels.h"

namespace dubsar {
namespace {

constexpr std::int64_t kWide = 70, kHigh = 40;

/// Two slabs of clay that touch at z = 19.5, with a crumb beside them.
bool is_clay(std::int64_t x, std::int64_t y, std::int64_t z) {
  if (x >= 66) return x >= 67 && x < 69 && y >= 3 && y < 5 && z >= 3 && z < 5;
  return x > 0 && y > 0 && y < kHigh - 1 && z > 0 && z < kHigh - 1;
}

TEST(ClayLabels, ClayBeyondTheBandIsThatOfTheBandBesideIt) {
  BitVolume inside(Dims{kWide, kHigh, kHigh});
  for (std::int64_t z = 0; z < kHigh; ++z)
    for (std::int64_t y = 0; y < kHigh; ++y)
      for (std::int64_t x = 0; x < kWide; ++x) inside.set(x, y, z, is_clay(x, y, z));
  std::vector<PatchPoint> samples;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < 66; ++x) samples.push_back({{static_cast<float>(x), static_cast<float>(y), 19.5f}, {0, 0, 1}});
  SilentProgress progress;
  const ContactBand band = ContactBand::make(inside, std::move(samples), 6.0f, progress).value();
  std::vector<ClaySide> side(band.nodes.size());
  for (std::uint32_t n = 0; n < side.size(); ++n)
    side[n] = band.nodes[n].z >= 20 ? ClaySide::kEnvelope : ClaySide::kTablet;
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
