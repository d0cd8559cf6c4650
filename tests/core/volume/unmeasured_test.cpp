// What lies outside a field of view is found in every layout and number type, and no background is taken for it.

#include "core/volume/unmeasured.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "core/volume/measured_source.h"

namespace dubsar {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr Dims kDims{56, 48, 40};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Splitmix, twelve of them added: nearly Gauss, deviation 1.
float noise_at(std::uint64_t at) {
  double sum = -6.0;
  for (std::uint64_t k = 0; k < 12; ++k) {
    std::uint64_t z = (at * 12 + k + 1) * 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    sum += static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  return static_cast<float>(sum);
}

struct Place {
  std::int64_t x, y, z;
  double from_axis() const { return std::hypot(static_cast<double>(x) - 27.5, static_cast<double>(y) - 23.5); }
  double from_centre() const { return std::hypot(from_axis(), static_cast<double>(z) - 19.5); }
};

Volume<float> volume_of(const std::function<float(const Place&, float noise)>& value) {
  Volume<float> volume(kDims);
  for (std::int64_t z = 0; z < kDims.z; ++z)
    for (std::int64_t y = 0; y < kDims.y; ++y)
      for (std::int64_t x = 0; x < kDims.x; ++x)
        volume.at(x, y, z) = value({x, y, z}, noise_at(static_cast<std::uint64_t>((z * kDims.y + y) * kDims.x + x)));
  return volume;
}

/// A ball of clay in air.
float ball(const Place& p, float noise) { return (p.from_centre() < 12.0 ? 900.0f : 200.0f) + 40.0f * noise; }

struct Layout {
  const char* name;
  std::function<bool(const Place&)> outside;
};
const Layout kLayouts[] = {
    {"circle along z", [](const Place& p) { return p.from_axis() > 23.0; }},
    {"circle along x", [](const Place& p) { return std::hypot(double(p.y) - 23.5, double(p.z) - 19.5) > 21.0; }},
    {"sphere", [](const Place& p) { return p.from_centre() > 22.0; }},
    {"a circle for each slice", [](const Place& p) { return p.from_axis() > 18.0 + double(p.z % 7); }},
    {"corners only", [](const Place& p) { return p.from_axis() > 29.0; }},
    {"box at one end", [](const Place& p) { return p.x >= 48 || p.y >= 40 || p.z >= 34; }},
    {"slices without data", [](const Place& p) { return p.z < 4; }},
};

struct Numbers {
  const char* name;
  std::function<float(float)> stored;  ///< as it comes back from the file
};
const Numbers kNumbers[] = {
    {"float32", [](float v) { return 1e-3f * v; }},
    {"uint16", [](float v) { return std::round(v); }},
    {"uint8 with slope and intercept", [](float v) { return 0.004f * std::round(v / 8.0f) - 0.1f; }},
};

TEST(Unmeasured, EveryValueLayoutAndTypeIsFound) {
  for (const Layout& layout : kLayouts)
    for (const Numbers& numbers : kNumbers)
      for (const float pad : {0.0f, -1.0f, -1000.0f, 65535.0f, 500.0f, kNaN}) {
        const float stored = numbers.stored(pad);
        const auto volume = volume_of(
            [&](const Place& p, float noise) { return layout.outside(p) ? stored : numbers.stored(ball(p, noise)); });
        VolumeSource source(volume);
        const auto found = find_unmeasured(source, {});
        const std::string what = fmt::format("{}, {}, {}", layout.name, numbers.name, pad);
        ASSERT_TRUE(found) << what;
        if (std::isfinite(pad))
          EXPECT_THAT(found->outside, ElementsAre(stored)) << what;
        else
          EXPECT_THAT(found->outside, IsEmpty()) << what;
        EXPECT_TRUE(found->at_rim) << what;
        const float unit = numbers.stored(1001.0f) - numbers.stored(1.0f);  // of a thousand
        EXPECT_NEAR(found->fill, numbers.stored(200.0f), 0.008f * std::abs(unit)) << what;
      }
}

/// Of programs that scale slice by slice: no slice but has its own.
TEST(Unmeasured, AnotherPadInEachSliceIsFoundAndFilled) {
  const std::pair<const char*, std::function<float(std::int64_t)>> pads[] = {
      {"a ramp", [](std::int64_t z) { return -500.0f + 13.0f * static_cast<float>(z); }},
      {"noise about the air's level",
       [](std::int64_t z) { return std::round(200.0f + 30.0f * noise_at(900'000u + static_cast<std::uint64_t>(z))); }},
      {"0 and 1 in turn", [](std::int64_t z) { return static_cast<float>(z / 2 % 2); }},
  };
  for (const auto& [name, pad] : pads)
    for (const Layout& layout : {kLayouts[0], kLayouts[3], kLayouts[4]}) {
      const auto rounded = [](const Place& p, float noise) { return std::round(ball(p, noise)); };
      const auto whole = volume_of(rounded);
      const auto padded =
          volume_of([&](const Place& p, float noise) { return layout.outside(p) ? pad(p.z) : rounded(p, noise); });
      MeasuredSource source(std::make_unique<VolumeSource>(padded), {{}, {}, {}, false});
      const auto found = source.unmeasured();
      ASSERT_TRUE(found);
      EXPECT_TRUE(found->each_slice) << name << ", " << layout.name;
      EXPECT_TRUE(found->at_rim);
      EXPECT_NEAR(found->fill, 200.0f, 8.0f);
      EXPECT_THAT(describe(*found), HasSubstr("another value in each slice"));
      Volume<float> out(kDims);
      ASSERT_TRUE(source.read(0, kDims.z, out.voxels.span()));
      std::int64_t wrong = 0, same_by_chance = 0;
      for (std::int64_t z = 0; z < kDims.z; ++z)
        for (std::int64_t y = 0; y < kDims.y; ++y)
          for (std::int64_t x = 0; x < kDims.x; ++x) {
            const bool outside = layout.outside({x, y, z});
            if (!outside && out.at(x, y, z) == found->fill && whole.at(x, y, z) == pad(z))
              ++same_by_chance;  // a measurement at the end of its row that has the slice's value
            else
              wrong += out.at(x, y, z) != (outside ? found->fill : whole.at(x, y, z));
          }
      EXPECT_EQ(wrong, 0) << name << ", " << layout.name;
      EXPECT_LT(same_by_chance, 300) << name << ", " << layout.name;
    }
}

/// What a picture that was packed with a loss leaves of a padding of 0, and paddings that meet in one slice.
TEST(Unmeasured, PaddingsOfSeveralValuesAreFoundWhole) {
  struct Case {
    const char* name;
    std::function<float(const Place&, float noise)> pad;
    std::vector<float> values;
    bool bytes = false;
  };
  const auto left = [](const Place& p) { return p.x < 28; };
  const Case cases[] = {
      {"0 to 2", [](const Place&, float n) { return n < -0.4f  ? 0.0f
                                                    : n < 0.4f ? 1.0f
                                                               : 2.0f; }, {0, 1, 2}},
      {"1 is rare", [](const Place&, float n) { return n < 2.0f ? 0.0f : 1.0f; }, {0, 1}},
      {"65534 and 65535", [](const Place&, float n) { return n < 0.0f ? 65534.0f : 65535.0f; }, {65534, 65535}},
      {"0 to 2 in bytes",
       [](const Place&, float n) { return n < -0.4f  ? 0.0f
                                          : n < 0.4f ? 1.0f
                                                     : 2.0f; },
       {0, 1, 2},
       true},
      {"two that meet", [&](const Place& p, float) { return left(p) ? 0.0f : 60000.0f; }, {0, 60000}},
      {"two that meet in bytes", [&](const Place& p, float) { return left(p) ? 0.0f : 255.0f; }, {0, 255}, true},
      {"a frame of two", [](const Place& p, float) { return p.y < 4 || p.y >= 44 ? 0.0f : 3.0f; }, {0, 3}},
  };
  for (const Case& c : cases) {
    const auto outside = [&](const Place& p) {
      return std::string(c.name) == "a frame of two" ? p.y < 4 || p.y >= 44 || p.x < 5 || p.x >= 51
                                                     : p.from_axis() > 23.0;
    };
    const auto measured = [&](const Place& p, float n) {
      return std::round(c.bytes ? ball(p, n) / 8.0f + 20.0f : 10.0f * ball(p, n));
    };
    const Volume<float> padded =
        volume_of([&](const Place& p, float n) { return outside(p) ? c.pad(p, n) : measured(p, n); });
    VolumeSource source(padded);
    const auto found = find_unmeasured(source, {});
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->outside, c.values) << c.name;
    EXPECT_TRUE(found->at_rim) << c.name;
  }
  const Volume<float> uneven = volume_of([&](const Place& p, float n) {
    return p.from_axis() > 23.0 ? std::round(1.0f + std::clamp(n, -1.0f, 1.0f)) : std::round(10.0f * ball(p, n));
  });
  VolumeSource source(uneven);
  EXPECT_THAT(describe(*find_unmeasured(source, {})), HasSubstr("outside the field of view (0 to 2)"));
}

TEST(Unmeasured, WhatIsOutsideCountsAsAirAndTheRestIsAsItWas) {
  for (const Layout& layout : kLayouts)
    for (const float pad : {-1.0f, kNaN}) {
      const auto whole = volume_of(ball);
      auto padded = std::make_unique<Volume<float>>(
          volume_of([&](const Place& p, float noise) { return layout.outside(p) ? pad : ball(p, noise); }));
      MeasuredSource source(std::make_unique<VolumeSource>(*padded), {});
      Volume<float> out(kDims);
      ASSERT_TRUE(source.read(0, kDims.z, out.voxels.span()));
      const float fill = source.unmeasured().value().fill;
      std::int64_t outside = 0, wrong = 0;
      for (std::int64_t z = 0; z < kDims.z; ++z)
        for (std::int64_t y = 0; y < kDims.y; ++y)
          for (std::int64_t x = 0; x < kDims.x; ++x) {
            const bool is_outside = layout.outside({x, y, z});
            outside += is_outside;
            wrong += out.at(x, y, z) != (is_outside ? fill : whole.at(x, y, z));
          }
      EXPECT_EQ(wrong, 0) << layout.name;
      EXPECT_EQ(source.counts().all(), outside) << layout.name;
      EXPECT_EQ(source.counts().nonfinite, std::isfinite(pad) ? 0 : outside) << layout.name;
    }
}

TEST(Unmeasured, TrueBackgroundsAreLeftAlone) {
  const auto skirt = [](const Place& p, float) {  // blurred without noise: exactly 0 where the blur ends
    return static_cast<float>(std::clamp(15.0 - p.from_centre(), 0.0, 4.0) * 200.0);
  };
  const std::pair<const char*, std::function<float(const Place&, float)>> cases[] = {
      {"noise everywhere", ball},
      {"air clipped at 0", [](const Place& p, float n) { return std::max(0.0f, ball(p, n) - 200.0f); }},
      {"a ball without noise", [](const Place& p, float) { return p.from_centre() < 12.0 ? 900.0f : 0.0f; }},
      {"a ball without noise that fills the grid",
       [](const Place& p, float) { return p.from_centre() < 24.0 ? 9.f : 0.f; }},
      {"a blurred ball without noise", skirt},
      {"a hollow ball without noise",
       [](const Place& p, float) { return p.from_centre() < 18.0 && p.from_centre() > 9.0 ? 900.0f : 0.0f; }},
      {"a masked ball of noisy clay",
       [](const Place& p, float n) { return p.from_centre() < 18.0 ? 900.0f + 40.0f * n : 0.0f; }},
      {"a masked shell of clay around noisy air",
       [](const Place& p, float n) {
         return p.from_centre() >= 19.0 ? 0.0f : (p.from_centre() > 12.0 ? 900.0f : 200.0f) + 40.0f * n;
       }},
      {"a noisy slab between slices of 0",
       [](const Place& p, float n) { return p.z < 6 || p.z > 33 ? 0.f : 900.f + 40.f * n; }},
      {"two values", [](const Place& p, float) { return p.x < 20 ? 0.0f : 1.0f; }},
      {"one value", [](const Place&, float) { return 7.0f; }},
  };
  for (const auto& [name, value] : cases) {
    const auto volume = volume_of(value);
    VolumeSource source(volume);
    const auto found = find_unmeasured(source, {});
    ASSERT_TRUE(found) << name;
    EXPECT_THAT(found->outside, IsEmpty()) << name;
    EXPECT_FALSE(found->left_out().has_value()) << name;
  }
}

/// A ramp along z, so that a slice is what lies half way between those beside it.
TEST(Unmeasured, UpToThreeSlicesWithoutAMeasurementAreBridged) {
  const auto tower = [](const Place& p, float noise) {
    return (p.from_axis() < 12.0 ? 900.0f : 200.0f) + 4.0f * static_cast<float>(p.z) +
           40.0f * noise_at(static_cast<std::uint64_t>(p.y * kDims.x + p.x)) + 0.0f * noise;
  };
  const auto whole = volume_of(tower);
  for (const float blank : {0.0f, kNaN, 5000.0f})
    for (const std::int64_t count : {1, 3, 4}) {
      const auto volume =
          volume_of([&](const Place& p, float n) { return p.z >= 20 && p.z < 20 + count ? blank : tower(p, n); });
      for (const std::int64_t height : {1, 2, 7, 40}) {
        MeasuredSource source(std::make_unique<VolumeSource>(volume), {});
        Volume<float> out(kDims);
        for (std::int64_t z = 0; z < kDims.z; z += height) {
          const std::int64_t end = std::min(kDims.z, z + height);
          ASSERT_TRUE(source.read(z, end, out.voxels.span().subspan(static_cast<std::size_t>(z * kDims.slice()))));
        }
        double most = 0.0;
        for (std::size_t at = 0; at < out.voxels.span().size(); ++at)
          most = std::max(most, std::abs(double(out.voxels.span()[at]) - double(whole.voxels.span()[at])));
        if (count <= 3) {
          EXPECT_LT(most, 1e-3) << blank << ", " << count << " slices, " << height << " at a time";
          EXPECT_EQ(source.bridged().size(), static_cast<std::size_t>(count));
          EXPECT_THAT(describe_bridged(source.bridged()), HasSubstr("20"));
        } else {
          EXPECT_GT(most, 100.0);
          EXPECT_THAT(source.bridged(), IsEmpty());
        }
      }
    }
}

TEST(Unmeasured, AirWithoutNoiseIsNotBridged) {
  const auto volume = volume_of([](const Place& p, float) {
    const bool body = p.from_axis() < 12.0 && (p.z < 20 || p.z > 21);
    return body && p.z > 4 && p.z < 35 ? 900.0f : 0.0f;
  });
  MeasuredSource source(std::make_unique<VolumeSource>(volume), {});
  Volume<float> out(kDims);
  ASSERT_TRUE(source.read(0, kDims.z, out.voxels.span()));
  EXPECT_THAT(source.bridged(), IsEmpty());
  EXPECT_TRUE(std::equal(volume.voxels.span().begin(), volume.voxels.span().end(), out.voxels.span().begin()));
}

TEST(Unmeasured, ValuesThatAreGivenAreIgnoredEverywhereAndNoneIsLookedFor) {
  const auto volume = volume_of([](const Place& p, float n) {
    if (p.from_axis() > 23.0) return 0.0f;
    return p.x == 27 && p.y == 23 ? -7.0f : std::round(ball(p, n));
  });
  const auto read = [&](const std::vector<std::string>& texts) {
    MeasuredSource source(std::make_unique<VolumeSource>(volume), {parse_ignored(texts).value(), {}, {}, false});
    Volume<float> out(kDims);
    EXPECT_TRUE(source.read(0, kDims.z, out.voxels.span()));
    return out;
  };
  const Volume<float> given = read({"-7"}), both = read({"0", "-7"}), none = read({"none"}), found = read({});
  EXPECT_EQ(given.at(0, 0, 0), 0.0f);
  EXPECT_NE(given.at(27, 23, 5), -7.0f);
  EXPECT_NEAR(both.at(0, 0, 0), 200.0f, 8.0f);
  EXPECT_EQ(both.at(27, 23, 5), both.at(0, 0, 0));
  EXPECT_TRUE(std::equal(volume.voxels.span().begin(), volume.voxels.span().end(), none.voxels.span().begin()));
  EXPECT_NEAR(found.at(0, 0, 0), 200.0f, 8.0f);
  EXPECT_EQ(found.at(27, 23, 5), -7.0f);
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"air"}, {"nan"}, {"3 4"}, {"none", "0"}}) {
    const auto refused = parse_ignored(wrong);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("expected"));
  }
}

TEST(Unmeasured, BinarySumsLeaveTheFillAsItIs) {
  for (const float value : {0.0f, 109.0f, -1000.0f, 65535.0f, 1e-3f, 1.2345678e30f}) {
    const float fill = fill_value(value);
    EXPECT_NEAR(fill, value, std::abs(value) * 0x1p-17f + 1e-20f);
    EXPECT_TRUE(std::abs(value) > 1e5f || fill != std::round(fill)) << "integers of 16 bits have it";
    float sum = 0.0f;
    for (int k = 0; k < 64; ++k) sum += fill / 64.0f;
    EXPECT_EQ(sum, fill);
    EXPECT_EQ(fill_value(fill), fill);
  }
}

}  // namespace
}  // namespace dubsar
