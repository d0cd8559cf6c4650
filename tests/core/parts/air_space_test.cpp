#include "core/parts/air_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace dubsar {
namespace {

BitVolume make_bits(const Dims& dims, const std::function<bool(std::int64_t, std::int64_t, std::int64_t)>& set) {
  BitVolume bits(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) bits.set(x, y, z, set(x, y, z));
  return bits;
}

bool random_bit(std::mt19937& random, unsigned per_mille) { return random() % 1000 < per_mille; }

TEST(AirSpace, DilationIsTheMaximumOverTheCube) {
  std::mt19937 random(3);
  const Dims dims{131, 9, 11};
  const BitVolume in = make_bits(dims, [&](auto, auto, auto) { return random_bit(random, 4); });
  for (const int r : {0, 1, 3}) {
    const BitVolume expected = make_bits(dims, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      for (std::int64_t k = std::max<std::int64_t>(z - r, 0); k <= std::min(z + r, dims.z - 1); ++k)
        for (std::int64_t j = std::max<std::int64_t>(y - r, 0); j <= std::min(y + r, dims.y - 1); ++j)
          for (std::int64_t i = std::max<std::int64_t>(x - r, 0); i <= std::min(x + r, dims.x - 1); ++i)
            if (in.get(i, j, k)) return true;
      return false;
    });
    EXPECT_TRUE(dilate(in, r) == expected) << r;
  }
}

TEST(AirSpace, FloodAndComponentsAgreeWithBreadthFirstSearch) {
  std::mt19937 random(5);
  const Dims dims{70, 20, 18};
  const BitVolume solid = make_bits(dims, [&](auto, auto, auto) { return random_bit(random, 700); });
  const auto index = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>((z * dims.y + y) * dims.x + x);
  };
  std::vector<int> component(static_cast<std::size_t>(dims.count()), -1);
  std::vector<bool> at_border;
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) {
        if (solid.get(x, y, z) || component[index(x, y, z)] >= 0) continue;
        const int id = static_cast<int>(at_border.size());
        at_border.push_back(false);
        std::vector<std::array<std::int64_t, 3>> queue{{x, y, z}};
        component[index(x, y, z)] = id;
        while (!queue.empty()) {
          const auto p = queue.back();
          queue.pop_back();
          for (int side = 0; side < 6; ++side) {
            auto q = p;
            const auto axis = static_cast<std::size_t>(side / 2);
            q[axis] += side % 2 == 0 ? 1 : -1;
            if (q[axis] < 0 || q[axis] >= std::array{dims.x, dims.y, dims.z}[axis]) {
              at_border[static_cast<std::size_t>(id)] = true;
              continue;
            }
            if (solid.get(q[0], q[1], q[2]) || component[index(q[0], q[1], q[2])] >= 0) continue;
            component[index(q[0], q[1], q[2])] = id;
            queue.push_back(q);
          }
        }
      }
  const BitVolume exterior = flood_from_border(solid);
  const EnclosedAir enclosed(solid, exterior);
  std::vector<std::uint32_t> matched(at_border.size(), EnclosedAir::kNone);
  std::uint32_t inner = 0;
  for (const bool border : at_border) inner += border ? 0 : 1;
  EXPECT_EQ(enclosed.count(), inner);
  EXPECT_GT(inner, 100u);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x) {
        const int id = component[index(x, y, z)];
        const bool outside = id >= 0 && at_border[static_cast<std::size_t>(id)];
        ASSERT_EQ(exterior.get(x, y, z), outside);
        if (id < 0 || outside) {
          ASSERT_EQ(enclosed.at(x, y, z), EnclosedAir::kNone);
          continue;
        }
        std::uint32_t& match = matched[static_cast<std::size_t>(id)];
        if (match == EnclosedAir::kNone) match = enclosed.at(x, y, z);
        ASSERT_EQ(enclosed.at(x, y, z), match);
      }
}

/// A box with a cavity that a slit of the given width joins to the outside.
BitVolume slit_box(int width) {
  return make_bits({60, 60, 60}, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto within = [&](std::int64_t lo, std::int64_t hi) {
      return std::min({x, y, z}) >= lo && std::max({x, y, z}) <= hi;
    };
    const bool slit = x >= 30 - width / 2 && x < 30 - width / 2 + width && z > 40 && y >= 20 && y <= 40;
    return within(6, 53) && !within(18, 41) && !slit;
  });
}

TEST(AirSpace, TheSmallestRadiusThatClosesTheCrackIsFound) {
  SilentProgress progress;
  for (const auto& [width, radius] : {std::pair{0, 0}, {1, 1}, {2, 1}, {3, 2}, {7, 4}, {15, 8}}) {
    const auto exterior = find_exterior(slit_box(width), 8, progress);
    ASSERT_TRUE(exterior.has_value());
    EXPECT_EQ(exterior->crack_radius, radius) << "slit of " << width;
    EXPECT_FALSE(exterior->air.get(24, 24, 24));
    EXPECT_TRUE(exterior->air.get(2, 30, 30));
    EXPECT_TRUE(exterior->air.get(30, 30, 57));
  }
  EXPECT_TRUE(find_exterior(slit_box(19), 8, progress)->air.get(24, 24, 24));  // too wide: all is outside
}

/// Every radius, closed and grown back point by point.
TEST(AirSpace, TheExteriorIsThatOfTrialsOfAllRadii) {
  std::mt19937 random(71);
  constexpr int kLargest = 4, kMargin = kLargest + 2;
  int broken = 0;
  for (int round = 0; round < 12; ++round) {
    const auto slits = static_cast<std::int64_t>(random() % 4);
    std::array<std::int64_t, 4> at{}, width{};
    for (std::size_t i = 0; i < 4; ++i) {
      at[i] = 8 + static_cast<std::int64_t>(random() % 20);
      width[i] = 1 + static_cast<std::int64_t>(random() % 7);
    }
    const BitVolume inside = make_bits({40, 38, 36}, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      const bool box = std::min({x, y, z}) >= 3 && x < 37 && y < 35 && z < 33;
      const bool hollow = std::min({x, y, z}) >= 8 && x < 32 && y < 30 && z < 28;
      bool slit = false;
      for (std::int64_t i = 0; i < slits; ++i) {
        const auto n = static_cast<std::size_t>(i);
        slit = slit || (z > 20 && x >= at[n] && x < at[n] + width[n] && y > 8 && y < 30);
      }
      return box && !hollow && !slit && !random_bit(random, 1);
    });
    const BitVolume padded = pad(inside, kMargin);
    std::vector<BitVolume> air;
    std::vector<std::int64_t> faces;
    for (int r = 0; r <= kLargest; ++r) {
      BitVolume out = flood_from_border(dilate(padded, r));
      for (int step = 0; r > 0 && step <= r; ++step) {
        out = dilate(out, 1);
        for (std::size_t w = 0; w < out.words().size(); ++w) out.words()[w] &= ~padded.words()[w];
      }
      air.push_back(crop(out, kMargin));
      const Dims d = padded.dims();
      std::int64_t count = 0;
      for (std::int64_t z = 1; z + 1 < d.z; ++z)
        for (std::int64_t y = 1; y + 1 < d.y; ++y)
          for (std::int64_t x = 1; x + 1 < d.x; ++x)
            if (padded.get(x, y, z))
              for (const auto& [dx, dy, dz] :
                   {std::array{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
                count += !padded.get(x + dx, y + dy, z + dz) && !out.get(x + dx, y + dy, z + dz);
      faces.push_back(count);
    }
    const auto most = static_cast<double>(*std::max_element(faces.begin(), faces.end()));
    int expected = 0;
    while (static_cast<double>(faces[static_cast<std::size_t>(expected)]) < 0.85 * most) ++expected;
    broken += expected > 0;
    SilentProgress progress;
    const Exterior found = find_exterior(inside, kLargest, progress).value();
    EXPECT_EQ(found.crack_radius, expected) << round;
    EXPECT_EQ(found.enclosed_faces, faces[static_cast<std::size_t>(expected)]) << round;
    EXPECT_TRUE(found.air == air[static_cast<std::size_t>(expected)]) << round;
  }
  EXPECT_GE(broken, 3);
  EXPECT_LE(broken, 11);
}

TEST(DepthField, DepthInABallIsTheDistanceToItsSurface) {
  const glm::vec3 centre(40.0f, 41.0f, 39.0f);
  const BitVolume ball = make_bits({80, 80, 80}, [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return glm::distance(glm::vec3(x, y, z), centre) < 30.0f;
  });
  SilentProgress progress;
  for (const int seal : {0, 4}) {
    const auto field = DepthField::make(ball, seal, progress);
    ASSERT_TRUE(field.has_value());
    for (const glm::vec3& d :
         {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0.6f, 0.0f, 0.8f), glm::vec3(-0.577f)})
      for (const float r : {10.0f, 20.0f, 26.0f}) {
        const glm::vec3 p = centre + r * d;
        if (seal == 0) {
          EXPECT_NEAR(field->depth(p), 30.0f - r, 1.2f);
        }
        EXPECT_GT(glm::dot(field->inwards(p), -glm::normalize(d)), 0.97f);
      }
  }
}

TEST(DepthField, ItIsTheDistanceToTheNearestPointOutsideAsMeansOfFiveLeaveItTwice) {
  const Dims d{17, 11, 14}, wide{d.x + 2, d.y + 2, d.z + 2};  // one layer of exterior around the grid
  std::mt19937 random(7);
  const BitVolume bits = make_bits(d, [&](auto...) { return random_bit(random, 930); });
  const BitVolume outside = flood_from_border(bits);
  const auto count = static_cast<std::size_t>(wide.count());
  const auto place = [&](std::size_t i) {
    const auto n = static_cast<std::int64_t>(i);
    return std::array<std::int64_t, 3>{n % wide.x, n / wide.x % wide.y, n / wide.slice()};
  };
  std::vector<bool> open(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, y, z] = place(i);
    const bool around = x == 0 || y == 0 || z == 0 || x > d.x || y > d.y || z > d.z;
    open[i] = around || outside.get(x - 1, y - 1, z - 1);
  }
  std::vector<double> expected(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t least = 1 << 30;
    for (std::size_t j = 0; j < count; ++j) {
      if (!open[j]) continue;
      const auto a = place(i), b = place(j);
      least = std::min(least,
                       (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
    }
    expected[i] = std::sqrt(static_cast<double>(least));
  }
  const std::array<std::int64_t, 3> size{wide.x, wide.y, wide.z}, stride{1, wide.x, wide.slice()};
  for (std::size_t turn = 0; turn < 6; ++turn) {
    const std::size_t axis = turn % 3;
    const std::vector<double> before = expected;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t here = place(i)[axis];
      expected[i] = 0.0;
      for (std::int64_t k = -2; k <= 2; ++k)
        expected[i] += before[i + static_cast<std::size_t>(
                                      (std::clamp<std::int64_t>(here + k, 0, size[axis] - 1) - here) * stride[axis])] /
                       5.0;
    }
  }
  SilentProgress progress;
  const auto field = DepthField::make(bits, 0, progress);
  ASSERT_TRUE(field.has_value());
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, y, z] = place(i);
    EXPECT_NEAR(field->depth(glm::vec3(x - 1, y - 1, z - 1)), expected[i], 1e-4) << x << " " << y << " " << z;
  }
}

TEST(DepthField, GrooveNarrowerThanTheSealDoesNotBendIt) {
  const BitVolume slab = make_bits({96, 96, 60}, [](std::int64_t x, std::int64_t, std::int64_t z) {
    return z < 50 && !(x >= 45 && x < 51 && z > 40);
  });
  SilentProgress progress;
  const auto field = DepthField::make(slab, 6, progress);
  ASSERT_TRUE(field.has_value());
  for (float x = 35.0f; x < 61.0f; x += 1.0f) EXPECT_LT(field->inwards({x, 48.0f, 34.0f}).z, -0.98f) << x;
}

}  // namespace
}  // namespace dubsar
