// Extraction of mirrored, turned and inverted volumes: the same surface, mirrored, turned and inverted.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <set>

#include "core/extract/cell_table.h"
#include "core/extract/row_kernels.h"
#include "tests/core/extract/extract_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

using Point = std::array<int, 3>;

/// Polygons by the places of their vertices, turned to start at the smallest. With 4-bit offsets the coordinates are
/// whole multiples of 1 / (32 * 2520): 2520 can be divided by any number of crossings of a piece.
std::multiset<std::vector<std::array<long, 3>>> polygons(const QuadMesh& mesh,
                                                         const std::function<glm::dvec3(glm::dvec3)>& map, bool reverse,
                                                         const std::set<Point>& without = {}) {
  std::multiset<std::vector<std::array<long, 3>>> all;
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q) {
    const Polygon polygon = mesh.polygon(q);
    std::vector<std::array<long, 3>> places;
    bool skipped = false;
    for (int i = 0; i < polygon.size; ++i) {
      const glm::vec3& at = mesh.positions[polygon.vertex[static_cast<std::size_t>(i)]];
      for (unsigned side = 0; side < 8 && !without.empty(); ++side) {  // cells that touch the vertex
        Point cell;
        for (int a = 0; a < 3; ++a) {
          cell[static_cast<std::size_t>(a)] =
              static_cast<int>(side >> a & 1u ? std::floor(at[a]) : std::ceil(at[a]) - 1.0f);
        }
        skipped |= without.contains(cell);
      }
      const glm::dvec3 p = map(glm::dvec3(at));
      places.push_back({std::lround(p.x * 80640), std::lround(p.y * 80640), std::lround(p.z * 80640)});
    }
    if (skipped) continue;
    if (reverse) std::reverse(places.begin(), places.end());
    std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
    all.insert(places);
  }
  return all;
}

/// Low corners of the cells whose split cannot follow every symmetry (CellTable,
/// SplitsFollowEverySymmetryWhereChordsCan).
std::set<Point> cells_without_symmetry(const Volume<float>& volume, float tau) {
  const CellTable& table = CellTable::instance();
  std::set<int> ids;
  for (int id = 0; id < CellTable::kConfigs; ++id) {
    for (const CellSymmetry& g : cell_symmetries()) {
      std::vector<CellChord> image;
      for (const CellChord& chord : table.chords(id)) {
        image.push_back({std::min(g.edge[chord.a], g.edge[chord.b]), std::max(g.edge[chord.a], g.edge[chord.b])});
      }
      std::ranges::sort(image);
      if (!std::ranges::equal(image, table.chords(transform_config(table, id, g)))) ids.insert(id);
    }
  }
  std::set<Point> cells;
  for (int z = 0; z + 1 < volume.dims.z; ++z) {
    for (int y = 0; y + 1 < volume.dims.y; ++y) {
      for (int x = 0; x + 1 < volume.dims.x; ++x) {
        const auto value = [&](unsigned c) { return volume.at(x + (c & 1u), y + (c >> 1 & 1u), z + (c >> 2)); };
        unsigned signs = 0, resolution = 0, place = 0;
        for (unsigned c = 0; c < 8; ++c) signs |= unsigned{value(c) >= tau} << c;
        for (unsigned f = 0; f < 6; ++f) {
          if (!(table.ambiguous_faces(signs) >> f & 1u)) continue;
          const unsigned a = f / 2, u = 1u << ((a + 1) % 3), v = 1u << ((a + 2) % 3), c = (f & 1u) << a;
          resolution |= unsigned{joins_inside(value(c), value(c | u), value(c | v), value(c | u | v), tau)} << place++;
        }
        if (ids.contains(table.id(signs, resolution))) cells.insert({x, y, z});
      }
    }
  }
  return cells;
}

/// Noise, low-pass filtered twice: curved, with many ambiguous faces.
Volume<float> smooth_volume(Dims dims, unsigned seed) {
  Volume<float> volume = random_volume(dims, seed, 0);
  for (const int axis : {0, 1, 2, 0, 1, 2}) {
    Volume<float> next(dims);
    for (std::int64_t z = 0; z < dims.z; ++z) {
      for (std::int64_t y = 0; y < dims.y; ++y) {
        for (std::int64_t x = 0; x < dims.x; ++x) {
          const auto at = [&](std::int64_t d) {
            return volume.at(std::clamp<std::int64_t>(x + (axis == 0) * d, 0, dims.x - 1),
                             std::clamp<std::int64_t>(y + (axis == 1) * d, 0, dims.y - 1),
                             std::clamp<std::int64_t>(z + (axis == 2) * d, 0, dims.z - 1));
          };
          next.at(x, y, z) = at(0) + 0.5f * (at(-1) + at(1));
        }
      }
    }
    volume = std::move(next);
  }
  return volume;
}

TEST(ExtractSymmetry, MirroredAndTurnedVolumesGiveTheMirroredAndTurnedMesh) {
  std::size_t doubled = 0;
  for (const bool closed : {true, false}) {
    const Dims dims{32, 32, 32};
    const Volume<float> volume = smooth_volume(dims, 4);
    const QuadMesh mesh = build(sample(volume, 0.1f, closed));
    doubled += mesh.doubled.size();
    const std::set<Point> special = cells_without_symmetry(volume, 0.1f);
    EXPECT_LT(special.size(), 0.01 * static_cast<double>(mesh.vertex_count()));
    const double last = static_cast<double>(dims.x - 1);
    // New coordinates of an old point: `axes` permutes, `flips` mirrors; an odd number of both together reverses.
    struct Turn {
      std::array<int, 3> axes;
      std::array<bool, 3> flips;
      bool reverses;
    };
    for (const Turn& turn :
         {Turn{{0, 1, 2}, {true, false, false}, true}, Turn{{0, 1, 2}, {false, true, false}, true},
          Turn{{0, 1, 2}, {false, false, true}, true}, Turn{{1, 0, 2}, {true, false, false}, false},
          Turn{{0, 2, 1}, {false, true, false}, false}, Turn{{1, 2, 0}, {false, false, false}, false},
          Turn{{2, 1, 0}, {false, false, true}, false}}) {
      const auto to_new = [&](const glm::dvec3& p) {
        glm::dvec3 image;
        for (std::size_t a = 0; a < 3; ++a) {
          const double c = p[turn.axes[a]];
          image[static_cast<int>(a)] = turn.flips[a] ? last - c : c;
        }
        return image;
      };
      Volume<float> turned(dims);
      for (std::int64_t z = 0; z < dims.z; ++z) {
        for (std::int64_t y = 0; y < dims.y; ++y) {
          for (std::int64_t x = 0; x < dims.x; ++x) {
            const glm::dvec3 p = to_new({x, y, z});
            turned.at(std::lround(p.x), std::lround(p.y), std::lround(p.z)) = volume.at(x, y, z);
          }
        }
      }
      const QuadMesh image = build(sample(turned, 0.1f, closed));
      const std::set<Point> special_image = cells_without_symmetry(turned, 0.1f);
      EXPECT_EQ(special_image.size(), special.size());
      EXPECT_EQ(image.vertex_count(), mesh.vertex_count());
      if (closed) {
        EXPECT_EQ(image.doubled.size(), mesh.doubled.size());
      }
      const auto found = polygons(
          image, [](glm::dvec3 p) { return p; }, false, special_image);
      const auto wanted = polygons(mesh, to_new, turn.reverses, special);
      EXPECT_GT(wanted.size(), 0.9 * static_cast<double>(mesh.quad_count()));
      EXPECT_TRUE(found == wanted) << "axes " << turn.axes[0] << turn.axes[1] << turn.axes[2];
    }
  }
  EXPECT_GT(doubled, 0u) << "the volume has no split cell";
}

TEST(ExtractSymmetry, ExchangeOfInsideAndOutsideReversesThePolygons) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Volume<float> volume = random_volume({21, 17, 13}, seed, 0);
    Volume<float> negative(volume.dims);
    for (std::int64_t i = 0; i < volume.dims.count(); ++i) negative.voxels[i] = -volume.voxels[i];
    const auto same = [](glm::dvec3 p) { return p; };
    const QuadMesh mesh = build(sample(volume, 0.01f, false)), inverse = build(sample(negative, -0.01f, false));
    EXPECT_EQ(mesh.positions.size(), inverse.positions.size());
    EXPECT_TRUE(polygons(mesh, same, true) == polygons(inverse, same, false));
  }
}

}  // namespace
}  // namespace dubsar
