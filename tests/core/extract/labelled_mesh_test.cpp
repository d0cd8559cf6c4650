#include "core/extract/labelled/labelled_mesh.h"

#include <gtest/gtest.h>

#include <functional>
#include <glm/vec4.hpp>
#include <map>
#include <set>

#include "tests/core/extract/labelled_help.h"
#include "tests/core/extract/random_volume.h"

namespace dubsar {
namespace {

void expect_manifolds(const LabelledScene& scene) {
  const BuiltMesh labelled = scene.build();
  const Triangulation cut = triangulate(labelled.mesh, {});
  expect_closed_manifolds(labelled, all_positions(labelled.mesh, cut), cut.triangles, cut.first_triangle);
}

TEST(LabelledMesh, IsTodaysMeshWhereNoTwoClaysAre) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const SurfaceSamples samples = sample(random_volume({23, 19, 17}, seed, static_cast<int>(seed)), 0.0f);
    SilentProgress progress;
    const EdgeIndex index = *EdgeIndex::create(samples);
    for (const bool envelope : {false, true}) {
      EnvelopeBits bits(samples.dims);
      LabelledScene::each(samples.dims, [&](auto x, auto y, auto z) { bits.set(x, y, z, envelope); });
      const PointLabels labels(samples.signs, bits);
      const ContactEdges edges(labels);
      EXPECT_TRUE(edges.all().empty());
      const BuiltMesh labelled(*build_labelled_mesh(samples, index, labels, edges, {}, progress), samples, index,
                               labels);
      const QuadMesh today = build(samples);
      EXPECT_TRUE(labelled.mesh.positions == today.positions);
      EXPECT_TRUE(labelled.mesh.quads == today.quads);
      EXPECT_TRUE(labelled.mesh.doubled == today.doubled);
      EXPECT_TRUE(labelled.mesh.incident == today.incident);
      EXPECT_TRUE(labelled.mesh.first_incident == today.first_incident);
      const auto pair = BuiltMesh::label_pair(PointLabel::kAir, envelope ? PointLabel::kEnvelope : PointLabel::kTablet);
      EXPECT_TRUE(std::ranges::all_of(labelled.pairs, [&](std::uint8_t p) { return p == pair; }));
    }
  }
}

TEST(PointLabels, HoldWhatWasSetAndGiveTilesOfOneClayBack) {
  const Dims dims{150, 9, 11};
  std::mt19937 random(3);
  BitVolume inside(dims);
  LabelledScene::each(dims, [&](auto x, auto y, auto z) { inside.set(x, y, z, random() % 4 != 0); });
  EnvelopeBits bits(dims);
  const PointLabels labels(inside, bits);
  Labels wanted(dims);
  LabelledScene::each(dims, [&](auto x, auto y, auto z) { wanted.at(x, y, z) = inside.get(x, y, z) ? 1 : 0; });
  const auto label = [&](std::int64_t x, std::int64_t y, std::int64_t z, std::uint8_t clay) {
    if (wanted.at(x, y, z) != 0) wanted.at(x, y, z) = clay;
  };
  for (std::int64_t y = 0; y < 9; ++y)
    for (std::int64_t z = 0; z < 11; ++z) {
      const std::int64_t begin = z < 4 ? 0 : 20, end = z < 4 ? 64 : 140;
      bits.set_run(begin, end, y, z);
      for (std::int64_t x = begin; x < end; ++x) label(x, y, z, 2);
    }
  for (int i = 0; i < 300; ++i) {
    const std::int64_t x = 64 + static_cast<std::int64_t>(random() % 86), y = static_cast<std::int64_t>(random() % 9),
                       z = static_cast<std::int64_t>(random() % 11);
    const bool envelope = random() % 2 != 0;
    bits.set(x, y, z, envelope);
    label(x, y, z, envelope ? 2 : 1);
  }
  const std::size_t before = bits.bytes();
  bits.compact(inside);
  EXPECT_LT(bits.bytes(), before) << "the first words of four slices are the envelope's alone";
  LabelledScene::each(dims, [&](auto x, auto y, auto z) {
    ASSERT_EQ(static_cast<int>(labels.get(x, y, z)), wanted.at(x, y, z)) << x << " " << y << " " << z;
    ASSERT_EQ(labels.envelope_word(x >> 6, y, z) >> (x & 63) & 1u, wanted.at(x, y, z) == 2);
    ASSERT_EQ(labels.tablet_word(x >> 6, y, z) >> (x & 63) & 1u, wanted.at(x, y, z) == 1);
  });
  EnvelopeBits other(dims);
  LabelledScene::each(dims, [&](auto x, auto y, auto z) { other.set(x, y, z, wanted.at(x, y, z) != 1); });
  other.compact(inside);
  EXPECT_TRUE(other == bits) << "points of air count for nothing";
  EXPECT_EQ(labels.get(-1, 0, 0), PointLabel::kAir);
  EXPECT_EQ(labels.envelope_word(0, 9, 0), 0u);
}

TEST(LabelledMesh, EveryLabellingOfACellGivesClosedManifoldsOfAllLabels) {
  for (const unsigned part : {0u, 1u, 2u})
    expect_manifolds(LabelledScene(all_labellings(11, static_cast<int>(part), 3)).draw(12 + part));
}

TEST(LabelledMesh, DrawnSmoothAndNestedVolumesGiveClosedManifoldsOfAllLabels) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    expect_manifolds(LabelledScene(random_labels({32, 32, 32}, seed)).draw(seed + 100));
    expect_manifolds(LabelledScene(random_labels({70, 5, 9}, seed, {2, 1, 1})).draw(seed + 200));
    expect_manifolds(LabelledScene(nested_labels(40, 0.25 * seed, seed)).draw(seed + 300));
  }
  for (unsigned seed = 0; seed < 2; ++seed)
    expect_manifolds(LabelledScene(smooth_labels({64, 64, 64}, seed)).draw(seed));
}

TEST(LabelledMesh, TakesNoMoreMemoryThanItHolds) {
  const BuiltMesh labelled = LabelledScene(nested_labels(40, 0.2, 5)).build();
  const auto expect_full = [](const auto& items) { EXPECT_EQ(items.capacity(), items.size()); };
  ASSERT_LT(labelled.first_contact, labelled.mesh.quads.size());
  expect_full(labelled.mesh.quads);
  expect_full(labelled.mesh.incident);
  EXPECT_LE(labelled.mesh.positions.capacity(), labelled.unlabelled.size() + labelled.cells.size());
}

TEST(LabelledMesh, EveryGridEdgeBetweenTwoLabelsHasOneXQuadWithItsLabels) {
  const Labels volume = random_labels({9, 11, 70}, 4);
  const BuiltMesh labelled = LabelledScene(volume).build();
  std::map<int, std::int64_t> wanted, found;
  const auto label = [&](std::int64_t x, std::int64_t y, std::int64_t z) -> int {
    const Dims& d = volume.dims;
    return x < 0 || y < 0 || z < 0 || x >= d.x || y >= d.y || z >= d.z ? 0 : volume.at(x, y, z);
  };
  for (std::int64_t z = -1; z < volume.dims.z; ++z)
    for (std::int64_t y = -1; y < volume.dims.y; ++y)
      for (std::int64_t x = -1; x < volume.dims.x; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          const int a = label(x, y, z), b = label(x + (axis == 0), y + (axis == 1), z + (axis == 2));
          if (a != b) ++wanted[std::min(a, b) | std::max(a, b) << 2];
        }
  for (const std::uint8_t pair : labelled.pairs) ++found[pair];
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(labelled.pairs.size(), labelled.mesh.quads.size());
}

// --- Moved, mirrored and relabelled volumes.

using Place = std::array<long, 3>;
/// Polygons by the places of their vertices, from the smallest on, with their labels, as seen from the lower one.
using Polygons = std::multiset<std::pair<std::vector<Place>, std::array<int, 2>>>;

Polygons polygons_of(const BuiltMesh& labelled, const std::function<glm::dvec3(glm::dvec3)>& map, bool reverse,
                     const std::array<int, 3>& relabel = {0, 1, 2}, const std::set<Place>& without = {}) {
  Polygons all;
  for (std::uint32_t q = 0; q < labelled.mesh.quads.size(); ++q) {
    const Polygon polygon = labelled.mesh.polygon(q);
    int low = relabel[labelled.pairs[q] & 3u], high = relabel[labelled.pairs[q] >> 2];
    std::vector<Place> places;
    bool skipped = false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.size); ++i) {
      const glm::dvec3 at(labelled.mesh.positions[polygon.vertex[i]]), p = map(at);
      skipped = skipped || without.contains({static_cast<long>(std::floor(at.x)), static_cast<long>(std::floor(at.y)),
                                             static_cast<long>(std::floor(at.z))});
      places.push_back({std::lround(p.x * 80640), std::lround(p.y * 80640), std::lround(p.z * 80640)});
    }
    if (skipped) continue;
    if (reverse != (low > high)) std::reverse(places.begin(), places.end());
    if (low > high) std::swap(low, high);
    std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
    all.insert({places, {low, high}});
  }
  return all;
}

/// No face of it has two labels in turn, so that nothing is decided but by the rule of three labels.
Labels without_faces_in_turn(Labels volume, unsigned seed) {
  std::mt19937 random(seed);
  const Dims& d = volume.dims;
  for (bool changed = true; changed;) {
    changed = false;
    LabelledScene::each(d, [&](auto x, auto y, auto z) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t ux = axis == 2, uy = axis == 0, uz = axis == 1, vx = axis == 1, vy = axis == 2,
                           vz = axis == 0;
        if (x + ux + vx >= d.x || y + uy + vy >= d.y || z + uz + vz >= d.z) continue;
        std::uint8_t& a = volume.at(x, y, z);
        const std::uint8_t b = volume.at(x + ux, y + uy, z + uz), c = volume.at(x + ux + vx, y + uy + vy, z + uz + vz);
        const std::uint8_t e = volume.at(x + vx, y + vy, z + vz);
        if (a != c || b != e || a == b) continue;
        a = static_cast<std::uint8_t>(random() % 3);
        changed = true;
      }
    });
  }
  return volume;
}

/// Each edge of the grid has its crossing, whatever is at its ends.
void draw_by_place(LabelledScene& scene, const std::function<glm::ivec4(glm::ivec4)>& map) {
  const auto drawn = [&](std::int64_t x, std::int64_t y, std::int64_t z, int axis) {
    const glm::ivec4 at = map({x, y, z, axis});  // w: axis, + 4 where it runs the other way
    const unsigned hash = static_cast<unsigned>(((at.x * 73 + at.y) * 89 + at.z) * 3 + at.w % 4) * 2654435761u;
    const auto offset = static_cast<std::uint16_t>(hash >> 27 & 15u);
    return at.w < 4 ? offset : static_cast<std::uint16_t>(15 - offset);
  };
  const BitVolume& signs = scene.samples->signs;
  LabelledScene::each(signs.dims(), [&](auto x, auto y, auto z) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto nx = x + (axis == 0), ny = y + (axis == 1), nz = z + (axis == 2);
      if (nx == signs.dims().x || ny == signs.dims().y || nz == signs.dims().z) continue;
      if (signs.get(x, y, z) != signs.get(nx, ny, nz))
        scene.samples->offsets[scene.index->quad_of(axis, x, y, z)] = drawn(x, y, z, axis);
    }
  });
  for (std::size_t i = 0; i < scene.contact.size(); ++i) {
    const GridEdge& e = scene.edges->all()[i];
    scene.contact[i] = drawn(e.x, e.y, e.z, e.axis);
  }
}

const auto kSame = [](glm::dvec3 p) { return p; };

TEST(LabelledMesh, AShiftOfTheGridShiftsTheMesh) {
  const Labels volume = random_labels({20, 18, 22}, 5);
  LabelledScene scene(in_air(volume, {1, 1, 1}, {1, 1, 1})), moved(in_air(volume, {64, 2, 7}, {3, 1, 1}));
  draw_by_place(scene, [](glm::ivec4 at) { return at; });
  draw_by_place(moved, [](glm::ivec4 at) { return at - glm::ivec4(63, 1, 6, 0); });
  const auto wanted = polygons_of(scene.build(), kSame, false);
  EXPECT_TRUE(wanted == polygons_of(
                            moved.build(), [](glm::dvec3 p) { return p - glm::dvec3(63, 1, 6); }, false));
}

TEST(LabelledMesh, ExchangingLabelsExchangesParts) {
  const Labels volume = in_air(without_faces_in_turn(random_labels({22, 20, 18}, 6), 7), {2, 2, 2}, {2, 2, 2});
  LabelledScene scene(without_faces_in_turn(volume, 8));
  const Labels& labels = volume;
  draw_by_place(scene, [](glm::ivec4 at) { return at; });
  const BuiltMesh mesh = scene.build();
  std::array<int, 3> to{0, 1, 2};
  while (std::next_permutation(to.begin(), to.end())) {
    if (to[0] != 0) continue;  // the border is air
    Labels other = labels;
    for (std::uint8_t& label : other.voxels) label = static_cast<std::uint8_t>(to[label]);
    LabelledScene exchanged(other);
    draw_by_place(exchanged, [](glm::ivec4 at) { return at; });
    EXPECT_TRUE(polygons_of(mesh, kSame, false, to) == polygons_of(exchanged.build(), kSame, false));
  }
}

/// Cells whose chords do not follow every symmetry (LabelledCellTable.ChordsFollowTheSymmetriesWhereTheyCan), in a
/// volume without faces in turn.
std::set<Place> cells_of_free_choice(const Labels& volume) {
  const LabelledCellTable& table = LabelledCellTable::instance();
  std::set<Place> cells;
  LabelledScene::each({volume.dims.x - 1, volume.dims.y - 1, volume.dims.z - 1}, [&](auto x, auto y, auto z) {
    CornerLabels labels;
    for (unsigned c = 0; c < 8; ++c) labels[c] = volume.at(x + (c & 1u), y + (c >> 1 & 1u), z + (c >> 2));
    const int id = table.id(LabelledCellTable::labelling(labels), 0);
    for (const LabelledSymmetry& g : labelled_symmetries()) {
      std::vector<LabelledChord> image(table.chords(id).begin(), table.chords(id).end());
      if (image.empty()) break;
      for (LabelledChord& chord : image) {
        for (std::uint8_t& e : chord.edges)
          if (e != LabelledChord::kNone) e = g.cell.edge[e];
        std::ranges::sort(chord.edges);
      }
      std::ranges::sort(image);
      if (!std::ranges::equal(image, table.chords(transform_config(table, id, g)))) cells.insert({x, y, z});
    }
  });
  return cells;
}

TEST(LabelledMesh, MirroredVolumesGiveTheMirroredMesh) {
  const Labels volume = in_air(without_faces_in_turn(random_labels({22, 20, 18}, 16), 17), {1, 1, 1}, {1, 1, 1});
  const Labels whole = without_faces_in_turn(volume, 18);
  const auto x_last = static_cast<int>(whole.dims.x) - 1;
  Labels mirrored(whole.dims);
  LabelledScene::each(whole.dims, [&](auto x, auto y, auto z) { mirrored.at(x, y, z) = whole.at(x_last - x, y, z); });
  LabelledScene scene(whole), other(mirrored);
  draw_by_place(scene, [](glm::ivec4 at) { return at; });
  draw_by_place(other, [&](glm::ivec4 at) {
    return at.w == 0 ? glm::ivec4(x_last - 1 - at.x, at.y, at.z, 4) : glm::ivec4(x_last - at.x, at.y, at.z, at.w);
  });
  const BuiltMesh mesh = scene.build();
  const auto wanted = polygons_of(
      mesh, [&](glm::dvec3 p) { return glm::dvec3(x_last - p.x, p.y, p.z); }, true, {0, 1, 2},
      cells_of_free_choice(whole));
  EXPECT_GT(wanted.size(), mesh.mesh.quads.size() / 2);
  EXPECT_TRUE(wanted == polygons_of(other.build(), kSame, false, {0, 1, 2}, cells_of_free_choice(mirrored)));
}

}  // namespace
}  // namespace dubsar
