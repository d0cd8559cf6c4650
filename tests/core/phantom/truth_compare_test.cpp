#include "tests/core/phantom/truth_compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/phantom/random.h"

namespace dubsar::phantom {
namespace {

struct Known {
  std::vector<glm::vec3> positions;
  std::vector<std::uint8_t> partition;

  /// A small triangle in the place of each.
  std::vector<glm::vec3> corners() const {
    std::vector<glm::vec3> all;
    for (const glm::vec3& p : positions)
      for (const glm::vec3& off :
           {glm::vec3(0.02f, 0.0f, -0.01f), glm::vec3(-0.01f, 0.02f, 0.0f), glm::vec3(-0.01f, -0.02f, 0.01f)})
        all.push_back(p + off);
    return all;
  }
  std::vector<std::array<std::uint32_t, 3>> triangles() const {
    std::vector<std::array<std::uint32_t, 3>> all;
    for (std::uint32_t i = 0; i < positions.size(); ++i) all.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    return all;
  }
};

// Vertices at a known distance off the true surface of known parts.
Known known_vertices(const Phantom& phantom, double offset) {
  Random random(1, 5);
  const Dims d = phantom.options().dims;
  Known known;
  while (known.positions.size() < 3000) {
    glm::dvec3 p{random.uniform(0, static_cast<double>(d.x)), random.uniform(0, static_cast<double>(d.y)),
                 random.uniform(0, static_cast<double>(d.z))};
    double distance = phantom.signed_distance(p);
    if (std::abs(distance) > 2.0) continue;
    const auto gradient = [&] {
      glm::dvec3 g;
      for (int a = 0; a < 3; ++a) {
        glm::dvec3 e(0.0);
        e[a] = 0.05;
        g[a] = phantom.signed_distance(p + e) - phantom.signed_distance(p - e);
      }
      return glm::normalize(g);
    };
    for (int i = 0; i < 4; ++i) {
      p += (offset - distance) * gradient();
      distance = phantom.signed_distance(p);
    }
    if (std::abs(distance - offset) > 0.01) continue;
    const Part part = phantom.nearest_part(p);
    if (part > Part::kEnvelopeInside) continue;
    known.positions.emplace_back(p);
    known.partition.push_back(part == Part::kTablet ? 5 : part == Part::kEnvelopeOutside ? 2 : 7);
  }
  return known;
}

std::shared_ptr<const Phantom> make() {
  PhantomOptions options;
  options.seed = 2;
  return Phantom::create(options).value();
}

TEST(TruthCompare, MeasuresAKnownDistance) {
  const auto phantom = make();
  for (const double offset : {0.0, 0.4}) {
    const Known known = known_vertices(*phantom, offset);
    const TruthComparison result = compare(*phantom, {known.positions, {}, {}});
    EXPECT_NEAR(result.all.rms, 0.5 * offset, 0.01);  // processed voxels are 2 input voxels
    EXPECT_NEAR(result.resolved.p95, 0.5 * offset, 0.01);
    EXPECT_EQ(result.all.vertices, 3000);
  }
}

TEST(TruthCompare, FindsWrongLabels) {
  const auto phantom = make();
  Known known = known_vertices(*phantom, 0.0);
  const auto corners = known.corners();
  const auto triangles = known.triangles();
  TruthComparison result = compare(*phantom, {corners, triangles, known.partition});
  for (const auto& score : result.part) {
    EXPECT_EQ(score.purity(), 1.0);
    EXPECT_EQ(score.recall(), 1.0);
  }
  int tablet = 0;
  for (std::uint8_t& label : known.partition)
    if (label == 5 && ++tablet % 10 == 0) label = 2;
  result = compare(*phantom, {corners, triangles, known.partition});
  EXPECT_NEAR(result.owner[0].recall(), 0.9, 0.01);
  EXPECT_EQ(result.owner[0].purity(), 1.0);
  EXPECT_EQ(result.owner[1].recall(), 1.0);
  EXPECT_LT(result.owner[1].purity(), 1.0);
  std::fill(known.partition.begin(), known.partition.end(), std::uint8_t{0});
  EXPECT_EQ(compare(*phantom, {corners, triangles, known.partition}).owner[0].recall(), 0.0);
}

TEST(TruthCompare, MeasuresWedgeDepthAlongItsDirection) {
  const auto phantom = make();
  for (const double ratio : {1.0, 0.85, 0.7, 1.3}) {
    std::vector<glm::vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const Wedge& w : phantom->wedges()) {
      if (w.owner != Owner::kTablet) continue;
      const glm::dvec3 across = glm::cross(w.outward, w.tail), middle = w.position - ratio * w.depth * w.outward;
      const auto first = static_cast<std::uint32_t>(positions.size());
      // A small triangle facing outwards at the depth, and one above it facing inwards that must not be taken.
      for (const double turn : {0.0, 2.1, 4.2})
        positions.emplace_back(middle + 0.05 * (std::cos(turn) * w.tail + std::sin(turn) * across));
      triangles.push_back({first, first + 1, first + 2});
      for (int i = 0; i < 3; ++i)
        positions.emplace_back(glm::dvec3(positions[first + static_cast<std::uint32_t>(i)]) + 1.0 * w.outward);
      triangles.push_back({first + 5, first + 4, first + 3});
    }
    const WedgeScore score = compare(*phantom, {positions, triangles, {}}).wedges;
    ASSERT_GT(score.wedges, 200);
    // Neighbouring triangles are so small that hardly a ray meets a wrong one.
    EXPECT_NEAR(score.mean_ratio, ratio, 0.01);
    EXPECT_NEAR(score.kept_fraction(), std::abs(ratio - 1.0) < 0.2 ? 1.0 : 0.0, 0.01);
  }
}

}  // namespace
}  // namespace dubsar::phantom
