// Does the surface cross or touch itself anywhere, by exact predicates, whichever allowed diagonals are taken?
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "core/extract/piece_moves.h"
#include "core/extract/quad_cuts.h"
#include "core/mesh/exact_crossings.h"
#include "core/relief/smoothing/smooth.h"
#include "tests/core/extract/extract_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

glm::vec3 anywhere(std::uint32_t, const glm::vec3& wanted) { return wanted; }

/// Closed, a 2-manifold, without crossing pairs and triangles of no area, with either kind of diagonal.
void expect_embedded(const QuadMesh& mesh, const std::string& what) {
  std::mt19937 bits(1);
  std::vector<glm::vec3> normals(mesh.positions.size());
  for (glm::vec3& n : normals)
    n = glm::normalize(glm::vec3(glm::ivec3(bits() % 199, bits() % 199, bits() % 199)) - 98.7f);
  for (const bool guided : {false, true}) {
    const Triangulation cut = triangulate(mesh, guided ? normals : std::vector<glm::vec3>{});
    const std::vector<glm::vec3> positions = all_positions(mesh, cut);
    const MeshCheck check = check_mesh(positions, cut.triangles);
    EXPECT_TRUE(check.triangles == 0 || check.watertight()) << what;
    EXPECT_EQ(check_exactly(positions, cut.triangles), ExactCheck{}) << what;
  }
}

/// Air around, so that no vertex lies on the border of the grid.
Volume<float> with_air_around(Volume<float> volume) {
  const Dims& d = volume.dims;
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x)
        if (x == 0 || y == 0 || z == 0 || x == d.x - 1 || y == d.y - 1 || z == d.z - 1) volume.at(x, y, z) = -1.0f;
  return volume;
}

/// As extracted, then smoothed, each with the vertices moved that have to; returns how many cells were concerned.
PieceMoves expect_embedded_twice(const Volume<float>& volume, const std::string& what, int bits = 4) {
  QuadMesh mesh = build(sample(volume, 0.0f, true, bits));
  const std::vector<glm::vec3> safe = mesh.positions;
  PieceMoves moves = part_pieces(mesh, safe, anywhere);
  EXPECT_EQ(moves.left, 0) << what;
  expect_embedded(mesh, what);
  if (mesh.quads.empty()) return moves;
  QuadMesh smoothed = build(sample(volume, 0.0f, true, bits));
  SilentProgress progress;
  std::vector<glm::vec3> normals;
  SmoothOptions options;
  options.max_displacement_vox = 1.0f;  // far more than the pipeline's
  EXPECT_TRUE(smooth(smoothed, normals, options, progress).has_value());
  const PieceMoves more = part_pieces(smoothed, safe, anywhere);
  EXPECT_EQ(more.left, 0) << what;
  expect_embedded(smoothed, what + ", smoothed");
  moves.touching += more.touching;
  moves.moved += more.moved;
  return moves;
}

TEST(Embedding, NoConfigurationOfACellCrossesInDrawnSurroundings) {
  // Every sign pattern in the middle of 6^3 points, the rest and all crossings drawn: half of them near grid points.
  std::mt19937 bits(20261127);
  std::int64_t touching = 0;
  for (unsigned signs = 0; signs < 256; ++signs)
    for (int draw = 0; draw < 4; ++draw) {
      Volume<float> volume({6, 6, 6});
      for (float& value : volume.voxels.span()) {
        const float share = static_cast<float>(bits() >> 8) * 0x1p-24f;
        value = (bits() & 1u ? 1.0f : -1.0f) * (bits() & 1u ? std::pow(0.01f, share) : share + 1e-3f);
      }
      for (unsigned c = 0; c < 8; ++c) {
        float& value = volume.at(2 + (c & 1u), 2 + (c >> 1 & 1u), 2 + (c >> 2));
        value = std::abs(value) * (signs >> c & 1u ? 1.0f : -1.0f);
      }
      touching += expect_embedded_twice(with_air_around(std::move(volume)), "signs " + std::to_string(signs)).touching;
      if (::testing::Test::HasFailure()) return;
    }
  EXPECT_GT(touching, 10) << "no cell needed its vertices moved: the draws are too tame";
}

TEST(Embedding, RandomVolumesDoNotCrossBeforeAndAfterSmoothing) {
  for (int kind = 0; kind < 5; ++kind)
    expect_embedded_twice(with_air_around(random_volume({22, 22, 22}, 91u + static_cast<unsigned>(kind), kind)),
                          "kind " + std::to_string(kind));
  expect_embedded_twice(with_air_around(random_volume({14, 14, 14}, 5, 0)), "5 bits", 5);
  expect_embedded_twice(with_air_around(random_volume({14, 14, 14}, 6, 0)), "2 bits", 2);
}

TEST(Embedding, ARoughBallDoesNotCrossAndTakesFewFans) {
  Volume<float> volume({40, 40, 40});
  std::mt19937 bits(5);
  for (std::int64_t z = 0; z < 40; ++z)
    for (std::int64_t y = 0; y < 40; ++y)
      for (std::int64_t x = 0; x < 40; ++x)
        volume.at(x, y, z) = 15.0f - glm::length(glm::vec3(glm::i64vec3(x, y, z)) - 19.5f) +
                             0.8f * (static_cast<float>(bits() >> 8) * 0x1p-24f - 0.5f);
  expect_embedded_twice(volume, "ball");
  const QuadCuts cuts = find_cuts(build(sample(volume, 0.0f)));
  EXPECT_EQ(std::ranges::count(cuts.of_quad, QuadCut::kFree), 0);
  EXPECT_LT(std::ranges::count(cuts.of_quad, QuadCut::kFan), static_cast<std::ptrdiff_t>(cuts.of_quad.size()) / 20);
}

TEST(Embedding, WithoutItTheSameSurfacesCross) {
  std::int64_t pairs = 0;
  for (const unsigned seed : {91u, 92u}) {
    QuadMesh mesh = build(sample(with_air_around(random_volume({32, 32, 32}, seed, 0)), 0.0f));
    mesh.embedded = false;
    const Triangulation cut = triangulate(mesh, {});
    pairs += check_exactly(all_positions(mesh, cut), cut.triangles).crossing_pairs;
  }
  EXPECT_GT(pairs, 100);
}

TEST(EmbeddingLong, LargerVolumesDoNotCrossBeforeAndAfterSmoothing) {
  for (int kind = 0; kind < 5; ++kind)
    for (const unsigned seed : {500u, 600u})
      expect_embedded_twice(with_air_around(random_volume({40, 40, 40}, seed + static_cast<unsigned>(kind), kind)),
                            "kind " + std::to_string(kind) + " seed " + std::to_string(seed));
}

TEST(Embedding, AllowedDiagonalsLieInTheTetrahedraAroundTheEdge) {
  std::mt19937 bits(3);
  const auto draw = [&] { return static_cast<std::int64_t>(1 + bits() % 1023); };
  std::array<int, 4> found{};
  int refused = 0, outside = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const int axis = trial % 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const ExactPlace low(5 * kExactSteps, 7 * kExactSteps, 3 * kExactSteps);
    std::array<ExactPlace, 4> corner;
    for (int i = 0; i < 4; ++i) {
      ExactPlace p = low;
      p[axis] += draw();
      p[u] += (i == 0 || i == 3 ? 1 : -1) * draw();
      p[v] += (i < 2 ? 1 : -1) * draw();
      corner[static_cast<std::size_t>(i)] = p;
    }
    if (trial % 2 == 1) std::swap(corner[1], corner[3]);  // the other way round
    const auto edge = edge_of_quad(corner);
    ASSERT_TRUE(edge && edge->strict && !edge->flat);
    ASSERT_EQ(edge->low, low);
    ASSERT_EQ(edge->axis, axis);
    ExactPlace end = low;
    end[axis] += kExactSteps;
    const auto inside = [&](const ExactPlace& p, std::int64_t scale) {
      for (std::size_t i = 0; i < 4; ++i) {
        std::array<ExactPlace, 4> t{corner[i] * scale, corner[(i + 1) % 4] * scale, low * scale, end * scale};
        bool in = true;
        for (std::size_t k = 0; k < 4 && in; ++k) {
          std::array<ExactPlace, 4> with = t;
          with[k] = p;
          in = orientation(with[0], with[1], with[2], with[3]) * orientation(t[0], t[1], t[2], t[3]) >= 0;
        }
        if (in) return true;
      }
      return false;
    };
    const unsigned allowed = allowed_diagonals(corner, *edge);
    ASSERT_EQ(allowed_inside(corner), allowed) << trial;
    ++found[allowed];
    for (std::size_t first = 0; first < 2; ++first) {
      bool all_inside = true;
      for (std::size_t half = 0; half < 2; ++half) {
        const std::array<ExactPlace, 3> t{corner[first], corner[(first + 1 + half) % 4],
                                          corner[(first + 2 + half) % 4]};
        constexpr int kScale = 24;
        for (int i = 0; i <= kScale; ++i)
          for (int j = 0; i + j <= kScale; ++j)
            all_inside =
                all_inside &&
                inside(t[0] * std::int64_t{i} + t[1] * std::int64_t{j} + t[2] * std::int64_t{kScale - i - j}, kScale);
      }
      if (allowed >> first & 1u)
        ASSERT_TRUE(all_inside) << trial;
      else
        ++refused, outside += !all_inside;
    }
  }
  for (const int count : found) EXPECT_GT(count, 50);
  EXPECT_GT(outside, refused * 9 / 10) << "diagonals are refused that leave the tetrahedra nowhere";
}

}  // namespace
}  // namespace dubsar
